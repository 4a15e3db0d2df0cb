"""Hangs a gear on the body that its coupling counts from.

A planetary's sun turns in the housing, yet its gear counts the sun against the carrier, which turns on the
same axis.  A hinge of the sun on the carrier instead leaves the very same motions and has that coordinate.
Where another coupling counts from the hinge as it is (the carrier of a planetary's first stage, which is the
sun of the second), it stays, and a joint that removes nothing is put beside it.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...diagnostics import Report
from ...model import FREE, RX, Constraint, ConstraintKind, JointKind, Scene, freedoms_of
from ...spatial import cross
from ..assembly.assemble import Assembly
from ..equations.coupled import COUPLED
from ..joints.links import Link

ON_AXIS = 1e-6
"""Distance between two axes, and sine between them, up to which they are one."""


def rehung(assembly: Assembly, links: list[Link], scene: Scene, report: Report) -> list[Link]:
    """The links with such hinges moved.  scene: with middle bodies, at the closed pose."""
    links = list(links)
    counted = _counted_from(assembly)
    for statement in assembly.equations.statements:
        if (
            isinstance(statement, Constraint)
            and statement.kind is ConstraintKind.GEAR
            and len(statement.features) > 2
        ):
            carrier = statement.features[2].node
            for feature in statement.features[:2]:
                if feature.node is not None and carrier is not None:
                    _hang(assembly, links, scene, report, statement, feature.node, carrier, counted)
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
) -> None:
    body, onto = assembly.body_of(part), assembly.body_of(carrier)
    if any({link.a, link.b} == {body, onto} for link in links) or body == onto:
        return
    for i, own in enumerate(links):
        if body not in (own.a, own.b) or not _plain_hinge(own):
            continue
        base = own.a if own.b == body else own.b
        for other in links:
            if {other.a, other.b} == {base, onto} and _plain_hinge(other) and _same_axis(own, other, scene):
                moved = _moved(own, part, carrier, body, onto, scene)
                if stays := frozenset((body, base)) in counted:
                    links.append(_removing_nothing(moved, statement.id))
                else:
                    links[i] = moved
                name = "ground" if base == 0 else scene.name(own.joint.a if own.b == body else own.joint.b)
                report.add(
                    "JOINT_FOR_COUPLING" if stays else "JOINT_REHUNG",
                    statement.where,
                    id=statement.id,
                    part=scene.nodes[part].id,
                    carrier=scene.nodes[carrier].id,
                    base=name,
                )
                return


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


def _removing_nothing(link: Link, coupling: str) -> Link:
    """The same place as a joint with all six freedoms, there for the coupling ``coupling`` alone."""
    free = freedoms_of(JointKind.FREE)
    return link.changed(kind=JointKind.FREE, freedoms=free, because=(coupling,)).found(closure=True)
