"""What the analysis tells a designer: for every joint and every part held still a reason, words and sizes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, analyse
from kinefab.analysis.findings.summary import document
from kinefab.analysis.findings.table import table
from kinefab.diagnostics import Report
from kinefab.model import Constraint, Feature, FeatureKind, JointKind, Motion, Node, Scene
from kinefab.model import ConstraintKind as C
from kinefab.sources import read
from kinefab.spatial import Pose, rotation_exp
from mechanism_cases import ROOT, all_ids, analysed, scene
from scenes import exported
from test_analysis_findings import CASES

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
    assert [c["because"] for c in fixed] == [
        ["insert:2", "angle:3", "insert:4", "angle:5"],
        ["insert:4", "angle:5"],
    ]


def test_a_joint_of_the_source_is_its_own_reason(tmp_path):
    """Hinge and slide of the box rest on no constraint: the table, the JSON and the scene name the joints."""
    lines = table(analyse(read(BOX, Report()))).splitlines()
    assert lines[3].split()[-1] == "Hinge" and lines[4].split()[-1] == "Slide"
    content, _ = exported(read(BOX, Report()), tmp_path)
    assert [c["because"] for c in joints_of(content)] == [["Hinge"], ["Slide"]]


def test_the_table_lists_every_joint_of_every_fixture():
    """Each joint between parts that move has its line with its reason, those of the middle bodies of M17 and M18 too."""
    for name in all_ids():
        found = analysed(name)
        lines = table(found).splitlines()
        middles = {node.id for node in found.nodes}
        assert {line.split()[0] for line in lines if line.startswith("middle:")} == middles
        assert middles or name not in ("M17", "M18")
        own = len(found.source.nodes)
        for joint in found.joints:
            stated = all(node is None or node < own for node in (joint.a, joint.b))
            if not (stated and found.groups.together(joint.a, joint.b)):
                kind = found.findings[joint.id].whole_kind(joint).value.replace("_", " ")
                assert any(kind in line and joint.because[0] in line for line in lines)


def test_couplings_and_idle_freedoms_are_told_in_words():
    """Which coordinate follows which by how much, signs apart from the joints' names; what idles, in source order."""
    assert "gear gear:3: rotation of [base - g2] = -0.4 x rotation of [base - g1]" in table(analysed("M25"))
    assert "rack rack:3: translation of [base - rack] = 0.25 m/rad x rotation of [base - pinion]" in table(
        analysed("M26")
    )
    idle = [line for line in table(analysed("M19")).splitlines() if line.startswith("idle")]
    assert idle == [
        f"idle: rod{i}{s} can move in 1 way that moves nothing else" for i in range(3) for s in "ab"
    ]


def test_an_approximated_relation_says_by_how_much(tmp_path):
    """A point kept on a plane and a direction at an angle about an axis: no joint does both; table, JSON and finding
    say by how much the nearest one misses each."""
    tilted = CASES["RELATION_APPROXIMATED"]()
    found = analyse(tilted)
    (joint,) = found.joints
    metres, radians = found.findings[joint.id].misfit
    assert (metres, radians) == pytest.approx(farthest(joint), rel=0.1) and min(metres, radians) > 0.0
    assert document(found)["joints"][0]["misfit"] == {"metres": metres, "radians": radians}
    size = f"{metres:.2g} m or {math.degrees(radians):.2g}"
    assert f"(approximated, off by up to {size} deg)" in table(found)
    (said,) = (d.message for d in found.report.diagnostics if d.code == "RELATION_APPROXIMATED")
    assert f"misses them by up to {size} degrees as it moves" in said
    content, _ = exported(tilted, tmp_path)
    assert [c["exact"] for c in joints_of(content)] == [False]


def farthest(joint) -> tuple[float, float]:
    """How far the point leaves the plane x = 0 and the direction its angle about z, as the joint turns by up to
    0.7 rad about X and Z and slides by up to 0.4 of the geometry's reach, 0.1 m."""
    off, turned, draw = 0.0, 0.0, np.random.default_rng(2)
    free = [f.motion is not Motion.LOCKED for f in joint.freedoms]
    assert free == [True, True, False, True, False, True]
    for _ in range(2000):
        (x, y), (rx, rz) = draw.uniform(-0.04, 0.04, 2), draw.uniform(-0.7, 0.7, 2)
        turn = rotation_exp(rz * np.eye(3)[2]) @ rotation_exp(rx * np.eye(3)[0])
        b_in_a = joint.frame_a @ Pose(turn, np.array([x, y, 0.0])) @ joint.frame_b.inverse()
        part = b_in_a if joint.b == 1 else b_in_a.inverse()
        u = part.direction(np.array([0.8, 0.6, 0.0]))
        off = max(off, abs(part.point(np.array([0.0, 0.2, 0.0]))[0]))
        turned = max(turned, abs(math.atan2(u[1], u[0]) - math.atan2(0.6, 0.8)))
    return off, turned


def test_a_joint_whose_second_body_is_the_ground_is_told_too(tmp_path):
    """A pin of the ground in a part's slot: which body carries the slot matters, so the ground is the joint's b."""
    slot = Feature(0, FeatureKind.LINE, np.zeros(3), np.array([1.0, 0.0, 0.0]))
    pin = Feature(None, FeatureKind.LINE, np.zeros(3), np.array([0.0, 0.0, 1.0]))
    source = Scene(nodes=[Node("arm", "arm")], constraints=[Constraint("pin", C.PIN_SLOT, (slot, pin))])
    found = analyse(source)
    (joint,) = found.joints
    assert (joint.a, joint.b, joint.kind) == (0, None, JointKind.PIN_SLOT)
    assert (document(found)["joints"][0]["a"], document(found)["joints"][0]["b"]) == ("arm", "ground")
    assert table(found).splitlines()[2].split()[-4:] == ["pin", "slot", "ground", "pin"]
    content, _ = exported(source, tmp_path)
    assert [c["type"] for c in joints_of(content)] == ["ConfigurableJoint"]


def test_a_range_is_called_as_its_joint_is_in_the_table():
    """By the user's name, which drives it too; where two joints share one the id says which."""
    lever = read(ROOT / "fixtures" / "lever" / "lever.bundle.json", Report())
    assert told_ranges(lever) == ["Shaft", "Slide", "Eccentric pin"]
    lever.joints = [replace(j, name="Shaft") if j.id == "Joint:Slide" else j for j in lever.joints]
    assert told_ranges(lever) == ["Shaft (Joint:Shaft)", "Shaft (Joint:Slide)", "Eccentric pin"]


def told_ranges(source: Scene) -> list[str]:
    """What the table calls the joints that it tells a range of."""
    lines = table(analyse(source, AnalysisOptions(limits=True))).splitlines()
    return [line.removeprefix("range of ").rpartition(": ")[0] for line in lines if line.startswith("range of ")]
