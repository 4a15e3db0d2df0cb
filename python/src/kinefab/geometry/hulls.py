"""Convex hulls for collision, small enough for Unity."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from ..diagnostics import Report
from ..model import Mesh, Scene
from ..spatial import Array, IntArray

UNITY_TRIANGLES = 255
"""Most triangles of a convex MeshCollider."""
UNITY_VERTICES = 128
"""So many vertices have at most 252 triangles: a hull of n points has 2 n - 4 (Euler)."""
DIRECTIONS = 24
"""Directions whose extreme vertices a simplified hull starts from."""

Hull = tuple[Array, IntArray]


def collision_hulls(scene: Scene, bodies: Iterable[tuple[int, str]], report: Report) -> dict[int, Mesh]:
    """The hull of each mesh named in ``bodies``: pairs of a mesh and what to call its body in the report.

    Flat meshes have none and are missing from the answer.
    """
    hulls: dict[int, Mesh] = {}
    seen: set[int] = set()
    for index, body in bodies:
        if index in seen:
            continue
        seen.add(index)
        mesh = scene.meshes[index]
        hull = hull_of_points(mesh.vertices)
        if hull is None:
            report.add("HULL_FLAT", body=body)
            continue
        vertices, faces = _simplified(hull, body, report)
        hulls[index] = Mesh(f"{mesh.name} hull", vertices, faces)
    return hulls


def hull_of_points(points: Array) -> Hull | None:
    """Convex hull of points, shape (n, 3): vertices and outward wound faces; None for a flat cloud."""
    from scipy.spatial import ConvexHull, QhullError

    if len(points) < 4 or not _is_solid(points):
        return None
    try:
        hull = ConvexHull(points)
    except QhullError:
        return None
    faces = hull.simplices.astype(np.int64)
    a, b, c = (points[faces[:, i]] for i in range(3))
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    kept, numbers = np.unique(faces, return_inverse=True)
    return points[kept], np.reshape(numbers, faces.shape)


def _is_solid(points: Array) -> bool:
    """Whether the points leave every plane by more than rounding."""
    centred = points - points.mean(axis=0)
    spread = np.linalg.eigvalsh(centred.T @ centred)  # squares of lengths
    return bool(spread[0] > 1e-14 * spread[2])


def _simplified(hull: Hull, body: str, report: Report) -> Hull:
    """The hull itself, or one through as many of its vertices as Unity takes, the farthest out first."""
    vertices, faces = hull
    if len(faces) <= UNITY_TRIANGLES:
        return hull
    chosen: IntArray = np.unique(np.argmax(vertices @ _directions().T, axis=0))
    heights = np.zeros(0)
    while (smaller := hull_of_points(vertices[chosen])) is not None:
        # For each facet the vertex that stands out of it the most.
        a, b, c = (smaller[0][smaller[1][:, i]] for i in range(3))
        normals = np.cross(b - a, c - a)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        heights = vertices @ normals.T - np.einsum("ij,ij->i", a, normals)
        highest = heights.argmax(axis=0)
        order = np.argsort(-heights.max(axis=0), kind="stable")
        taken = set(chosen.tolist())
        fresh = [v for v in dict.fromkeys(highest[order].tolist()) if v not in taken]
        room = min(UNITY_VERTICES - len(chosen), len(chosen))
        if not fresh or room == 0:
            break
        chosen = np.sort(np.append(chosen, fresh[:room]))
    if smaller is None:
        return hull
    deviation = f"{max(0.0, float(heights.max(initial=0.0))):.3g}"
    report.add("HULL_SIMPLIFIED", body=body, before=len(faces), after=len(smaller[1]), deviation=deviation)
    return smaller


@lru_cache(maxsize=1)
def _directions() -> Array:
    """Directions spread evenly over the sphere (Fibonacci lattice), shape (DIRECTIONS, 3)."""
    i = np.arange(DIRECTIONS) + 0.5
    z, turn = 1.0 - 2.0 * i / DIRECTIONS, math.pi * (1.0 + math.sqrt(5.0)) * i
    radius = np.sqrt(1.0 - z * z)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z])
