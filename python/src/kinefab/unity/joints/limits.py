"""Findings about a joint's pose and ranges that all its forms share, in Unity and in USD."""

from __future__ import annotations

import math
from dataclasses import replace

from ...diagnostics import Report
from ...model import RX, TX, Freedom, Joint, JointKind, Motion
from .coordinates import CanonicalJoint, Coordinates

GAP_LENGTH = 1e-5
"""Metres that the two sides of a joint may be apart before it is reported; CAD files carry 1e-6 or so."""
GAP_ANGLE = 1e-4
"""Radians, likewise."""
HALF_TURN = math.pi
"""Radians to either side of the exported pose that a ConfigurableJoint counts a twist by."""

WRAP_STEPS = 2
"""Physics steps that a joint may need to turn back from beyond its stop."""
STEP = 0.02
"""Seconds, Unity's fixed time step where nobody changed it."""
SLOWEST, FASTEST = 1.0, 7.0
"""rad/s: least speed that a joint is taken to meet its stop with, whatever its source states, and the speed where it
states none, Unity's own default of maxAngularVelocity."""


def feature_of(joint: Joint, what: str, freedom: int) -> str:
    """What the report calls one thing that a joint has, a feature beside the joint itself: ``friction of joint Knee``.

    freedom: TX..RZ, named where the joint has several.
    """
    which = f", {joint.freedom_name(freedom)}" if len(joint.unlocked) > 1 else ""
    return f"{what} of joint {joint.id}{which}"


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


def report_gap(joint: Joint, coordinates: Coordinates, report: Report) -> bool:
    """Whether the exported pose meets the joint; a warning with the misfit where it does not."""
    if coordinates.gap_length <= GAP_LENGTH and coordinates.gap_angle <= GAP_ANGLE:
        return True
    report.approximated(
        f"joint {joint.id}",
        "JOINT_POSE_GAP",
        joint.where,
        joint=joint.id,
        metres=f"{coordinates.gap_length:.3g}",
        degrees=f"{math.degrees(coordinates.gap_angle):.3g}",
    )
    return False


def one_sided(low: float, high: float, furthest: float) -> tuple[float, float]:
    """A range with one end, about the exported pose, with a second one as far as the component can count.

    Where the pose is so far outside that even the first end is further, nothing is left: both are that end.
    """
    if math.isinf(low):
        return min(-furthest, high), min(high, furthest)
    return max(low, -furthest), max(furthest, low)


def may_wrap(joint: Joint, shape: CanonicalJoint, low: float, high: float) -> bool:
    """Whether the twist, which wraps at half a turn without extendedLimits, may get there beyond a stop: PhysX then
    reads it from the other side and turns the bodies on instead of back.  low, high: degrees from the exported pose."""
    stated = joint.freedoms[shape.name_of[RX]].passive
    speed = FASTEST
    if stated is not None and math.isfinite(stated.speed):
        speed = min(max(stated.speed, SLOWEST), FASTEST)
    drive = shape.freedoms[RX].drive
    if drive is not None and (drive.motor or drive.damping > 0.0):
        speed = max(speed, abs(drive.target_velocity))
    return max(-low, high) + WRAP_STEPS * STEP * math.degrees(speed) > 180.0


def turns_as_travel(joint: Joint, shape: CanonicalJoint, coordinates: Coordinates) -> CanonicalJoint:
    """A screw's range of more turns than Unity counts as the range of its slide, which the lead makes the same."""
    turn, slide = shape.freedoms[RX], shape.freedoms[TX]
    if joint.kind is not JointKind.SCREW or joint.lead == 0.0 or turn.motion is not Motion.LIMITED:
        return shape
    travel, along = joint.lead / math.tau, coordinates.values[TX]
    zero = along / travel if turn.at is None else turn.nearest_turn(coordinates.values[RX])
    if -HALF_TURN <= turn.lower - zero and turn.upper - zero <= HALF_TURN:
        return shape
    ends = sorted(along + travel * (end - zero) for end in (turn.lower, turn.upper))
    if slide.motion is Motion.LIMITED:
        ends = [max(ends[0], slide.lower), min(ends[1], slide.upper)]
    if ends[0] > ends[1]:
        return shape
    stiffer = 1.0 / travel**2  # the same force at the thread
    limited = replace(
        slide,
        motion=Motion.LIMITED,
        lower=ends[0],
        upper=ends[1],
        stiffness=slide.stiffness + stiffer * turn.stiffness,
        damping=slide.damping + stiffer * turn.damping,
        restitution=max(slide.restitution, turn.restitution),
    )
    freedoms = list(shape.freedoms)
    freedoms[TX] = limited
    freedoms[RX] = replace(turn, motion=Motion.FREE, lower=-math.inf, upper=math.inf)
    return replace(shape, freedoms=tuple(freedoms))
