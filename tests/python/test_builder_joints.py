"""Joints, couplings, rotations and shapes as a script states them: by word, in degrees, and refused with what to pass."""

from __future__ import annotations

import json
import math

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.model import (
    RX,
    TX,
    Collider,
    ColliderKind,
    Freedom,
    JointKind,
    Motion,
    PhysicsMaterial,
    Surface,
)
from kinefab.spatial import rotation_about
from scenes import BOX

AT = {"point": (0, 0, 0), "axis": (0, 0, 1)}


def pair() -> kinefab.Scene:
    scene = kinefab.Scene()
    scene.add_part("Base", grounded=True)
    scene.add_part("Arm")
    return scene


@pytest.mark.parametrize("spring", [(4.0, -45), np.array([4.0, -45.0])])
def test_a_joint_by_its_word_with_limits_drive_spring_and_damping_in_degrees(spring):
    scene = pair()
    drive = {"target": 30, "target_velocity": -90, "stiffness": 5.0, "max_force": 7.0}
    joint = scene.add_joint("revolute", 0, 1, **AT, limits=(-10, 80), drive=drive, spring=spring, damping=0.5)
    freedom = joint.freedoms[RX]
    assert joint.kind is JointKind.REVOLUTE and freedom.motion is Motion.LIMITED
    assert (freedom.lower, freedom.upper) == pytest.approx((math.radians(-10), math.radians(80)))
    assert freedom.drive.target == pytest.approx(math.radians(30))
    assert freedom.drive.target_velocity == pytest.approx(math.radians(-90))
    assert (freedom.drive.stiffness, freedom.drive.max_force) == (5.0, 7.0)
    assert (freedom.passive.stiffness, freedom.passive.damping) == (4.0, 0.5)
    assert freedom.passive.rest == pytest.approx(math.radians(-45))


@pytest.mark.parametrize("word", ["hinge", "slider", "ball", "fixed"])
def test_a_joint_by_the_word_of_its_own_method_is_the_same(word: str) -> None:
    """Who writes ``add_hinge`` writes ``add_joint("hinge")``; it was refused with the words of the model."""
    scene = pair()
    at = {} if word == "fixed" else AT
    own = getattr(scene, f"add_{word}")(0, 1, **at)
    asked = scene.add_joint(word, 0, 1, **AT)
    assert (asked.kind, asked.freedoms) == (own.kind, own.freedoms)


def test_a_joint_stands_where_its_parts_do_now():
    """Its frames meet at the point, along the axis, wherever the two parts stand, and count from there."""
    scene = kinefab.Scene()
    for name, turn, at in (
        ("Base", (20, -50, 70), (1.0, -2.0, 0.5)),
        ("Arm", (-30, 10, 40), (0.2, 0.7, -3.0)),
    ):
        scene.add_part(name, rotation=("XYZ", turn), translation=at)
    point, axis = np.array([0.4, 1.5, -0.6]), np.array([2.0, -1.0, 2.0]) / 3.0
    for a in (0, None):
        joint = scene.add_hinge(a, 1, point=tuple(point), axis=tuple(3.0 * axis), limits=(200, 300))
        for side, frame in ((joint.a, joint.frame_a), (joint.b, joint.frame_b)):
            world = scene.pose(side) @ frame
            assert np.allclose(world.translation, point) and np.allclose(world.rotation[:, 0], axis)
        assert joint.freedoms[RX].at == 0.0  # and not a turn away, where its range would have it


def test_a_range_may_be_one_value():
    joint = pair().add_hinge(0, 1, **AT, limits=(5, 5))
    assert joint.freedoms[RX].lower == joint.freedoms[RX].upper == pytest.approx(math.radians(5))


def test_several_freedoms_are_named():
    joint = pair().add_joint(
        "cylindrical", 0, 1, **AT, limits={"tx": (-0.1, 0.2), "rx": (-10, 80)}, damping={"tx": 3}
    )
    assert (joint.freedoms[TX].lower, joint.freedoms[TX].upper) == (-0.1, 0.2)
    assert joint.freedoms[RX].upper == pytest.approx(math.radians(80))
    assert joint.freedoms[TX].passive.damping == 3


