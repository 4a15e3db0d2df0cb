"""How deep two shapes overlap, by Coal (GJK and EPA; meshes triangle by triangle)."""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from ...spatial import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """vertices: shape (n, 3), metres, all shapes in one frame.  faces: shape (m, 3).
    convex: whether all inside counts; else only the surface does.  radius: what the shape is thicker by on all sides."""

    vertices: Array
    faces: IntArray
    convex: bool = True
    radius: float = 0.0


def is_available() -> bool:
    return find_spec("coal") is not None


class Depths:
    """Depths of overlap between shapes that are each prepared once."""

    def __init__(self) -> None:
        self._coal: Any = import_module("coal")  # it states no types
        self._prepared: dict[int, Any] = {}

    def between(self, first: Solid, second: Solid) -> float:
        """Metres that one must move to be free of the other; 0 where they do not touch."""
        coal = self._coal
        request, result = coal.CollisionRequest(), coal.CollisionResult()
        request.num_max_contacts = 1 if first.convex and second.convex else 256
        request.enable_contact = True
        here = coal.Transform3s()
        coal.collide(self._shape(first), here, self._shape(second), here, request, result)
        deepest = 0.0
        for contact in result.getContacts():
            deepest = max(deepest, -float(contact.penetration_depth))
        return deepest

    def _shape(self, solid: Solid) -> Any:
        if id(solid) not in self._prepared:
            coal = self._coal
            model = coal.BVHModelOBBRSS()
            model.beginModel(len(solid.faces), len(solid.vertices))
            model.addSubModel(
                _listed(coal.StdVec_Vec3s(), np.asarray(solid.vertices, dtype=np.float64)),
                _listed(coal.StdVec_Triangle(), [coal.Triangle(*map(int, face)) for face in solid.faces]),
            )
            model.endModel()
            if solid.convex:
                model.buildConvexHull(True, "Qt")
                model = model.convex
            model.computeLocalAABB()
            if solid.radius > 0.0 and solid.convex:
                model.setSweptSphereRadius(solid.radius)
            self._prepared[id(solid)] = model
        return self._prepared[id(solid)]


def _listed(target: Any, values: Any) -> Any:
    for value in values:
        target.append(value)
    return target
