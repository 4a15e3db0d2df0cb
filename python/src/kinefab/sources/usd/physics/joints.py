"""UsdPhysics joints as joints of the scene."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ....diagnostics import Report
from ....model import (
    FREE,
    LOCKED,
    RX,
    RY,
    RZ,
    TX,
    TZ,
    Freedom,
    Joint,
    JointKind,
    Motion,
    SphericalDrive,
    exchange_of,
    freedoms_of,
    kind_of,
    unlocked_of,
)
from ....spatial import Array, Pose, rotation_about, rotation_exp, rotation_log
from ..api import UsdPhysics
from ..found import Found, JointPrim, body_above, moves_beside, world_of
from ..stage import OpenStage
from ..transforms import Stand, rotation_of
from ..values import Values, schemas
from .freedoms import DOFS, Freedoms, Units
from .vendor import passive_of

MAIN = {"X": [0, 1, 2], "Y": [1, 2, 0], "Z": [2, 0, 1]}
"""Which of the joint frame's axes become X Y Z, by the axis token: a cyclic change, so that X is the main one."""
GROUND = -1
ROUNDED = 1e-6
"""Share of a length, and radians, that the 32-bit numbers of frames and poses may be apart by."""
APART = 1e-4
"""Share of a length, and radians, that a text of few digits may put the frames of a fixed joint apart by."""
TURNED = 1e-5
"""Radians, and radians a second, that 32 bits of a drive's target may differ from the same in 64."""
COUPLINGS = ("PhysxPhysicsGearJoint", "PhysxPhysicsRackAndPinionJoint")


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """One side of a joint.  node: GROUND for the world.  axes, origin: joint frame in the source's world."""

    node: int
    axes: Array
    origin: Array


@dataclass(frozen=True, slots=True, eq=False)
class _Draft:
    """freedoms: in the order tx .. rz, of body1 against body0, along the axes that ``order`` picks."""

    freedoms: tuple[Freedom, ...]
    order: list[int]
    extras: dict[str, object]


@dataclass(slots=True, eq=False)
class Readings:
    """How the freedoms of a joint prim are read on the joint: by its id, for each of the prim's the joint's and the sense.
    Joints that are not listed have them as they stand."""

    turned: dict[str, tuple[tuple[int, ...], tuple[int, ...]]] = field(
        default_factory=dict[str, tuple[tuple[int, ...], tuple[int, ...]]]
    )

    def of(self, joint: str, freedom: int) -> tuple[int, float]:
        """Freedom of the joint and sense, +1 or -1."""
        if joint not in self.turned or freedom < 0:
            return freedom, 1.0
        names, senses = self.turned[joint]
        where = names.index(freedom % 3)
        return where + freedom // 3 * 3, float(senses[where])

    def sense(self, joint: str, freedom: int) -> float:
        """Of a freedom of the joint itself."""
        return float(self.turned[joint][1][freedom % 3]) if joint in self.turned else 1.0


