"""Real limits of mechanisms, found by following the curve of their poses."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, analyse
from kinefab.model import Freedom, Motion
from linkages import CRANK, CRANK_2, ROD, ROD_2, five_bar, ring, tip, tip_2
from mechanism_cases import scene, table

SWEEP = AnalysisOptions(limits=True)


def ranges(id):
    found = analyse(scene(id), SWEEP)
    return found, {r.joint: r for r in found.ranges}


def test_non_grashof_crank_stops_at_its_dead_points():
    """M03's crank swings to +-94.09604376 degrees (law of cosines), found to 1e-6 degrees and written."""
    limit = float(next(r["value"] for r in table("closed_forms") if r["quantity"] == "crank limit +- deg"))
    found, by_joint = ranges("M03")
    crank = by_joint["base - crank"]
    assert math.degrees(crank.lower) + 40.0 == pytest.approx(-limit, abs=1e-7)
    assert math.degrees(crank.upper) + 40.0 == pytest.approx(limit, abs=1e-7)
    joint = next(j for j in found.joints if j.id == "base - crank")
    assert joint.freedoms[3].motion is Motion.LIMITED and joint.freedoms[3].upper == crank.upper
    assert "LIMITS_FOUND" in [d.code for d in found.report.diagnostics]


def test_crank_that_turns_all_round_has_no_limits_and_its_rocker_has():
    """M01: the crank turns fully; the rocker's inner angle (from the ground line) swings between 51.31781255
    (coupler over crank) and 125.09963220 degrees (coupler and crank in line)."""
    found, by_joint = ranges("M01")
    folded, extended = (
        float(r["value"])
        for word in ("folded", "extended")
        for r in table("closed_forms")
        if word in r["quantity"]
    )
    start = next(
        float(r["value"])
        for r in table("closed_forms")
        if r["id"] == "M01" and "rocker" in r["quantity"] and r["driver"] == "60"
    )
    assert math.isinf(by_joint["base - crank"].upper)
    rocker = by_joint["base - rocker"]
    assert math.degrees(rocker.lower) + start == pytest.approx(180.0 - extended, abs=1e-7)
    assert math.degrees(rocker.upper) + start == pytest.approx(180.0 - folded, abs=1e-7)
    assert next(j for j in found.joints if j.id == "base - crank").freedoms[3].motion is Motion.FREE


@pytest.mark.parametrize(
    ("id", "slide", "stroke"),
    [
        ("M07", "base - slider", 1.0),
        ("M08", "base - slider", math.sqrt(2.0**2 - 0.2**2) - math.sqrt(1.0**2 - 0.2**2)),
        ("M09", "base - sliderD", 0.5),
    ],
)
def test_slider_stroke_is_that_of_the_closed_form(id, slide, stroke):
    """From the dead point with crank 0.5 and rod 1.5 in line to the one where they lie on each other; the offset of 0.2
    makes the stroke longer than twice the crank.  The lever's slider runs from 0.65 to 1.15."""
    found = ranges(id)[1][slide]
    assert found.upper - found.lower == pytest.approx(stroke, abs=1e-9)


def test_a_limit_of_one_joint_ends_the_range_of_the_others():
    """A rocker limited to +-10 degrees keeps the full-turning crank of M01 within what that allows."""
    source = scene("M01")
    plain = analyse(source)
    limited = Freedom(Motion.LIMITED, -math.radians(10.0), math.radians(10.0))
    joints = [
        replace(j, freedoms=(*j.freedoms[:3], limited, *j.freedoms[4:])) if j.id == "base - rocker" else j
        for j in plain.joints
    ]
    found = analyse(replace(source, joints=joints, constraints=[]), SWEEP)
    crank = next(r for r in found.ranges if r.joint == "base - crank")
    drive = plain.drive(("base - crank", 3))
    for bound in (crank.lower, crank.upper):
        drive.to([bound])
        poses = drive.poses()
        rocker = next(i for i, n in enumerate(source.nodes) if n.name == "rocker")
        turn = poses[rocker].rotation @ source.nodes[rocker].pose.rotation.T
        assert abs(abs(math.atan2(turn[1, 0], turn[0, 0])) - math.radians(10.0)) < 1e-6


def test_limits_are_written_on_the_joints_to_the_ground_alone():
    """Each range is told; one more limit on the joints between the moving bars would stop the same motion twice."""
    found, by_joint = ranges("M03")
    limited = {j.id for j in found.joints if any(f.motion is Motion.LIMITED for f in j.freedoms)}
    inner = {name for name, r in by_joint.items() if "base" not in name and not r.endless}
    assert limited == {"base - crank", "base - rocker"} and inner


