"""Ranges count from a joint's own zero, wherever the exported pose stands on it; the file counts from that pose."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, analyse
from kinefab.analysis.findings.summary import document
from kinefab.analysis.findings.table import table
from kinefab.model import RX, Freedom, Motion
from scenes import components, exported
from source_bundles import FIXTURES, bundle, frame, part, read
from test_sources_left_handed import by_the_other_hand, limited

SWEEP = AnalysisOptions(limits=True)
CRANK, ROD, ROCKER, GROUND = 0.5, 1.2, 0.9, 1.5
AT = 80.0
"""Where the crank stands, degrees from the line of the pivots."""


def rocker_angle(crank: float) -> float:
    """From the line of the pivots, degrees, the rocker's tip above the way from the crank's tip to its pivot."""
    tip = CRANK * np.array([math.cos(math.radians(crank)), math.sin(math.radians(crank))])
    x, y = tip - (GROUND, 0.0)
    d = math.hypot(x, y)
    return math.degrees(math.atan2(y, x) - math.acos((d * d + ROCKER**2 - ROD**2) / (2.0 * d * ROCKER)))


def inner_angle(reach: float) -> float:
    """At the rocker's pivot, degrees, with its tip so far from the crank's pivot."""
    return math.degrees(math.acos((GROUND**2 + ROCKER**2 - reach**2) / (2.0 * GROUND * ROCKER)))


def four_bar(crank: dict, rocker: dict) -> dict:
    """A crank and rocker whose pivots display what the CAD says, degrees."""
    a = CRANK * np.array([math.cos(math.radians(AT)), math.sin(math.radians(AT)), 0.0])
    turn = math.radians(rocker_angle(AT))
    b = np.array([GROUND, 0.0, 0.0]) + ROCKER * np.array([math.cos(turn), math.sin(turn), 0.0])

    def hinge(name: str, a: str, b: str, o, dof: list[dict]) -> dict:
        return {
            "id": name,
            "type": "revolute",
            "a": a,
            "b": b,
            "frameA": frame(o, (0, 0, 1), (1, 0, 0)),
            "dof": dof,
        }

    joints = [
        hinge("crank", "base", "Crank", (0.0, 0.0, 0.0), [crank]),
        hinge("tip", "Crank", "Rod", a.tolist(), []),
        hinge("rocker", "base", "Rocker", (GROUND, 0.0, 0.0), [rocker]),
        hinge("end", "Rocker", "Rod", b.tolist(), []),
    ]
    parts = [
        part("base", grounded=True),
        *(part(name, (0.1 * i, 0.2, 0.0)) for i, name in enumerate(("Crank", "Rod", "Rocker"))),
    ]
    return bundle(*parts, angle="deg", joints=joints)


def shown(value: float) -> dict:
    return {"name": "rz", "value": value}


def handed(values: dict, hand: str) -> dict:
    return values if hand == "right" else by_the_other_hand(values)


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("value", [100.0, -130.0, 170.0, 0.0])
def test_a_rocker_is_limited_from_the_exported_pose_whatever_it_displays(tmp_path, hand, value):
    """Its dead points are where crank and rod lie in line; the hinge's limits are how far they are from here."""
    scene, _ = read(handed(four_bar(shown(20.0), shown(value)), hand), tmp_path)
    found = next(r for r in analyse(scene, SWEEP).ranges if r.joint == "rocker")
    low, high = (180.0 - inner_angle(reach) - rocker_angle(AT) for reach in (ROD + CRANK, ROD - CRANK))
    low, high = ((end + 180.0) % 360.0 - 180.0 for end in (low, high))
    assert low < 0.0 < high and abs(low + high) > 5.0
    assert math.degrees(found.lower) == pytest.approx(value + low, abs=1e-7)
    assert math.degrees(found.upper) == pytest.approx(value + high, abs=1e-7)
    (hinge,) = components(exported(scene, tmp_path, limits=True)[0], "Rocker", "HingeJoint")
    assert hinge["useLimits"] is True
    assert (hinge["limits"]["min"], hinge["limits"]["max"]) == pytest.approx((low, high), abs=1e-5)


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("value", [100.0, 190.0, -550.0])
def test_ranges_are_told_around_what_the_cad_displays(tmp_path, hand, value):
    """A rocker that shows 190 degrees swings about 190, not about -170: in the table, the JSON and the findings."""
    scene, _ = read(handed(four_bar(shown(20.0), shown(value)), hand), tmp_path)
    found = analyse(scene, SWEEP)
    low, high = (180.0 - inner_angle(reach) - rocker_angle(AT) for reach in (ROD + CRANK, ROD - CRANK))
    low, high = (value + (end + 180.0) % 360.0 - 180.0 for end in (low, high))
    if hand == "left":  # whose file says the same turn with the other sign
        low, high = -high, -low
    listed = next(r for r in document(found)["ranges"] if r["joint"] == "rocker")
    assert np.degrees((listed["lower"], listed["upper"])) == pytest.approx((low, high), abs=1e-7)
    assert f"range of rocker: {low:.6g} to {high:.6g} deg" in table(found)
    (said,) = (
        d.message for d in found.report.diagnostics if d.code == "LIMITS_FOUND" and "rocker" in d.message
    )
    assert f"from {low:.6f} to {high:.6f} degrees" in said


