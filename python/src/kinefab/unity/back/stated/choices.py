"""Whether written colliders are those that the export chose for a body, so that a target may choose its own kind of them."""

from __future__ import annotations

from collections.abc import Sequence
from collections.abc import Set as AbstractSet
from dataclasses import fields

import numpy as np

from ....geometry.recognition import recognised
from ....model import Mesh
from ....options import ColliderShape
from ....spatial import Pose
from ...bodies.colliders import PlacedCollider, box_about, without_mesh
from ...scene import Collider, MeshCollider
from ...scene.colliders.collider import CHOSEN

CLOSE = 1e-5
"""Of a mesh's largest extent: its numbers have 32 bits in the file."""
WORDS = {shape.value: shape for shape in ColliderShape}


def choice_of(colliders: Sequence[Collider]) -> ColliderShape | None:
    """The one choice that all of them say they were made by; None where one does not, or there is none."""
    words = {str(collider.extras.get(CHOSEN, "")) for collider in colliders}
    return WORDS.get(words.pop()) if len(words) == 1 else None


def still_chosen(
    shape: ColliderShape, number: int, mesh: Mesh, colliders: Sequence[tuple[Collider, Pose]], drawn: AbstractSet[int]
) -> bool:
    """Whether a body's colliders are still what the choice makes of its mesh, as far as that is seen without making convex ones.

    number: of the mesh.  colliders: each with its object's place on the mesh's.  drawn: numbers of the meshes that are drawn.
    """
    if not colliders or any(_states_more(collider) for collider, _ in colliders):
        return False
    if all(isinstance(collider, MeshCollider) for collider, _ in colliders):
        return all(_is_of(collider, number, drawn) for collider, _ in colliders)
    (collider, place), *more = colliders
    own = recognised(mesh) if shape is ColliderShape.AUTO else None
    candidates = [PlacedCollider(box_about(mesh)), None if own is None else without_mesh(own, {})]
    extent = float(np.ptp(mesh.vertices, axis=0).max())
    return not more and any(_is_at(made, collider, place, extent) for made in candidates if made is not None)


def _states_more(collider: Collider) -> bool:
    plain = Collider()
    return any(getattr(collider, own.name) != getattr(plain, own.name) for own in fields(plain) if own.name != "extras")


def _is_of(collider: Collider, number: int, drawn: AbstractSet[int]) -> bool:
    assert isinstance(collider, MeshCollider)
    return collider.mesh not in drawn if collider.convex else collider.mesh == number


def _is_at(made: PlacedCollider, collider: Collider, place: Pose, extent: float) -> bool:
    component, pose = made.component, made.pose or Pose()
    if type(component) is not type(collider):
        return False
    if not np.allclose(pose.translation, place.translation, rtol=0.0, atol=CLOSE * extent):
        return False
    if not np.allclose(pose.rotation, place.rotation, rtol=0.0, atol=CLOSE):
        return False
    pairs = ((getattr(component, own.name), getattr(collider, own.name)) for own in fields(component) if own.name != "extras")
    return all(
        one == other if isinstance(one, (str, bool)) or one is None else np.allclose(one, other, rtol=0.0, atol=CLOSE * extent)
        for one, other in pairs
    )
