"""Which colliders do not collide: collision groups and filtered pairs, as the scene's extras say it.

ignoreCollision: pairs of ids.  collisionGroups: for each group those that it ignores.  collisionMasks: for each group contype and
conaffinity; two groups collide where one's type meets the other's affinity, and what is in none has 1 of both.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import cast

from ....diagnostics import Report
from ....model import Scene
from ..prims import Prim


def write_groups(scope: Prim, members: Mapping[str, Sequence[str]], scene: Scene) -> None:
    """members: for each group the paths of its colliders."""
    ignored = _ignored(members, scene)
    prims = {name: scope.child(name, "PhysicsCollisionGroup", name) for name in sorted(members)}
    for name, prim in prims.items():
        prim.tell_source(name)
        prim.relation("collection:colliders:includes", *members[name])
        others = [prims[other].path for other in sorted(ignored[name])]
        if others:
            prim.relation("physics:filteredGroups", *others)


def _ignored(members: Iterable[str], scene: Scene) -> dict[str, set[str]]:
    found: dict[str, set[str]] = {name: set() for name in members}
    for name, others in _table(scene.extras.get("collisionGroups")).items():
        if name in found:
            found[name] |= {other for other in others if isinstance(other, str)} & found.keys()
    masks = {
        name: pair
        for name, pair in _table(scene.extras.get("collisionMasks")).items()
        if name in found and len(pair) == 2 and all(isinstance(bits, int) for bits in pair)
    }
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


def write_pairs(scene: Scene, prims: Sequence[Prim], report: Report, target: str) -> None:
    """prims: of each node.  What names no node is told."""
    stated = scene.extras.get("ignoreCollision")
    of_node = {node.id: i for i, node in enumerate(scene.nodes)}
    others: dict[int, list[int]] = {}
    for pair in cast("list[object]", stated) if isinstance(stated, list) else []:
        ids = [str(id) for id in cast("list[object]", pair)] if isinstance(pair, list) else []
        numbers = [of_node[id] for id in ids if id in of_node]
        if len(ids) != 2 or len(numbers) != 2:
            told = {"field": "what does not collide", "target": target}
            report.dropped(f"filtered pair {' and '.join(ids)}", "TARGET_FIELD_DROPPED", **told)
            continue
        others.setdefault(numbers[0], []).append(numbers[1])
    for number, its in others.items():
        prims[number].apply("PhysicsFilteredPairsAPI")
        prims[number].relation("physics:filteredPairs", *(prims[other].path for other in its))
