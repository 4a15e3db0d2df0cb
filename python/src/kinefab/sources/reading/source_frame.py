"""The units and axes of a source, and the turn into the scene's frame: a rotation and a scale, and for a
left-handed source a mirror.

Mirrored, every vector goes by the same matrix, the third axis of a joint (z x x) turns round, and what is counted
about an axis, by the left hand there, changes its sign.  All of these signs are decided here.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...spatial import Array

METRES = {
    "mm": 1e-3, "millimeter": 1e-3, "cm": 1e-2, "centimeter": 1e-2, "dm": 1e-1, "m": 1.0, "meter": 1.0,
    "um": 1e-6, "micron": 1e-6, "in": 0.0254, "inch": 0.0254, "ft": 0.3048, "foot": 0.3048, "yd": 0.9144,
}  # fmt: skip
"""Metres in one unit of length.  The international inch is 25.4 mm exactly."""

RADIANS = {
    "deg": math.pi / 180.0,
    "degree": math.pi / 180.0,
    "rad": 1.0,
    "radian": 1.0,
    "turn": 2.0 * math.pi,
}
KILOGRAMS = {"kg": 1.0, "g": 1e-3, "t": 1e3, "lb": 0.45359237, "oz": 0.45359237 / 16.0}

DIRECTIONS = {
    sign + name: tuple(float(f"{sign}1") if axis == index else 0.0 for axis in range(3))
    for sign in ("", "-", "+")
    for index, name in enumerate("XYZ")
}
"""Words for an axis direction: X, -X, +X, ..."""

FORWARD = {"X": "Z", "Y": "Z", "Z": "-Y"}
"""Forward axis of a source that does not name one, by its up axis: CAD programs look at a part along +Y."""


@dataclass(frozen=True, slots=True, eq=False)
class SourceFrame:
    """How numbers of the source become numbers of the scene.

    turn: orthogonal, source axes to scene axes, shape (3, 3), a mirror in it for a left-handed source.  length,
    angle, mass: metres, radians and kilograms in one unit of the source.  mesh_length: metres in one unit of
    its mesh files.
    """

    turn: Array = field(default_factory=lambda: np.eye(3))
    length: float = 1.0
    angle: float = 1.0
    mass: float = 1.0
    mesh_length: float = 1.0

    @property
    def hand(self) -> float:
        """1, or -1 for a left-handed source."""
        return math.copysign(1.0, np.linalg.det(self.turn))

    @property
    def about(self) -> float:
        """Radians in one unit of an angle that is counted about an axis."""
        return self.hand * self.angle

    @property
    def travel(self) -> float:
        """Metres in one unit of a travel for a turn about the axis travelled along: a lead, a pitch."""
        return self.hand * self.length

    def coordinate(self, name: str) -> float:
        """Metres or radians in one unit of a joint's coordinate, by its name in the source (tx ... rz)."""
        along = self.hand if name.endswith("y") else 1.0
        return along * (self.length if name.startswith("t") else self.about)


def turn_to_scene(up: tuple[float, ...], forward: tuple[float, ...], left_handed: bool = False) -> Array:
    """Orthogonal matrix that takes ``up`` to +Y and ``forward`` to +Z (unit vectors, perpendicular).

    A right-handed source's right, up x forward, goes to +X; a left-handed one's to -X.
    """
    right = np.cross(up, forward)
    return np.vstack([-right if left_handed else right, up, forward])
