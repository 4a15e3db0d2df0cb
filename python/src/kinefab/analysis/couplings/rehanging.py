"""Hangs a gear on the body that its coupling counts from.

A planetary's sun turns in the housing, yet its gear counts the sun against the carrier, which turns on the
same axis.  A hinge of the sun on the carrier instead leaves the very same motions and has that coordinate.
Where another coupling counts from the hinge as it is (the carrier of a planetary's first stage, which is the
sun of the second), it stays, and a joint that removes nothing is put beside it; so too where several joints lead from
the one to the other (a pulley on an arm, counted from the arm's base).
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...diagnostics import Report
from ...findings import JointFinding
from ...model import (
    FREE,
    RX,
    Constraint,
    ConstraintKind,
    Feature,
    FreeIds,
    Joint,
    JointKind,
    Scene,
    freedoms_of,
)
from ...partition import Partition
from ...spatial import Pose, cross, frame_from_axes
from ..assembly.assemble import Assembly
from ..equations.coupled import COUPLED
from ..joints.links import Link
from .stated import COUNTED, by_pair_of, coordinate_of

ON_AXIS = 1e-6
"""Distance between two axes, and sine between them, up to which they are one."""


def rehung(assembly: Assembly, links: list[Link], scene: Scene, report: Report) -> list[Link]:
    """The links with such hinges moved, and those that couplings count from.  scene: with middle bodies, at the closed pose."""
    links = list(links)
    counted, by_pair = _counted_from(assembly), by_pair_of(links)
    for statement in assembly.equations.statements:
        if not isinstance(statement, Constraint) or statement.kind not in COUPLED:
            continue
        carrier = statement.features[2].node if len(statement.features) > 2 else None
        for feature, turning in zip(statement.features, COUNTED[statement.kind][1:]):
            body = assembly.body_of(feature.node)
            pair = frozenset((body, assembly.body_of(carrier)))
            between = by_pair.get(pair, [])
            if len(pair) == 1 or coordinate_of(between, scene, feature, body, turning):
                continue
            hung = (
                statement.kind is ConstraintKind.GEAR
                and not between
                and feature.node is not None
                and carrier is not None
                and _hang(assembly, links, scene, report, statement, feature.node, carrier, counted)
            )
            over = None if hung else _over_others(assembly, links, scene, feature, carrier)
            if over is not None:
                _stand_beside(links, scene, report, statement, over)
            if hung or over is not None:
                by_pair = by_pair_of(links)
    return links


def _counted_from(assembly: Assembly) -> set[frozenset[int]]:
    """Pairs of bodies whose joint a gear, belt, rack or linear coupling counts from."""
    pairs: set[frozenset[int]] = set()
    for statement in assembly.equations.statements:
        if isinstance(statement, Constraint) and statement.kind in COUPLED:
            bodies = [assembly.body_of(f.node) for f in statement.features]
            carrier = bodies[2] if len(bodies) > 2 else 0
            pairs |= {frozenset((body, carrier)) for body in bodies[:2]}
    return pairs


def _hang(
    assembly: Assembly,
    links: list[Link],
    scene: Scene,
    report: Report,
    statement: Constraint,
    part: int,
    carrier: int,
    counted: set[frozenset[int]],
) -> bool:
    """Whether the part has a hinge on the axis of its carrier, which stands between them now."""
    body, onto = assembly.body_of(part), assembly.body_of(carrier)
    for i, own in enumerate(links):
        if body not in (own.a, own.b) or not _plain_hinge(own):
            continue
        base = own.a if own.b == body else own.b
        for other in links:
            if {other.a, other.b} == {base, onto} and _plain_hinge(other) and _same_axis(own, other, scene):
                moved = _moved(own, part, carrier, body, onto, scene)
                if frozenset((body, base)) in counted:
                    _stand_beside(links, scene, report, statement, moved)
                    return True
                links[i] = moved
                name = "ground" if base == 0 else scene.name(own.joint.a if own.b == body else own.joint.b)
                report.add(
                    "JOINT_REHUNG",
                    statement.where,
                    id=statement.id,
                    part=scene.nodes[part].id,
                    carrier=scene.nodes[carrier].id,
                    base=name,
                )
                return True
    return False


def _plain_hinge(link: Link) -> bool:
    joint = link.joint
    return joint.kind is JointKind.REVOLUTE and joint.freedoms[RX] == FREE and not link.finding.closure


def _same_axis(one: Link, other: Link, scene: Scene) -> bool:
    first, second = (scene.pose(l.joint.a) @ l.joint.frame_a for l in (one, other))
    axis = first.rotation[:, 0]
    offset = second.translation - first.translation
    across = np.linalg.norm(offset - axis * (axis @ offset))
    return bool(across < ON_AXIS and np.linalg.norm(cross(axis, second.rotation[:, 0])) < ON_AXIS)


def _moved(link: Link, part: int, carrier: int, body: int, onto: int, scene: Scene) -> Link:
    world = scene.pose(link.joint.a) @ link.joint.frame_a
    frames = {n: scene.pose(n).inverse() @ world for n in (part, carrier)}
    name = f"{scene.nodes[carrier].id} - {scene.nodes[part].id}"
    joint = replace(link.joint, id=name, a=carrier, b=part, frame_a=frames[carrier], frame_b=frames[part])
    return Link(onto, body, joint, replace(link.finding, joint=name))


def _stand_beside(links: list[Link], scene: Scene, report: Report, statement: Constraint, link: Link) -> None:
    """The link's place as a joint with all six freedoms, there for the coupling alone."""
    free = freedoms_of(JointKind.FREE)
    joint = link.changed(kind=JointKind.FREE, freedoms=free, because=(statement.id,))
    links.append(joint.found(closure=True))
    carrier, part = ("ground" if n is None else scene.nodes[n].id for n in (link.joint.a, link.joint.b))
    report.add("JOINT_FOR_COUPLING", statement.where, id=statement.id, part=part, carrier=carrier)


