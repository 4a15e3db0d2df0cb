"""Which colliders do not collide: groups and filtered pairs."""

from __future__ import annotations

from ....diagnostics import Report
from ....model import Apart, Scene
from ..api import UsdPhysics
from ..found import Found
from ..stage import OpenStage
from ..values import Values


def collision_groups(found: Found, opened: OpenStage, report: Report) -> dict[str, str]:
    """The group of each collider's path; of several the first, and the others are told."""
    groups: dict[str, str] = {}
    queries = [
        (
            str(prim.GetPath())[1:],
            UsdPhysics.CollisionGroup(prim).GetCollidersCollectionAPI().ComputeMembershipQuery(),
        )
        for prim in found.collision_groups
    ]
    if not queries:
        return groups
    for part in found.parts:
        for piece in part.pieces:
            if not piece.collides:
                continue
            path = piece.prim.GetPath()
            own = [name for name, query in queries if query.IsPathIncluded(path)]
            if own and groups.setdefault(str(path), own[0]) and len(own) > 1:
                report.approximated(
                    f"collision group of {piece.id}", "USD_FEATURE_APPROXIMATED", opened.place(piece.path),
                    detail=f"it is in {', '.join(own)}; a collider is in one here, and stays in {own[0]}",
                )  # fmt: skip
    return groups


def filters(
    scene: Scene, found: Found, opened: OpenStage, values: Values, report: Report
) -> dict[str, object]:
    """Adds the pairs of bodies to the scene; returns what is left for its extras.

    ignoreCollision: pairs of paths of which one is no body, as a single collider.  collisionGroups: for each group the groups that it ignores.
    """
    extras: dict[str, object] = {}
    pairs: list[list[str]] = []
    for prim in found.filtered:
        for target in values.targets(prim, "physics:filteredPairs"):
            if not opened.stage.GetPrimAtPath(target):
                report.dropped(
                    f"filtered pair of {prim.GetPath()}",
                    "USD_TARGET_MISSING",
                    opened.place(prim),
                    path=str(target),
                )
                continue
            pair = [str(prim.GetPath())[1:], str(target)[1:]]
            if pair[0] != pair[1] and pair not in pairs and pair[::-1] not in pairs:
                pairs.append(pair)
    node_of = {node.id: i for i, node in enumerate(scene.nodes)}
    unknown: list[list[str]] = []
    for first, second in pairs:
        where = opened.place(f"/{first}")
        if first in node_of and second in node_of:
            scene.apart.append(Apart(node_of[first], node_of[second], "filtered pair", where))
        else:
            unknown.append([first, second])
            report.approximated(f"filtered pair {first} and {second}", "USD_COLLISION_FILTER", where)
    if unknown:
        extras["ignoreCollision"] = unknown
    if found.collision_groups:
        table = UsdPhysics.CollisionGroup.ComputeCollisionGroupTable(opened.stage)
        ignored: dict[str, list[str]] = {}
        for prim in found.collision_groups:
            own = prim.GetPath()
            ignored[str(own)[1:]] = [
                str(o)[1:] for o in table.GetGroups() if not table.IsCollisionEnabled(own, o)
            ]
        extras["collisionGroups"] = ignored
    return extras


def offered(opened: OpenStage) -> dict[str, tuple[str, ...]]:
    """What else the stage can give, by option."""
    return {"variant": opened.variants} if opened.variants else {}