class Joints:
    """Reads joint prims.  nodes: for each part of ``found`` its node, GROUND for what does not move.
    stands: of the nodes by number."""

    def __init__(
        self, opened: OpenStage, values: Values, found: Found, nodes: list[int], stands: dict[int, Stand], units: Units, report: Report
    ):  # fmt: skip
        self._opened, self._values, self._found, self._report = opened, values, found, report
        self._nodes, self._stands = nodes, stands
        self._world = Stand(np.eye(3), np.zeros(3), opened.frame)
        self._freedoms = Freedoms(opened, values, units, report)
        self.readings = Readings()

    def read(self, entry: JointPrim) -> Joint | None:
        """None, with its reason in the report, where there is no joint to make."""
        prim = entry.prim
        feature, where = f"joint {entry.id}", self._opened.place(prim)
        if str(prim.GetTypeName()) in COUPLINGS:
            return None  # no joint between bodies: read apart
        if not prim.IsA(UsdPhysics.Joint):
            self._report.dropped(feature, "USD_JOINT_UNKNOWN", where, kind=prim.GetTypeName())
            return None
        first, second = self._side(entry, 0), self._side(entry, 1)
        if first is None or second is None:
            return None
        if first.node == second.node:
            what = "the world" if first.node == GROUND else "one body"
            self._report.dropped(feature, "USD_JOINT_ENDS_EQUAL", where, what=what)
            return None
        draft = self._draft(entry)
        if draft is None:
            return None
        freedoms, order = draft.freedoms, draft.order
        first = replace(first, axes=first.axes[:, order])
        second = replace(second, axes=second.axes[:, order])
        freedoms, first = _held(freedoms, first, self._opened.frame.length)
        freedoms, slerp = self._slerp(prim, freedoms) if second.node != GROUND else (freedoms, None)
        # What this program turned round for the sake of engines goes back, unless it is to be turned round again.
        turned = self._values.flag(prim, "kinefab:exchanged", False)
        if first.node != GROUND if turned else second.node == GROUND:
            freedoms, first, second = self._swapped(entry, freedoms, first, second)
        kind = kind_of(unlocked_of(freedoms))
        if kind is JointKind.FIXED:
            first = self._met(entry, first, second)
        if tuple(i for i in unlocked_of(freedoms) if i >= RX) == (RY, RZ):
            self._approximated(entry, "its two swings without twist became the two axes of a universal joint")
        breaks = [
            self._values.number(prim, f"physics:break{what}", math.inf, open_ended=True) * self._freedoms.units.force(turns)
            for what, turns in (("Force", False), ("Torque", True))
        ]  # fmt: skip
        extras = draft.extras
        if self._values.flag(prim, "physics:excludeFromArticulation", False):
            extras["excludeFromArticulation"] = True
        return Joint(
            entry.id, kind,
            None if first.node == GROUND else first.node, second.node,
            self._frame(first), self._frame(second), freedoms,
            name=self._values.title(prim),
            break_force=breaks[0], break_torque=breaks[1],
            enabled=self._values.flag(prim, "physics:jointEnabled", True),
            collide=self._values.flag(prim, "physics:collisionEnabled", False),
            closes="excludeFromArticulation" in extras and prim.GetTypeName() != "PhysicsJoint" and math.isinf(min(breaks)),
            slerp=slerp, where=where, extras=extras,
        )  # fmt: skip

    def _slerp(
        self, prim: Any, freedoms: tuple[Freedom, ...]
    ) -> tuple[tuple[Freedom, ...], SphericalDrive | None]:
        """The one drive about all three rotations that Kinefab wrote as three, where those are still what it wrote."""
        turn = self._values.array(prim, "kinefab:slerp:target")
        spin = self._values.array(prim, "kinefab:slerp:targetVelocity")
        drives = [f.drive for f in freedoms[RX:] if f.drive is not None]
        if turn is None or spin is None or len(turn) != 3 or len(spin) != 3 or len(drives) != 3:
            return freedoms, None
        targets = np.array([[d.target, d.target_velocity] for d in drives])
        gains = {(d.stiffness, d.damping, d.max_force, d.acceleration, d.motor) for d in drives}
        if len(gains) > 1 or not np.abs(targets - np.column_stack([turn, spin])).max() <= TURNED:
            return freedoms, None
        first = drives[0]
        slerp = SphericalDrive(
            rotation_exp(turn), spin, first.stiffness, first.damping, first.max_force, first.acceleration
        )
        return (*freedoms[:RX], *(replace(f, drive=None) for f in freedoms[RX:])), slerp

    def _side(self, entry: JointPrim, number: int) -> Side | None:
        """None, and the joint is lost, where what it names is not there."""
        prim = entry.prim
        name = f"physics:body{number}"
        targets = self._values.targets(prim, name)
        position = self._values.vector(prim, f"physics:localPos{number}", (0.0, 0.0, 0.0))
        turn = self._values.rotation(prim, f"physics:localRot{number}")
        whole = self._values.array(prim, f"kinefab:localPos{number}")
        if whole is not None and len(whole) == 3 and np.array_equal(whole.astype(np.float32), position):
            position = whole
        whole_turn = self._values.rotation(prim, f"kinefab:localRot{number}")
        if turn is not None and whole_turn is not None and np.abs(turn - whole_turn).max() <= ROUNDED:
            turn = whole_turn
        rotation = np.eye(3) if turn is None else turn
        if len(targets) > 1:
            self._approximated(entry, f"{name} names {len(targets)} prims; the first was taken")
        if not targets:
            return Side(GROUND, rotation, position)
        path = targets[0].GetPrimPath()
        target = self._opened.stage.GetPrimAtPath(path)
        if not target:
            self._report.dropped(
                f"joint {entry.id}",
                "USD_TARGET_MISSING",
                self._opened.place(prim, name),
                path=str(path),
            )
            return None
        meant = entry.meant(str(path))
        world = self._found.worlds.get(meant)
        if world is None:
            world = world_of(path, self._found, self._opened, self._values)
        part = body_above(meant, self._found)
        if (
            meant == str(path)
            and part >= 0
            and self._found.parts[part].path[1:] != self._found.parts[part].id
        ):
            detail = f"{name} names the prototype of a PointInstancer; its first instance was taken"
            self._approximated(entry, detail)
        if part < 0 and moves_beside(target, self._opened.root):
            self._approximated(
                entry,
                f"{name} is beside {self._opened.root.GetPath()}, which alone is read; the world stands in for {path}",
            )
        node = GROUND if part < 0 else self._nodes[part]
        return Side(node, rotation_of(world[:3, :3]) @ rotation, world[:3, :3] @ position + world[:3, 3])

    def _met(self, entry: JointPrim, first: Side, second: Side) -> Side:
        """The first side of a fixed joint, put on the second: Unity's fixed joint holds the bodies as it finds them."""
        reach = max(float(np.abs(first.origin).max()), float(np.abs(second.origin).max()))
        apart = float(np.linalg.norm(first.origin - second.origin))
        turned = float(np.linalg.norm(rotation_log(first.axes.T @ second.axes)))
        if apart > APART * reach or turned > APART:
            metres, degrees = apart * self._opened.frame.length, math.degrees(turned)
            detail = f"its frames are {metres:.3g} m and {degrees:.3g} degrees apart at the exported pose"
            self._approximated(entry, f"{detail}; the bodies are fixed as they stand")
        return replace(first, axes=second.axes, origin=second.origin)

    def _frame(self, side: Side) -> Pose:
        stand = self._world if side.node == GROUND else self._stands[side.node]
        return Pose(stand.axes(side.axes), stand.point(side.origin))

    def _draft(self, entry: JointPrim) -> _Draft | None:
        prim = entry.prim
        order = MAIN[self._values.token(prim, "physics:axis", tuple(MAIN), "X")]
        extras: dict[str, object] = {}
        if prim.IsA(UsdPhysics.FixedJoint):
            self._other_instances(entry, set())
            return _Draft(freedoms_of(JointKind.FIXED), MAIN["X"], extras)
        for schema, turns, main, instance in (
            (UsdPhysics.RevoluteJoint, True, RX, "angular"),
            (UsdPhysics.PrismaticJoint, False, TX, "linear"),
        ):
            if prim.IsA(schema):
                lower = self._values.number(prim, "physics:lowerLimit", -math.inf, open_ended=True)
                upper = self._values.number(prim, "physics:upperLimit", math.inf, open_ended=True)
                freedom = self._freedoms.limited(prim, lower, upper, turns, instance)
                freedom = self._freedoms.with_drive(freedom, prim, instance, turns)
                freedom = self._freedoms.standing(freedom, prim, instance, turns)
                freedom = passive_of(freedom, prim, turns, instance, self._values, self._freedoms.units)
                self._other_instances(entry, {instance})
                return _Draft(tuple(freedom if i == main else LOCKED for i in range(6)), order, extras)
        if prim.IsA(UsdPhysics.SphericalJoint):
            self._other_instances(entry, set())
            return _Draft(self._spherical(entry), order, extras)
        if prim.IsA(UsdPhysics.DistanceJoint):
            self._other_instances(entry, set())
            return _Draft(self._distance(entry), MAIN["X"], extras)
        if prim.GetTypeName() != "PhysicsJoint":
            self._report.dropped(
                f"joint {entry.id}",
                "USD_JOINT_UNKNOWN",
                self._opened.place(prim),
                kind=prim.GetTypeName(),
            )
            return None
        return _Draft(self._generic(entry), MAIN["X"], extras)

    def _spherical(self, entry: JointPrim) -> tuple[Freedom, ...]:
        """Cones as PhysX has them: angle 0 bounds the turn about the axis after the main one, angle 1 the next."""
        prim = entry.prim
        angles = [
            self._values.number(prim, f"physics:coneAngle{i}Limit", -1.0, open_ended=True) for i in (0, 1)
        ]
        if angles[0] < 0.0 or angles[1] < 0.0 or math.isinf(angles[0]) or math.isinf(angles[1]):
            if max(angles) >= 0.0 and min(angles) < 0.0:
                self._approximated(
                    entry, "only one cone angle is stated, which limits nothing in PhysX either"
                )
            return freedoms_of(JointKind.SPHERICAL)
        if angles[0] != angles[1]:
            self._approximated(
                entry,
                "its cone has two angles, which the schema and PhysX name the other way round; PhysX was followed",
            )
        swings = [self._freedoms.limited(prim, -angle, angle, True, "cone") for angle in angles]
        return freedoms_of(JointKind.SPHERICAL, ry=swings[0], rz=swings[1])

    def _distance(self, entry: JointPrim) -> tuple[Freedom, ...]:
        """At most so far apart: a ball for the slides.  Nothing of Unity's joints keeps bodies apart."""
        prim = entry.prim
        least = self._values.number(prim, "physics:minDistance", -1.0, open_ended=True)
        most = self._values.number(prim, "physics:maxDistance", -1.0, open_ended=True)
        if least > 0.0:
            self._approximated(entry, f"its least distance {least:g} was left out")
        return self._ball(prim, most)

    def _ball(self, prim: Any, most: float) -> tuple[Freedom, ...]:
        if most < 0.0 or math.isinf(most):
            return (FREE,) * 6
        if most == 0.0:
            return freedoms_of(JointKind.SPHERICAL)
        slide = replace(self._freedoms.limited(prim, -most, most, False, "distance"), radial=True)
        stiffness = self._values.number(prim, "physxPhysicsDistanceJoint:springStiffness", 0.0)
        damping = self._values.number(prim, "physxPhysicsDistanceJoint:springDamping", 0.0)
        if self._values.flag(prim, "physxPhysicsDistanceJoint:springEnabled", False):
            gain = self._freedoms.units.gain(False)
            slide = replace(slide, stiffness=stiffness * gain, damping=damping * gain)
        return (slide,) * 3 + (FREE,) * 3

    def _generic(self, entry: JointPrim) -> tuple[Freedom, ...]:
        prim = entry.prim
        found: list[Freedom] = []
        for i, name in enumerate(DOFS):
            freedom = self._freedoms.with_drive(self._freedoms.of_limit(prim, i), prim, name, i >= RX)
            freedom = self._freedoms.standing(freedom, prim, name, i >= RX)
            found.append(passive_of(freedom, prim, i >= RX, name, self._values, self._freedoms.units))
        known = {*DOFS, "distance"}
        if "PhysicsLimitAPI:distance" in schemas(prim):
            most = self._values.number(prim, "limit:distance:physics:high", math.inf, open_ended=True)
            if self._values.number(prim, "limit:distance:physics:low", -math.inf, open_ended=True) > 0.0:
                self._approximated(entry, "its least distance was left out")
            slides = self._ball(prim, most if most >= 0.0 else math.inf)[:RX]
            for i, slide in enumerate(slides):
                if found[i].motion is Motion.FREE:
                    found[i] = replace(slide, drive=found[i].drive, passive=found[i].passive, at=found[i].at)
        self._other_instances(entry, known)
        return tuple(found)

    def _other_instances(self, entry: JointPrim, known: set[str]) -> None:
        prim = entry.prim
        """That a drive or range is lost whose name, not one of the known, is none of the joint's freedoms."""
        for schema in schemas(prim):
            name, _, instance = schema.partition(":")
            if name in ("PhysicsLimitAPI", "PhysicsDriveAPI") and instance not in known:
                self._report.dropped(
                    f"{schema} of {entry.id}", "USD_FEATURE_DROPPED", self._opened.place(prim),
                    detail=f"a {prim.GetTypeName()} has no freedom of that name",
                )  # fmt: skip

    def _swapped(
        self, entry: JointPrim, freedoms: tuple[Freedom, ...], first: Side, second: Side
    ) -> tuple[tuple[Freedom, ...], Side, Side]:
        """The second side as the first.  Axes are turned so that coordinates keep their sense where they can."""
        turns = [i for i in unlocked_of(freedoms) if i >= RX]
        slides = [i for i in unlocked_of(freedoms) if i < RX]
        exchange = exchange_of(freedoms)
        self.readings.turned[entry.id] = (exchange.names, exchange.senses)
        other = [i for i in slides if [i + RX] != turns]
        if turns and any(freedoms[i].motion is Motion.LIMITED or freedoms[i].drive for i in other):
            self._approximated(
                entry, "its second body is the world; its slides were taken along the other body's axes"
            )
        first, second = (replace(side, axes=side.axes @ exchange.axes) for side in (second, first))
        return exchange.freedoms(freedoms), first, second

    def _approximated(self, entry: JointPrim, detail: str) -> None:
        self._report.approximated(
            f"joint {entry.id}", "USD_FEATURE_APPROXIMATED", self._opened.place(entry.prim), detail=detail
        )


def _held(freedoms: tuple[Freedom, ...], first: Side, length: float) -> tuple[tuple[Freedom, ...], Side]:
    """Ranges of one value as locked freedoms of a first frame that is moved there.  length: metres of a stage's unit."""
    single = [i for i, f in enumerate(freedoms) if f.motion is Motion.LIMITED and f.lower == f.upper]
    if not single:
        return freedoms, first
    axes, origin = first.axes, first.origin
    offset = np.zeros(3)
    for i in single:
        if i <= TZ:
            offset[i] = freedoms[i].lower / length
    origin = origin + axes @ offset
    for i in reversed([i for i in single if i >= RX]):  # R = Rz Ry Rx, the outermost first
        axes = axes @ rotation_about(np.eye(3)[i - RX], freedoms[i].lower)
    kept = tuple(LOCKED if i in single else f for i, f in enumerate(freedoms))
    return kept, replace(first, axes=axes, origin=origin)
