"""How deep two shapes overlap, by Coal (GJK and EPA; meshes triangle by triangle)."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from ...spatial import Array, IntArray

FLAT = 1e-7
"""Share of the way to its farthest point that a shape must be wide."""
FARTHEST, SMALLEST = 1e9, 1e-9
"""Metres."""


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """vertices: shape (n, 3), metres, all shapes in one frame.  faces: shape (m, 3).
    convex: whether all inside counts; else only the surface does."""

    vertices: Array
    faces: IntArray
    convex: bool = True


def is_available() -> bool:
    return find_spec("coal") is not None


class Depths:
    """Depths of overlap between shapes that are each prepared once."""

    def __init__(self) -> None:
        self._coal: Any = import_module("coal")  # it states no types
        self._prepared: dict[Solid, Any] = {}

    def between(self, first: Solid, second: Solid) -> float:
        """Metres that one must move to be free of the other; 0 where they do not touch, or one has no extent."""
        shapes = [self._shape(solid) for solid in (first, second)]
        if None in shapes:
            return 0.0
        coal = self._coal
        request, result = coal.CollisionRequest(), coal.CollisionResult()
        request.num_max_contacts = 1 if first.convex and second.convex else 256
        request.enable_contact = True
        here = coal.Transform3s()
        coal.collide(shapes[0], here, shapes[1], here, request, result)
        deepest = 0.0
        for contact in result.getContacts():
            deepest = max(deepest, -float(contact.penetration_depth))
        return deepest

    def _shape(self, solid: Solid) -> Any:
        """None of a shape without extent."""
        if solid not in self._prepared:
            extent = _extent(solid)
            self._prepared[solid] = self._made(solid, extent == 3) if extent else None
        return self._prepared[solid]

    def _made(self, solid: Solid, spatial: bool) -> Any:
        """spatial: whether it is wide in three directions; qhull ends the whole process over a flat shape."""
        coal = self._coal
        vertices = np.asarray(solid.vertices, dtype=np.float64)
        if solid.convex and spatial:
            made = coal.Convex.convexHull(_listed(coal.StdVec_Vec3s(), vertices), True, "Qt")
        else:
            made = coal.BVHModelOBBRSS()
            made.beginModel(len(solid.faces), len(vertices))
            triangles = [coal.Triangle(*face) for face in solid.faces.tolist()]
            made.addSubModel(
                _listed(coal.StdVec_Vec3s(), vertices), _listed(coal.StdVec_Triangle(), triangles)
            )
            made.endModel()
        made.computeLocalAABB()
        return made


def _extent(solid: Solid) -> int:
    """In how many directions a shape is wider than rounding: 3 of a solid, 2 of a plate, 0 of what nothing can touch."""
    farthest = float(np.abs(solid.vertices).max(initial=0.0))
    if not farthest < FARTHEST:  # nor NaN
        return 0
    widths = np.linalg.svd(solid.vertices - solid.vertices.mean(axis=0), compute_uv=False)
    return int((widths > FLAT * max(farthest, SMALLEST)).sum())


def _listed(target: Any, values: Any) -> Any:
    for value in values:
        target.append(value)
    return target