def test_freedoms_by_keyword_are_ranges_in_degrees():
    joint = pair().add_joint("general", 0, 1, **AT, rx=(-10, 80), tz=True, ty=False)
    assert joint.freedoms[RX].upper == pytest.approx(math.radians(80))
    assert [f.motion for f in joint.freedoms] == [
        Motion(w) for w in ("locked", "locked", "free", "limited", "locked", "locked")
    ]


@pytest.mark.parametrize(
    "kind, options, error, says",
    [
        (
            "revolute",
            {"rz": (0, 1)},
            ValueError,
            "turns about its axis, which is rx; rz is locked in it: pass rx=",
        ),
        (
            "prismatic",
            {"rx": True},
            ValueError,
            "slides along its axis, which is tx; rx is locked in it: pass tx=",
        ),
        ("door", {}, ValueError, "pass one of: hinge, slider, ball, fixed, revolute"),
        ("revolute", {"turn": 1}, TypeError, "'turn' is no freedom; pass one of: tx"),
        ("planar", {"limits": (0, 1)}, ValueError, "leaves ty, tz, rx; pass limits by name"),
        ("revolute", {"drive": 5}, TypeError, "pass a dict such as"),
        ("revolute", {"drive": {"speed": 5}}, TypeError, "pass"),
        ("revolute", {"spring": (1, 2, 3)}, TypeError, "(stiffness, rest)"),
        ("revolute", {"damping": -1.0}, ValueError, "not below 0"),
        ("revolute", {"limits": "0, 1"}, TypeError, "pass two numbers"),
        ("revolute", {"limits": (math.inf, math.inf)}, ValueError, "lower not above upper"),
        ("prismatic", {"limits": (-1e300, 80)}, ValueError, "none but infinity beyond 1e+09"),
        ("revolute", {"rx": (-10, 80), "limits": (0, 90)}, ValueError, "rx is stated twice"),
        ("revolute", {"rx": False, "limits": (0, 90)}, ValueError, "rx is stated twice"),
        ("general", {"tx": True, "drive": {"rx": {"target": 5}}}, ValueError, "rx is locked; a drive"),
        ("fixed", {"limits": (0, 1)}, ValueError, "leaves nothing free; it takes no limits"),
        ("revolute", {"drive": {"targt": 5}}, TypeError, "a drive has no 'targt'; pass acceleration"),
        ("revolute", {"drive": {"stiffness": -1.5}}, ValueError, "not below 0"),
        ("revolute", {"drive": {"damping": -1.5}}, ValueError, "not below 0"),
        ("revolute", {"drive": {"max_force": -1.5, "motor": True}}, ValueError, "not below 0"),
        ("revolute", {"drive": {"motor": "no"}}, TypeError, "pass True or False"),
        ("revolute", {"drive": kinefab.Drive(stiffness=-2.5)}, ValueError, "below 0"),
        ("revolute", {"rx": Freedom(Motion.LIMITED, -0.1, 0.8, restitution=3.0)}, ValueError, "outside 0..1"),
        ("universal", {"secondary": (0, 0, -3)}, ValueError, "pass a direction across it"),
        ("revolute", {"name": "a\ud800"}, ValueError, "UTF-8"),
    ],
)
def test_a_wrong_joint_says_what_to_pass(kind, options, error, says):
    scene = pair()
    with pytest.raises(error) as raised:
        scene.add_joint(kind, 0, 1, **AT, **options)
    assert says in str(raised.value) and scene.joints == []


@pytest.mark.parametrize("collider", [5, ["box"], object()])
def test_a_collider_that_is_none_says_what_to_pass(collider):
    scene = kinefab.Scene()
    with pytest.raises(TypeError, match="the collider of Box is .*; pass a word, a Collider, or several"):
        scene.add_part("Box", BOX, collider=collider)
    assert scene.nodes == []


def test_joints_of_one_name_are_told_apart(tmp_path):
    scene = pair()
    scene.add_part("Hand")
    first = scene.add_hinge(0, 1, **AT, name="Pin")
    second = scene.add_hinge(1, 2, point=(1, 0, 0), axis=(0, 0, 1), name="Pin")
    assert (first.id, second.id, second.name) == ("Pin", "Pin:2", "Pin")
    result = kinefab.export(scene, tmp_path / "two.kinefab")
    assert {o.feature for o in result.report.outcomes} >= {"joint Pin", "joint Pin:2"}


