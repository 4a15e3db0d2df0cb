"""What drives, softens and breaks a written joint, as the model has it: the way back of ``joints.hinge`` and ``joints.configurable``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...model import MOTOR_DAMPING, RX, Drive, Freedom, Motion, Passive, SphericalDrive
from ...spatial import matrix_from_quaternion, rotation_exp, rotation_log
from .. import frames
from ..joints.passive import OWN
from ..scene.joints.configurable_joint import SWING_RANGES, TWIST_RANGE
from ..scene.joints.joint import UNLIMITED_FORCE

Entry = Mapping[str, Any]

_SENSES = frames.Senses.of(b_in_a=True)
COORDINATES = ("x", "y", "z", "angularX", "angularY", "angularZ")
"""Of a ConfigurableJoint, as the file names them."""
_LINEAR = ("xDrive", "yDrive", "zDrive")


def _says(stated: Entry) -> bool:
    """Whether an entry of a joint or of one of its coordinates states any of what no joint of Unity's has."""
    return "effort" in stated or "speed" in stated or bool(stated.get("friction") or stated.get("armature"))


def _with_stated(stated: Entry, freedom: Freedom, unit: float) -> Freedom:
    """With what the source states beside any drive.  unit: of the coordinate in the scene file, in the model's."""
    if freedom.motion is Motion.LOCKED or not _says(stated):
        return freedom
    passive = Passive(
        friction=float(stated.get("friction", 0.0)),
        armature=float(stated.get("armature", 0.0)),
        effort=float(stated.get("effort", math.inf)),
        speed=unit * float(stated.get("speed", math.inf)),
    )
    return replace(freedom, passive=passive)


def _own(component: Entry, name: str, freedom: Freedom) -> Freedom:
    """With its drive as the joint's own spring and damper, where the file says that it is nothing else.  name: of the coordinate."""
    drive = freedom.drive
    if drive is None or name not in component.get("extras", {}).get(OWN, ()):
        return freedom
    springs = {"stiffness": drive.stiffness, "rest": drive.target, "damping": drive.damping}
    return replace(freedom, drive=None, passive=replace(freedom.passive or Passive(), **springs))


def hinge_turn(component: Entry, turn: Freedom) -> Freedom:
    """A hinge's one freedom with its bounce and what drives it."""
    turn = _with_stated(component, turn, math.radians(1.0))
    if turn.motion is Motion.LIMITED:
        turn = replace(turn, restitution=float(component.get("limits", {}).get("bounciness", 0.0)))
    if component.get("useMotor", False):
        motor: Entry = component.get("motor", {})
        force = float(motor.get("force", 0.0))
        speed = math.radians(motor.get("targetVelocity", 0.0))
        most = math.inf if force >= UNLIMITED_FORCE else force
        return replace(turn, drive=Drive(target_velocity=speed, max_force=most, motor=True))
    if component.get("useSpring", False):
        spring: Entry = component.get("spring", {})
        drive = Drive(
            target=math.radians(spring.get("targetPosition", 0.0)),
            stiffness=float(spring.get("spring", 0.0)),
            damping=float(spring.get("damper", 0.0)),
            acceleration=bool(component.get("useAcceleration", False)),
        )
        return _own(component, "angle", replace(turn, drive=drive))
    return turn