def _over_others(
    assembly: Assembly, links: list[Link], scene: Scene, feature: Feature, carrier: int | None
) -> Link | None:
    """Between a part and the carrier that it hangs on by way of others, along the feature's direction, where that is the
    only one they let it turn about: then the place has the coordinates that a coupling counts, along and about it."""
    body, onto = assembly.body_of(feature.node), assembly.body_of(carrier)
    if feature.direction is None or not _turns_about(scene, links, feature, body, onto):
        return None
    pose = scene.pose(feature.node)
    world = Pose(frame_from_axes(pose.direction(feature.direction)), pose.point(feature.point))
    ends = [(onto, carrier), (body, feature.node)]
    (first, a), (second, b) = ends if feature.node is not None else ends[::-1]
    assert b is not None  # one of the two is no ground
    base = "ground" if a is None else scene.nodes[a].id
    id = FreeIds(link.joint.id for link in links).take(f"{base} - {scene.nodes[b].id}")
    frame_a, frame_b = (scene.pose(node).inverse() @ world for node in (a, b))
    joint = Joint(id, JointKind.FREE, a, b, frame_a, frame_b, freedoms_of(JointKind.FREE))
    return Link(first, second, joint, JointFinding(id))


def _turns_about(scene: Scene, links: list[Link], feature: Feature, body: int, onto: int) -> bool:
    """Whether joints lead from one body to the other that let them turn about the feature's direction only."""
    assert feature.direction is not None
    direction = scene.pose(feature.node).direction(feature.direction)
    turning = [
        (i, freedom - RX) for i, link in enumerate(links) for freedom in link.joint.unlocked if freedom >= RX
    ]
    frames = {i: scene.pose(links[i].joint.a).rotation @ links[i].joint.frame_a.rotation for i, _ in turning}
    axes = np.array([frames[i][:, axis] for i, axis in turning]).reshape(-1, 3)
    across = np.linalg.norm(cross(axes, direction), axis=1) >= ON_AXIS
    others = {i for (i, _), off in zip(turning, across) if off}
    joined = Partition(1 + max([body, onto, *(max(link.a, link.b) for link in links)]))
    for i, link in enumerate(links):
        if i not in others:
            joined.join(link.a, link.b)
    return joined.find(body) == joined.find(onto)