def test_a_coupling_counts_in_degrees_and_metres(tmp_path):
    """A rack of 2 mm a degree and 50 mm before it, and a gear of -3 with an offset of 5 degrees."""
    scene = pair()
    for name in ("Rack", "Wheel"):
        scene.add_part(name)
    pinion = scene.add_hinge(0, 1, **AT, name="Pinion")
    rack = scene.add_slider(0, 2, point=(0, 0, 0), axis=(1, 0, 0))
    wheel = scene.add_hinge(0, 3, point=(1, 0, 0), axis=(0, 0, 1))
    travel = scene.add_coupling(pinion, rack, 0.002, offset=0.05)
    turn = scene.add_coupling("Pinion", wheel, -3, offset=5)
    assert travel.terms[0].ratio == pytest.approx(0.002 * 180 / math.pi) and travel.kind.value == "rack"
    assert travel.offset == 0.05 and scene.couplings[0] is travel
    assert (turn.terms[0].ratio, turn.offset) == pytest.approx((-3, math.radians(5)))
    content = json.loads(kinefab.export(scene, tmp_path / "gears.kinefab").path.read_text("utf-8"))
    assert {c["ratio"] for c in content["couplings"]} == {0.002, -3} and content["analysis"]["mobility"] == 1


@pytest.mark.parametrize(
    "a, b, ratio, says",
    [
        ("Nowhere", "Pin", 1.0, "pass a joint of this scene"),
        ("Pin", "Fix", 1.0, "leaves nothing free"),
        (("Pin", "tx"), "Pin", 1.0, "which leaves rx free"),
        ("Pin", "Pin", 0.0, "nothing would follow"),
        ("Pin", "Pin", math.nan, "pass a finite number"),
        ("Pin", "Pin", 2.0, "a and b are both rx of joint Pin; pass two"),
    ],
)
def test_a_wrong_coupling_says_what_to_pass(a, b, ratio, says):
    scene = pair()
    scene.add_part("Lump")
    scene.add_hinge(0, 1, **AT, name="Pin")
    scene.add_fixed(1, 2, name="Fix")
    with pytest.raises(ValueError, match="pass|nothing|leaves") as raised:
        scene.add_coupling(a, b, ratio)
    assert says in str(raised.value) and scene.couplings == []


def test_rotations_in_every_form_are_one():
    x, z = (
        rotation_about(np.array([1.0, 0, 0]), math.radians(30)),
        rotation_about(np.array([0, 0, 1.0]), math.radians(-70)),
    )
    turn = x @ z  # about x, then about the part's own z
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = turn, (1, 2, 3)
    half = np.radians([15, -35])
    cx, sx, cz, sz = math.cos(half[0]), math.sin(half[0]), math.cos(half[1]), math.sin(half[1])
    quaternion = (sx * cz, -sx * sz, cx * sz, cx * cz)
    scene = kinefab.Scene()
    for rotation in (turn, quaternion, ("XYZ", (30, 0, -70)), ("zxy", (-70, 30, 0)), whole):
        scene.add_part("Part", rotation=rotation)
    for node in scene.nodes:
        assert np.abs(node.pose.rotation - turn).max() < 1e-12
    assert scene.nodes[-1].pose.translation.tolist() == [1, 2, 3]


def test_parts_from_scenes_and_files_in_their_unit(tmp_path):
    """Two boxes of a trimesh.Scene become two bodies; a file in millimetres is read in metres when it is exported."""
    both = trimesh.Scene()
    both.add_geometry(trimesh.creation.box((1, 2, 3)), node_name="left")
    both.add_geometry(
        trimesh.creation.box((1, 1, 1)),
        node_name="right",
        transform=trimesh.transformations.translation_matrix((5, 0, 0)),
    )
    trimesh.creation.box((100, 200, 300)).export(tmp_path / "block.stl")
    scene = kinefab.Scene()
    scene.add_part("Twins", both, unit="cm", density=1000)
    scene.add_part("Block", tmp_path / "block.stl", unit="mm", density=1000)
    result = kinefab.export(scene, tmp_path / "parts.kinefab")
    bodies = [c for o in result.unity.gameObjects for c in o.components if type(c).__name__ == "Rigidbody"]
    assert [b.mass for b in bodies] == pytest.approx([0.007, 6.0])
    assert bodies[0].centerOfMass == pytest.approx((-0.05 / 7, 0, 0))
    with pytest.raises(TypeError, match="pass a trimesh.Trimesh or trimesh.Scene"):
        scene.add_part("Wrong", 5)