def test_a_range_that_the_mechanism_cannot_come_into_stays_as_the_source_has_it():
    """M03's crank stands at its zero and comes to 54 degrees at most; its source says 60 to 90."""
    source = scene("M03")
    stated = math.radians(60.0), math.radians(90.0)
    limited = Freedom(Motion.LIMITED, *stated)
    joints = [
        replace(j, freedoms=(*j.freedoms[:3], limited, *j.freedoms[4:])) if j.id == "base - crank" else j
        for j in analyse(source).joints
    ]
    found = analyse(replace(source, joints=joints, constraints=[]), SWEEP)
    crank = next(j for j in found.joints if j.id == "base - crank").freedoms[3]
    assert (crank.lower, crank.upper) == pytest.approx(stated)


def crank_limit(crank: float, others: float, ground: float = 1.5) -> float:
    """Angle from the ground line at which the rest of a ring of bars is stretched out (law of cosines), radians."""
    return math.acos((crank**2 + ground**2 - others**2) / (2.0 * crank * ground))


@pytest.mark.parametrize(
    ("one", "two", "side"), [(60.0, 110.0, 1.0), (60.0, 110.0, -1.0), (-75.0, 170.0, 1.0)]
)
def test_either_crank_of_a_five_bar_goes_as_far_as_the_other_lets_it(one, two, side):
    """Two freedoms: a crank's end is where both rods and the other crank are in line, however they stand now."""
    found = analyse(five_bar(math.radians(one), math.radians(two), side), SWEEP)
    by_joint = {r.joint: r for r in found.ranges}
    first, second = by_joint["base - crank"], by_joint["base - crank2"]
    limit = crank_limit(CRANK, ROD + ROD_2 + CRANK_2)
    assert first.lower + math.radians(one) == pytest.approx(-limit, abs=1e-9)
    assert first.upper + math.radians(one) == pytest.approx(limit, abs=1e-9)
    limit = crank_limit(CRANK_2, ROD + ROD_2 + CRANK)
    assert second.lower + math.radians(two) == pytest.approx(math.pi - limit, abs=1e-9)
    assert second.upper + math.radians(two) == pytest.approx(math.pi + limit, abs=1e-9)
    written = next(j for j in found.joints if j.id == "base - crank").freedoms[3]
    assert (written.motion, written.lower, written.upper) == (Motion.LIMITED, first.lower, first.upper)


def test_a_pose_from_which_no_velocity_turns_the_crank_is_no_end_of_its_range():
    """Exported with rods and second crank folded onto one line, the first crank is at rest for every velocity: a saddle,
    which small motions of the others leave to either side."""
    ground, reach = 1.2, CRANK_2 + ROD_2 - ROD
    one = crank_limit(CRANK, reach, ground)
    pivot = np.array([ground, 0.0, 0.0])
    back = (tip(one) - pivot) / reach
    source = five_bar(one, math.atan2(back[1], back[0]), ground=ground)
    crank = next(r for r in analyse(source, SWEEP).ranges if r.joint == "base - crank")
    limit = crank_limit(CRANK, ROD + ROD_2 + CRANK_2, ground)
    assert crank.lower + one == pytest.approx(-limit, abs=1e-9)
    assert crank.upper + one == pytest.approx(limit, abs=1e-9)


def test_limits_of_one_driver_bound_the_other():
    """With the second crank held to 100-120 degrees by the CAD, the first ends, both ways, where both rods stretch from
    its tip to that of the second at 120 degrees."""
    one, two = math.radians(60.0), math.radians(110.0)
    source = five_bar(one, two)
    joints = [
        limited(j, -math.radians(10.0), math.radians(10.0)) if j.id == "base - crank2" else j
        for j in analyse(source).joints
    ]
    found = analyse(replace(source, joints=joints, constraints=[]), SWEEP)
    by_joint = {r.joint: r for r in found.ranges}

    def stretched(angle: float, sign: float) -> float:
        x, y, _ = tip_2(angle)
        r = math.hypot(x, y)
        return math.atan2(y, x) + sign * math.acos(
            (CRANK**2 + r * r - (ROD + ROD_2) ** 2) / (2.0 * CRANK * r)
        )

    bounds = np.radians(np.linspace(100.0, 120.0, 201))
    assert max(bounds, key=lambda b: stretched(b, 1.0)) == bounds[-1]
    assert min(bounds, key=lambda b: stretched(b, -1.0)) == bounds[-1]
    crank = by_joint["base - crank"]
    assert crank.upper + one == pytest.approx(stretched(bounds[-1], 1.0), abs=1e-9)
    assert crank.lower + one == pytest.approx(stretched(bounds[-1], -1.0), abs=1e-9)
    own = by_joint["base - crank2"]
    assert (own.lower, own.upper) == pytest.approx((-math.radians(10.0), math.radians(10.0)), abs=1e-9)


