"""Meshes of the shapes that robot formats and USD name: box, ellipsoid, sphere, cylinder, capsule, cone, plane.

All stand about the origin of their own frame, metres, round ones along Z, wound outwards, with normals (sharp edges have
a vertex for each side) and one uv set.  The same numbers give the same bytes on every machine.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ..model import Mesh
from ..spatial import Array, IntArray

SIDES = 48
"""Of a round shape's outline; its volume is 0.3 % short of the true one."""
RINGS = 24
"""Of a sphere from pole to pole; even, so that a capsule is two halves of it."""

Outline = tuple[Array, Array, Array]
"""Part of a profile that is turned about Z: (radius, z), shape (n, 2); normals (outwards, upwards), shape (n, 2);
v of the texture, shape (n,).  It goes from the bottom upwards with its outward side to the right."""


def box(size: Sequence[float], name: str = "box") -> Mesh:
    """size: full extents along X Y Z."""
    corners: list[Array] = []
    normals: list[Array] = []
    uvs: list[Array] = []
    square = np.array([[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]])
    for axis in range(3):
        for side in (-1.0, 1.0):
            across = [(axis + 1) % 3, (axis + 2) % 3]
            face = np.zeros((4, 3))
            face[:, axis], face[:, across] = 0.5 * side, square if side > 0.0 else square[:, ::-1]
            corners.append(face * np.asarray(size, dtype=np.float64))
            normals.append(np.tile(side * np.eye(3)[axis], (4, 1)))
            uvs.append(square + 0.5)
    quads = np.arange(6)[:, None, None] * 4 + np.array([[0, 1, 2], [0, 2, 3]])
    return Mesh(name, np.vstack(corners), quads.reshape(-1, 3), np.vstack(normals), (np.vstack(uvs),))


def plane(width: float, length: float, name: str = "plane") -> Mesh:
    """A rectangle across Z, its face upwards.  width: along X.  length: along Y."""
    corners = np.array([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]])
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    normals = np.tile([0.0, 0.0, 1.0], (4, 1))
    return Mesh(name, corners * [width, length, 1.0], faces, normals, (corners[:, :2] + 0.5,))


def sphere(radius: float, name: str = "sphere") -> Mesh:
    return _turned(name, _arc(radius, 0, RINGS, 0.0))


def ellipsoid(radii: Sequence[float], name: str = "ellipsoid") -> Mesh:
    """radii: half extents along X Y Z."""
    ball, scale = sphere(1.0, name), np.asarray(radii, dtype=np.float64)
    assert ball.normals is not None
    normals = ball.normals / scale
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    return Mesh(name, ball.vertices * scale, ball.faces, normals, ball.uvs)


def cylinder(radius: float, length: float, name: str = "cylinder") -> Mesh:
    """length: from end to end."""
    low, high = -0.5 * length, 0.5 * length
    side = np.array([[radius, low], [radius, high]]), np.array([[1.0, 0.0]] * 2), np.array([0.0, 1.0])
    return _turned(name, _disc(radius, low, -1.0), side, _disc(radius, high, 1.0))


def cone(radius: float, length: float, name: str = "cone") -> Mesh:
    """Base below, tip above; the middle of its length is the origin."""
    low, high = -0.5 * length, 0.5 * length
    slope = np.array([length, radius]) / math.hypot(length, radius)
    side = np.array([[radius, low], [0.0, high]]), np.array([slope] * 2), np.array([0.0, 1.0])
    return _turned(name, _disc(radius, low, -1.0), side)


def capsule(radius: float, length: float, name: str = "capsule") -> Mesh:
    """length: between the centres of the two half balls."""
    half = RINGS // 2
    low, high = _arc(radius, 0, half, -0.5 * length), _arc(radius, half, RINGS, 0.5 * length)
    whole = tuple(np.concatenate([a, b]) for a, b in zip(low, high))
    return _turned(name, (whole[0], whole[1], whole[2]))


def _arc(radius: float, first: int, last: int, z: float) -> Outline:
    """Of a ball's ``RINGS`` steps from the south pole those from ``first`` to ``last``, its centre at ``z``."""
    angle = math.pi * (np.arange(first, last + 1) / RINGS - 0.5)
    normals = np.column_stack([np.cos(angle), np.sin(angle)])
    normals[np.abs(normals) < 1e-15] = 0.0  # the poles lie on the axis
    return radius * normals + [0.0, z], normals, np.arange(first, last + 1) / RINGS


def _disc(radius: float, z: float, side: float) -> Outline:
    """A flat end; side: 1 faces upwards, -1 downwards."""
    points = np.array([[0.0, z], [radius, z]])
    normals = np.array([[0.0, side]] * 2)
    return (
        (points, normals, np.array([0.0, 1.0]))
        if side < 0.0
        else (points[::-1], normals, np.array([1.0, 0.0]))
    )


def _turned(name: str, *outlines: Outline) -> Mesh:
    """Outlines turned about Z; where the radius is zero a quad is one triangle."""
    turn = 2.0 * math.pi * np.arange(SIDES + 1) / SIDES
    around = np.column_stack([np.cos(turn), np.sin(turn)])
    around[-1] = around[0]  # the seam has two uvs and one place
    around[np.abs(around) < 1e-15] = 0.0
    vertices: list[Array] = []
    normals: list[Array] = []
    uvs: list[Array] = []
    faces: list[IntArray] = []
    count = 0
    for points, slopes, v in outlines:
        rings = len(points)
        for (radius, z), (outward, upward), height in zip(points, slopes, v):
            vertices.append(np.column_stack([radius * around, np.full(SIDES + 1, z)]))
            normals.append(np.column_stack([outward * around, np.full(SIDES + 1, upward)]))
            uvs.append(np.column_stack([turn / (2.0 * math.pi), np.full(SIDES + 1, height)]))
        k = np.arange(SIDES)
        for ring in range(rings - 1):
            a, c = count + ring * (SIDES + 1) + k, count + (ring + 1) * (SIDES + 1) + k
            if points[ring][0] > 0.0:
                faces.append(np.column_stack([a, a + 1, c + 1]))
            if points[ring + 1][0] > 0.0:
                faces.append(np.column_stack([a, c + 1, c]))
        count += rings * (SIDES + 1)
    return Mesh(name, np.vstack(vertices), np.vstack(faces), np.vstack(normals), (np.vstack(uvs),))
