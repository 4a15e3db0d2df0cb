"""Joints of the model as UsdPhysics joints.

Both count b's frame as seen from a's, along and about a's axes, so body 0 is a's and body 1 is b's and no sign changes.
Where b is nearer to the root of an articulation the joint is exchanged: engines of reduced coordinates take body 0 for the parent,
and Newton refuses a stage where it is not.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ....diagnostics import Report
from ....findings import JointFinding
from ....model import (
    RX,
    RZ,
    TX,
    Drive,
    Freedom,
    Joint,
    Motion,
    Passive,
    Scene,
    exchange_of,
    is_same_from_both_sides,
    unlocked_of,
)
from ....spatial import Pose, quaternion_from_matrix, rotation_log
from ....unity.joints.coordinates import CanonicalJoint, canonical, coordinates_in
from ....unity.joints.limits import feature_of, report_gap
from ....unity.joints.passive import with_passive_drives
from ..bodies import Bodies
from ..prims import Prim, quaternion32, quaternion64, rounded, vector3d, vector3f
from .articulations import Edge, Trees
from .freedoms import (
    DOFS,
    bound,
    even,
    write_drive,
    write_limit_api,
    write_passive,
    write_soft_limit,
    write_state,
)

AXES = "XYZ"


@dataclass(frozen=True, slots=True, eq=False)
class WrittenJoint:
    """instance_of: for each unlocked freedom TX..RZ of the source's joint what USD calls it.  typed: it has one freedom, which
    needs no name."""

    prim: Prim
    instance_of: Mapping[int, str]
    typed: bool


@dataclass(frozen=True, slots=True, eq=False)
class Places:
    """Prims and poses of what joints name.  prims: of each node.  root: the default prim, which stands for the world, so that
    the stage may be referred to anywhere; root_pose: its own."""

    scene: Scene
    prims: Sequence[Prim]
    root: Prim
    root_pose: Pose

    def write_sides(
        self, prim: Prim, sides: tuple[tuple[int | None, Pose], tuple[int | None, Pose]], exchanged: bool
    ) -> None:
        """Bodies and frames.  sides: node of the body (None: the world) and the joint frame in the world.
        exchanged: they are the other way round in the scene."""
        if exchanged:
            prim.attribute("kinefab:exchanged", "Bool", True, custom=True)
        for i, (node, frame) in enumerate(sides):
            pose = self.root_pose if node is None else self.scene.pose(node)
            local = pose.inverse() @ frame
            prim.relation(f"physics:body{i}", (self.root if node is None else self.prims[node]).path)
            prim.attribute(f"physics:localPos{i}", "Point3f", vector3f(local.translation))
            turn = quaternion_from_matrix(local.rotation)
            prim.attribute(f"physics:localRot{i}", "Quatf", quaternion32(turn))
            # The schema has 32 bits, in which the axes of a loop are not quite parallel: the whole numbers stand beside.
            if rounded(local.translation):
                prim.attribute(f"kinefab:localPos{i}", "Double3", vector3d(local.translation), custom=True)
            if rounded(turn):
                prim.attribute(f"kinefab:localRot{i}", "Quatd", quaternion64(turn), custom=True)

    def write_fixed(self, edge: Edge, exchanged: bool) -> None:
        """The sides of a joint that holds b as it stands."""
        at = self.scene.pose(edge.b)
        first, second = (edge.b, edge.a) if exchanged else (edge.a, edge.b)
        self.write_sides(edge.prim, ((first, at), (second, at)), exchanged)


@dataclass(frozen=True, slots=True, eq=False)
class _Begun:
    """A joint whose prim is there.  values: the six coordinates at the exported pose, of ``shape``."""

    joint: Joint
    edge: Edge
    shape: CanonicalJoint
    passives: Mapping[int, Passive]
    values: Sequence[float]
    kind: str


@dataclass(slots=True, eq=False)
class Joints:
    """Writes joints below ``scope``.  places: of the bodies.  written: by the joints' ids."""

    scene: Scene
    bodies: Bodies
    scope: Prim
    places: Places
    report: Report
    ending: str
    written: dict[str, WrittenJoint] = field(default_factory=dict[str, WrittenJoint])
    _begun: list[_Begun] = field(default_factory=list[_Begun])

    def begin(self, joint: Joint, name: str, finding: JointFinding | None, coupled: bool) -> Edge:
        """Make the joint's prim, whose sides are known when all joints are.  name: of the prim.  coupled: couplings count by it."""
        bare, passives = _passive_apart(joint)
        shape = canonical(with_passive_drives(bare, self.report))
        values = self._standing(joint, shape)
        kind = _kind(shape, joint)
        prim = self.scope.child(joint.name or joint.id, kind, name=name)
        prim.tell_source(joint.id)
        free = unlocked_of(shape.freedoms)
        breaks = math.isfinite(joint.break_force) or math.isfinite(joint.break_torque)
        world = self.bodies.stand_in(coupled)
        edge = Edge(
            world if joint.a is None else self.bodies.carrier(joint.a),
            world if joint.b is None else self.bodies.carrier(joint.b),
            prim,
            fits=(len(free) <= 1 or all(i >= RX for i in free)) and not breaks,
            closing=finding is not None and finding.closure,
            exchanges=joint.slerp is None and is_same_from_both_sides(shape.freedoms),
        )
        self._begun.append(_Begun(joint, edge, shape, passives, values, kind))
        return edge

    def finish(self, trees: Trees) -> None:
        """Write what was begun."""
        for begun in self._begun:
            path = begun.edge.prim.path
            self._finish(begun, begun.edge.exchanges and path in trees.inward)
            self._write_contact(begun, path in trees.first)

    def _write_contact(self, begun: _Begun, linked: bool) -> None:
        """Whether the joint's two bodies collide.  linked: it is in an articulation."""
        joint, edge = begun.joint, begun.edge
        on_base = None in (joint.a, joint.b) and None not in (edge.a, edge.b)
        if not joint.collide and not on_base:
            return
        edge.prim.attribute("physics:collisionEnabled", "Bool", True)
        if linked:
            self.report.approximated(
                f"contact at joint {joint.id}", "TARGET_FEATURE_APPROXIMATED", joint.where, target=self.ending,
                detail="that its two bodies collide stands there, and PhysX never lets neighbours of one articulation",
            )  # fmt: skip

    def _finish(self, begun: _Begun, exchanged: bool) -> None:
        joint, prim, shape, values = begun.joint, begun.edge.prim, begun.shape, begun.values
        sides = (
            (begun.edge.a, self.scene.pose(joint.a) @ shape.frame_a),
            (begun.edge.b, self.scene.pose(joint.b) @ shape.frame_b),
        )
        if exchanged:
            exchange = exchange_of(shape.freedoms)
            turn = Pose(exchange.axes)
            (own, at_own), (other, at_other) = sides
            sides = (other, at_other @ turn), (own, at_own @ turn)
            values = exchange.coordinates(values)
            names = exchange.picked(shape.name_of)
            shape = replace(shape, freedoms=exchange.freedoms(shape.freedoms), name_of=names)
        self.places.write_sides(prim, sides, exchanged)
        free = unlocked_of(shape.freedoms)
        if begun.kind == "PhysicsJoint":
            self._write_generic(prim, joint, shape, begun.passives, values)
        elif begun.kind == "PhysicsSphericalJoint":
            _write_cone(prim, shape)
        elif free:
            (main,) = free
            passive = begun.passives.get(shape.name_of[main])
            _write_typed(prim, shape.freedoms[main], passive, main, values[main])
        if math.isfinite(joint.break_force):
            prim.numbers({"physics:breakForce": joint.break_force})
        if math.isfinite(joint.break_torque):
            prim.numbers({"physics:breakTorque": joint.break_torque})
        if joint.enabled:
            self.report.kept(f"joint {joint.id}", joint.where)
        else:
            prim.attribute("physics:jointEnabled", "Bool", False)
            # No tree may hang on it: an articulation's own joints cannot be switched on later.
            prim.attribute("physics:excludeFromArticulation", "Bool", True, uniform=True)
            self.report.kept(f"joint {joint.id}", joint.where, "JOINT_DISABLED", joint=joint.id)
        names = {shape.name_of[i]: DOFS[i] for i in free}
        self.written[joint.id] = WrittenJoint(prim, names, len(free) == 1)

    def _write_generic(
        self,
        prim: Prim,
        joint: Joint,
        shape: CanonicalJoint,
        passives: Mapping[int, Passive],
        values: Sequence[float],
    ) -> None:
        for i, freedom in enumerate(shape.freedoms):
            write_limit_api(prim, i, freedom)
            if freedom.motion is Motion.LOCKED:
                continue
            write_soft_limit(prim, DOFS[i], freedom, i >= RX)
            write_state(prim, DOFS[i], values[i], i >= RX)
            if freedom.drive is not None and (i < RX or joint.slerp is None):
                write_drive(prim, DOFS[i], freedom.drive, i >= RX)
            passive = passives.get(shape.name_of[i])
            if passive is not None:
                write_passive(prim, passive, i >= RX, DOFS[i], typed=False)
                self._tell_passive(joint, shape, i, passive)
        if joint.slerp is not None:
            order = [i - RX for i in shape.name_of[RX:]]
            turn, spin = rotation_log(joint.slerp.target)[order], joint.slerp.target_velocity[order]
            given = joint.slerp
            for k, i in enumerate(range(RX, RZ + 1)):
                if shape.freedoms[i].motion is not Motion.LOCKED:
                    one = Drive(
                        float(turn[k]), float(spin[k]), given.stiffness, given.damping, given.max_force, given.acceleration
                    )  # fmt: skip
                    write_drive(prim, DOFS[i], one, True)
            # No schema has such a drive: what it was stands beside, for as long as the three are its.
            prim.attribute("kinefab:slerp:target", "Double3", vector3d(turn), custom=True)
            prim.attribute("kinefab:slerp:targetVelocity", "Double3", vector3d(spin), custom=True)
            self.report.approximated(
                f"joint {joint.id}", "TARGET_FEATURE_APPROXIMATED", joint.where, target=self.ending,
                detail="its drive about all three rotations became one about each",
            )  # fmt: skip

    def _tell_passive(self, joint: Joint, shape: CanonicalJoint, freedom: int, passive: Passive) -> None:
        """What engines take of it: turns within articulations, which have no joint that slides too."""
        name = joint.freedom_name(shape.name_of[freedom])
        if math.isfinite(passive.effort):
            field = f"the largest effort of {name}"
            self.report.field_dropped(f"joint {joint.id}", field, self.ending, joint.where)
        if (
            any(i < RX for i in unlocked_of(shape.freedoms))
            and replace(passive, effort=math.inf) != Passive()
        ):
            feature = feature_of(joint, "friction, armature and largest speed", shape.name_of[freedom])
            self.report.approximated(
                feature, "TARGET_FEATURE_APPROXIMATED", joint.where, target=self.ending,
                detail="what is stated of these stands there, and no engine takes it of a joint that slides and turns",
            )  # fmt: skip

    def _standing(self, joint: Joint, shape: CanonicalJoint) -> list[float]:
        """The six coordinates at the exported pose, metres and radians; the report tells where it does not meet the joint."""
        found = coordinates_in(self.scene, joint, shape)
        report_gap(joint, found, self.report)
        return [
            float(freedom.nearest_turn(value)) if i >= RX else float(value)
            for i, (freedom, value) in enumerate(zip(shape.freedoms, found.values))
        ]


