"""Colliders that Unity would push apart at the start: of different bodies, overlapping, and not kept from colliding."""

from __future__ import annotations

import numpy as np

from ...diagnostics import Report
from ...geometry.contact.depth import Depths, is_available
from ...geometry.contact.nearness import close_pairs
from ...spatial import Array
from ..scene import ArticulationBody, Joint, Rigidbody, UnityScene
from .placed import placed_colliders

CONTACT_OFFSET = 0.01
"""Metres: Unity's default, within which touching shapes are held apart softly."""
SHARE = 0.02
"""Of the smaller shape's size: the depth that counts for shapes that are small against the contact offset."""
MOST_PAIRS = 20_000
"""Pairs of close shapes that are looked at."""
MOST_TRIANGLES = 100_000
"""Of a mesh that is not convex; finer ones take minutes to prepare."""


def check_overlaps(scene: UnityScene, report: Report) -> None:
    """Tell which pairs of objects overlap, each once with its greatest depth, the deepest first."""
    bodies = bodies_of(scene)
    dynamic = {
        i
        for i, entry in enumerate(scene.gameObjects)
        for c in entry.components
        if (isinstance(c, Rigidbody) and not c.isKinematic) or (isinstance(c, ArticulationBody) and not c.immovable)
    }
    if not dynamic:
        return
    joined = joined_pairs(scene, bodies)
    ignored = {frozenset((pair.a, pair.b)) for pair in scene.ignoredCollisions}  # told, where Unity keeps them not

    def are_ignored(first: int, second: int) -> bool:
        within = [_within_body(scene, bodies, owner) for owner in (first, second)] if ignored else [[], []]
        return any(frozenset((a, b)) in ignored for a in within[0] for b in within[1])

    placed = placed_colliders(scene)
    moved = [bodies[owner] for owner in placed.owners]
    free = [
        (first, second, tolerated)
        for first, second, tolerated in _close(placed.low, placed.high)
        if moved[first] != moved[second]
        and dynamic & {moved[first], moved[second]}
        and frozenset((moved[first], moved[second])) not in joined
        and not are_ignored(placed.owners[first], placed.owners[second])
    ]
    if not free:
        return
    if not is_available():
        report.add("OVERLAPS_NOT_CHECKED", detail="the Python package coal is not installed")
        return
    if len(free) > MOST_PAIRS:
        report.add("OVERLAPS_NOT_CHECKED", detail=f"more than {MOST_PAIRS} pairs of shapes are close")
    depths, found = Depths(), dict[tuple[int, int], float]()
    fine: set[int] = set()
    for first, second, tolerated in free[:MOST_PAIRS]:
        finest = max(first, second, key=placed.triangles)
        if placed.triangles(finest) > MOST_TRIANGLES:
            fine.add(placed.owners[finest])
            continue
        depth = depths.between(placed.solid(first), placed.solid(second))
        if depth > tolerated:
            pair = (placed.owners[first], placed.owners[second])
            found[pair] = max(depth, found.get(pair, 0.0))
    for owner in sorted(fine):
        detail = f"{scene.gameObjects[owner].id} has more than {MOST_TRIANGLES} triangles"
        report.add("OVERLAPS_NOT_CHECKED", detail=detail)
    for (a, b), depth in sorted(found.items(), key=lambda entry: (-round(entry[1], 9), entry[0])):
        ids = (scene.gameObjects[a].id, scene.gameObjects[b].id)
        report.add("COLLIDERS_OVERLAP", a=ids[0], b=ids[1], depth=f"{depth:.3g}")


def _within_body(scene: UnityScene, bodies: list[int | None], index: int) -> list[int]:
    """An object and those above it that are part of its body."""
    found = [index]
    while found[-1] != bodies[index] and (above := scene.gameObjects[found[-1]].parent) is not None:
        found.append(above)
    return found


def bodies_of(scene: UnityScene) -> list[int | None]:
    """For each object the one whose Rigidbody or ArticulationBody moves it."""
    found: list[int | None] = []
    for i, entry in enumerate(scene.gameObjects):
        own = any(isinstance(c, (Rigidbody, ArticulationBody)) for c in entry.components)
        found.append(i if own else None if entry.parent is None else found[entry.parent])
    return found


def joined_pairs(scene: UnityScene, moved: list[int | None]) -> set[frozenset[int | None]]:
    """Pairs of bodies that a joint keeps from colliding, and a link and the one above it; Unity does so for no static collider."""
    joined = {
        frozenset((moved[i], moved[c.connectedBody]))
        for i, entry in enumerate(scene.gameObjects)
        for c in entry.components
        if isinstance(c, Joint) and c.enabled and c.connectedBody is not None and not c.enableCollision
    }
    links = {i for i, e in enumerate(scene.gameObjects) if any(isinstance(c, ArticulationBody) for c in e.components)}
    return joined | {frozenset((i, above)) for i in links if (above := _link_above(scene, links, i)) is not None}


def _link_above(scene: UnityScene, links: set[int], index: int) -> int | None:
    """Of a link the one that its joint holds it to; None of a root."""
    at = scene.gameObjects[index].parent
    while at is not None and at not in links:
        at = scene.gameObjects[at].parent
    return at


def _close(low: Array, high: Array) -> list[tuple[int, int, float]]:
    """Pairs whose boxes overlap by more than is tolerated, each with the depth, metres, up to which that is.

    low, high: of the boxes, shape (n, 3).  What stands in a box moves no further to be free of another than the box itself.
    """
    first, second = close_pairs(low, high).T
    size = (high - low).max(axis=1, initial=0.0)
    tolerated = np.minimum(CONTACT_OFFSET, SHARE * np.minimum(size[first], size[second]))
    deep = np.minimum(high[first] - low[second], high[second] - low[first]).min(axis=1) > tolerated
    return list(zip(first[deep].tolist(), second[deep].tolist(), tolerated[deep].tolist()))
