"""Which pairs of nodes a target is to keep from colliding, and which it is not, whatever groups they are in."""

from __future__ import annotations

from typing import cast

from ..diagnostics import Report
from ..model import Scene, ignored_groups


def ignored_pairs(scene: Scene) -> tuple[list[tuple[int, int]], list[str]]:
    """Pairs of nodes, and in words those of which a side is no node.

    They are ``Scene.apart``; a script's own scene may state them by id too, as ``ignoreCollision`` of its extras.
    """
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


def tell_colliding(scene: Scene, report: Report, target: str) -> None:
    """Tell the pairs that collide in the source though their groups do not: the target's groups have no exception."""
    groups = [{collider.group for collider in node.colliders or ()} for node in scene.nodes]
    for pair in scene.colliding:
        ignored = ignored_groups(groups[pair.a] | groups[pair.b], scene.extras)
        if any(ignored[group] & groups[pair.b] for group in groups[pair.a]):
            told = {"field": "what collides in spite of its groups", "target": target}
            report.dropped(pair.reason, "TARGET_FIELD_DROPPED", pair.where, **told)
