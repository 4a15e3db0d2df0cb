"""Parents before their children, as the scene file has them; every index of an object follows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, is_dataclass, replace
from typing import Any, cast

from ..scene import GameObject, UnityScene

INDICES = frozenset({"gameObject", "connectedBody", "parent"})
"""Fields that hold the index of an object."""


def with_parents_first(scene: UnityScene) -> UnityScene:
    """The same scene; objects keep their order as far as each can stand behind its parent."""
    order = _order(scene.gameObjects)
    if order == list(range(len(order))):
        return scene
    place = {old: new for new, old in enumerate(order)}
    moved = tuple(_moved(scene.gameObjects[old], place) for old in order)
    ignored = tuple(replace(pair, a=place[pair.a], b=place[pair.b]) for pair in scene.ignoredCollisions)
    return replace(
        scene,
        gameObjects=moved,
        ignoredCollisions=ignored,
        couplings=_moved(scene.couplings, place),
        animations=_moved(scene.animations, place),
        constraints=_moved(scene.constraints, place),
        analysis=_moved(scene.analysis, place),
    )


def _order(objects: Sequence[GameObject]) -> list[int]:
    """Old indices in their new order."""
    order: list[int] = []
    found: set[int] = set()
    for index in range(len(objects)):
        above: list[int] = []
        at: int | None = index
        while at is not None and at not in found:
            found.add(at)
            above.append(at)
            at = objects[at].parent
        order += reversed(above)
    return order


def _moved(value: Any, place: dict[int, int]) -> Any:
    """The value with every index of an object replaced."""
    if isinstance(value, tuple):
        return tuple(_moved(item, place) for item in cast(tuple[Any, ...], value))
    if not is_dataclass(value) or isinstance(value, type):
        return value
    changed: dict[str, Any] = {}
    for each in fields(value):
        own = getattr(value, each.name)
        if each.name in INDICES and isinstance(own, int):
            changed[each.name] = place[own]
        elif each.name == "gameObjects":
            changed[each.name] = tuple(place[index] for index in own)
        elif (new := _moved(own, place)) is not own and new != own:
            changed[each.name] = new
    return replace(value, **changed) if changed else value
