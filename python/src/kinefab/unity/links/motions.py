"""What a joint's component lets a link do, as an ArticulationBody says it, and what that has no field for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any, cast

from ...diagnostics import Report
from ..scene import (
    ArticulationDrive,
    ConfigurableJoint,
    FixedJoint,
    HingeJoint,
    Joint,
    JointDrive,
    Rigidbody,
)
from ..scene.joints.configurable_joint import SWING_RANGES, TWIST_RANGE

ARTICULATION = "an articulation"
MOTOR_DAMPING = 1e7
"""N m s/rad of the drive that stands for a motor: its force is then the motor's largest."""
MOST_TURN = 360.0
"""Degrees to either side within which PhysX holds the range of a link's hinge."""
NOISE = 1e-12
"""Of a target: what is left of an axis that is square to it, and is not written to a file."""
RUNTIME = ("maxAngularVelocity", "solverIterations", "solverVelocityIterations")
"""Of a body, which Unity takes from a script only."""


class NotArticulated(Exception):
    """Why a joint cannot be one of an articulation."""


def link_motion(joint: Joint, start: float) -> dict[str, Any]:
    """Fields of the link.  start: metres by which a slide stands out at the exported pose.  Raises NotArticulated."""
    if math.isfinite(joint.breakForce) or math.isfinite(joint.breakTorque):
        raise NotArticulated("it can break")
    if isinstance(joint, FixedJoint):
        return {"jointType": "Fixed"}
    if isinstance(joint, HingeJoint):
        lock = "Limited" if joint.useLimits else "Free"
        return {"jointType": "Revolute", "twistLock": lock, "xDrive": _hinge_drive(joint)}
    assert isinstance(joint, ConfigurableJoint)
    linear = (joint.xMotion, joint.yMotion, joint.zMotion)
    angular = (joint.angularXMotion, joint.angularYMotion, joint.angularZMotion)
    if linear == angular == ("Locked",) * 3:
        return {"jointType": "Fixed"}
    if angular == ("Locked",) * 3 and linear[1:] == ("Locked",) * 2:
        drive = _slide_drive(joint, start)
        return {"jointType": "Prismatic", "linearLock": linear[0], "xDrive": drive}
    if linear == ("Locked",) * 3:
        return _turning(joint, angular)
    raise NotArticulated("an articulation has revolute, prismatic, spherical and fixed joints only")


def twist_range(joint: Joint) -> tuple[float, float] | None:
    """Ends of the twist of a hinge, degrees, where only a link can hold them: within a whole turn to either side."""
    stated = joint.extras.get(TWIST_RANGE)
    if not isinstance(stated, list) or len(cast("list[float]", stated)) != 2:
        return None
    low, high = cast("list[float]", stated)
    return (low, high) if -MOST_TURN <= low and high <= MOST_TURN else None


def counts_as_link(joint: Joint, on_child: bool) -> bool:
    """Whether a component counts the child in the parent, as the link that stands for it does; where it counts the other way round,
    the twist turns its swings into each other.  on_child: whether the component is on the link's own body."""
    return isinstance(joint, ConfigurableJoint) and joint.swapBodies == on_child


def swung(moving: Mapping[str, Any], joint: Joint, on_child: bool) -> dict[str, Any]:
    """The fields of a spherical link with the uneven ends of its swings, which a ConfigurableJoint that counts alike does not hold."""
    found = dict(moving)
    # of a component on the parent the link's frame is turned round about Y
    for name, key, sense in zip(("yDrive", "zDrive"), SWING_RANGES, (1.0, 1.0 if on_child else -1.0)):
        stated = joint.extras.get(key)
        if isinstance(stated, list) and len(cast("list[float]", stated)) == 2:
            low, high = sorted(sense * end for end in cast("list[float]", stated))
            found[name] = replace(found[name], lowerLimit=low, upperLimit=high)
    return found


def _slide_drive(joint: ConfigurableJoint, start: float) -> ArticulationDrive:
    """Counted from the exported pose: the component counts from where its anchors meet."""
    sense = 1.0 if joint.swapBodies else -1.0
    reach = joint.linearLimit.limit if joint.xMotion == "Limited" else 0.0
    limits = (-reach - start, reach - start) if joint.xMotion == "Limited" else (0.0, 0.0)
    driven = _driven(joint.xDrive, sense * joint.targetPosition[0] - start, sense * joint.targetVelocity[0])
    return replace(driven, lowerLimit=limits[0], upperLimit=limits[1])


