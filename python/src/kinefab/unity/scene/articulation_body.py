from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from .vectors import IDENTITY, ONE, ZERO, Quaternion, Vector3


@dataclass(frozen=True, slots=True)
class ArticulationDrive:
    """Metres or degrees, newtons or newton metres; gains for each metre or radian.

    driveType: ``Force``; ``Acceleration``, gains per unit of inertia; ``Target`` or ``Velocity``, as stiff as the solver can.
    """

    lowerLimit: float = 0.0
    upperLimit: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0
    forceLimit: float = math.inf
    target: float = 0.0
    targetVelocity: float = 0.0
    driveType: str = "Force"


@dataclass(frozen=True, slots=True)
class ArticulationBody:
    """A link of a tree, held to the nearest one above it in the hierarchy; zero of its coordinates is the pose at the start.

    jointType: ``Fixed``, ``Prismatic``, ``Revolute`` or ``Spherical``, along and about X of the anchors; locks: ``Locked``, ``Limited``
    or ``Free``.  anchor, parentAnchor: the same frame, seen from the link and from the one above.
    maxJointVelocity: of each axis, m/s or rad/s; None: PhysX's own 100.
    """

    mass: float = 1.0
    parentAnchorPosition: Vector3 = ZERO
    parentAnchorRotation: Quaternion = IDENTITY
    anchorPosition: Vector3 = ZERO
    anchorRotation: Quaternion = IDENTITY
    jointType: str = "Fixed"
    linearLock: str = "Locked"
    twistLock: str = "Locked"
    swingYLock: str = "Locked"
    swingZLock: str = "Locked"
    xDrive: ArticulationDrive = ArticulationDrive()
    yDrive: ArticulationDrive = ArticulationDrive()
    zDrive: ArticulationDrive = ArticulationDrive()
    linearDamping: float = 0.0
    angularDamping: float = 0.05
    jointFriction: float = 0.0
    maxJointVelocity: float | None = None
    centerOfMass: Vector3 = ZERO
    inertiaTensor: Vector3 = ONE
    inertiaTensorRotation: Quaternion = IDENTITY
    immovable: bool = False
    useGravity: bool = True
    collisionDetectionMode: str = "Discrete"
    because: tuple[str, ...] = ()
    extras: Mapping[str, object] = field(default_factory=dict[str, object], compare=False, hash=False)