@pytest.mark.parametrize("hand", ["right", "left"])
def test_a_pose_outside_its_limits_is_told_in_what_the_cad_displays(tmp_path, hand):
    """Limits of 350 to 440 degrees and 340 displayed are told so, whichever turn the frames read."""
    scene, _ = read(handed(four_bar(limited("rz", 340.0, 350.0, 440.0), shown(35.0)), hand), tmp_path)
    _, result = exported(scene, tmp_path)
    (said,) = (d.message for d in result.report.diagnostics if d.code == "JOINT_OUTSIDE_LIMITS")
    assert "340" in said and "350" in said and "440" in said


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize(("value", "turns"), [(20.0, 0.0), (20.0, 360.0), (20.0, -720.0)])
def test_a_crank_limited_by_the_cad_ends_the_rocker_where_it_ends_itself(tmp_path, hand, value, turns):
    """-10 to 80 degrees with 20 displayed are 30 back and 60 on; so they are counted whole turns further."""
    crank = limited("rz", value + turns, -10.0 + turns, 80.0 + turns)
    scene, _ = read(handed(four_bar(crank, shown(35.0)), hand), tmp_path)
    ranges = {r.joint: r for r in analyse(scene, SWEEP).ranges}
    ends = sorted(rocker_angle(AT + by) - rocker_angle(AT) for by in (-30.0, 60.0))
    assert np.degrees((ranges["rocker"].lower, ranges["rocker"].upper)) == pytest.approx(
        np.add(35.0, ends), abs=1e-7
    )
    content, _ = exported(scene, tmp_path, limits=True)
    written = {name: components(content, name, "HingeJoint")[0]["limits"] for name in ("Crank", "Rocker")}
    assert (written["Crank"]["min"], written["Crank"]["max"]) == pytest.approx((-30.0, 60.0), abs=1e-5)
    assert (written["Rocker"]["min"], written["Rocker"]["max"]) == pytest.approx(ends, abs=1e-5)


