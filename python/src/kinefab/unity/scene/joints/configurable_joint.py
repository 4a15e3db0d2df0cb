from __future__ import annotations

import math
from dataclasses import dataclass

from ..vectors import IDENTITY, ZERO, Quaternion, Vector3
from .joint import AnchoredJoint


@dataclass(frozen=True, slots=True)
class SoftJointLimit:
    """limit: metres or degrees.  bounciness: 0..1."""

    limit: float = 0.0
    bounciness: float = 0.0
    contactDistance: float = 0.0


@dataclass(frozen=True, slots=True)
class SoftJointLimitSpring:
    spring: float = 0.0
    damper: float = 0.0


@dataclass(frozen=True, slots=True)
class JointDrive:
    """positionSpring, positionDamper: N/m, N s/m, or N m/rad, N m s/rad.  maximumForce: infinite is Unity's largest float."""

    positionSpring: float = 0.0
    positionDamper: float = 0.0
    maximumForce: float = math.inf
    useAcceleration: bool = False


@dataclass(frozen=True, slots=True)
class StatedAxis:
    """What the source states of one coordinate, as ``AnchoredJoint`` has it for all of them."""

    effort: float = math.inf
    speed: float = math.inf
    friction: float = 0.0
    armature: float = 0.0


@dataclass(frozen=True, slots=True)
class StatedAxes:
    """Of a joint whose coordinates differ in it, each one's own."""

    x: StatedAxis = StatedAxis()
    y: StatedAxis = StatedAxis()
    z: StatedAxis = StatedAxis()
    angularX: StatedAxis = StatedAxis()
    angularY: StatedAxis = StatedAxis()
    angularZ: StatedAxis = StatedAxis()


APART = "apart"
"""Of the extras of a joint that holds nothing and only keeps two bodies from colliding: the source's rule."""

TWIST_RANGE = "angularXRange"
"""Of the extras of a joint whose twist has a range beyond half a turn, which the component does not count: its ends, degrees, of the
same sense as ``lowAngularXLimit`` and ``highAngularXLimit``."""
SWING_RANGES = ("angularYRange", "angularZRange")
"""Likewise, of swings whose ends are not the same to either side."""


@dataclass(frozen=True, slots=True)
class ConfigurableJoint(AnchoredJoint):
    """Motions are ``Locked``, ``Limited`` or ``Free``.  targetVelocity: m/s; targetAngularVelocity: rad/s."""

    secondaryAxis: Vector3 = (0.0, 1.0, 0.0)
    xMotion: str = "Free"
    yMotion: str = "Free"
    zMotion: str = "Free"
    angularXMotion: str = "Free"
    angularYMotion: str = "Free"
    angularZMotion: str = "Free"
    linearLimitSpring: SoftJointLimitSpring = SoftJointLimitSpring()
    linearLimit: SoftJointLimit = SoftJointLimit()
    angularXLimitSpring: SoftJointLimitSpring = SoftJointLimitSpring()
    lowAngularXLimit: SoftJointLimit = SoftJointLimit()
    highAngularXLimit: SoftJointLimit = SoftJointLimit()
    angularYZLimitSpring: SoftJointLimitSpring = SoftJointLimitSpring()
    angularYLimit: SoftJointLimit = SoftJointLimit()
    angularZLimit: SoftJointLimit = SoftJointLimit()
    targetPosition: Vector3 = ZERO
    targetVelocity: Vector3 = ZERO
    xDrive: JointDrive = JointDrive()
    yDrive: JointDrive = JointDrive()
    zDrive: JointDrive = JointDrive()
    targetRotation: Quaternion = IDENTITY
    targetAngularVelocity: Vector3 = ZERO
    rotationDriveMode: str = "XYAndZ"
    angularXDrive: JointDrive = JointDrive()
    angularYZDrive: JointDrive = JointDrive()
    slerpDrive: JointDrive = JointDrive()
    projectionMode: str = "None"
    projectionDistance: float = 0.1
    projectionAngle: float = 180.0
    configuredInWorldSpace: bool = False
    swapBodies: bool = False
    stated: StatedAxes = StatedAxes()

    @property
    def keeps_apart(self) -> bool:
        """Whether it is there only to keep two bodies from colliding."""
        return APART in self.extras


MOTION_FIELDS = ("xMotion", "yMotion", "zMotion", "angularXMotion", "angularYMotion", "angularZMotion")
"""The fields of its motions, in the order of ``model.FREEDOM_NAMES``."""
