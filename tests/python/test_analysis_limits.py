"""Real limits of mechanisms, found by following the curve of their poses."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from mechanism_cases import scene, table

from kinefab.analysis import AnalysisOptions, analyse
from kinefab.model import Freedom, Motion

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


def test_mechanism_with_two_freedoms_is_not_swept():
    """The five-bar has two freedoms; its joints' ranges depend on each other and are left open."""
    found, by_joint = ranges("M33")
    assert by_joint == {}
    assert "LIMITS_NOT_SWEPT" in [d.code for d in found.report.diagnostics]
