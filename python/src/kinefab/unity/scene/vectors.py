"""Vectors as plain tuples: nouns are compared and written number by number."""

from __future__ import annotations

from ...spatial import Array

Vector2 = tuple[float, float]
Vector3 = tuple[float, float, float]
Quaternion = tuple[float, float, float, float]
"""x, y, z, w, unit."""
Color = tuple[float, float, float, float]
"""Linear RGBA, 0..1."""

ZERO: Vector3 = (0.0, 0.0, 0.0)
ONE: Vector3 = (1.0, 1.0, 1.0)
IDENTITY: Quaternion = (0.0, 0.0, 0.0, 1.0)


def vector3(values: Array) -> Vector3:
    """values: shape (3,)."""
    x, y, z = values.tolist()
    return (x, y, z)


def vectors3(values: Array) -> tuple[Vector3, ...]:
    """values: shape (n, 3)."""
    return tuple((x, y, z) for x, y, z in values.tolist())


def quaternion4(values: Array) -> Quaternion:
    """values: x y z w, shape (4,)."""
    x, y, z, w = values.tolist()
    return (x, y, z, w)
