"""Which colliders do not collide, as the scene's extras say it.

Pairs of nodes are ``Scene.apart``; a script's own scene may state them by id too.  ignoreCollision: pairs of ids.  collisionGroups: for each group those that it ignores.  collisionMasks: for each group contype and
conaffinity; two groups collide where one's type meets the other's affinity, and what is in none has 1 of both.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import cast

from ..model import Scene


def ignored_groups(names: Iterable[str], scene: Scene) -> dict[str, set[str]]:
    """Of each of these groups those of them that it does not collide with."""
    found: dict[str, set[str]] = {name: set() for name in names}
    for name, others in _table(scene.extras.get("collisionGroups")).items():
        if name in found:
            found[name] |= {other for other in others if isinstance(other, str)} & found.keys()
    masks = {
        name: pair
        for name, pair in _table(scene.extras.get("collisionMasks")).items()
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


def ignored_pairs(scene: Scene) -> tuple[list[tuple[int, int]], list[str]]:
    """Pairs of nodes, and in words those of which a side is no node."""
    stated = scene.extras.get("ignoreCollision")
    of_node = {node.id: i for i, node in enumerate(scene.nodes)}
    found: list[tuple[int, int]] = [(pair.a, pair.b) for pair in scene.apart]
    known = {frozenset(pair) for pair in found}
    unknown: list[str] = []
    for pair in cast("list[object]", stated) if isinstance(stated, list) else []:
        ids = [str(id) for id in cast("list[object]", pair)] if isinstance(pair, list) else []
        numbers = [of_node[id] for id in ids if id in of_node]
        if len(ids) == 2 and len(numbers) == 2:
            if frozenset(numbers) not in known:
                known.add(frozenset(numbers))
                found.append((numbers[0], numbers[1]))
        else:
            unknown.append(" and ".join(ids))
    return found, unknown
