from __future__ import annotations

from dataclasses import dataclass

from .collider import Collider


@dataclass(frozen=True, slots=True)
class MeshCollider(Collider):
    """mesh: index into ``UnityScene.meshes``.  convex: moving, not kinematic bodies may have no other; 255 triangles at
    most then."""

    mesh: int = 0
    convex: bool = False