def driven(component: Entry, freedoms: tuple[Freedom, ...]) -> tuple[Freedom, ...]:
    """A ConfigurableJoint's six with their drives and what their limits are like; counted as its component counts."""
    found = [_limited(component, i, freedom) for i, freedom in enumerate(freedoms)]
    moves, speeds = (component.get(name, (0, 0, 0)) for name in ("targetPosition", "targetVelocity"))
    turn = rotation_log(matrix_from_quaternion(np.array(component.get("targetRotation", (0, 0, 0, 1)), float)))
    spins = component.get("targetAngularVelocity", (0, 0, 0))
    for i in range(3):
        sign = _SENSES.linear[i]
        if found[i].motion is not Motion.LOCKED:
            found[i] = _with_drive(
                found[i], component.get(_LINEAR[i], {}), sign * moves[i], sign * speeds[i]
            )
        if found[RX + i].motion is not Motion.LOCKED and component.get("rotationDriveMode") != "Slerp":
            name = "angularXDrive" if i == 0 else "angularYZDrive"
            sign = _SENSES.angular[i]
            found[RX + i] = _with_drive(
                found[RX + i], component.get(name, {}), sign * float(turn[i]), -sign * spins[i]
            )
    units = [1.0] * RX + [math.radians(1.0)] * RX
    each: Entry = component.get("stated", {})
    stated = (
        _with_stated(own if _says(own := each.get(name, {})) else component, f, unit)
        for name, f, unit in zip(COORDINATES, found, units)
    )
    return tuple(_own(component, name, freedom) for name, freedom in zip(COORDINATES, stated))


def slerp_of(component: Entry) -> SphericalDrive | None:
    """The one drive about all three rotations, None where there is none."""
    drive: Entry = component.get("slerpDrive", {})
    if component.get("rotationDriveMode") != "Slerp" or not _acts(drive):
        return None
    senses = np.array(_SENSES.angular)
    target = matrix_from_quaternion(np.array(component.get("targetRotation", (0, 0, 0, 1)), float))
    spin = np.array(component.get("targetAngularVelocity", (0, 0, 0)), float)
    return SphericalDrive(
        rotation_exp(senses * rotation_log(target)),
        -senses * spin,
        float(drive.get("positionSpring", 0.0)),
        float(drive.get("positionDamper", 0.0)),
        float(drive.get("maximumForce", math.inf)),
        bool(drive.get("useAcceleration", False)),
    )


def breaks(component: Entry) -> tuple[float, float]:
    """Newtons and newton metres at which it breaks."""
    return float(component.get("breakForce", math.inf)), float(component.get("breakTorque", math.inf))


def _acts(drive: Entry) -> bool:
    return bool(drive.get("positionSpring", 0.0) or drive.get("positionDamper", 0.0))


def _with_drive(freedom: Freedom, drive: Entry, target: float, velocity: float) -> Freedom:
    if not _acts(drive):
        return freedom
    stiffness, damping = float(drive.get("positionSpring", 0.0)), float(drive.get("positionDamper", 0.0))
    most = float(drive.get("maximumForce", math.inf))
    if stiffness == 0.0 and damping == MOTOR_DAMPING:  # what was written for a motor
        return replace(freedom, drive=Drive(target_velocity=velocity, max_force=most, motor=True))
    accelerates = bool(drive.get("useAcceleration", False))
    return replace(
        freedom, drive=Drive(target if stiffness else 0.0, velocity, stiffness, damping, most, accelerates)
    )


def _limited(component: Entry, i: int, freedom: Freedom) -> Freedom:
    if i >= RX and (stated := component.get("extras", {}).get((TWIST_RANGE, *SWING_RANGES)[i - RX])) is not None:
        sign = frames.Senses.of(b_in_a=True).angular[i - RX]
        ends = sorted(sign * math.radians(end) for end in stated)
        freedom = replace(freedom, motion=Motion.LIMITED, lower=ends[0], upper=ends[1])
    if freedom.motion is not Motion.LIMITED:
        return freedom
    names = (
        ("linearLimit", "linearLimitSpring")
        if i < RX
        else ("lowAngularXLimit", "angularXLimitSpring")
        if i == RX
        else ("angularYLimit" if i == RX + 1 else "angularZLimit", "angularYZLimitSpring")
    )
    limit, spring = (component.get(name, {}) for name in names)
    return replace(
        freedom,
        stiffness=float(spring.get("spring", 0.0)),
        damping=float(spring.get("damper", 0.0)),
        restitution=float(limit.get("bounciness", 0.0)),
        radial=i < RX,
    )
