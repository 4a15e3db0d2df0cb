"""Triangles of USD's analytic shapes, in the prim's own axes and units."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ....spatial import Array

AROUND = 48
"""Segments of a full circle."""
CAP = 12
"""Rings from a cap's equator to its pole."""

AXES = {"X": [1, 2, 0], "Y": [2, 0, 1], "Z": [0, 1, 2]}
"""Columns of the rotation that takes Z to the named axis."""


@dataclass(frozen=True, slots=True, eq=False)
class Surface3:
    """vertices: shape (n, 3); normals: unit, shape (n, 3); faces: shape (m, 3), counter-clockwise from outside."""

    vertices: Array
    normals: Array
    faces: np.ndarray


def axis_turn(axis: str) -> Array:
    """Rotation that takes Z to a shape's axis ('X', 'Y' or 'Z'), shape (3, 3)."""
    return np.eye(3)[:, AXES.get(axis, AXES["Z"])]


def box(size: float) -> Surface3:
    """A cube about the origin, each side with vertices of its own."""
    vertices: list[Array] = []
    normals: list[Array] = []
    faces: list[list[int]] = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            u, v = np.zeros(3), np.zeros(3)
            u[(axis + 1) % 3], v[(axis + 2) % 3] = sign, 1.0
            n = np.zeros(3)
            n[axis] = sign
            first = len(vertices)
            vertices += [n - u - v, n + u - v, n + u + v, n - u + v]
            normals += [n] * 4
            faces += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    return Surface3(0.5 * size * np.array(vertices), np.array(normals), np.array(faces))


def plane(width: float, length: float, axis: str) -> Surface3:
    """A rectangle across its axis: width along X, length along Y for Z (USD: for X, width along Z and length along Y)."""
    w, h = 0.5 * width, 0.5 * length
    corners = {
        "X": [[0, -h, -w], [0, h, -w], [0, h, w], [0, -h, w]],
        "Y": [[-w, 0, h], [w, 0, h], [w, 0, -h], [-w, 0, -h]],
    }.get(axis, [[-w, -h, 0], [w, -h, 0], [w, h, 0], [-w, h, 0]])
    normal = np.eye(3)["XYZ".index(axis) if axis in AXES else 2]
    return Surface3(
        np.array(corners, dtype=np.float64), np.tile(normal, (4, 1)), np.array([[0, 1, 2], [0, 2, 3]])
    )


def revolved(profile: list[tuple[float, float, float, float]], axis: str) -> Surface3:
    """A body of revolution.  profile: (radius, height, normal's radial part, normal's height part), upwards; where the
    normal breaks two entries stand at one place."""
    turn = np.arange(AROUND + 1) * (2.0 * math.pi / AROUND)
    turn[-1] = 0.0  # the seam's two columns are one place, bit by bit
    cos, sin = np.cos(turn), np.sin(turn)
    vertices: list[Array] = []
    normals: list[Array] = []
    for radius, height, across, along in profile:
        vertices.append(np.column_stack([radius * cos, radius * sin, np.full_like(cos, height)]))
        normals.append(np.column_stack([across * cos, across * sin, np.full_like(cos, along)]))
    faces: list[np.ndarray] = []
    count = AROUND + 1
    for ring, (low, high) in enumerate(zip(profile, profile[1:])):
        if low[:2] == high[:2]:
            continue
        i = ring * count + np.arange(AROUND)
        if low[0] > 0.0:
            faces.append(np.column_stack([i, i + 1, i + 1 + count]))
        if high[0] > 0.0:
            faces.append(np.column_stack([i, i + 1 + count, i + count]))
    turned = axis_turn(axis)
    return Surface3(
        np.concatenate(vertices) @ turned.T, np.concatenate(normals) @ turned.T, np.concatenate(faces)
    )


def sphere(radius: float) -> Surface3:
    return capsule(radius, radius, 0.0, "Z")


def capsule(bottom: float, top: float, height: float, axis: str) -> Surface3:
    """height: between the centres of the caps.  Caps of unlike radii are joined by the cone through their equators."""
    profile: list[tuple[float, float, float, float]] = []
    for radius, sign in ((bottom, -1.0), (top, 1.0)):
        rings: list[tuple[float, float, float, float]] = []
        for i in range(CAP + 1):
            angle = 0.5 * math.pi * i / CAP
            c = 0.0 if i == CAP else math.cos(angle)
            rings.append(
                (radius * c, sign * (0.5 * height + radius * math.sin(angle)), c, sign * math.sin(angle))
            )
        profile += rings[::-1] if sign < 0.0 else rings
    return revolved(profile, axis)


def cylinder(bottom: float, top: float, height: float, axis: str) -> Surface3:
    """A cylinder, a cone (top radius zero) or a frustum."""
    low, high = -0.5 * height, 0.5 * height
    slope = math.hypot(height, bottom - top) or 1.0
    across, along = height / slope, (bottom - top) / slope
    profile = [
        (0.0, low, 0.0, -1.0),
        (bottom, low, 0.0, -1.0),
        (bottom, low, across, along),
        (top, high, across, along),
    ]
    if top > 0.0:
        profile += [(top, high, 0.0, 1.0), (0.0, high, 0.0, 1.0)]
    return revolved(profile, axis)
