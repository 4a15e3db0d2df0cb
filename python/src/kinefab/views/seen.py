"""What of a written scene is seen, as Unity shows it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any


def shown(objects: Sequence[Mapping[str, Any]]) -> list[bool]:
    """Of each GameObject whether its renderer, if it has one, is on, and neither it nor an object above it inactive."""
    active: list[bool] = []
    for item in objects:
        parent: int | None = item.get("parent")
        active.append(bool(item.get("active", True)) and (parent is None or active[parent]))
    return [
        own and _component(item, "MeshRenderer").get("enabled", True) for own, item in zip(active, objects)
    ]


def seen_meshes(objects: Sequence[Mapping[str, Any]]) -> list[tuple[int, int, Sequence[int]]]:
    """Each GameObject whose mesh is seen, with its mesh and the materials of that."""
    return [
        (index, mesh, _component(item, "MeshRenderer").get("materials", ()))
        for index, (item, own) in enumerate(zip(objects, shown(objects)))
        if own and (mesh := _component(item, "MeshFilter").get("mesh")) is not None
    ]


def _component(item: Mapping[str, Any], kind: str) -> Mapping[str, Any]:
    none: Mapping[str, Any] = {}
    return next((c for c in item.get("components", ()) if c["type"] == kind), none)
