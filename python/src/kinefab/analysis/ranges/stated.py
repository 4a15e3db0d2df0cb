"""Bounded distances and angles as limits of the joints that were found."""

from __future__ import annotations

import math
from dataclasses import replace

from ...diagnostics import Report
from ...model import Motion, Scene
from ..assembly.assemble import Assembly
from ..joints.links import Link


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
        axis, turns = coordinate.axis, coordinate.is_angle
        place = None if index is None else links[index].freedom_along(axis, turns, bodies[1], scene)
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
        if low > high:
            told = {"id": constraint.id, "joint": joint.id}
            report.dropped(
                f"constraint {constraint.id}", "CONSTRAINT_RANGE_EXCLUDED", constraint.where, **told
            )
            continue
        freedoms[freedom] = replace(old, motion=Motion.LIMITED, lower=low, upper=high)
        links[index] = links[index].changed(freedoms=tuple(freedoms), because=(*joint.because, constraint.id))
        report.add("CONSTRAINT_RANGE_KEPT", constraint.where, id=constraint.id, joint=joint.id)
    return links
