from __future__ import annotations

from dataclasses import dataclass

from .joint import AnchoredJoint


@dataclass(frozen=True, slots=True)
class JointSpring:
    """spring: N m/rad.  damper: N m s/rad.  targetPosition: degrees."""

    spring: float = 0.0
    damper: float = 0.0
    targetPosition: float = 0.0


@dataclass(frozen=True, slots=True)
class JointMotor:
    """targetVelocity: degrees/s.  force: largest torque, N m."""

    targetVelocity: float = 0.0
    force: float = 0.0
    freeSpin: bool = False


@dataclass(frozen=True, slots=True)
class JointLimits:
    """min, max, contactDistance: degrees.  bounciness: 0..1."""

    min: float = 0.0
    max: float = 0.0
    bounciness: float = 0.0
    bounceMinVelocity: float = 0.2
    contactDistance: float = 0.0


@dataclass(frozen=True, slots=True)
class HingeJoint(AnchoredJoint):
    useSpring: bool = False
    spring: JointSpring = JointSpring()
    useMotor: bool = False
    motor: JointMotor = JointMotor()
    useLimits: bool = False
    limits: JointLimits = JointLimits()
    extendedLimits: bool = False
    useAcceleration: bool = False
