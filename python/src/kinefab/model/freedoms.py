"""What one of a joint's six freedoms may do: its range, what drives it, and what it is by itself."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from typing import TypeVar

from ..spatial import Array

TX, TY, TZ, RX, RY, RZ = range(6)
"""Indices of a freedom in a joint's frame: translation along and rotation about X, Y, Z."""
FREEDOM_NAMES = ("tx", "ty", "tz", "rx", "ry", "rz")
"""Their names, by index."""


MOTOR_DAMPING = 1e9
"""N s/m or N m s/rad, of a drive that stands for a motor where a format has none: its force is then the motor's largest."""
Amount = TypeVar("Amount", float, Array)
SEAM = 1e-6
"""Turns by which half a turn outside of a range may be the rounding of half a turn inside."""


class Motion(str, Enum):
    """Whether a freedom moves, and how far.

    >>> import kinefab
    >>> [motion.value for motion in kinefab.Motion]
    ['locked', 'limited', 'free']
    """

    LOCKED = "locked"
    LIMITED = "limited"
    FREE = "free"


@dataclass(frozen=True, slots=True)
class Drive:
    """A spring, damper or motor on one freedom; metres or radians, newtons or newton metres, seconds.

    Force = stiffness * (target - q) + damping * (target_velocity - qdot), clamped to +-max_force.
    acceleration: the gains are per unit of inertia instead (rad/s^2, m/s^2).
    motor: ``target_velocity`` is held with up to ``max_force`` (stiffness and damping are not used).

    >>> import kinefab
    >>> drive = kinefab.Drive(target=0.5, stiffness=200.0, damping=5.0, max_force=40.0)
    >>> drive.acceleration, drive.motor
    (False, False)
    """

    target: float = 0.0
    target_velocity: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0
    max_force: float = math.inf
    acceleration: bool = False
    motor: bool = False


@dataclass(frozen=True, slots=True)
class Passive:
    """What a freedom is by itself, beside any actuator; metres or radians, newtons or newton metres, seconds.

    stiffness, rest: a spring, force = stiffness * (rest - q).  damping: force = -damping * qdot.
    friction: largest dry friction.  armature: inertia that turns or slides with the coordinate, kg m^2 or kg.
    effort: largest force of whatever drives it; speed: largest rate: both infinite where nobody states them.
    """

    stiffness: float = 0.0
    rest: float = 0.0
    damping: float = 0.0
    friction: float = 0.0
    armature: float = 0.0
    effort: float = math.inf
    speed: float = math.inf


@dataclass(frozen=True, slots=True, eq=False)
class SphericalDrive:
    """One spring and damper about all three rotations (Unity's slerp drive); radians, newton metres, seconds.

    target: rotation of b's joint frame in a's that is driven to, shape (3, 3).
    target_velocity: of b against a, in a's joint frame, shape (3,).
    Torque = stiffness * angle + damping * (target_velocity - w), clamped to max_force.
    acceleration: the gains are per unit of inertia instead.
    """

    target: Array
    target_velocity: Array
    stiffness: float = 0.0
    damping: float = 0.0
    max_force: float = math.inf
    acceleration: bool = False


