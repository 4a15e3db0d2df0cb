"""Mates that were found, put into the scene as its constraints; each is reported as found, not stated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from ..diagnostics import Report, named
from ..model import Constraint, Feature, Scene
from .mate import AUTO, Mate, Mates, MateSide


def with_found(scene: Scene, found: Mates, report: Report, threshold: float = AUTO) -> Scene:
    """The scene with the mates of at least this confidence; those below are reported as left out."""
    constraints: list[Constraint] = []
    for mate in found.mates:
        where, parts = _place(scene, mate), " and ".join(scene.nodes[side.node].id for side in mate.sides)
        values = {
            "parts": parts,
            "joint": mate.joint,
            "reason": mate.reason,
            "confidence": f"{mate.confidence:.2f}",
        }
        if mate.confidence < threshold:
            report.dropped(f"mate {mate.number}", "MATE_UNSURE", where, threshold=threshold, **values)
            continue
        report.approximated(f"mate {mate.number}", "MATE_FOUND", where, **values)
        constraints.append(constraint_of(scene, mate))
    return grounded(
        replace(scene, constraints=[*scene.constraints, *constraints]),
        found.ground,
        found.loose,
        report,
        found.ground_reason,
    )


def grounded(scene: Scene, ground: int | None, loose: Sequence[int], report: Report, reason: str) -> Scene:
    """The scene with that node on the ground; nodes that nothing holds are told."""
    if loose:
        names = named(scene.nodes[i].id for i in loose)
        report.add("MATE_NONE", scene.source.uri, count=len(loose), names=names)
    if ground is None or any(node.grounded for node in scene.nodes):
        return scene
    nodes = list(scene.nodes)
    nodes[ground] = replace(nodes[ground], grounded=True)
    feature = f"ground {nodes[ground].id}"
    report.approximated(feature, "GROUND_FOUND", nodes[ground].where, part=nodes[ground].id, reason=reason)
    return replace(scene, nodes=nodes)


def constraint_of(scene: Scene, mate: Mate) -> Constraint:
    return Constraint(
        id=f"Mate:{mate.number}",
        kind=mate.kind,
        features=tuple(_feature(scene, side) for side in mate.sides),
        value=mate.value,
        name=f"Mate:{mate.number}",
        raw_kind=f"found: {mate.reason}",
        where=_place(scene, mate),
    )


def _feature(scene: Scene, side: MateSide) -> Feature:
    """In the node's own frame."""
    inverse = scene.nodes[side.node].pose.inverse()
    return Feature(
        node=side.node,
        kind=side.kind,
        point=inverse.point(side.point),
        direction=None if side.direction is None else inverse.direction(side.direction),
        secondary=None if side.secondary is None else inverse.direction(side.secondary),
        radius=side.radius,
    )


def _place(scene: Scene, mate: Mate) -> str:
    return scene.nodes[mate.sides[0].node].where
