"""What a part looks like and touches with, as a script passes it."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any, cast

from ..model import Collider, PhysicsMaterial, Surface
from ..options import ColliderShape
from .arguments import shown


def materials_of(name: str, given: Any) -> tuple[Surface | None, PhysicsMaterial | None]:
    """How a part looks and what it touches with."""
    if given is None:
        return None, None
    several = isinstance(given, Iterable) and not isinstance(given, (str, Mapping))
    items = list(cast("Iterable[Any]", given)) if several else [given]
    looks = [item for item in items if isinstance(item, Surface)]
    touch = [item for item in items if isinstance(item, PhysicsMaterial)]
    if len(looks) + len(touch) < len(items) or len(looks) > 1 or len(touch) > 1:
        raise TypeError(
            f"the material of {name} is {shown(given)}; pass a Surface, a PhysicsMaterial, or one of each"
        )
    return looks[0] if looks else None, touch[0] if touch else None


def colliders_of(
    name: str, given: Any, touch: PhysicsMaterial | None
) -> tuple[ColliderShape | None, tuple[Collider, ...] | None]:
    """The shape asked for, and the colliders stated."""
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
    items = list(cast("Iterable[Any]", given)) if isinstance(given, Iterable) else [given]
    colliders = [item for item in items if isinstance(item, Collider)]
    if not items:
        raise ValueError(
            f"the collider of {name} is {shown(given)}; pass 'none' for a part that nothing touches"
        )
    if len(colliders) < len(items):
        raise TypeError(f"the collider of {name} is {shown(given)}; pass a word, a Collider, or several")
    return None, tuple(
        c if c.material is not None or touch is None else replace(c, material=touch) for c in colliders
    )
