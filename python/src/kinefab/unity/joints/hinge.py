"""The fields of a HingeJoint: limits, motor and spring of one rotation."""

from __future__ import annotations

import math
from typing import Any

from ...diagnostics import Report
from ...model import RX, Joint, Motion
from ..scene import JointLimits, JointMotor, JointSpring
from ..scene.joints.joint import UNLIMITED_FORCE
from .coordinates import CanonicalJoint, Coordinates
from .limits import may_wrap, one_sided, report_outside

TURN_ROUNDED = 1e-3
"""Degrees by which a whole turn, written as 6.2832 or so, may be past what Unity takes."""


def fits_hinge(joint: CanonicalJoint) -> bool:
    """Whether the joint is one rotation without what only a ConfigurableJoint has: a soft limit, a spring
    with a largest torque or with a target speed."""
    if joint.rotations != (0,) or joint.translations:
        return False
    freedom = joint.freedoms[RX]
    if freedom.motion is Motion.LIMITED and (freedom.stiffness > 0.0 or freedom.damping > 0.0):
        return False
    drive = freedom.drive
    if drive is None or drive.motor:
        return True
    return math.isinf(drive.max_force) and (drive.target_velocity == 0.0 or drive.damping == 0.0)


def hinge_fields(
    joint: Joint,
    shape: CanonicalJoint,
    coordinates: Coordinates,
    report: Report,
) -> dict[str, Any]:
    """Limits, motor and spring of the component; degrees."""
    freedom = shape.freedoms[RX]
    zero = freedom.nearest_turn(coordinates.values[RX])
    fields: dict[str, Any] = {}
    if freedom.motion is Motion.LIMITED:
        fields |= _limits(joint, shape, zero, report)
    drive = freedom.drive
    if drive is not None and drive.motor:
        fields["useMotor"] = True
        fields["motor"] = JointMotor(
            math.degrees(drive.target_velocity), min(drive.max_force, UNLIMITED_FORCE)
        )
    elif drive is not None:
        fields["useSpring"] = True
        fields["spring"] = JointSpring(drive.stiffness, drive.damping, math.degrees(drive.target - zero))
        if drive.acceleration:
            fields["useAcceleration"] = True
    return fields


def _limits(joint: Joint, shape: CanonicalJoint, zero: float, report: Report) -> dict[str, Any]:
    freedom, feature = shape.freedoms[RX], f"joint {joint.id}"
    report_outside(joint, shape.name_of[RX], freedom, zero, report)
    low, high = math.degrees(freedom.lower - zero), math.degrees(freedom.upper - zero)
    if math.isinf(low) or math.isinf(high):
        report.approximated(
            feature,
            "JOINT_LIMIT_ONE_SIDED",
            joint.where,
            joint=joint.id,
            stop="360 degrees from the exported pose",
        )
        low, high = one_sided(low, high, 360.0)
    if -360.0 - TURN_ROUNDED < low < -360.0:
        low = -360.0
    if 360.0 < high < 360.0 + TURN_ROUNDED:
        high = 360.0
    if low < -360.0 or high > 360.0:
        report.approximated(
            feature, "JOINT_LIMIT_BEYOND_TURN", joint.where, joint=joint.id, low=f"{low:g}", high=f"{high:g}"
        )
        return {}
    limits = JointLimits(low, high, freedom.restitution)
    return {"useLimits": True, "limits": limits, "extendedLimits": may_wrap(joint, shape, low, high)}
