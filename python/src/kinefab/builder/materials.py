"""What a part looks like and touches with, as a script passes it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, cast

import numpy as np

from ..model import Collider, ColliderKind, PhysicsMaterial, Surface
from ..options import ColliderShape
from ..spatial import Array, Pose
from .arguments import LARGEST, checked_color, checked_number, checked_pose, numbers_in, shown

LEAST = 1e-30
"""Metres: smaller is nothing to a 32-bit float."""
OF_MESHES = (ColliderKind.HULL, ColliderKind.PIECES, ColliderKind.MESH)
LENGTHS = {
    ColliderKind.SPHERE: ("radius",),
    ColliderKind.CAPSULE: ("radius",),
    ColliderKind.CYLINDER: ("radius", "length"),
}
"""What must be above zero."""


def materials_of(name: str, given: Any) -> tuple[Surface | None, PhysicsMaterial | None]:
    """How a part looks and what it touches with."""
    if given is None:
        return None, None
    items = _listed(given)
    looks = [item for item in items if isinstance(item, Surface)]
    touch = [item for item in items if isinstance(item, PhysicsMaterial)]
    if len(looks) + len(touch) < len(items) or len(looks) > 1 or len(touch) > 1:
        raise TypeError(
            f"the material of {name} is {shown(given)}; pass a Surface, a PhysicsMaterial, or one of each"
        )
    looks = [_checked_surface(name, surface) for surface in looks]
    for material in touch:
        _check_touch(name, material)
    return looks[0] if looks else None, touch[0] if touch else None


def colliders_of(
    name: str, given: Any, touch: PhysicsMaterial | None, meshes: int
) -> tuple[ColliderShape | None, tuple[Collider, ...] | None]:
    """The shape asked for, and the colliders stated.  meshes: how many the scene has."""
    if given is None:
        return None, None
    if isinstance(given, (str, ColliderShape)):
        try:
            return ColliderShape(given), None
        except ValueError:
            words = ", ".join(member.value for member in ColliderShape)
            raise ValueError(
                f"the collider of {name} is {shown(given)}; pass one of: {words}, or Colliders"
            ) from None
    items = _listed(given)
    colliders = [item for item in items if isinstance(item, Collider)]
    if not items:
        raise ValueError(
            f"the collider of {name} is {shown(given)}; pass 'none' for a part that nothing touches"
        )
    if len(colliders) < len(items):
        raise TypeError(f"the collider of {name} is {shown(given)}; pass a word, a Collider, or several")
    colliders = [_checked_collider(name, collider, meshes) for collider in colliders]
    return None, tuple(
        c if c.material is not None or touch is None else replace(c, material=touch) for c in colliders
    )


def _listed(given: Any) -> list[Any]:
    """One thing, or the members of several."""
    if isinstance(given, Iterable) and not isinstance(given, (str, Mapping, np.ndarray)):
        return list(cast("Iterable[Any]", given))
    return [cast(Any, given)]


def _checked_surface(name: str, surface: Surface) -> Surface:
    """Raises ValueError for a colour or a share outside 0..1, TypeError for what is no number."""
    emission = numbers_in(surface.emission)
    if emission is None or emission.shape != (3,) or not _all_between(emission, 0.0):
        raise ValueError(
            f"the emission of {name} is {shown(surface.emission)}; pass three numbers of 0 or more"
        )
    for what in ("metallic", "smoothness", "alpha_cutoff"):
        _checked_share(f"the {what} of {name}", getattr(surface, what))
    return replace(surface, color=checked_color(name, surface.color))


def _check_touch(name: str, material: PhysicsMaterial) -> None:
    for what in ("dynamic_friction", "static_friction"):
        checked_number(f"the {what} of {name}", getattr(material, what), least=0.0)
    _checked_share(f"the restitution of {name}", material.restitution)


def _checked_collider(name: str, collider: Collider, meshes: int) -> Collider:
    """With arrays in its pose.  Raises TypeError for a field of another type, ValueError for a shape without extent or of a mesh that is not there."""
    kind, of = cast(object, collider.kind), f"of {name}'s collider"
    if not isinstance(kind, ColliderKind):
        words = ", ".join(member.name for member in ColliderKind)
        raise TypeError(f"the kind {of} is {shown(kind)}; pass a ColliderKind: {words}")
    if not isinstance(cast(object, collider.pose), Pose):
        raise TypeError(f"the pose {of} is {shown(collider.pose)}; pass a kinefab.Pose")
    touch = cast(object, collider.material)
    if isinstance(touch, PhysicsMaterial):
        _check_touch(name, touch)
    elif touch is not None:
        raise TypeError(f"the material {of} is {shown(touch)}; pass a PhysicsMaterial")
    if kind is ColliderKind.BOX:
        size = numbers_in(collider.size)
        if size is None or size.shape != (3,) or not _all_between(size, LEAST):
            raise ValueError(f"the size {of} is {shown(collider.size)}; pass three lengths above zero")
    for what in LENGTHS.get(kind, ()):
        if checked_number(f"the {what} {of}", getattr(collider, what)) < LEAST:
            raise ValueError(f"the {what} {of} is {getattr(collider, what)}; pass one above zero")
    if kind is ColliderKind.CAPSULE:
        checked_number(f"the length {of}", collider.length, least=0.0)
    if kind in OF_MESHES and collider.reference is None:
        number = cast(object, collider.mesh)
        if not isinstance(number, int) or not 0 <= number < meshes:
            raise ValueError(
                f"the mesh {of} is {shown(number)}; pass an index into the scene's {meshes} meshes"
            )
    at = collider.pose
    return replace(collider, pose=Pose(*checked_pose(f"{name}'s collider", at.translation, at.rotation)))


def _all_between(values: Array, least: float) -> bool:
    return bool(((values >= least) & (values <= LARGEST)).all())


def _checked_share(what: str, value: object) -> None:
    if checked_number(what, value, least=0.0) > 1.0:
        raise ValueError(f"{what} is {value}; pass a number from 0 to 1")
