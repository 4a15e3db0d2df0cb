"""Colliders of bodies: convex hull, box or the mesh itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Mapping

import numpy as np

from ..model import Mesh
from ..options import ColliderShape
from . import frames
from .numbers import rounded, without_defaults


@dataclass(frozen=True, slots=True, eq=False)
class Colliders:
    """shape: what was asked for.  hull_of: for each mesh of the scene that has one, the index of its hull
    among all meshes of the file.  hulls: those meshes, to stand behind the scene's own."""

    shape: ColliderShape = ColliderShape.HULL
    hull_of: Mapping[int, int] = field(default_factory=dict)
    hulls: tuple[Mesh, ...] = ()


def collider_fields(colliders: Colliders, index: int, mesh: Mesh, dynamic: bool) -> list[dict[str, Any]]:
    """The collider of one body, none or one.  dynamic: the body has a Rigidbody, where Unity takes convex
    meshes only."""
    shape = colliders.shape
    if shape is ColliderShape.NONE:
        return []
    if shape is ColliderShape.MESH and not dynamic:
        return [{"type": "MeshCollider", "mesh": index}]
    if shape is ColliderShape.BOX or index not in colliders.hull_of:
        low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
        box = {
            "type": "BoxCollider",
            "center": frames.point(0.5 * (low + high)),
            "size": np.subtract(high, low),
        }
        return [without_defaults("BoxCollider", rounded(box))]
    return [{"type": "MeshCollider", "mesh": colliders.hull_of[index], "convex": True}]
