"""What ties joint coordinates together: mimics of Newton and PhysX, PhysX's gears and racks.  Tendons and actuators of
vendors, which Unity's joints cannot have, are told."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ....diagnostics import Report
from ....model import RX, TX, Coupling, CouplingKind, Joint, JointKind, Scene, Term, unlocked_of
from ..found import JointPrim
from ..stage import OpenStage
from ..values import Values, identity, schemas
from .freedoms import DOFS
from .joints import COUPLINGS, Readings

GEAR, RACK = COUPLINGS
POLYNOMIAL = ("mjc:coef2", "mjc:coef3", "mjc:coef4")
TOLD = ("PhysxTendon", "MjcEquality", "PhysxVehicle", "PhysxAuto", "PhysxForceAPI", "PhysxSurfaceVelocity")
"""Beginnings of schemas that say how things move and that nothing of the scene can."""
PHYSX_MIMIC = ("gearing", "offset", "referenceJoint", "referenceJointAxis")
"""What its properties are called after their axis."""


class Couplings:
    """Reads couplings between the joints of ``scene``.  readings: how a prim's freedom is read on its joint."""

    def __init__(self, opened: OpenStage, values: Values, scene: Scene, readings: Readings, report: Report):
        self._opened, self._values, self._scene, self._readings = opened, values, scene, readings
        self._report = report
        self._joints = {joint.id: joint for joint in scene.joints}
        self._leads: dict[str, float] = {}

    def screwed(self) -> list[Joint]:
        """The scene's joints, with those as screws whose slide follows their own turn."""
        return [
            replace(joint, kind=JointKind.SCREW, lead=self._leads[joint.id])
            if joint.id in self._leads
            else joint
            for joint in self._scene.joints
        ]

    def read(self, entries: Sequence[JointPrim]) -> list[Coupling]:
        """entries: the joint prims, gears and racks among them."""
        found: list[Coupling | None] = []
        for entry in entries:
            kind = str(entry.prim.GetTypeName())
            if kind == GEAR:
                found.append(self._gear(entry))
            elif kind == RACK:
                found.append(self._rack(entry))
            applied = schemas(entry.prim)
            mimics = [s.partition(":")[2] for s in applied if s.startswith("PhysxMimicJointAPI:")]
            if "NewtonMimicAPI" in applied:
                found.append(self._newton(entry))
                for axis in mimics:  # the same in PhysX's words
                    self._values.pass_over(f"physxMimicJoint:{axis}:{name}" for name in PHYSX_MIMIC)
            else:
                found += [self._physx(entry, axis) for axis in mimics]
            found += [self._kinefab(entry, name) for name in _own_mimics(self._values, entry.prim)]
        return [coupling for coupling in found if coupling is not None]

    def _newton(self, entry: JointPrim) -> Coupling | None:
        """q = coef0 + coef1 q_leader, in the follower's and the leader's units."""
        prim = entry.prim
        if not self._values.flag(prim, "newton:mimicEnabled", True):
            self._report.dropped(f"mimic of {entry.id}", "FEATURE_SUPPRESSED", self._opened.place(prim))
            return None
        if any(self._values.number(prim, name, 0.0) for name in POLYNOMIAL):
            self._report.approximated(
                f"mimic of {entry.id}", "USD_FEATURE_APPROXIMATED", self._opened.place(prim),
                detail="its terms of higher order were left out",
            )  # fmt: skip
        coefficients = [self._values.number(prim, f"newton:mimicCoef{i}", float(i)) for i in (0, 1)]
        return self._mimic(entry, "newton:mimicJoint", "", "", coefficients[1], coefficients[0])

    def _physx(self, entry: JointPrim, instance: str) -> Coupling | None:
        """q + gearing q_leader + offset = 0."""
        prim = entry.prim
        prefix = f"physxMimicJoint:{instance}:"
        gearing = self._values.number(prim, prefix + "gearing", 1.0)
        offset = self._values.number(prim, prefix + "offset", 0.0)
        leader = self._values.word(prim, prefix + "referenceJointAxis", "")
        return self._mimic(entry, prefix + "referenceJoint", instance, leader, -gearing, -offset)

    def _kinefab(self, entry: JointPrim, instance: str) -> Coupling | None:
        """q = ratio q_leader + offset, in the follower's and the leader's units: what no engine's mimic was, written by Kinefab."""
        prefix = f"kinefab:mimic:{instance}"
        ratio = self._values.number(entry.prim, f"{prefix}:ratio", 1.0)
        offset = self._values.number(entry.prim, f"{prefix}:offset", 0.0)
        leader = self._values.word(entry.prim, f"{prefix}:freedom", "")
        return self._mimic(entry, f"{prefix}:joint", instance, leader, ratio, offset)

    def _mimic(
        self, entry: JointPrim, relation: str, own: str, other: str, ratio: float, offset: float
    ) -> Coupling | None:
        feature, where = f"mimic of {entry.id}", self._opened.place(entry.prim, relation)
        targets = self._values.targets(entry.prim, relation)
        follower = self.coordinate(entry.id, own)
        leader = self.coordinate(entry.meant(str(targets[0]))[1:], other) if targets else None
        if follower is None or leader is None:
            missing = str(targets[0]) if targets and follower is not None else entry.id
            self._lost(feature, where, f"joint {missing} has no free coordinate for it")
            return None
        (joint, freedom, sense), (led, led_freedom, led_sense) = follower, leader
        unit, led_unit = self._unit(freedom), self._unit(led_freedom)
        factor = ratio * unit / led_unit * sense * led_sense
        if factor == 0.0:
            self._lost(feature, where, "its ratio is zero")
            return None
        if joint is led and joint.kind is JointKind.CYLINDRICAL and (freedom, led_freedom) == (TX, RX):
            self._leads[joint.id] = 2.0 * math.pi * factor
            return None
        return Coupling(
            f"mimic:{entry.id}" + (f":{own}" if own else ""),
            CouplingKind.LINEAR, joint.id, freedom, (Term(led.id, led_freedom, factor),),
            offset * unit * sense, where,
        )  # fmt: skip

    def _gear(self, entry: JointPrim) -> Coupling | None:
        """As PhysX solves it: R w0 + w1 = 0 along the hinges' axes, whichever bodies of the hinges the gear names."""
        ratio = self._values.number(entry.prim, "physics:gearRatio", 1.0)
        ends = [self._end(entry, f"physics:hinge{i}", f"physics:body{i}") for i in (0, 1)]
        first, second = ends
        if first is None or second is None or ratio == 0.0:
            self._lost(
                f"gear {entry.id}", self._opened.place(entry.prim), "it names no two hinges with a free turn"
            )
            return None
        return self._tied(entry, CouplingKind.GEAR, first, second, -ratio)

    def _rack(self, entry: JointPrim) -> Coupling | None:
        """As PhysX solves it: w = R v along the axes, with the sign that rolling without slip has where the pinion lies
        beside the rack.  R in degrees for a unit of length."""
        ratio = self._values.number(entry.prim, "physics:ratio", 1.0)
        pinion = self._end(entry, "physics:hinge", "physics:body0")
        rack = self._end(entry, "physics:prismatic", "physics:body1")
        if pinion is None or rack is None or ratio == 0.0:
            self._lost(
                f"rack {entry.id}", self._opened.place(entry.prim), "it names no hinge and slide that move"
            )
            return None
        ratio *= self._opened.degree / self._opened.frame.length
        return self._tied(entry, CouplingKind.RACK, rack, pinion, ratio * self._rolling(pinion[0], rack[0]))

    def _rolling(self, pinion: Joint, rack: Joint) -> float:
        frames = [self._scene.pose(j.a) @ j.frame_a for j in (pinion, rack)]
        moved = self._scene.pose(rack.b) @ rack.frame_b
        apart = moved.translation - (self._scene.pose(pinion.b) @ pinion.frame_b).translation
        along = float(np.cross(frames[0].rotation[:, 0], apart) @ frames[1].rotation[:, 0])
        return -1.0 if along < -1e-3 * self._opened.frame.length else 1.0

    def _end(self, entry: JointPrim, relation: str, body: str) -> tuple[Joint, int, float] | None:
        """The coordinate of a hinge or slide, counted as the body that the gear names moves."""
        targets = self._values.targets(entry.prim, relation)
        end = self.coordinate(entry.meant(str(targets[0]))[1:], "") if targets else None
        if end is None:
            return None
        joint, freedom, sense = end
        hinge = self._opened.stage.GetPrimAtPath(targets[0])
        named = self._values.targets(entry.prim, body)
        if named and named[:1] == self._values.targets(hinge, "physics:body0")[:1]:
            sense = -sense
        return joint, freedom, sense

    def _tied(
        self, entry: JointPrim, kind: CouplingKind, first: tuple[Joint, int, float], second: tuple[Joint, int, float], ratio: float
    ) -> Coupling:  # fmt: skip
        """second = ratio * first, both as they stand at the exported pose: gears count speeds, not angles."""
        ratio = ratio * first[2] * second[2]
        offset = self._now(*second[:2]) - ratio * self._now(*first[:2])
        term = Term(first[0].id, first[1], ratio)
        return Coupling(
            entry.id, kind, second[0].id, second[1], (term,), offset, self._opened.place(entry.prim)
        )

    def _now(self, joint: Joint, freedom: int) -> float:
        """A coordinate at the exported pose."""
        a = self._scene.pose(joint.a) @ joint.frame_a
        here = a.inverse() @ self._scene.pose(joint.b) @ joint.frame_b
        if freedom < RX:
            return float(here.translation[freedom])
        i, j = (freedom - RX + 1) % 3, (freedom - RX + 2) % 3
        return float(np.arctan2(here.rotation[j, i], here.rotation[j, j]))

    def coordinate(self, joint_id: str, instance: str = "") -> tuple[Joint, int, float] | None:
        """Joint, freedom and sense of a prim's freedom; the only one that moves where none of a D6 is named."""
        joint = self._joints.get(joint_id)
        if joint is None:
            return None
        free = unlocked_of(joint.freedoms)
        freedom, sense = self._readings.of(joint_id, DOFS.index(instance) if instance in DOFS else -1)
        if freedom not in free:  # of a hinge or slide the axis names its only freedom
            if len(free) != 1:
                return None
            freedom, sense = free[0], self._readings.sense(joint_id, free[0])
        return joint, freedom, sense

    def _unit(self, freedom: int) -> float:
        return self._opened.degree if freedom >= TX + 3 else self._opened.frame.length

    def _lost(self, feature: str, where: str, detail: str) -> None:
        self._report.dropped(feature, "USD_FEATURE_DROPPED", where, detail=detail)


def tell_vendors(prims: Sequence[Any], values: Values, opened: OpenStage, report: Report) -> None:
    """What vendors state about motion and nothing of the scene can hold."""
    for prim in prims:
        for schema in values.traits(prim).schemas:
            if schema.startswith(TOLD):
                report.dropped(
                    f"{schema} of {identity(prim)}", "USD_FEATURE_DROPPED", opened.place(prim),
                    detail="nothing in Unity's joints is like it",
                )  # fmt: skip


def tell_prims(prims: Sequence[Any], opened: OpenStage, report: Report) -> None:
    """Actuators, tendons and the like that are prims of their own."""
    for prim in prims:
        report.dropped(
            f"{prim.GetTypeName()} {identity(prim)}", "USD_FEATURE_DROPPED", opened.place(prim),
            detail="nothing in Unity's joints is like it",
        )  # fmt: skip


def _own_mimics(values: Values, prim: Any) -> list[str]:
    """Freedoms of a prim that follow another by Kinefab's own words."""
    words = (
        name.split(":") for name in sorted(values.traits(prim).names) if name.startswith("kinefab:mimic:")
    )
    return [parts[2] for parts in words if len(parts) == 4 and parts[3] == "ratio"]