def _kind(shape: CanonicalJoint, joint: Joint) -> str:
    """The prim's type; of a hinge or a slide, of the one freedom that the joint leaves."""
    free = unlocked_of(shape.freedoms)
    if not free:
        return "PhysicsFixedJoint"
    if len(free) == 1 and joint.slerp is None:
        return "PhysicsRevoluteJoint" if free[0] >= RX else "PhysicsPrismaticJoint"
    if free == (RX, RX + 1, RZ) and joint.slerp is None:
        twist, *swings = shape.freedoms[RX:]
        driven = any(f.drive is not None for f in (twist, *swings))
        open_swings = all(f.motion is Motion.FREE for f in swings)
        if twist.motion is Motion.FREE and not driven and (open_swings or even(swings)):
            return "PhysicsSphericalJoint"
    return "PhysicsJoint"


def _write_typed(prim: Prim, freedom: Freedom, passive: Passive | None, main: int, value: float) -> None:
    """A hinge's or slide's only freedom."""
    turns, instance = main >= RX, "angular" if main >= RX else "linear"
    prim.attribute("physics:axis", "Token", AXES[main - RX if turns else main - TX], uniform=True)
    if freedom.motion is Motion.LIMITED:
        ends = {"physics:lowerLimit": freedom.lower, "physics:upperLimit": freedom.upper}
        prim.numbers({name: bound(value, turns) for name, value in ends.items()})
    write_soft_limit(prim, instance, freedom, turns)
    write_state(prim, instance, value, turns)
    if freedom.drive is not None:
        write_drive(prim, instance, freedom.drive, turns)
    if passive is not None:
        write_passive(prim, passive, turns, instance, typed=True)


def _write_cone(prim: Prim, shape: CanonicalJoint) -> None:
    prim.attribute("physics:axis", "Token", "X", uniform=True)
    swing = shape.freedoms[RX + 1]
    if swing.motion is Motion.LIMITED:
        half = math.degrees(swing.upper)
        prim.numbers({"physics:coneAngle0Limit": half, "physics:coneAngle1Limit": half})


def _passive_apart(joint: Joint) -> tuple[Joint, dict[int, Passive]]:
    """The joint with no more passive properties than a drive has room for, and the others by freedom."""
    apart: dict[int, Passive] = {}
    freedoms: list[Freedom] = []
    for i, freedom in enumerate(joint.freedoms):
        passive = freedom.passive
        if passive is not None and freedom.motion is not Motion.LOCKED:
            rest = replace(passive, stiffness=0.0, rest=0.0, damping=0.0)
            if rest != Passive():
                apart[i] = rest
            freedom = replace(freedom, passive=Passive(passive.stiffness, passive.rest, passive.damping))
        freedoms.append(freedom)
    return replace(joint, freedoms=tuple(freedoms)), apart
