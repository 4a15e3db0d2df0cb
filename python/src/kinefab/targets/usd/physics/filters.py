"""Collision groups, and pairs of prims that do not collide."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ....diagnostics import Report
from ....model import Scene, ignored_groups
from ...filtering import ignored_pairs, tell_colliding
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


def write_pairs(scene: Scene, prims: Sequence[Prim], report: Report, target: str) -> None:
    """prims: of each node.  What names no node is told."""
    tell_colliding(scene, report, target)
    pairs, unknown = ignored_pairs(scene)
    for told in unknown:
        report.dropped(
            f"filtered pair {told}", "TARGET_FIELD_DROPPED", field="what does not collide", target=target
        )
    others: dict[int, list[int]] = {}
    for first, second in pairs:
        others.setdefault(first, []).append(second)
    for number, its in others.items():
        prims[number].apply("PhysicsFilteredPairsAPI")
        prims[number].relation("physics:filteredPairs", *(prims[other].path for other in its))
