"""Joints and couplings of a bundle: axes, coordinates and their signs, limits, flips."""

from __future__ import annotations

import json
import math

import kinefab
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report
from kinefab.model import RX, TX, UNLOCKED, JointKind, Motion
from kinefab.spatial import rotation_about
from source_bundles import FIXTURES, bundle, codes, coordinates, frame, part, read

X, Y, Z = (1, 0, 0), (0, 1, 0), (0, 0, 1)


def two(joint: dict, *more: dict, **options) -> dict:
    """A base and an arm at (1, 2, 3) with one joint between them."""
    joint = {"id": "J", "a": "Base", "b": "Arm", **joint}
    return bundle(part("Base"), part("Arm", (1, 2, 3)), joints=[joint, *more], **options)


@pytest.mark.parametrize("folder", ["hinge_slider_zup", "hinge_slider_yup"])
def test_hinge_and_slider_keep_signs_in_either_world(folder):
    """Z-up millimetres and Y-up metres give the same axes, coordinates and limits -10 .. 80, by hand."""
    report = Report()
    scene = sources.read(FIXTURES / folder / "hinge_slider.bundle.json", report)
    assert report.diagnostics == []
    hinge, slide = scene.joints
    axis = scene.pose(hinge.a).direction(hinge.frame_a.rotation[:, 0])
    assert axis == pytest.approx(X, abs=1e-12)
    assert scene.pose(hinge.a).point(hinge.frame_a.translation) == pytest.approx([0.010, 0.030, -0.020])
    translation, angle = coordinates(scene, hinge)
    assert (translation, angle) == (pytest.approx(0, abs=1e-12), pytest.approx(math.radians(25)))
    limits = hinge.freedoms[RX]
    assert (limits.lower, limits.upper) == pytest.approx((math.radians(-10), math.radians(80)))
    # The slide runs along -Y of the Z-up world: forward, +Z, in the scene.
    along = scene.pose(slide.a).direction(slide.frame_a.rotation[:, 0])
    assert along == pytest.approx(Z, abs=1e-12)
    translation, _ = coordinates(scene, slide)
    assert translation == pytest.approx([0.015, 0, 0], abs=1e-12)
    assert (slide.freedoms[TX].lower, slide.freedoms[TX].upper) == pytest.approx((-0.010, 0.080))


def test_lever_coordinates_are_those_of_the_closed_form():
    """At 30 degrees: lever 30, pin -30 - 7.98355614, slider pin -7.98355614 degrees, slide 110.778352 mm."""
    scene = sources.read(FIXTURES / "lever" / "lever.bundle.json", Report())
    angles = {joint.name: math.degrees(coordinates(scene, joint)[1]) for joint in scene.joints}
    assert angles["Shaft"] == pytest.approx(30, abs=1e-8)
    assert angles["Eccentric pin"] == pytest.approx(-37.98355614, abs=1e-7)
    assert angles["Slider pin"] == pytest.approx(-7.98355614, abs=1e-7)
    slide = next(joint for joint in scene.joints if joint.name == "Slide")
    assert coordinates(scene, slide)[0][0] == pytest.approx(0.11077835244, abs=1e-10)


@pytest.mark.parametrize(
    ("word", "kind"),
    [
        ("rigid", JointKind.FIXED),
        ("revolute", JointKind.REVOLUTE),
        ("slider", JointKind.PRISMATIC),
        ("cylindrical", JointKind.CYLINDRICAL),
        ("pin_slot", JointKind.PIN_SLOT),
        ("planar", JointKind.PLANAR),
        ("ball", JointKind.SPHERICAL),
        ("universal", JointKind.UNIVERSAL),
        ("screw", JointKind.SCREW),
    ],
)
def test_joint_type_leaves_its_freedoms(tmp_path, word, kind):
    """Every type of the format becomes the lower pair of that name with exactly its freedoms unlocked."""
    scene, report = read(two({"type": word, "frameA": frame((1, 2, 3), Z, X), "lead": 0.01}), tmp_path)
    (joint,) = scene.joints
    assert codes(report) == []
    assert joint.kind is kind
    assert tuple(i for i in range(6) if joint.freedoms[i].motion is Motion.FREE) == UNLOCKED[kind]


