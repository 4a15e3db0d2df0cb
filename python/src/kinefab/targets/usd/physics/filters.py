"""Collision groups, and pairs of prims that do not collide."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ....model import Scene, ignored_groups
from ....unity.bodies.standing import bases_of
from ...content import Content
from ...filtering import base_pairs, carried_with, ignored_pairs, tell_colliding
from ..bodies import Bodies
from ..prims import Prim


def write_groups(scope: Prim, members: Mapping[str, Sequence[str]], scene: Scene) -> None:
    """members: for each group the paths of its colliders."""
    ignored = ignored_groups(members, scene.extras)
    prims = {name: scope.child(name, "PhysicsCollisionGroup", name) for name in sorted(members)}
    for name, prim in prims.items():
        prim.tell_source(name)
        prim.relation("collection:colliders:includes", *members[name])
        others = [prims[other].path for other in sorted(ignored[name])]
        if others:
            prim.relation("physics:filteredGroups", *others)


def write_pairs(
    content: Content, bodies: Bodies, prims: Sequence[Prim], colliders: Sequence[Sequence[str]], target: str
) -> None:
    """prims: of each node.  colliders: paths, of each node.  What names no node is told, and what names parts of two bodies alone.

    UsdPhysics filters bodies and colliders: of a part of a body, and of what stands and is none, as scenery and most of a base, each
    collider.
    """
    scene, report = content.scene, content.report
    tell_colliding(scene, report, target)
    pairs, unknown = ignored_pairs(scene)
    for told in unknown:
        report.dropped(
            f"filtered pair {told}", "TARGET_FIELD_DROPPED", field="what does not collide", target=target
        )
    bases = bases_of(scene, content.groups)
    below: dict[int, list[str]] = {i: [] for i in range(len(prims))}
    whole: dict[int | None, set[str]] = {}
    for i, own in enumerate(colliders):
        whole.setdefault(bodies.inside[i], set()).update(own)
        for above in carried_with(scene, content.groups, bases, i):
            below[above] += own

    def body(node: int) -> int | None:
        """The body that a node and what is below it are all of."""
        own = bodies.inside[node]
        return own if own == node or (own is not None and whole[own] <= set(below[node])) else None

    others: dict[int, dict[str, None]] = {}
    for pair in sorted(tuple(sorted(pair)) for pair in (*pairs, *base_pairs(scene, content.groups))):
        if not all(below[node] for node in pair):
            continue  # nothing touches there
        first, second = sorted(pair, key=lambda node: (body(node) is None, not bodies.dynamic(node)))
        own, other = body(first), body(second)
        if own is not None:
            others.setdefault(own, {}).update(dict.fromkeys(below[second] if other is None else [str(prims[other].path)]))
        elif any(bodies.inside[node] is not None for node in pair):
            names = " and ".join(scene.nodes[node].id for node in pair)
            report.dropped(f"filtered pair {names}", "TARGET_FIELD_DROPPED", field="what does not collide", target=target)
    for number, its in others.items():
        prims[number].apply("PhysicsFilteredPairsAPI")
        prims[number].relation("physics:filteredPairs", *its)
