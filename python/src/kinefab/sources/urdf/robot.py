"""A URDF file's robot, as it states it: links, joints, materials; source axes, metres, radians."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from ...spatial import Array, Pose
from ..robots.rigid_links import Link
from ..robots.xml_elements import Element


@dataclass(slots=True, eq=False)
class Mimic:
    """q = multiplier * (q of ``joint``) + offset."""

    joint: str
    multiplier: float
    offset: float
    where: str


@dataclass(slots=True, eq=False)
class UrdfJoint:
    """origin: child's frame in the parent's at q = 0.  axis: unit, child's frame.  kind: the format's word.

    lower, upper: radians or metres, infinite where the joint has no limits.
    moves: False for one that its type, its range or what it follows holds in place.
    """

    name: str
    kind: str
    parent: str
    child: str
    origin: Pose
    axis: Array
    where: str
    lower: float = -math.inf
    upper: float = math.inf
    effort: float = math.inf
    velocity: float = math.inf
    damping: float = 0.0
    friction: float = 0.0
    mimic: Mimic | None = None
    extras: dict[str, object] = field(default_factory=dict[str, object])

    @property
    def moves(self) -> bool:
        return self.kind != "fixed" and not self.lower == self.upper


@dataclass(slots=True, eq=False)
class Robot:
    """links, joints: by name, in the file's order.  starts: of joints that ``tree.start_of`` was asked for."""

    name: str
    element: Element
    links: dict[str, Link] = field(default_factory=dict[str, Link])
    joints: dict[str, UrdfJoint] = field(default_factory=dict[str, UrdfJoint])
    starts: dict[str, float] = field(default_factory=dict[str, float])
