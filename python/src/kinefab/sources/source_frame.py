"""The units and axes of a source, and the turn into the scene's frame: a rotation and a scale, never a
mirror."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ..spatial import Array

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

    turn: proper rotation, source axes to scene axes, shape (3, 3).  length, angle, mass: metres, radians and
    kilograms in one unit of the source.  mesh_length: metres in one unit of its mesh files.
    """

    turn: Array = field(default_factory=lambda: np.eye(3))
    length: float = 1.0
    angle: float = 1.0
    mass: float = 1.0
    mesh_length: float = 1.0


def turn_to_scene(up: tuple[float, ...], forward: tuple[float, ...]) -> Array:
    """Rotation matrix that takes ``up`` to +Y and ``forward`` to +Z (unit vectors, perpendicular)."""
    return np.vstack([np.cross(up, forward), up, forward])