@pytest.mark.parametrize("word", ["revolute", "cylindrical", "slider", "planar", "rigid"])
def test_opposed_axes_are_no_fault_where_the_source_does_not_say(tmp_path, word):
    """Only a flag that is there can be wrong."""
    joint = {"type": word, "frameA": frame((0, 0, 0), Z, X), "frameB": frame((0, 0, 0), (0, 0, -1), X)}
    scene, report = read(two(joint), tmp_path)
    assert codes(report) == []
    translation, angle = coordinates(scene, scene.joints[0])
    assert [*translation, angle] == pytest.approx([0, 0, 0, 0], abs=1e-12)
    _, report = read(two({**joint, "flipped": False}), tmp_path)
    assert codes(report) == ["JOINT_FLIP_MISMATCH"]


@pytest.mark.parametrize("solve", [False, True])
@pytest.mark.parametrize("word", ["rigid", "slider"])
@pytest.mark.parametrize("z, x", [((0, 0, -1), X), (Z, (-1, 0, 0)), ((0, 0, -1), (-1, 0, 0))])
def test_axes_named_the_other_way_are_no_gap_where_nothing_turns(tmp_path, solve, word, z, x):
    """Half a turn about any axis of the frame: the parts stand as the joint holds them, and stay there."""
    joint = {"type": word, "frameA": frame((0, 0, 0), Z, X), "frameB": frame((0, 0, 0), z, x)}
    scene, report = read(two(joint), tmp_path)
    result = kinefab.export(scene, tmp_path / "out.kinefab", kinefab.ExportOptions(solve=solve))
    assert codes(report) == []
    assert "JOINT_POSE_GAP" not in codes(result.report)
    moved = next(o for o in result.unity.gameObjects if o.name == "Arm")
    assert np.allclose(moved.transform.localPosition, [-1, 2, 3], atol=1e-12)
    assert np.allclose(moved.transform.localRotation, [0, 0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("word", "names", "expected"),
    [
        ("pin_slot", {"tx": 0.3, "rz": 0.2}, ((0, 0.3, 0), 0.2)),
        ("planar", {"tx": 0.1, "ty": -0.2, "rz": 0.4}, ((0, 0.1, -0.2), 0.4)),
        ("cylindrical", {"tz": -0.7, "rz": -0.5}, ((-0.7, 0, 0), -0.5)),
    ],
)
def test_coordinates_are_relabelled_from_z_to_x(tmp_path, word, names, expected):
    """(x, y, z) of a Z-main joint frame are (Y, Z, X) of the scene's; without frameB b stands at the
    values."""
    dof = [{"name": name, "value": value} for name, value in names.items()]
    scene, report = read(two({"type": word, "frameA": frame((1, 2, 3), Y, Z), "dof": dof}), tmp_path)
    translation, angle = coordinates(scene, scene.joints[0])
    assert codes(report) == []
    assert (translation, angle) == (pytest.approx(expected[0], abs=1e-12), pytest.approx(expected[1]))


def test_slot_lies_along_the_given_x(tmp_path):
    """A pin-slot's X is the pin and its Y the slot, as given by z and x."""
    scene, _ = read(two({"type": "pin_slot", "frameA": frame((0, 0, 0), Y, Z)}), tmp_path)
    assert scene.joints[0].frame_a.rotation == pytest.approx(np.column_stack([Y, Z, X]))


def test_opposed_axes_keep_the_sense_of_a(tmp_path):
    """With b's z against a's, the angle still runs from a's x to b's x about a's z, and lengths along it."""
    other = {"in": "world", "o": [0, 0, 0.4], "z": [0, 0, -1], "x": [math.cos(0.3), math.sin(0.3), 0]}
    joint = {"type": "cylindrical", "frameA": frame((0, 0, 0), Z, X), "frameB": other, "flipped": True}
    scene, report = read(
        two({**joint, "dof": [{"name": "rz", "value": 0.3}, {"name": "tz", "value": 0.4}]}), tmp_path
    )
    translation, angle = coordinates(scene, scene.joints[0])
    assert codes(report) == []
    assert (translation, angle) == (pytest.approx([0.4, 0, 0]), pytest.approx(0.3))


@settings(max_examples=30, deadline=None)
@given(
    axis=st.tuples(*[st.floats(-1, 1)] * 3).filter(lambda v: math.hypot(*v) > 0.1),
    angle=st.floats(-3.1, 3.1),
    flipped=st.booleans(),
)
def test_angle_is_measured_about_any_axis(tmp_path_factory, axis, angle, flipped):
    """b's x turned by the angle about a's z (Rodrigues) is read back as the angle, flipped or not."""
    z = np.array(axis) / np.linalg.norm(axis)
    x = np.cross(z, np.eye(3)[int(np.argmin(np.abs(z)))])
    x /= np.linalg.norm(x)
    turned = rotation_about(z, angle) @ x
    other = frame((1, 2, 3), (-z if flipped else z).tolist(), turned.tolist())
    joint = {
        "type": "revolute",
        "frameA": frame((1, 2, 3), z.tolist(), x.tolist()),
        "frameB": other,
        "flipped": flipped,
    }
    scene, report = read(two(joint), tmp_path_factory.mktemp("angle"))
    assert codes(report) == []
    assert coordinates(scene, scene.joints[0])[1] == pytest.approx(angle, abs=1e-9)


def test_limit_without_its_flag_is_no_limit(tmp_path):
    """CAD programs keep old limit numbers; only those switched on count, each end for itself."""
    dof = [{"name": "rz", "value": 0, "min": -1, "max": 2, "maxEnabled": True}]
    scene, _ = read(two({"type": "revolute", "frameA": frame((0, 0, 0), Z, X), "dof": dof}), tmp_path)
    freedom = scene.joints[0].freedoms[RX]
    assert (freedom.motion, freedom.lower, freedom.upper) == (Motion.LIMITED, -math.inf, 2.0)


def test_whole_turns_are_taken_out_of_value_and_limits(tmp_path):
    """A CAD angle of 390 degrees with limits 350 .. 440 is 30 with -10 .. 80: the frame cannot show turns."""
    dof = [{"name": "rz", "value": 390, "min": 350, "max": 440, "minEnabled": True, "maxEnabled": True}]
    joint = {"type": "revolute", "frameA": frame((0, 0, 0), Z, X), "dof": dof}
    scene, report = read(two(joint, angle="deg"), tmp_path)
    freedom = scene.joints[0].freedoms[RX]
    assert codes(report) == []
    assert coordinates(scene, scene.joints[0])[1] == pytest.approx(math.radians(30))
    assert (freedom.lower, freedom.upper) == pytest.approx((math.radians(-10), math.radians(80)))


def test_displayed_value_rules_where_the_frames_disagree(tmp_path):
    """Limits are stated beside the displayed value, so the frames are moved to read it, with a warning."""
    joint = {"type": "slider", "frameA": frame((0, 0, 0), X, Y), "frameB": frame((0.2, 0, 0), X, Y)}
    scene, report = read(two({**joint, "dof": [{"name": "tz", "value": 0.05}]}), tmp_path)
    assert codes(report) == ["JOINT_VALUE_MISMATCH"]
    assert coordinates(scene, scene.joints[0])[0] == pytest.approx([0.05, 0, 0])


def test_gap_of_the_saved_pose_is_kept(tmp_path):
    """What a pose misses in the locked freedoms stays visible; it is not hidden in a frame."""
    joint = {"type": "revolute", "frameA": frame((0, 0, 0), Z, X), "frameB": frame((0, 0.002, 0.001), Z, X)}
    scene, _ = read(two({**joint, "dof": [{"name": "rz", "value": 0.7}]}), tmp_path)
    translation, _ = coordinates(scene, scene.joints[0])
    assert math.hypot(*translation) == pytest.approx(math.hypot(0.002, 0.001))


def test_universal_takes_one_arm_from_each_side(tmp_path):
    """Z of the scene's joint turns in a, X turns in b, and both are as given."""
    joint = {"type": "universal", "frameA": frame((0, 0, 0), Y, Z), "frameB": frame((0, 0, 0), Z, Y)}
    scene, report = read(two(joint), tmp_path)
    (found,) = scene.joints
    assert codes(report) == []
    assert scene.pose(found.a).direction(found.frame_a.rotation[:, 2]) == pytest.approx(Y)
    assert scene.pose(found.b).direction(found.frame_b.rotation[:, 0]) == pytest.approx(Z)
    # Both arms stand at zero: the frames coincide.
    translation, angle = coordinates(scene, found)
    assert (translation, angle) == (pytest.approx(0, abs=1e-12), pytest.approx(0, abs=1e-12))


def test_frames_may_be_given_in_any_component(tmp_path):
    """World, the part itself and a third component name the same line."""
    places = [("world", (1, 2, 3)), ("part", (0, 0, 0)), ("Other", (1, 2, -7))]
    found = []
    for inside, o in places:
        joint = {"id": "J", "type": "revolute", "a": "ground", "b": "Arm", "frameA": frame((1, 2, 3), Z, X)}
        joint["frameB"] = frame(o, Z, X, inside)
        values = bundle(part("Arm", (1, 2, 3)), part("Other", (0, 0, 10)), joints=[joint])
        scene, _ = read(values, tmp_path)
        assert scene.joints[0].a is None
        found.append(scene.joints[0].frame_b.translation)
    assert all(translation == pytest.approx(0, abs=1e-12) for translation in found)


def test_frame_in_a_mirrored_part_follows_the_mirror(tmp_path):
    """Numbers in a mirrored part's own axes go through its mirror: here x of the part is -x of the world."""
    mirrored = part("Arm", (1, 2, 3))
    mirrored["pose"]["x"] = [-1, 0, 0]
    inside = frame((0.5, 0, 0), (0.6, 0.8, 0), Z, "part")
    joint = {
        "id": "J",
        "type": "slider",
        "a": "ground",
        "b": "Arm",
        "frameA": frame((0.5, 2, 3), (-0.6, 0.8, 0), Z),
    }
    scene, report = read(bundle(mirrored, joints=[{**joint, "frameB": inside}]), tmp_path)
    (found,) = scene.joints
    assert codes(report) == ["POSE_MIRRORED"]
    world = scene.pose(found.b) @ found.frame_b
    assert world.translation == pytest.approx([0.5, 2, 3])
    assert world.rotation[:, 0] == pytest.approx([-0.6, 0.8, 0])
    assert np.linalg.det(world.rotation) == pytest.approx(1.0)


def test_screw_lead_is_a_length_a_turn(tmp_path):
    """-2 mm a turn, a left-hand thread, is -0.002 m."""
    scene, _ = read(
        two({"type": "screw", "frameA": frame((0, 0, 0), Z, X), "lead": -2}, length="mm"), tmp_path
    )
    assert scene.joints[0].lead == pytest.approx(-0.002)


@pytest.mark.parametrize(
    ("sizes", "ratio"),
    [
        ({"kind": "gear", "teethA": 20, "teethB": 50}, -0.4),
        ({"kind": "gear", "radiusA": 20, "radiusB": 50, "reversed": True}, 0.4),
        ({"kind": "belt", "radiusA": 30, "radiusB": 10}, 3.0),
        ({"kind": "linear", "ratio": -1.5}, -1.5),
    ],
)
def test_coupling_of_two_hinges(tmp_path, sizes, ratio):
    """dq_b/dq_a from teeth, radii or as given; the offset is that of the exported pose."""
    joints = [
        {
            "id": name,
            "type": "revolute",
            "a": "ground",
            "b": name,
            "frameA": frame((0, 0, 0), Z, X),
            "dof": [{"name": "rz", "value": q}],
        }
        for name, q in (("A", 10), ("B", 35))
    ]
    coupling = {"id": "C", "a": {"joint": "A", "dof": "rz"}, "b": {"joint": "B", "dof": "rz"}, **sizes}
    values = bundle(part("A"), part("B"), joints=joints, couplings=[coupling], length="mm", angle="deg")
    scene, report = read(values, tmp_path)
    (found,) = scene.couplings
    assert codes(report) == []
    assert found.terms[0].ratio == pytest.approx(ratio)
    assert found.offset == pytest.approx(math.radians(35) - ratio * math.radians(10))
    assert (found.terms[0].freedom, found.freedom) == (RX, RX)


@pytest.mark.parametrize(
    ("sizes", "ratio"),
    [
        ({"kind": "rack", "radius": 8}, 0.008),
        ({"kind": "rack", "pitch": 5}, 0.005 / (2 * math.pi)),
        ({"kind": "linear", "ratio": 0.25}, 0.00025 * 180 / math.pi),
    ],
)
def test_coupling_of_a_hinge_and_a_slider(tmp_path, sizes, ratio):
    """Metres a radian from a pitch radius, a travel a turn, or millimetres a degree."""
    hinge = {"id": "H", "type": "revolute", "a": "ground", "b": "A", "frameA": frame((0, 0, 0), Z, X)}
    slide = {"id": "S", "type": "slider", "a": "ground", "b": "B", "frameA": frame((0, 0, 0), X, Y)}
    coupling = {"id": "C", "a": {"joint": "H", "dof": "rz"}, "b": {"joint": "S", "dof": "tz"}, **sizes}
    values = bundle(
        part("A"), part("B"), joints=[hinge, slide], couplings=[coupling], length="mm", angle="deg"
    )
    scene, _ = read(values, tmp_path)
    assert scene.couplings[0].terms[0].ratio == pytest.approx(ratio)


@pytest.mark.parametrize(
    "sizes",
    [
        {"kind": "rack", "radius": 20.0},
        {"kind": "screw", "pitch": 40.0 * math.pi},
        {"kind": "linear", "ratio": 2.0},
    ],
)
def test_coupling_of_a_slider_that_leads_a_hinge(tmp_path, sizes):
    """20 mm of travel turn the pinion by a radian; 1 mm by 2 degrees."""
    hinge = {"id": "H", "type": "revolute", "a": "ground", "b": "A", "frameA": frame((0, 0, 0), (0, 1, 0))}
    slide = {"id": "S", "type": "slider", "a": "ground", "b": "B", "frameA": frame((0, 0, 0), (1, 0, 0))}
    coupling = {"id": "C", "a": {"joint": "S", "dof": "tz"}, "b": {"joint": "H", "dof": "rz"}, **sizes}
    values = bundle(
        part("A"), part("B"), joints=[hinge, slide], couplings=[coupling], length="mm", angle="deg"
    )
    scene, _ = read(values, tmp_path)
    expected = 50.0 if "ratio" not in sizes else 2.0 * math.pi / 180.0 / 0.001
    assert scene.couplings[0].terms[0].ratio == pytest.approx(expected)


@pytest.mark.parametrize(
    "word, meant",
    [
        ("prismatic", "slider"),
        ("hinge", "revolute"),
        ("Revolut", "revolute"),
        ("pin-slot", "pin_slot"),
        ("cam", "none"),
    ],
)
def test_unknown_joint_type_is_an_error_that_names_the_meant_one(tmp_path, word, meant):
    """Another program's word, or a slip of the pen, is refused with the type it may stand for."""
    (tmp_path / "a.bundle.json").write_text(json.dumps(two({"type": word, "frameA": frame((0, 0, 0), Z, X)})))
    with pytest.raises(KinefabError) as refused:
        sources.read(tmp_path / "a.bundle.json", Report())
    (found,) = refused.value.diagnostics
    assert found.code == "JOINT_TYPE_UNKNOWN"
    assert f"'{word}'. Near matches: {meant}." in found.message
