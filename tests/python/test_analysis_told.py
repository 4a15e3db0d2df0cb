"""What the analysis tells a designer: for every joint and every part held still a reason, words and sizes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from mechanism_cases import ROOT, all_ids, analysed, scene
from scenes import exported
from test_analysis_findings import CASES

from kinefab.analysis import analyse
from kinefab.analysis.summary import document
from kinefab.analysis.table import table
from kinefab.diagnostics import Report
from kinefab.model import RX, Motion
from kinefab.sources import read
from kinefab.spatial import rotation_exp

BOX = ROOT / "fixtures" / "hinge_slider_zup" / "hinge_slider.bundle.json"


def joints_of(content):
    return [c for o in content["gameObjects"] for c in o.get("components", ()) if c["type"].endswith("Joint")]


def test_every_joint_of_every_fixture_says_why():
    """In the JSON each joint names what the source states, and each part held still names what holds it."""
    for name in all_ids():
        found = document(analysed(name))
        stated = {c.id for c in scene(name).constraints}
        assert all(j["because"] and set(j["because"]) <= stated for j in found["joints"])
        for held in (f for part in found["parts"] for f in part["fixed"]):
            assert held["because"] and set(held["because"]) <= stated
        held_still = [p for p in found["parts"] if p["group"] not in (p["id"], "ground")]
        assert all(p["fixed"] for p in held_still)


def test_a_part_held_still_is_told_with_what_holds_it(tmp_path):
    """The truss and the platform on six rods have no joints, and a reason; so have the FixedJoints of a group."""
    assert [line.split() for line in table(analysed("M34")).splitlines()[3:5]] == [
        ["b1", "ground", "none", "fixed", "base", "insert:1"],
        ["b2", "ground", "none", "fixed", "base,", "b1", "insert:3,", "insert:2"],
    ]
    assert "fixed  base  distance:1, distance:2 and 4 more" in table(analysed("M16"))
    content, _ = exported(scene("M09"), tmp_path)
    fixed = [c for c in joints_of(content) if c["type"] == "FixedJoint"]
    assert [c["because"] for c in fixed] == [["insert:2", "angle:3", "insert:4", "angle:5"], ["insert:4", "angle:5"]]


def test_a_joint_of_the_source_is_its_own_reason(tmp_path):
    """Hinge and slide of the box rest on no constraint: the table, the JSON and the scene name the joints."""
    lines = table(analyse(read(BOX, Report()))).splitlines()
    assert lines[3].split()[-1] == "Hinge" and lines[4].split()[-1] == "Slide"
    content, _ = exported(read(BOX, Report()), tmp_path)
    assert [c["because"] for c in joints_of(content)] == [["Hinge"], ["Slide"]]


def test_couplings_and_idle_freedoms_are_told_in_words():
    """Which coordinate follows which by how much, signs apart from the joints' names; what idles, in source order."""
    assert "gear gear:3: rotation of [base - g2] = -0.4 x rotation of [base - g1]" in table(analysed("M25"))
    assert "rack rack:3: translation of [base - rack] = 0.25 m/rad x rotation of [base - pinion]" in table(analysed("M26"))
    idle = [line for line in table(analysed("M19")).splitlines() if line.startswith("idle")]
    assert idle == [f"idle: rod{i}{s} can move in 1 way that moves nothing else" for i in range(3) for s in "ab"]


def test_an_approximated_relation_says_by_how_much(tmp_path):
    """The rim of a tilted disc on a plane: the nearest joint lets it sink; table, JSON and finding say how deep."""
    rim = CASES["RELATION_APPROXIMATED"]()
    found = analyse(rim)
    (joint,) = found.joints
    metres, radians = joint.misfit
    assert metres == pytest.approx(deepest(joint), rel=0.3) and radians == 0.0
    assert document(found)["joints"][0]["misfit"] == {"metres": metres, "radians": radians}
    assert f"(approximated, off by up to {metres:.2g} m or 0 deg)" in table(found)
    (said,) = (d.message for d in found.report.diagnostics if d.code == "RELATION_APPROXIMATED")
    assert f"misses them by up to {metres:.2g} m or 0 degrees as it moves" in said
    content, _ = exported(rim, tmp_path)
    assert [c["exact"] for c in joints_of(content)] == [False]


def deepest(joint) -> float:
    """How far the rim's lowest point leaves the plane as the part turns about the joint's point by up to 0.7 rad."""
    worst, draw = 0.0, np.random.default_rng(2)
    radius, across, middle = 0.1, np.array([0.8, 0.0, 0.6]), np.array([0.0, 0.0, 0.08])
    free = [f.motion is not Motion.LOCKED for f in joint.freedoms]
    assert free[RX:] == [True] * 3 and free[:3] == [True, True, False]
    for _ in range(2000):
        turn = rotation_exp(draw.uniform(-0.7, 0.7, 3))
        n, c = turn @ across, turn @ (middle - joint.frame_b.translation) + joint.frame_b.translation
        worst = max(worst, abs(c[2] - radius * math.sqrt(1.0 - n[2] ** 2)))
    return worst
