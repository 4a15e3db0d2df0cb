"""A written collider as the model has it: the way back of ``bodies.colliders``."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ... import model
from ...model import Combine
from ...spatial import Array, Pose
from .. import frames
from ..assets.surfaces import COMBINE
from ..scene import BoxCollider, CapsuleCollider, Collider, MeshCollider, PhysicsMaterial, SphereCollider

_COMBINES = {word: combine for combine, word in COMBINE.items()}
_ALONG = {  # what turns Z to the axis of a capsule, columns are where X, Y, Z go
    "X": np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]),
    "Y": np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]),
    "Z": np.eye(3),
}


def shape_of(
    collider: Collider, place: Pose, scale: Array, materials: Sequence[PhysicsMaterial]
) -> model.Collider:
    """place, scale: of its object in the node, and of the object along its own axes.  materials: of the scene."""
    common: dict[str, Any] = {
        "name": collider.id,
        "material": None if collider.material is None else _material(materials[collider.material]),
        "trigger": collider.isTrigger,
        "enabled": collider.enabled,
        "group": collider.group,
    }
    if isinstance(collider, BoxCollider):
        at = place.point(scale * frames.point(collider.center))
        size = tuple((np.abs(scale) * collider.size).tolist())
        return model.Collider(model.ColliderKind.BOX, Pose(place.rotation, at), size=size, **common)
    if isinstance(collider, SphereCollider):
        at = place.point(scale * frames.point(collider.center))
        radius = collider.radius * float(np.abs(scale).max())
        return model.Collider(model.ColliderKind.SPHERE, Pose(place.rotation, at), radius=radius, **common)
    if isinstance(collider, CapsuleCollider):
        at = place.point(scale * frames.point(collider.center))
        axis = "XYZ".index(collider.direction)
        wide = float(np.abs(np.delete(scale, axis)).max())
        radius = collider.radius * wide
        length = max(0.0, collider.height * abs(float(scale[axis])) - 2.0 * radius)
        turned = Pose(place.rotation @ _ALONG[collider.direction], at)
        return model.Collider(model.ColliderKind.CAPSULE, turned, radius=radius, length=length, **common)
    assert isinstance(collider, MeshCollider)
    kind = model.ColliderKind.HULL if collider.convex else model.ColliderKind.MESH
    x, y, z = scale.tolist()
    return model.Collider(kind, place, mesh=collider.mesh, scale=(x, y, z), **common)


def _material(material: PhysicsMaterial) -> model.PhysicsMaterial:
    return model.PhysicsMaterial(
        material.name,
        material.dynamicFriction,
        material.staticFriction,
        material.bounciness,
        _COMBINES.get(material.frictionCombine, Combine.AVERAGE),
        _COMBINES.get(material.bounceCombine, Combine.AVERAGE),
    )
