"""Gear-like constraints as couplings between the coordinates of the joints that were found."""

from __future__ import annotations

from ...diagnostics import Report
from ...model import Constraint, ConstraintKind, Coupling, CouplingKind, Feature, Scene, Term
from ..assembly.assemble import Assembly
from ..joints.links import Link

COUNTED = {
    ConstraintKind.GEAR: (CouplingKind.GEAR, True, True),
    ConstraintKind.BELT: (CouplingKind.BELT, True, True),
    ConstraintKind.RACK: (CouplingKind.RACK, True, False),
    ConstraintKind.LINEAR: (CouplingKind.LINEAR, False, False),
}
"""What becomes of a constraint, and whether what it counts of its first and second feature is a turn."""


def couplings_of(assembly: Assembly, links: list[Link], scene: Scene, report: Report) -> list[Coupling]:
    """Explicit couplings as they are, and one for each gear, belt, rack and linear constraint.

    scene: with middle bodies, at the closed pose, where every found joint's coordinates are zero.
    """
    by_pair = by_pair_of(links)
    found = list(scene.couplings)
    for statement in assembly.equations.statements:
        if not isinstance(statement, Constraint) or statement.kind not in COUNTED:
            continue
        kind, *turns = COUNTED[statement.kind]
        carrier = assembly.body_of(statement.features[2].node) if len(statement.features) > 2 else 0
        ends: list[tuple[Link, int, float]] = []
        for feature, turning in zip(statement.features, turns):
            body = assembly.body_of(feature.node)
            end = coordinate_of(by_pair.get(frozenset((body, carrier)), []), scene, feature, body, turning)
            if end is None:
                part = "ground" if feature.node is None else scene.nodes[feature.node].id
                report.dropped(
                    f"constraint {statement.id}",
                    "COUPLING_UNPLACED",
                    statement.where,
                    id=statement.id,
                    part=part,
                )
                break
            ends.append(end)
        else:
            (link_a, freedom_a, sign_a), (link_b, freedom_b, sign_b) = ends
            ratio = statement.value * sign_a * sign_b
            found.append(
                Coupling(
                    statement.id,
                    kind,
                    link_b.joint.id,
                    freedom_b,
                    (Term(link_a.joint.id, freedom_a, ratio),),
                    link_b.coordinate(freedom_b, scene) - ratio * link_a.coordinate(freedom_a, scene),
                    statement.where,
                )
            )
    first = len(scene.couplings)
    return found[:first] + sorted(found[first:], key=lambda c: assembly.equations.places[c.id])


def by_pair_of(links: list[Link]) -> dict[frozenset[int], list[Link]]:
    """The links between each two bodies."""
    by_pair: dict[frozenset[int], list[Link]] = {}
    for link in links:
        by_pair.setdefault(frozenset((link.a, link.b)), []).append(link)
    return by_pair


def coordinate_of(
    links: list[Link], scene: Scene, feature: Feature, body: int, turning: bool
) -> tuple[Link, int, float] | None:
    """(link, freedom, sign) of the joint coordinate along or about a feature's direction, or None.

    links: those between ``body``, the feature's, and its carrier.  turning: about it, not along it.
    """
    if feature.direction is None:
        return None
    direction = scene.pose(feature.node).direction(feature.direction)
    for link in links:
        if (found := link.freedom_along(direction, turning, body, scene)) is not None:
            return link, *found
    return None
