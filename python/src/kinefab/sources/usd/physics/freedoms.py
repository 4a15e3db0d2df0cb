"""LimitAPI and DriveAPI: what each freedom of a joint may do, in metres, radians, newtons and newton metres.

USD counts angles in degrees and angular gains per degree; lengths and masses in the stage's units.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ....diagnostics import Report
from ....model import FREE, LOCKED, RX, Drive, Freedom, Motion
from ..stage import OpenStage
from ..values import Values, identity, schemas

DOFS = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")
"""USD's names of the freedoms TX..RZ."""
PER_DEGREE = 180.0 / math.pi
MOTOR_DAMPING = 0.999e9
"""N s/m or N m s/rad from which on a drive without stiffness is a motor, which its largest force alone bounds."""


@dataclass(frozen=True, slots=True, eq=False)
class Units:
    """SI for one unit of the stage.  coordinate, force, gain: of a slide, or with ``turns`` of a turn.

    mujoco_angle: radians in a unit of the angles that MuJoCo's schemas state."""

    opened: OpenStage
    mujoco_angle: float

    def coordinate(self, turns: bool) -> float:
        return self.opened.degree if turns else self.opened.frame.length

    def force(self, turns: bool) -> float:
        frame = self.opened.frame
        return frame.mass * frame.length ** (2 if turns else 1)

    def gain(self, turns: bool, acceleration: bool = False) -> float:
        """Of a stiffness; of a damping too, as seconds are seconds."""
        if acceleration:
            return PER_DEGREE if turns else 1.0
        return self.force(turns) / self.coordinate(turns)

    def mujoco_gain(self, turns: bool) -> float:
        """Of a stiffness or damping of MuJoCo's schemas, which are per radian whatever their angles are in."""
        return self.force(turns) / (1.0 if turns else self.opened.frame.length)

    def mujoco_coordinate(self, turns: bool) -> float:
        return self.mujoco_angle if turns else self.opened.frame.length


def mujoco_angle(scenes: Sequence[Any], values: Values) -> float:
    """Radians in a unit of MuJoCo's angles: a degree, unless its settings on a physics scene say otherwise."""
    words = {values.word(scene, "mjc:compiler:angle", "degree") for scene in scenes}
    return 1.0 if words == {"radian"} else math.radians(1.0)


class Freedoms:
    """Reads the freedoms of joint prims."""

    def __init__(self, opened: OpenStage, values: Values, units: Units, report: Report):
        self._values, self._report, self._opened = values, report, opened
        self.units = units

    def limited(self, prim: Any, lower: float, upper: float, turns: bool, instance: str) -> Freedom:
        """A freedom between two ends in the stage's units; either may be infinite.

        lower > upper is USD's word for locked.  instance: whose PhysxLimitAPI makes it soft.
        """
        if lower > upper:
            return LOCKED
        if math.isinf(lower) and math.isinf(upper):
            return FREE
        unit = self.units.coordinate(turns)
        get, gain = self._values.number, self.units.gain(turns)
        stiffness = self._soft(prim, f"physxLimit:{instance}:stiffness", "newton:limitStiffness") * gain
        damping = (
            self._soft(prim, f"physxLimit:{instance}:damping", "newton:limitDamping") * gain
            if stiffness
            else 0.0
        )
        restitution = min(1.0, max(0.0, get(prim, f"physxLimit:{instance}:restitution", 0.0)))
        return Freedom(
            Motion.LIMITED, lower * unit, upper * unit, None, stiffness, damping, 0.0 if stiffness or damping else restitution
        )  # fmt: skip

    def _soft(self, prim: Any, *names: str) -> float:
        """The first gain that is stated; 0 for a hard limit, which infinity and what is not above zero stand for."""
        for name in names:
            if self._values.authored(prim, name):
                found = self._values.number(prim, name, 0.0, open_ended=True)
                return found if 0.0 < found < math.inf else 0.0
        return 0.0

    def of_limit(self, prim: Any, freedom: int) -> Freedom:
        """A D6's freedom by its LimitAPI; free without one."""
        name = DOFS[freedom]
        if f"PhysicsLimitAPI:{name}" not in schemas(prim):
            return FREE
        lower = self._values.number(prim, f"limit:{name}:physics:low", -math.inf, open_ended=True)
        upper = self._values.number(prim, f"limit:{name}:physics:high", math.inf, open_ended=True)
        return self.limited(prim, lower, upper, freedom >= RX, name)

    def with_drive(self, freedom: Freedom, prim: Any, instance: str, turns: bool) -> Freedom:
        """The freedom with the drive of a DriveAPI instance, where there is one."""
        # what Kinefab writes beside a slide's mimic is the mimic once more
        if f"PhysicsDriveAPI:{instance}" not in schemas(prim) or self._values.authored(prim, "kinefab:mimic:drive"):
            return freedom
        prefix = f"drive:{instance}:physics:"
        get = self._values.number
        acceleration = (
            self._values.token(prim, prefix + "type", ("force", "acceleration"), "force") == "acceleration"
        )
        gain, unit = self.units.gain(turns, acceleration), self.units.coordinate(turns)
        stiffness = get(prim, prefix + "stiffness", 0.0, open_ended=True)
        damping = get(prim, prefix + "damping", 0.0, open_ended=True)
        most = get(prim, prefix + "maxForce", math.inf, open_ended=True)
        for name, value in (("stiffness", stiffness), ("damping", damping), ("maxForce", most)):
            if value < 0.0 or (math.isinf(value) and name != "maxForce"):
                self._values.wrong(prim, prefix + name, value)
        target = get(prim, prefix + "targetPosition", 0.0) * unit
        velocity = get(prim, prefix + "targetVelocity", 0.0) * unit
        if not (stiffness or damping or target or velocity):
            return freedom
        if freedom.motion is Motion.LOCKED:
            feature = f"drive {instance} of {identity(prim)}"
            where = self._opened.place(prim, prefix + "stiffness")
            self._report.dropped(feature, "USD_FEATURE_DROPPED", where, detail="its freedom is locked")
            return freedom
        force = most * self.units.force(turns)
        if not stiffness and damping * gain >= MOTOR_DAMPING and not acceleration:
            return replace(freedom, drive=Drive(target_velocity=velocity, max_force=force, motor=True))
        return replace(
            freedom, drive=Drive(target, velocity, stiffness * gain, damping * gain, force, acceleration)
        )

    def standing(self, freedom: Freedom, prim: Any, instance: str, turns: bool) -> Freedom:
        """The freedom with its coordinate at the exported pose, where PhysX's JointStateAPI says it."""
        name = f"state:{instance}:physics:position"
        if not self._values.authored(prim, name):
            return freedom
        return replace(freedom, at=self._values.number(prim, name, 0.0) * self.units.coordinate(turns))
