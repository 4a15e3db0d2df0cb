"""Findings about a joint's ranges that hinge and configurable joints share."""

from __future__ import annotations

import math

from ...diagnostics import Report
from ...model import RX, Freedom, Joint


def report_outside(joint: Joint, freedom: int, limits: Freedom, value: float, report: Report) -> None:
    """Warn when the exported pose lies outside the range: Unity would throw the part into it at start-up.

    freedom: index in the source joint.  value: coordinate at the exported pose, metres or radians.
    """
    beyond = max(limits.lower - value, value - limits.upper)
    if beyond <= 1e-6:
        return
    angle = freedom >= RX
    shown = *limits.displayed(value), *limits.displayed_range(limits.lower, limits.upper)
    value, lower, upper = map(math.degrees, shown) if angle else shown
    report.add(
        "JOINT_OUTSIDE_LIMITS",
        limits.where or joint.where,
        joint=joint.id,
        freedom=joint.freedom_name(freedom),
        value=f"{value:g}",
        lower=f"{lower:g}",
        upper=f"{upper:g}",
        unit="degrees" if angle else "m",
    )


def one_sided(low: float, high: float, furthest: float) -> tuple[float, float]:
    """A range with one end, about the exported pose, with a second one as far as the component can count.

    Where the pose is so far outside that even the first end is further, nothing is left: both are that end.
    """
    if math.isinf(low):
        return min(-furthest, high), min(high, furthest)
    return max(low, -furthest), max(furthest, low)