def test_a_limit_on_one_side_leaves_the_other_end_to_the_mechanism():
    """M03's crank, stopped by the CAD at 20 degrees upwards, still ends at its dead point downwards."""
    plain = analyse(scene("M03"))
    found = analyse(
        replace(
            scene("M03"),
            joints=[
                limited(j, -math.inf, math.radians(20.0)) if j.id == "base - crank" else j
                for j in plain.joints
            ],
            constraints=[],
        ),
        SWEEP,
    )
    crank = next(r for r in found.ranges if r.joint == "base - crank")
    free = next(r for r in ranges("M03")[0].ranges if r.joint == "base - crank")
    assert crank.upper == pytest.approx(math.radians(20.0), abs=1e-9)
    assert crank.lower == pytest.approx(free.lower, abs=1e-9)


def limited(joint, lower: float, upper: float):
    """The hinge with limits, radians."""
    freedoms = (*joint.freedoms[:3], Freedom(Motion.LIMITED, lower, upper), *joint.freedoms[4:])
    return replace(joint, freedoms=freedoms)


@pytest.mark.parametrize("id", ["M33", "M36"])
def test_joints_that_nothing_stops_have_no_end(id):
    """The short five-bar's cranks turn all round whatever the other does, and so does every hinge of an arm of six."""
    found, by_joint = ranges(id)
    assert len(by_joint) == (4 if id == "M33" else 6)
    assert all(r.endless for r in by_joint.values())
    assert all(f.motion is not Motion.LIMITED for j in found.joints for f in j.freedoms)
    assert not {d.code for d in found.report.diagnostics} & {"LIMITS_FOUND", "LIMITS_NOT_SWEPT"}


def test_own_limits_of_an_arm_are_its_ranges():
    """A hinge in no loop goes as far as its own limits, wherever the others stand."""
    arm = analyse(scene("M36"))
    name = arm.joints[2].id
    joints = [limited(j, -0.5, 1.25) if j.id == name else j for j in arm.joints]
    found = analyse(replace(scene("M36"), joints=joints, constraints=[]), SWEEP)
    assert next((r.lower, r.upper) for r in found.ranges if r.joint == name) == (-0.5, 1.25)


def test_a_search_that_would_take_minutes_is_not_begun():
    """A ring of 40 bars has 37 freedoms; its ranges are left open, and the report says why."""
    angles = np.linspace(0.0, 2.0 * np.pi, 40, endpoint=False)
    pins = [np.array([math.cos(a), math.sin(a), 0.0]) for a in angles]
    found = analyse(ring(pins, [f"bar{i}" for i in range(40)]), SWEEP)
    reported = [d for d in found.report.diagnostics if d.code == "LIMITS_NOT_SWEPT"]
    assert found.ranges == [] and len(reported) == 39 and "37 freedoms" in reported[0].message


@pytest.mark.parametrize("id", ["M05", "M39"])
def test_a_range_that_is_lost_at_a_singular_pose_is_not_written(id):
    """Exported where branches cross, the way on is not unique; what little was seen of it is no range."""
    found, by_joint = ranges(id)
    assert by_joint == {}
    assert all(f.motion is not Motion.LIMITED for j in found.joints for f in j.freedoms)
    assert "LIMITS_NOT_SWEPT" in [d.code for d in found.report.diagnostics]


def test_progress_is_told():
    """The share of the joints searched rises to what closes no loop."""
    told = []
    analyse(scene("M33"), SWEEP, told.append)
    assert told == sorted(told) and len(told) == 4 and 0.0 < told[-1] <= 1.0


def test_a_search_that_would_not_end_stops_and_says_where(monkeypatch):
    """The wobble plate's pistons: nothing is written of what was not searched to its end, and each says how far it came."""
    whole, _ = ranges("M47")
    monkeypatch.setattr("kinefab.analysis.ranges.reach.STEPS_IN_ALL", 150)
    found = analyse(scene("M47"), SWEEP)
    stopped = [d.message for d in found.report.diagnostics if d.code == "LIMITS_NOT_SWEPT"]
    assert len(stopped) + len(found.ranges) == len(whole.ranges) and stopped
    assert all("the search stopped after 150 steps, having come from " in message for message in stopped)
    complete = {r.joint: (r.lower, r.upper) for r in whole.ranges}
    assert all((r.lower, r.upper) == complete[r.joint] for r in found.ranges)


def test_a_curve_too_long_to_be_followed_stops_and_says_where(monkeypatch):
    """A four-bar followed for ten steps: no range is written, and each joint says how far it came."""
    monkeypatch.setattr("kinefab.analysis.ranges.curve.WORK_IN_ALL", 30)
    found = analyse(scene("M01"), SWEEP)
    stopped = [d.message for d in found.report.diagnostics if d.code == "LIMITS_NOT_SWEPT"]
    assert not found.ranges and len(stopped) == 3
    assert all("stopped after 10 steps, having come from " in message for message in stopped)