def _hinge_drive(joint: HingeJoint) -> ArticulationDrive:
    limits = (joint.limits.min, joint.limits.max) if joint.useLimits else (0.0, 0.0)
    if joint.useMotor:
        motor = joint.motor
        return ArticulationDrive(*limits, 0.0, MOTOR_DAMPING, motor.force, 0.0, motor.targetVelocity)
    if joint.useSpring:
        spring = joint.spring
        return ArticulationDrive(
            *limits,
            spring.spring,
            spring.damper,
            target=spring.targetPosition,
            driveType=_kind(joint.useAcceleration),
        )
    return ArticulationDrive(*limits)


def _kind(accelerates: bool) -> str:
    return "Acceleration" if accelerates else "Force"


def _driven(drive: JointDrive, target: float, velocity: float) -> ArticulationDrive:
    gains = (drive.positionSpring, drive.positionDamper, drive.maximumForce)
    return ArticulationDrive(
        0.0, 0.0, *gains, target if drive.positionSpring else 0.0, velocity, _kind(drive.useAcceleration)
    )


def _turning(joint: ConfigurableJoint, angular: tuple[str, str, str]) -> dict[str, Any]:
    """A ConfigurableJoint limits and drives the connected body's twist, unless the bodies are swapped; a link turns itself."""
    sense = 1.0 if joint.swapBodies else -1.0
    low, high = sorted((sense * joint.lowAngularXLimit.limit, sense * joint.highAngularXLimit.limit))
    slerp = joint.rotationDriveMode == "Slerp"
    x, y, z, w = joint.targetRotation
    aside = (y, z, *joint.targetAngularVelocity[1:])
    if any(abs(v) > NOISE for v in (*aside, *((x, joint.targetAngularVelocity[0]) if slerp else ()))):
        raise NotArticulated("its drive turns about several axes to a target")
    target = sense * math.degrees(2.0 * math.atan2(x, w))
    velocity = -sense * math.degrees(joint.targetAngularVelocity[0])
    twist = _driven(joint.slerpDrive if slerp else joint.angularXDrive, target, velocity)
    found: dict[str, Any] = {
        "twistLock": angular[0],
        "xDrive": replace(twist, lowerLimit=low, upperLimit=high),
    }
    if angular[1:] == ("Locked", "Locked"):
        if (range := twist_range(joint)) is not None:
            found["twistLock"] = "Limited"
            low, high = sorted(sense * end for end in range)
            found["xDrive"] = replace(twist, lowerLimit=low, upperLimit=high)
        return {"jointType": "Revolute", **found}
    swing = _driven(joint.slerpDrive if slerp else joint.angularYZDrive, 0.0, 0.0)
    reach_y, reach_z = joint.angularYLimit.limit, joint.angularZLimit.limit
    return {
        "jointType": "Spherical",
        **found,
        "swingYLock": angular[1],
        "swingZLock": angular[2],
        "yDrive": replace(swing, lowerLimit=-reach_y, upperLimit=reach_y),
        "zDrive": replace(swing, lowerLimit=-reach_z, upperLimit=reach_z),
    }


def tell_link_losses(joint: Joint, body: Rigidbody, owner: str, report: Report) -> None:
    """joint: above the link that stands for ``body``.  owner: id of its object."""
    feature = f"joint {joint.id or owner}"
    for field in _without_a_field(joint):
        report.field_dropped(feature, field, ARTICULATION)
    for name in RUNTIME:
        if getattr(body, name) is not None:
            report.field_dropped(f"Rigidbody of {owner}", name, ARTICULATION)
    if not isinstance(joint, ConfigurableJoint) or joint.rotationDriveMode != "Slerp":
        return
    if joint.slerpDrive != JointDrive():
        detail = "its drive about all three rotations became one about each"
        report.approximated(feature, "TARGET_FEATURE_APPROXIMATED", target=ARTICULATION, detail=detail)


def _without_a_field(joint: Joint) -> list[str]:
    found = ["enableCollision"] if joint.enableCollision else []
    if isinstance(joint, HingeJoint):
        if joint.useLimits and joint.limits.bounciness:
            found.append("the limit's bounciness")
        if joint.useMotor and joint.motor.freeSpin:
            found.append("the motor's freeSpin")
    if not isinstance(joint, ConfigurableJoint):
        return found
    twist, swing = joint.angularXLimitSpring, joint.angularYZLimitSpring
    low, high = joint.lowAngularXLimit, joint.highAngularXLimit
    for motions, spring, limits in (
        ((joint.xMotion, joint.yMotion, joint.zMotion), joint.linearLimitSpring, (joint.linearLimit,)),
        ((joint.angularXMotion,), twist, (low, high)),
        ((joint.angularYMotion, joint.angularZMotion), swing, (joint.angularYLimit, joint.angularZLimit)),
    ):
        if "Limited" in motions and (spring.spring or spring.damper):
            found.append("the limit's spring")
        if "Limited" in motions and any(limit.bounciness for limit in limits):
            found.append("the limit's bounciness")
    return found