def test_a_part_states_its_colliders_and_materials(tmp_path):
    rubber, paint = PhysicsMaterial("rubber", 0.9, 1.0), Surface("paint", (1, 0, 0, 1))
    scene = kinefab.Scene()
    scene.add_part("Plain", BOX, collider="box", material=paint)
    scene.add_part("None", BOX, collider="none")
    scene.add_part("Own", BOX, collider=Collider(ColliderKind.SPHERE, radius=0.2), material=(rubber, paint))
    result = kinefab.export(scene, tmp_path / "parts.kinefab")
    kinds = [
        [type(c).__name__ for c in o.components if "Collider" in type(c).__name__]
        for o in result.unity.gameObjects
    ]
    assert kinds == [["BoxCollider"], [], ["SphereCollider"]]
    assert [m.name for m in result.unity.physicsMaterials] == ["rubber"]
    assert result.unity.materials[0].color == (1, 0, 0, 1)


@pytest.mark.parametrize(
    "ratio, offset, says",
    [
        (2e7, 0.0, "the ratio is 20000000.0, 2e+07 in metres and radians"),
        (-1e-8, 0.0, "Pass one from 1e-06 to 1e+06"),
        (1e308, 0.0, "the slower of the two would stand still"),
        (-2.5, 1e300, "the offset is 1e+300; pass a number, none beyond 1e+09"),
    ],
)
def test_a_ratio_that_the_analysis_cannot_see_is_refused(ratio, offset, says):
    """Both hinges would be fixed, and only a remark would say so."""
    scene = kinefab.Scene()
    hinges = [scene.add_hinge(None, scene.add_part(name), **AT) for name in ("Motor", "Hand")]
    with pytest.raises(ValueError) as raised:
        scene.add_coupling(*hinges, ratio, offset=offset)
    assert says in str(raised.value) and scene.couplings == []
    scene.add_coupling(*hinges, 9e5)
    assert kinefab.motion(scene).mobility == 1


BOX_KIND, BALL = kinefab.ColliderKind.BOX, kinefab.ColliderKind.SPHERE
INERTIA = np.diag([0.2, 0.3, 0.4])


