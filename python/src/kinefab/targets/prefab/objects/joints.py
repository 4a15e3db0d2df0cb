"""Joints, every field told: what is left out Unity would fill with defaults of its own."""

from __future__ import annotations

import math

from ....unity.scene import (
    ConfigurableJoint,
    FixedJoint,
    HingeJoint,
    Joint,
    JointDrive,
    SoftJointLimit,
    SoftJointLimitSpring,
)
from ....unity.scene.joints.joint import UNLIMITED_FORCE, AnchoredJoint
from ...numbers import DECIMALS
from ..text.dialects import Dialect
from ..text.documents import component_head, version
from ..text.yaml import NULL, Fields, Plain, placed

MOTIONS = {"Locked": 0, "Limited": 1, "Free": 2}
DRIVE_MODES = {"XYAndZ": 0, "Slerp": 1}
PROJECTIONS = {"None": 0, "PositionAndRotation": 1}


def joint_class(joint: Joint) -> tuple[int, str]:
    """Unity's number and name."""
    kinds: dict[type[Joint], tuple[int, str]] = {
        HingeJoint: (59, "HingeJoint"),
        ConfigurableJoint: (153, "ConfigurableJoint"),
        FixedJoint: (138, "FixedJoint"),
    }
    return kinds[type(joint)]


def joint_fields(
    joint: Joint, owner: int, connected: Plain, dialect: Dialect, articulation: Plain = NULL
) -> Fields:
    """connected, articulation: references to the Rigidbody or ArticulationBody of the other side."""
    head: Fields = {
        **component_head(owner),
        "m_ConnectedBody": connected,
        "m_ConnectedArticulationBody": articulation,
    }
    tail: Fields = {
        "m_BreakForce": float(joint.breakForce),
        "m_BreakTorque": float(joint.breakTorque),
        "m_EnableCollision": joint.enableCollision,
        "m_EnablePreprocessing": joint.enablePreprocessing,
        "m_MassScale": float(joint.massScale),
        "m_ConnectedMassScale": float(joint.connectedMassScale),
    }
    if not isinstance(joint, AnchoredJoint):
        return {**head, **tail}
    anchors: Fields = {
        "m_Anchor": placed(joint.anchor),
        "m_Axis": placed(joint.axis),
        "m_AutoConfigureConnectedAnchor": joint.autoConfigureConnectedAnchor,
        "m_ConnectedAnchor": placed(joint.connectedAnchor),
    }
    if isinstance(joint, HingeJoint):
        return {**head, **anchors, **version(dialect.hinge), **_hinge(joint, dialect), **tail}
    assert isinstance(joint, ConfigurableJoint)
    return {**head, **anchors, **version(dialect.configurable), **_configurable(joint, dialect), **tail}


def _hinge(joint: HingeJoint, dialect: Dialect) -> Fields:
    newer: Fields = {}
    if dialect.mass_properties:  # came with the same editor
        newer = {"m_ExtendedLimits": joint.extendedLimits, "m_UseAcceleration": joint.useAcceleration}
    spring, motor, limits = joint.spring, joint.motor, joint.limits
    return {
        "m_UseSpring": joint.useSpring,
        "m_Spring": {
            "spring": float(spring.spring),
            "damper": float(spring.damper),
            "targetPosition": round(float(spring.targetPosition), DECIMALS),
        },
        "m_UseMotor": joint.useMotor,
        "m_Motor": {
            "targetVelocity": round(float(motor.targetVelocity), DECIMALS),
            "force": float(motor.force),
            "freeSpin": motor.freeSpin,
        },
        "m_UseLimits": joint.useLimits,
        **newer,
        "m_Limits": {
            "min": round(float(limits.min), DECIMALS),
            "max": round(float(limits.max), DECIMALS),
            "bounciness": float(limits.bounciness),
            "bounceMinVelocity": float(limits.bounceMinVelocity),
            "contactDistance": round(float(limits.contactDistance), DECIMALS),
        },
    }


def _configurable(joint: ConfigurableJoint, dialect: Dialect) -> Fields:
    return {
        "m_SecondaryAxis": placed(joint.secondaryAxis),
        "m_XMotion": MOTIONS[joint.xMotion],
        "m_YMotion": MOTIONS[joint.yMotion],
        "m_ZMotion": MOTIONS[joint.zMotion],
        "m_AngularXMotion": MOTIONS[joint.angularXMotion],
        "m_AngularYMotion": MOTIONS[joint.angularYMotion],
        "m_AngularZMotion": MOTIONS[joint.angularZMotion],
        "m_LinearLimitSpring": _spring(joint.linearLimitSpring),
        "m_LinearLimit": _limit(joint.linearLimit),
        "m_AngularXLimitSpring": _spring(joint.angularXLimitSpring),
        "m_LowAngularXLimit": _limit(joint.lowAngularXLimit),
        "m_HighAngularXLimit": _limit(joint.highAngularXLimit),
        "m_AngularYZLimitSpring": _spring(joint.angularYZLimitSpring),
        "m_AngularYLimit": _limit(joint.angularYLimit),
        "m_AngularZLimit": _limit(joint.angularZLimit),
        "m_TargetPosition": placed(joint.targetPosition),
        "m_TargetVelocity": placed(joint.targetVelocity),
        "m_XDrive": _drive(joint.xDrive, dialect),
        "m_YDrive": _drive(joint.yDrive, dialect),
        "m_ZDrive": _drive(joint.zDrive, dialect),
        "m_TargetRotation": placed(joint.targetRotation),
        "m_TargetAngularVelocity": placed(joint.targetAngularVelocity),
        "m_RotationDriveMode": DRIVE_MODES[joint.rotationDriveMode],
        "m_AngularXDrive": _drive(joint.angularXDrive, dialect),
        "m_AngularYZDrive": _drive(joint.angularYZDrive, dialect),
        "m_SlerpDrive": _drive(joint.slerpDrive, dialect),
        "m_ProjectionMode": PROJECTIONS[joint.projectionMode],
        "m_ProjectionDistance": float(joint.projectionDistance),
        "m_ProjectionAngle": float(joint.projectionAngle),
        "m_ConfiguredInWorldSpace": joint.configuredInWorldSpace,
        "m_SwapBodies": joint.swapBodies,
    }


def _limit(limit: SoftJointLimit) -> Fields:
    return {
        "limit": round(float(limit.limit), DECIMALS),
        "bounciness": float(limit.bounciness),
        "contactDistance": round(float(limit.contactDistance), DECIMALS),
    }


def _spring(spring: SoftJointLimitSpring) -> Fields:
    return {"spring": float(spring.spring), "damper": float(spring.damper)}


def _drive(drive: JointDrive, dialect: Dialect) -> Fields:
    force = UNLIMITED_FORCE if math.isinf(drive.maximumForce) else drive.maximumForce
    newer: Fields = {"useAcceleration": drive.useAcceleration} if dialect.drive > 3 else {}
    return {
        "serializedVersion": dialect.drive,
        "positionSpring": float(drive.positionSpring),
        "positionDamper": float(drive.positionDamper),
        "maximumForce": float(force),
        **newer,
    }
