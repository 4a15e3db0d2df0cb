"""Limits and couplings count from where the source says that the joint stands, not from what fits a range best."""

from __future__ import annotations

import math

import kinefab
import numpy as np
import pytest
from kinefab.model import Freedom, JointKind, Motion
from scenes import BOX, components, exported
from source_bundles import bundle, codes, frame, part, read
from test_analysis_limits_zero import AT, four_bar, rocker_angle, shown
from test_sources_left_handed import by_the_other_hand, feature, limited

X, Z = (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)
MASS = {"in": "part", "mass": 2.0, "center": [0.1, 0.2, 0.3], "inertia": [3.0, 4.0, 5.0, 0.3, 0.4, 0.5]}


def arm_on(word: str, dof: dict, hand: str = "right", **more) -> dict:
    """An arm on the ground, counted in degrees, whose frames read what ``dof`` says."""
    joint = {
        "id": "J",
        "type": word,
        "a": "ground",
        "b": "Arm",
        "frameA": frame((0.0, 0.0, 0.0), Z, X),
        "lead": 0.1,
    }
    values = bundle(
        part("Arm", (1.0, 2.0, 3.0), mass=MASS), angle="deg", joints=[{**joint, "dof": [dof]}], **more
    )
    return values if hand == "right" else by_the_other_hand(values)


def one_sided(value: float | None, end: str, limit: float, name: str = "rz") -> dict:
    stated = {} if value is None else {"value": value}
    return {"name": name, **stated, end: limit, f"{end}Enabled": True}


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize(
    ("value", "end", "limit", "written"),
    [
        (0.0, "min", 30.0, (30.0, 360.0)),
        (0.0, "max", -30.0, (-360.0, -30.0)),
        (0.0, "min", 200.0, (200.0, 360.0)),
        (-60.0, "min", 130.0, (190.0, 360.0)),
        (170.0, "max", -80.0, (-360.0, -250.0)),
        (400.0, "min", 430.0, (30.0, 360.0)),
    ],
)
def test_a_limit_on_one_side_that_the_pose_violates_is_written_and_told(
    tmp_path, hand, value, end, limit, written
):
    """By the source's own name of the freedom and at its own place, with what the CAD displays."""
    scene, report = read(arm_on("revolute", one_sided(value, end, limit), hand), tmp_path)
    assert codes(report) == []
    content, result = exported(scene, tmp_path)
    (hinge,) = components(content, "Arm", "HingeJoint")
    assert (hinge["limits"]["min"], hinge["limits"]["max"]) == pytest.approx(written)
    assert codes(result.report) == ["JOINT_OUTSIDE_LIMITS", "JOINT_LIMIT_ONE_SIDED"]
    outside = result.report.diagnostics[0]
    assert f"{abs(value):g} degrees" in outside.message and f"{abs(limit):g}" in outside.message
    assert " rz = " in outside.message
    assert outside.where == "case.bundle.json#/joints/0/dof/0"


@pytest.mark.parametrize("value", [0.0, 180.0, -60.0, 300.0, -550.0])
@pytest.mark.parametrize(
    ("end", "by", "written"), [("min", -10.0, (-10.0, 360.0)), ("max", 10.0, (-360.0, 10.0))]
)
def test_a_limit_on_one_side_that_the_pose_keeps_counts_from_it(tmp_path, value, end, by, written):
    """Ten degrees to the stop, whatever the CAD displays, at half a turn too."""
    scene, _ = read(arm_on("revolute", one_sided(value, end, value + by)), tmp_path)
    content, result = exported(scene, tmp_path)
    (hinge,) = components(content, "Arm", "HingeJoint")
    assert (hinge["limits"]["min"], hinge["limits"]["max"]) == pytest.approx(written)
    assert codes(result.report) == ["JOINT_LIMIT_ONE_SIDED"]


@pytest.mark.parametrize(("word", "furthest"), [("revolute", 360.0), ("cylindrical", 180.0)])
def test_a_limit_further_off_than_unity_counts_is_left_out_and_told(tmp_path, word, furthest):
    """Never with its lower end above the upper one."""
    scene, _ = read(arm_on(word, one_sided(0.0, "min", furthest + 40.0)), tmp_path)
    content, result = exported(scene, tmp_path)
    kind = "HingeJoint" if word == "revolute" else "ConfigurableJoint"
    (joint,) = components(content, "Arm", kind)
    assert "limits" not in joint and "lowAngularXLimit" not in joint
    assert codes(result.report) == [
        "JOINT_OUTSIDE_LIMITS",
        "JOINT_LIMIT_ONE_SIDED",
        "JOINT_LIMIT_BEYOND_TURN",
    ]


@pytest.mark.parametrize(
    ("word", "name", "dof"),
    [
        ("cylindrical", "tz", {"min": 0.3, "max": 0.5}),
        ("planar", "tx", {"min": 0.3, "max": 0.5}),
        ("planar", "ty", {"min": 0.3, "max": 0.5}),
        ("pin_slot", "tx", {"min": 0.3, "max": 0.5}),
        ("universal", "rx", {"min": 30.0, "max": 50.0}),
    ],
)
def test_a_freedom_outside_its_range_has_the_name_that_the_source_gives_it(tmp_path, word, name, dof):
    """A bundle's axis is z, the scene's is x; a universal's cross keeps its names."""
    limits = {"name": name, "value": 0.0, **dof, "minEnabled": True, "maxEnabled": True}
    scene, _ = read(arm_on(word, limits), tmp_path)
    _, result = exported(scene, tmp_path)
    (outside,) = (d for d in result.report.diagnostics if d.code == "JOINT_OUTSIDE_LIMITS")
    assert f"stands at {name} = 0 " in outside.message
    assert outside.where == "case.bundle.json#/joints/0/dof/0"


