"""Which bodies pass through each other, and which do not in spite of their groups.

Groups of colliders are in a scene's extras.  collisionGroups: for each group those that it ignores.  collisionMasks: for each group
contype and conaffinity; two groups collide where one's type meets the other's affinity, and what is in none has 1 of both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import cast


@dataclass(frozen=True, slots=True)
class Apart:
    """Two nodes whose bodies do not collide with each other, whatever joints there are.

    a, b: indices into ``Scene.nodes``.  reason: the source's rule, as ``contact exclude``.  where: place in the source.
    stated: whether the source says it by itself; else it follows from its joints.
    """

    a: int
    b: int
    reason: str
    where: str = ""
    stated: bool = True


@dataclass(frozen=True, slots=True)
class Colliding:
    """Two nodes whose bodies collide with each other though groups or a joint say otherwise.

    a, b: indices into ``Scene.nodes``.  reason: the source's rule, as ``contact pair``.  where: place in the source.
    """

    a: int
    b: int
    reason: str
    where: str = ""


def ignored_groups(names: Iterable[str], extras: Mapping[str, object]) -> dict[str, set[str]]:
    """Of each of these groups (``""``: what is in none) those of them that it does not collide with."""
    found: dict[str, set[str]] = {name: set() for name in names}
    for name, others in _table(extras.get("collisionGroups")).items():
        if name in found:
            found[name] |= {other for other in others if isinstance(other, str)} & found.keys()
    masks = {
        name: pair
        for name, pair in _table(extras.get("collisionMasks")).items()
        if name in found and len(pair) == 2 and all(isinstance(bits, int) for bits in pair)
    }
    if masks and "" in found:
        masks[""] = [1, 1]
    for name, (kind, affinity) in cast("dict[str, list[int]]", masks).items():
        for other, (its_kind, its_affinity) in cast("dict[str, list[int]]", masks).items():
            if not (kind & its_affinity or its_kind & affinity):
                found[name].add(other)
    return found


def _table(stated: object) -> dict[str, list[object]]:
    if not isinstance(stated, dict):
        return {}
    entries = cast("dict[object, object]", stated).items()
    return {k: cast("list[object]", v) for k, v in entries if isinstance(k, str) and isinstance(v, list)}