@pytest.mark.parametrize(
    "options, error, says",
    [
        (
            {"material": Surface("s", (0.1, math.nan, 0.3, 1))},
            ValueError,
            "pass three or four numbers from 0 to 1",
        ),
        ({"material": Surface("s", "red")}, ValueError, "the color of Lid is 'red'; pass three"),
        (
            {"material": Surface("s", metallic=1.5)},
            ValueError,
            "the metallic of Lid is 1.5; pass a number from 0 to 1",
        ),
        (
            {"material": Surface("s", emission=(0, 2, -1))},
            ValueError,
            "the emission of Lid is (0, 2, -1); pass three",
        ),
        (
            {"material": PhysicsMaterial("r", -0.5)},
            ValueError,
            "the dynamic_friction of Lid is -0.5; pass a finite",
        ),
        ({"material": PhysicsMaterial("r", restitution=2.0)}, ValueError, "pass a number from 0 to 1"),
        ({"collider": Collider("box", size=(1, 2, 3))}, TypeError, "pass a ColliderKind: BOX, SPHERE"),
        ({"collider": Collider(BOX_KIND)}, ValueError, "is (0.0, 0.0, 0.0); pass three lengths above zero"),
        ({"collider": Collider(BOX_KIND, size=(1, -2, 3))}, ValueError, "pass three lengths above zero"),
        (
            {"collider": Collider(BOX_KIND, size=(1, math.inf, 3))},
            ValueError,
            "pass three lengths above zero",
        ),
        ({"collider": Collider(BOX_KIND, np.eye(4), (1, 2, 3))}, TypeError, "pass a kinefab.Pose"),
        (
            {"collider": Collider(BALL, radius=-0.2)},
            ValueError,
            "the radius of Lid's collider is -0.2; pass one above",
        ),
        (
            {"collider": Collider(BALL, radius="2")},
            TypeError,
            "the radius of Lid's collider is '2'; pass a number",
        ),
        ({"collider": Collider(BALL, radius=0.2, material="ice")}, TypeError, "pass a PhysicsMaterial"),
        (
            {"collider": Collider(kinefab.ColliderKind.MESH, mesh=7)},
            ValueError,
            "pass an index into the scene's 1 m",
        ),
        (
            {"mass": kinefab.MassProperties(math.nan, (0, 0, 0), INERTIA)},
            ValueError,
            "the mass of Lid is nan",
        ),
        (
            {"mass": kinefab.MassProperties(2.0, (0, 0), INERTIA)},
            ValueError,
            "the center of Lid's mass is (0, 0); pass",
        ),
        (
            {"mass": kinefab.MassProperties(2.0, (0, 0, 0), (1, 2, 3))},
            ValueError,
            "pass a matrix of numbers, 3 x 3",
        ),
        (
            {"mass": kinefab.MassProperties(2.0, (0, 0, 0), np.triu(INERTIA + 0.1))},
            ValueError,
            "is not symmetric",
        ),
    ],
)
def test_what_a_part_states_of_itself_is_looked_at(options, error, says):
    """Most went through to the file, or ended in an error of numpy's; nothing is added."""
    scene = kinefab.Scene()
    with pytest.raises(error) as raised:
        scene.add_part("Lid", BOX, **options)
    assert says in str(raised.value)
    assert not (scene.nodes or scene.surfaces)


def test_lists_do_for_arrays_and_three_colours_for_four():
    scene = kinefab.Scene()
    stated = kinefab.MassProperties(2, [0, 0.1, 0], INERTIA.tolist())
    scene.add_part("Lid", BOX, mass=stated, material=Surface("red", (0.9, 0.1, 0.2)))
    mass = scene.nodes[0].mass
    assert mass is not None and mass.center.tolist() == [0, 0.1, 0] and np.array_equal(mass.inertia, INERTIA)
    assert scene.surfaces[0].color == (0.9, 0.1, 0.2, 1.0)


def test_a_joint_breaks_at_what_the_script_says(tmp_path):
    """Every kind of joint; two parts that a breakable joint fixes stay two bodies, and no end is infinity."""
    scene = kinefab.Scene()
    frame = scene.add_part("Frame", BOX, grounded=True)
    breaks = {"break_force": 300.0, "break_torque": math.inf}
    at = {"point": (0, 0, 0), "axis": (0, 1, 0)}
    scene.add_hinge(frame, scene.add_part("Hinged", BOX), **at, **breaks)
    scene.add_slider(frame, scene.add_part("Slid", BOX), **at, **breaks)
    scene.add_ball(frame, scene.add_part("Balled", BOX), **at, **breaks)
    scene.add_fixed(frame, scene.add_part("Fixed", BOX), **breaks)
    scene.add_joint("cylindrical", frame, scene.add_part("Rod", BOX), **at, **breaks)
    unity = kinefab.export(scene, tmp_path / "breaking.kinefab").unity
    joints = [c for entry in unity.gameObjects for c in entry.components if hasattr(c, "breakForce")]
    assert [(joint.breakForce, joint.breakTorque) for joint in joints] == [(300.0, math.inf)] * 5


@pytest.mark.parametrize(
    "value, error", [(0.0, ValueError), (-1, ValueError), (math.nan, ValueError), ("3", TypeError)]
)
def test_a_joint_breaks_at_something(value, error):
    """A joint that breaks at nothing is none."""
    scene = kinefab.Scene()
    with pytest.raises(error, match="the break_torque is"):
        scene.add_fixed(None, scene.add_part("Lid"), break_torque=value)
    assert scene.joints == []