def test_limits_a_whole_turn_from_what_the_frames_read_hold_the_sweep_too(tmp_path):
    """A scene made in code may limit a crank to 350..440 degrees where its frames read 20: both are one pose."""
    scene, _ = read(four_bar(shown(20.0), shown(35.0)), tmp_path)
    limits = Freedom(Motion.LIMITED, math.radians(350.0), math.radians(440.0))
    free = next(j for j in scene.joints if j.id == "crank")
    crank = replace(free, freedoms=(*free.freedoms[:RX], limits, *free.freedoms[RX + 1 :]))
    scene.joints[scene.joints.index(free)] = crank
    ranges = {r.joint: r for r in analyse(scene, SWEEP).ranges}
    assert np.degrees((ranges["crank"].lower, ranges["crank"].upper)) == pytest.approx(
        (350.0, 440.0), abs=1e-7
    )
    ends = sorted(rocker_angle(AT + by) - rocker_angle(AT) for by in (-30.0, 60.0))
    assert np.degrees((ranges["rocker"].lower, ranges["rocker"].upper)) == pytest.approx(
        np.add(35.0, ends), abs=1e-7
    )


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("value", [11.0778352444, -3.5, 400.0])
def test_the_levers_slide_is_limited_where_it_stops(tmp_path, hand, value):
    """Without limits of its own it runs from 6.5 to 11.5 cm, whatever it displays there: 4.578 cm back, 0.422 on."""
    folder = FIXTURES / "lever"
    values = json.loads((folder / "lever.bundle.json").read_text("utf-8"))
    values["meta"].pop("mesh")
    for component in values["components"]:
        component.pop("bodies", None)
    values.pop("dof", None)
    slide = next(j for j in values["joints"] if j["id"] == "Joint:Slide")
    slide["dof"] = [{"name": "tz", "value": value}]
    slide.pop("frameB")
    scene, _ = read(handed(values, hand), tmp_path)
    found = analyse(scene, SWEEP)
    back, on = 0.065 - 0.110778352444, 0.115 - 0.110778352444
    (swept,) = [r for r in found.ranges if r.joint == "Joint:Slide"]
    assert (swept.lower, swept.upper) == pytest.approx((0.01 * value + back, 0.01 * value + on), abs=1e-7)
    listed = next(r for r in document(found)["ranges"] if r["joint"] == "Joint:Slide")
    assert (listed["freedom"], listed["lower"], listed["upper"]) == ("tx", swept.lower, swept.upper)
    assert f"range of Slide: {swept.lower:.6g} to {swept.upper:.6g} m" in table(found)
    content, _ = exported(scene, tmp_path, limits=True)
    joint = next(c for c in components(content, "SliderD:1", "ConfigurableJoint") if "connectedBody" not in c)
    assert joint["xMotion"] == "Limited" and joint["linearLimit"]["limit"] == pytest.approx(0.025, abs=1e-8)
    # The mirror makes x = 9 cm, where the unturned slider is amid its travel, -9 cm.
    assert joint["connectedAnchor"][0] - joint.get("anchor", (0,))[0] == pytest.approx(-0.09, abs=1e-8)


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("value", [0.2, 400.0, -55.5])
def test_a_slide_of_a_mechanism_of_two_freedoms_ends_wherever_its_zero_is(tmp_path, hand, value):
    """Two slides along x, 0.3 m apart, joined by two rods: the one that is not limited goes as far as both rods stretched
    from the other's ends; its zero may lie many lengths away."""
    long, short, apart, at_a, at_b = 0.6, 0.5, 0.3, 0.2, 0.9
    d = math.hypot(at_b - at_a, apart)
    along = (d * d + long**2 - short**2) / (2.0 * d)
    u = np.array([at_b - at_a, apart, 0.0]) / d
    elbow = (
        np.array([at_a, 0.0, 0.0]) + along * u + math.sqrt(long**2 - along**2) * np.array([-u[1], u[0], 0.0])
    )

    def joint(name: str, kind: str, a: str, b: str, o, z, dof: list[dict]) -> dict:
        return {"id": name, "type": kind, "a": a, "b": b, "frameA": frame(o, z), "dof": dof}

    x, z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
    joints = [
        joint("one", "slider", "base", "A", (0.0, 0.0, 0.0), x, [limited("tz", 0.25, -0.1, 0.8)]),
        joint("two", "slider", "base", "B", (0.0, 0.0, 0.0), x, [{"name": "tz", "value": value}]),
        joint("left", "revolute", "A", "Long", (at_a, 0.0, 0.0), z, []),
        joint("middle", "revolute", "Long", "Short", elbow.tolist(), z, []),
        joint("right", "revolute", "B", "Short", (at_b, apart, 0.0), z, []),
    ]
    parts = [part("base", grounded=True), *(part(name) for name in ("A", "B", "Long", "Short"))]
    scene, _ = read(handed(bundle(*parts, joints=joints), hand), tmp_path)
    found = analyse(scene, SWEEP)
    assert found.mobility == 2
    ranges = {r.joint: r for r in found.ranges}
    assert (ranges["one"].lower, ranges["one"].upper) == pytest.approx((-0.1, 0.8), abs=1e-8)
    stretched = math.sqrt((long + short) ** 2 - apart**2)
    low, high = at_a - 0.35 - stretched - at_b, at_a + 0.55 + stretched - at_b
    assert (ranges["two"].lower - value, ranges["two"].upper - value) == pytest.approx((low, high), abs=1e-7)