@dataclass(frozen=True, slots=True)
class Freedom:
    """One of a joint's six freedoms.

    lower, upper: range of the coordinate when LIMITED, metres or radians; either may be infinite.
    stiffness, damping: of the limit, 0 and 0 for a hard one.  restitution: 0..1, of a hard limit.
    radial: of a slide, that the range is one for all slides of the joint that have it: how far apart the two frames are at most.
    passive: what the freedom is by itself, None for nothing stated.
    at: the coordinate at the exported pose where the source states it: its frames tell an angle up to whole turns only.
    turns: whole turns by which the source displays more than the coordinate, its limits too.  sign: -1 where it counts by the
    other hand.  Both for what people read only.
    name, where: what the source calls the freedom and where it speaks of it, empty where it does not; for messages only.

    >>> import kinefab
    >>> freedom = kinefab.Freedom(kinefab.Motion.LIMITED, lower=-0.5, upper=1.5)
    >>> freedom.displayed(freedom.lower, freedom.upper)
    (-0.5, 1.5)
    """

    motion: Motion = Motion.LOCKED
    lower: float = -math.inf
    upper: float = math.inf
    drive: Drive | None = None
    stiffness: float = 0.0
    damping: float = 0.0
    restitution: float = 0.0
    radial: bool = False
    passive: Passive | None = None
    at: float | None = field(default=None, compare=False)
    turns: int = field(default=0, compare=False)
    sign: float = field(default=1.0, compare=False)
    name: str = field(default="", compare=False)
    where: str = field(default="", compare=False)

    @property
    def acts(self) -> bool:
        """Whether it has an end, a drive or a spring: what a joint is there for that locks nothing.

        >>> kinefab.Freedom(kinefab.Motion.FREE).acts, kinefab.Freedom(kinefab.Motion.LIMITED, upper=0.5).acts
        (False, True)
        """
        limited = self.motion is Motion.LIMITED and not (math.isinf(self.lower) and math.isinf(self.upper))
        sprung = self.passive is not None and (self.passive.stiffness or self.passive.damping)
        return bool(limited or self.drive is not None or sprung)

    def displayed(self, *values: Amount) -> tuple[Amount, ...]:
        """Values of the coordinate, or arrays of them, radians or metres, as the source shows them.

        >>> kinefab.Freedom(kinefab.Motion.FREE).displayed(0.25)
        (0.25,)
        """
        return tuple(0.0 + self.sign * (value + 2.0 * math.pi * self.turns) for value in values)  # no -0

    def counted(self, displayed: Amount) -> Amount:
        """What ``displayed`` undoes.

        >>> kinefab.Freedom(sign=-1.0).counted(0.25)
        -0.25
        """
        return self.sign * displayed - 2.0 * math.pi * self.turns

    def displayed_range(self, lower: float, upper: float) -> tuple[float, float]:
        """A range of the coordinate as the source shows it: where that counts by the other hand, its ends change places.

        >>> kinefab.Freedom(sign=-1.0).displayed_range(-0.5, 1.5)
        (-1.5, 0.5)
        """
        low, high = sorted(self.displayed(lower, upper))
        return low, high

    def counted_from(self, zero: float) -> Freedom:
        """The same freedom whose coordinate is zero where it was ``zero``, metres or radians.

        >>> kinefab.Freedom(kinefab.Motion.LIMITED, lower=-1.0, upper=2.0).counted_from(0.5).upper
        1.5
        """
        if zero == 0.0:
            return self
        drive, passive = self.drive, self.passive
        return replace(
            self,
            lower=self.lower - zero,
            upper=self.upper - zero,
            drive=None if drive is None else replace(drive, target=drive.target - zero),
            passive=None if passive is None else replace(passive, rest=passive.rest - zero),
            at=None if self.at is None else self.at - zero,
        )

    def turned_round(self) -> Freedom:
        """The same freedom counted the other way.

        >>> kinefab.Freedom(kinefab.Motion.LIMITED, lower=-0.5, upper=1.5).turned_round().lower
        -1.5
        """
        drive, passive = self.drive, self.passive
        if drive is not None:
            drive = replace(drive, target=-drive.target, target_velocity=-drive.target_velocity)
        return replace(
            self,
            lower=-self.upper,
            upper=-self.lower,
            drive=drive,
            passive=None if passive is None else replace(passive, rest=-passive.rest),
            at=None if self.at is None else -self.at,
        )

    def nearest_turn(self, value: float) -> float:
        """The angle, radians, that ``value`` stands for where it is known up to whole turns.

        It is the one nearest to where the source says that the pose is.  Where it does not say: the one nearest to the
        middle of the range; of a range with one end ``value`` itself where it lies inside, else the nearest to that end.

        >>> turned = kinefab.Freedom(kinefab.Motion.LIMITED, lower=3.0, upper=9.0)
        >>> round(turned.nearest_turn(0.5), 6)  # a whole turn on
        6.783185
        """
        turn = 2.0 * math.pi
        open_ends = math.isinf(self.lower) + math.isinf(self.upper)
        if self.motion is not Motion.LIMITED or open_ends == 2:
            return value
        if self.at is not None:
            return value + turn * round((self.at - value) / turn)
        if not open_ends:
            return value + turn * round((0.5 * (self.lower + self.upper) - value) / turn)
        outwards, end = (1.0, self.lower) if math.isinf(self.upper) else (-1.0, self.upper)
        missing = outwards * (end - value) / turn  # turns that it is outside of the range
        return value + outwards * turn * max(0, math.ceil(missing - 0.5 + SEAM))


LOCKED = Freedom()
FREE = Freedom(Motion.FREE)
