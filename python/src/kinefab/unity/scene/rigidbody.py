from __future__ import annotations

from dataclasses import dataclass

from .vectors import IDENTITY, ONE, ZERO, Quaternion, Vector3


@dataclass(frozen=True, slots=True)
class Rigidbody:
    """mass: kg.  centerOfMass: in the object's frame, metres.  inertiaTensor: principal moments, kg m^2, along the axes
    that inertiaTensorRotation turns the object's to.  linearDamping, angularDamping: 1/s."""

    mass: float = 1.0
    linearDamping: float = 0.0
    angularDamping: float = 0.05
    centerOfMass: Vector3 = ZERO
    inertiaTensor: Vector3 = ONE
    inertiaTensorRotation: Quaternion = IDENTITY
    useGravity: bool = True
    isKinematic: bool = False
    interpolation: str = "None"
    constraints: tuple[str, ...] = ()
    collisionDetectionMode: str = "Discrete"
    maxAngularVelocity: float | None = None
    solverIterations: int | None = None
    solverVelocityIterations: int | None = None
