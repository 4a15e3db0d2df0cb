"""Bounded distances and angles as limits of the joints that were found."""

from __future__ import annotations

import math
from dataclasses import replace

from ...diagnostics import Report
from ...model import RX, TX, Motion, Scene
from ..assembly.assemble import Assembly
from ..equations.bounded import RangedCoordinate
from ..joints.links import Link

ALONG = 1.0 - 1e-6


def with_ranges(assembly: Assembly, links: list[Link], scene: Scene, report: Report) -> list[Link]:
    """The links with the source's ranges as limits; what is no coordinate of a joint is reported."""
    if not assembly.equations.ranges:
        return links
    links = list(links)
    by_pair = {(min(l.a, l.b), max(l.a, l.b)): i for i, l in reversed(list(enumerate(links)))}
    for coordinate in assembly.equations.ranges:
        constraint = coordinate.constraint
        bodies = (int(assembly.body[coordinate.body_a]), int(assembly.body[coordinate.body_b]))
        index = by_pair.get((min(bodies), max(bodies)))
        place = None if index is None else _freedom(links[index], scene, coordinate, bodies)
        if index is None or place is None:
            report.dropped(
                f"constraint {constraint.id}", "CONSTRAINT_RANGE_DROPPED", constraint.where, id=constraint.id
            )
            continue
        freedom, sign = place
        low = -math.inf if constraint.lower is None else constraint.lower - coordinate.measured
        high = math.inf if constraint.upper is None else constraint.upper - coordinate.measured
        if sign < 0.0:
            low, high = -high, -low
        joint = links[index].joint
        here = links[index].coordinate(freedom, scene)
        low, high = low + here, high + here
        old = joint.freedoms[freedom]
        freedoms = list(joint.freedoms)
        low, high = max(old.lower, low), min(old.upper, high)
        freedoms[freedom] = replace(old, motion=Motion.LIMITED, lower=low, upper=high)
        links[index] = links[index].changed(freedoms=tuple(freedoms), because=(*joint.because, constraint.id))
        report.add("CONSTRAINT_RANGE_KEPT", constraint.where, id=constraint.id, joint=joint.id)
    return links


def _freedom(
    link: Link, scene: Scene, coordinate: RangedCoordinate, bodies: tuple[int, int]
) -> tuple[int, float] | None:
    """The joint's freedom that measures the coordinate, and its sign."""
    axes = (scene.pose(link.joint.a) @ link.joint.frame_a).rotation
    first = RX if coordinate.is_angle else TX
    for i in range(3):
        cosine = float(coordinate.axis @ axes[:, i])
        if abs(cosine) > ALONG and first + i in link.joint.unlocked:
            return first + i, math.copysign(1.0, cosine) * (1.0 if link.b == bodies[1] else -1.0)
    return None
