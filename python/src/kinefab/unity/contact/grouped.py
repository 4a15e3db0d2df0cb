"""Collision groups as pairs of bodies: Unity has layers, which belong to the project, and a scene none of its own."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations, combinations_with_replacement, product

from ...diagnostics import Report
from ...model import Scene, ignored_groups
from ..apart import with_apart
from ..scene import Collider, Rigidbody, UnityScene
from .overlaps import bodies_of, joined_pairs

MOST_JOINTS = 1000
"""Pairs of bodies that get a joint for their groups."""

Groups = frozenset[str]
"""Those of one body's colliders."""


def with_groups_apart(scene: UnityScene, stated: Scene, report: Report) -> UnityScene:
    """The scene in which bodies do not collide of which no two colliders do by their groups; those of which some do are told.

    stated: what it was mapped from, with its pairs that collide whatever their groups.
    """
    bodies = bodies_of(scene)
    groups, ignored = _groups(scene, bodies, stated.extras)
    if not any(ignored.values()):
        return scene
    whole, partly = _pairs(scene, groups, ignored)
    index = {entry.id: i for i, entry in enumerate(scene.gameObjects)}
    nodes = [bodies[index[node.id]] if node.id in index else None for node in stated.nodes]
    passing = joined_pairs(scene, bodies) | {frozenset((nodes[p.a], nodes[p.b])) for p in stated.colliding}
    whole = [pair for pair in whole if frozenset(pair) not in passing]
    left = {frozenset(pair) for pair in partly} - passing
    left |= {frozenset(pair) for pair in whole if None in pair or len(whole) > MOST_JOINTS}
    _tell(scene, groups, ignored, left, report)
    pairs: dict[tuple[int, int], str] = {}
    for a, b in whole:
        if a is not None and b is not None and frozenset((a, b)) not in left:
            own, other = (a, b) if _moves(scene, a) else (b, a)
            names = sorted({*groups[a], *groups[b]} - {""})
            pairs[own, other] = f"collision group {', '.join(names)}"
    return with_apart(scene, pairs)


def colliding_in_spite_of_groups(scene: UnityScene) -> list[tuple[int, int]]:
    """Pairs of bodies, by their objects, that a written scene lets collide though no two colliders of theirs do by their groups: the
    source states them.  Where groups were too many to be kept it is not known of any."""
    bodies = bodies_of(scene)
    groups, ignored = _groups(scene, bodies, scene.extras)
    if not any(ignored.values()):
        return []
    whole, _ = _pairs(scene, groups, ignored)
    passing = joined_pairs(scene, bodies) | {frozenset((pair.a, pair.b)) for pair in scene.ignoredCollisions}
    if len(whole) > MOST_JOINTS:
        return []
    return [(a, b) for a, b in whole if a is not None and b is not None and frozenset((a, b)) not in passing]


Pairs = list[tuple[int | None, int | None]]


def _groups(
    scene: UnityScene, bodies: list[int | None], extras: Mapping[str, object]
) -> tuple[dict[int | None, set[str]], dict[str, set[str]]]:
    """Of each body the groups of its colliders, and of each group those that it ignores."""
    groups: dict[int | None, set[str]] = {}
    for i, entry in enumerate(scene.gameObjects):
        for component in entry.components:
            if isinstance(component, Collider) and component.enabled and not component.isTrigger:
                groups.setdefault(bodies[i], set()).add(component.group)
    names = {name for own in groups.values() for name in own}
    one_way = ignored_groups(names, extras)
    return groups, {name: one_way[name] | {other for other in names if name in one_way[other]} for name in names}


def _pairs(
    scene: UnityScene, groups: Mapping[int | None, set[str]], ignored: Mapping[str, set[str]]
) -> tuple[Pairs, Pairs]:
    """Pairs of bodies, one of which moves, of which no two colliders collide, and those of which some do not."""
    alike: dict[Groups, list[int | None]] = {}
    for body in sorted(groups, key=lambda i: -1 if i is None else i):
        alike.setdefault(frozenset(groups[body]), []).append(body)
    whole, partly = Pairs(), Pairs()
    for first, second in combinations_with_replacement(alike, 2):
        passing = [b in ignored[a] for a, b in product(first, second)]
        if not any(passing):
            continue
        same = first == second
        for a, b in combinations(alike[first], 2) if same else product(alike[first], alike[second]):
            if _moves(scene, a) or _moves(scene, b):
                (whole if all(passing) else partly).append((a, b))
    return whole, partly


def _tell(
    scene: UnityScene,
    groups: Mapping[int | None, set[str]],
    ignored: Mapping[str, set[str]],
    left: set[frozenset[int | None]],
    report: Report,
) -> None:
    """Of each group whether all bodies of which a collider is in it pass what they ignore.  left: pairs that collide all the same."""
    for name in sorted(group for group, others in ignored.items() if group and others):
        own = [
            sorted(scene.gameObjects[i].id if i is not None else "the ground" for i in pair)
            for pair in left
            if any(name in groups[a] and ignored[name] & groups[b] for a, b in (tuple(pair), tuple(pair)[::-1]))
        ]
        if own:
            a, b = min(own)
            report.approximated(f"collision group {name}", "GROUP_PARTLY_KEPT", group=name, a=a, b=b, count=len(own))
        else:
            report.kept(f"collision group {name}")


def _moves(scene: UnityScene, body: int | None) -> bool:
    return body is not None and any(
        isinstance(c, Rigidbody) and not c.isKinematic for c in scene.gameObjects[body].components
    )