@pytest.mark.parametrize(("reading", "lower", "coordinate"), [
    (0.0, 30.0, 0.0), (-60.0, 10.0, -60.0), (170.0, -10.0, 170.0), (20.0, 350.0, 380.0), (-180.0, 0.0, 180.0),
    (-170.0, 0.0, -170.0), (-100.0, 200.0, 260.0),
])  # fmt: skip
def test_an_angle_that_nobody_states_is_the_one_nearest_to_the_end_of_its_range(reading, lower, coordinate):
    """Of a range with one end, mirrored too; inside stays inside."""
    low = Freedom(Motion.LIMITED, lower=math.radians(lower))
    high = Freedom(Motion.LIMITED, upper=math.radians(-lower))
    assert math.degrees(low.nearest_turn(math.radians(reading))) == pytest.approx(coordinate)
    assert math.degrees(high.nearest_turn(math.radians(-reading))) == pytest.approx(-coordinate)
    assert Freedom(Motion.LIMITED).nearest_turn(1.25) == 1.25


def test_a_joint_of_a_script_stands_at_zero(tmp_path):
    """The frames meet where the parts stand, so a range from 200 degrees on is violated by 200."""
    scene = kinefab.Scene()
    arm = scene.add_part("Arm", BOX)
    turn = Freedom(Motion.LIMITED, lower=math.radians(200.0))
    scene.add_joint(JointKind.REVOLUTE, None, arm, point=(0, 0, 0), axis=Z, rx=turn)
    content, result = exported(scene, tmp_path)
    (hinge,) = components(content, "Arm", "HingeJoint")
    assert hinge["limits"]["min"] == pytest.approx(200.0)
    assert "JOINT_OUTSIDE_LIMITS" in codes(result.report)


@pytest.mark.parametrize("low, high, written", [(30.0, 80.0, (10.0, 60.0)), (-80.0, 10.0, (-100.0, -10.0))])
def test_a_search_for_limits_begins_outside_of_a_range_as_the_pose_does(tmp_path, low, high, written):
    """A crank at 20 degrees keeps the limits it has, and the rocker goes as far as the way in and through them."""
    scene, _ = read(four_bar(limited("rz", 20.0, low, high), shown(35.0)), tmp_path)
    content, result = exported(scene, tmp_path, limits=True)
    (crank,), (rocker,) = (components(content, name, "HingeJoint") for name in ("Crank", "Rocker"))
    assert (crank["limits"]["min"], crank["limits"]["max"]) == pytest.approx(written, abs=1e-5)
    swept = np.linspace(*sorted((0.0, max(written, key=abs))), 2001)
    ends = np.degrees(np.unwrap(np.radians([rocker_angle(AT + by) for by in swept])))
    ends -= ends[0 if low > 0.0 else -1]
    found = rocker["limits"].get("min", 0.0), rocker["limits"].get("max", 0.0)
    assert found == pytest.approx((ends.min(), ends.max()), abs=1e-4)
    assert "JOINT_OUTSIDE_LIMITS" in codes(result.report)


def turned_to(angle: float, part_name: str) -> dict:
    along = [math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0.0]
    return feature(part_name, "line", [0.0, 0.0, 0.0], along)


@pytest.mark.parametrize("hand", ["right", "left"])
@pytest.mark.parametrize("value", [0.0, 25.0, -130.0, 385.0])
def test_a_ranged_constraint_limits_an_explicit_joint_wherever_its_zero_is(tmp_path, hand, value):
    """An angle of 25 degrees that may be -10..80 leaves -35..55, whatever the joint displays."""
    bounds = {"id": "range", "kind": "angle", "min": -10.0, "max": 80.0}
    sides = {
        "a": turned_to(0.0, "ground"),
        "b": turned_to(25.0, "Arm"),
        "c": feature("ground", "line", [0.0, 0.0, 0.0], list(Z)),
    }
    scene, report = read(
        arm_on("revolute", {"name": "rz", "value": value}, hand, constraints=[bounds | sides]), tmp_path
    )
    assert codes(report) == []
    content, _ = exported(scene, tmp_path)
    (hinge,) = components(content, "Arm", "HingeJoint")
    assert (hinge["limits"]["min"], hinge["limits"]["max"]) == pytest.approx((-35.0, 55.0), abs=1e-6)


@pytest.mark.parametrize(("first", "second"), [(0.0, 0.0), (30.0, 0.0), (-20.0, 115.0)])
def test_a_gear_constraint_holds_at_the_exported_pose_of_explicit_joints(tmp_path, first, second):
    """Whatever the two hinges display there: the coupling has no offset in the file."""
    wheels = [part(name, (x, 0.0, 0.0), mass=MASS) for name, x in (("A", 0.0), ("B", 1.0))]
    joints = [
        {"id": f"hinge {name}", "type": "revolute", "a": "ground", "b": name, "frameA": frame((x, 0.0, 0.0), Z, X),
         "dof": [{"name": "rz", "value": value}]}
        for name, x, value in (("A", 0.0, first), ("B", 1.0, second))
    ]  # fmt: skip
    sides = {
        "a": feature("A", "line", [0.0, 0.0, 0.0], list(Z)),
        "b": feature("B", "line", [1.0, 0.0, 0.0], list(Z)),
    }
    gear = {"id": "gear", "kind": "gear", "value": -2.0, **sides}
    scene, report = read(bundle(*wheels, angle="deg", joints=joints, constraints=[gear]), tmp_path)
    assert codes(report) == []
    content, _ = exported(scene, tmp_path)
    (coupling,) = content["couplings"]
    assert coupling["ratio"] == pytest.approx(-2.0) and "offset" not in coupling
