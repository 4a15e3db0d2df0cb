"""Collision groups, and pairs of prims that do not collide."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ....diagnostics import Report
from ....model import Scene, ignored_groups
from ...content import Content
from ...filtering import base_pairs, ignored_pairs, tell_colliding
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
    """prims: of each node.  colliders: paths, of each node.  What names no node is told.

    UsdPhysics filters bodies and colliders: of what stands and is no body, as scenery and most of a base, each collider.
    """
    scene, report = content.scene, content.report
    tell_colliding(scene, report, target)
    pairs, unknown = ignored_pairs(scene)
    for told in unknown:
        report.dropped(
            f"filtered pair {told}", "TARGET_FIELD_DROPPED", field="what does not collide", target=target
        )
    others: dict[int, dict[str, None]] = {}
    for pair in (*pairs, *base_pairs(scene, content.groups)):
        first, second = sorted(pair, key=lambda node: bodies.inside[node] is None)
        still = bodies.inside[second] is None and colliders[second]
        others.setdefault(first, {}).update(dict.fromkeys(still or [str(prims[second].path)]))
    for number, its in others.items():
        prims[number].apply("PhysicsFilteredPairsAPI")
        prims[number].relation("physics:filteredPairs", *its)
