"""The forward kinematics of the tests is itself tested: against closed forms, and against joints of known signs."""

from __future__ import annotations

import json
import math
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.model import JointKind
from scene_kinematics import CAD, ROS, Y_UP, Coordinate, SceneKinematics, about, difference, unity_pose

FIXTURES = Path(__file__).parents[2] / "fixtures"


def exported(scene, path) -> SceneKinematics:
    return SceneKinematics.load(kinefab.export(scene, path / "scene.kinefab").path)


@pytest.mark.parametrize("grounded_side", ["a", "b"])
@pytest.mark.parametrize("angle", [-7.0, 33.0])
def test_a_hinge_turns_as_the_right_hand_says(tmp_path, angle, grounded_side):
    """The source's q about its axis, by the right-hand rule of b against a, is the hinge's angle; mirrored last."""
    scene = kinefab.Scene()
    first = scene.add_part("base", grounded=grounded_side == "a", translation=(0.3, -0.2, 0.5))
    second = scene.add_part("arm", grounded=grounded_side == "b", translation=(1.0, 0.4, -0.2))
    axis, point = np.array([0.36, 0.48, 0.8]), np.array([0.2, 0.1, -0.3])
    scene.add_hinge(first, second, point=point, axis=axis, limits=(-10, 80))
    motion = exported(scene, tmp_path)
    (coordinate,) = [c for joint in motion.joints for c in joint.coordinates]
    assert motion.joints[0].range(coordinate.name) == pytest.approx((-10.0, 80.0))
    name, sign, at = (
        ("arm", 1.0, (1.0, 0.4, -0.2)) if grounded_side == "a" else ("base", -1.0, (0.3, -0.2, 0.5))
    )
    turn = about(axis, sign * math.radians(angle))
    expected = unity_pose(turn, point + turn @ (np.array(at) - point), Y_UP)
    metres, radians = difference(expected, motion.pose_of(name, motion.poses({coordinate: angle})))
    assert metres < 1e-11 and radians < 1e-11


@pytest.mark.parametrize("travel", [-0.05, 0.31])
def test_a_slide_goes_along_its_axis(tmp_path, travel):
    scene = kinefab.Scene()
    base = scene.add_part("base", grounded=True)
    arm = scene.add_part("arm", translation=(1.0, 0.4, -0.2))
    scene.add_slider(base, arm, point=(0.2, 0.1, -0.3), axis=(0.36, 0.48, 0.8), limits=(-0.1, 0.8))
    motion = exported(scene, tmp_path)
    (coordinate,) = motion.joints[0].coordinates
    assert motion.joints[0].range(coordinate.name) == pytest.approx((-0.1, 0.8))
    expected = unity_pose(np.eye(3), np.array([1.0, 0.4, -0.2]) + travel * np.array([0.36, 0.48, 0.8]), Y_UP)
    assert difference(expected, motion.pose_of("arm", motion.poses({coordinate: travel})))[0] < 1e-11


@pytest.mark.parametrize("kind", [JointKind.UNIVERSAL, JointKind.CYLINDRICAL, JointKind.PIN_SLOT])
def test_joints_of_two_motions_move_as_in_the_model(tmp_path, kind):
    """b's frame in a's is a translation along a's axes, then Rz Rx (Z in a, X in b), as ``model.Joint`` has it."""
    scene = kinefab.Scene()
    base = scene.add_part("base", translation=(0.3, -0.2, 0.5), rotation=about((0.6, 0.0, 0.8), 0.4))
    arm = scene.add_part("arm", translation=(1.0, 0.4, -0.2))
    foot = scene.add_part("foot", grounded=True)
    scene.add_hinge(foot, base, point=(0.1, 0.0, 0.0), axis=(0.0, 0.0, 1.0), name="root")
    point, x = np.array([0.2, 0.1, -0.3]), np.array([0.36, 0.48, 0.8])
    joint = scene.add_joint(kind, base, arm, point=point, axis=x, name="joint")
    motion = exported(scene, tmp_path)
    joint_of = next(j for j in motion.joints if len(j.coordinates) == 2)
    on_b = motion.objects[joint_of.game_object]["name"] == "arm"
    r, t = unity_pose(scene.pose(base).rotation @ joint.frame_a.rotation, point, Y_UP)
    values = dict(zip(joint_of.coordinates, (17.0, -8.0) if kind is JointKind.UNIVERSAL else (0.07, 31.0)))
    poses = motion.poses(values)
    assert max(motion.gap(joint_of, poses)) < 1e-12
    d, turns = np.zeros(3), []
    for axis in (2, 0):  # Rz Rx: the right-hand turns of the source, seen in the mirror
        for coordinate, value in values.items():
            component_axis = (
                motion.placed[joint_of.game_object][0]
                @ joint_of.own_frame[0][:, "XYZ".find(coordinate.name[-1])]
            )
            if coordinate.is_angle and abs(component_axis @ r[:, axis]) > 0.999:
                sense = (1.0 if on_b else -1.0) * (component_axis @ r[:, axis])
                turns.append(about(np.eye(3)[axis], sense * math.radians(value)))
    for coordinate, value in values.items():
        if not coordinate.is_angle:
            i = "xyz".index(coordinate.name)
            axis = motion.placed[joint_of.game_object][0] @ joint_of.own_frame[0][:, i]
            d = d + (1.0 if on_b else -1.0) * value * axis
    turn = np.linalg.multi_dot([r, *turns, r.T]) if turns else np.eye(3)
    start = motion.placed[motion.object("arm")]
    expected = turn @ start[0], t + d + turn @ (start[1] - t)
    metres, radians = difference(expected, motion.pose_of("arm", poses))
    assert metres < 1e-11 and radians < 1e-11


def test_the_lever_closes_where_its_equations_say():
    """The slider's way at crank angle t is r cos t + sqrt(l^2 - r^2 sin^2 t), from the paper; the loop has no gap there."""
    motion = SceneKinematics.load(FIXTURES / "lever" / "lever.kinefab")
    start = motion.poses({})
    assert max(difference(a, b)[0] for a, b in zip(start, motion.placed)) < 1e-9
    assert max(motion.gap(joint, start)[0] for joint in motion.joints) < 1e-9
    r, l, t0 = 0.025, 0.09, math.radians(30.0)
    for t in np.radians([-40.0, 0.0, 75.0]):
        way = r * math.cos(t) + math.sqrt(l**2 - (r * math.sin(t)) ** 2)
        way -= r * math.cos(t0) + math.sqrt(l**2 - (r * math.sin(t0)) ** 2)
        rod, rod0 = (math.asin(-r * math.sin(x) / l) for x in (t, t0))
        goals = {"Insert:1": t - t0, "Insert:4": (rod - t) - (rod0 - t0)}
        values = {motion.coordinate(name): math.degrees(goal) for name, goal in goals.items()}
        values[motion.coordinate("Mate:1")] = way
        poses = motion.poses(values)
        assert max(max(motion.gap(joint, poses)) for joint in motion.joints) < 1e-9


def test_turns_of_the_world_keep_lengths_and_change_the_hand():
    for turn in (ROS, CAD, Y_UP):
        assert np.allclose(turn @ turn.T, np.eye(3)) and np.linalg.det(turn) == pytest.approx(-1.0)
    assert ROS @ [1, 2, 3] == pytest.approx([-2, 3, 1])
    assert CAD @ [1, 2, 3] == pytest.approx([-1, 3, -2])


def test_couplings_are_followed_in_chains():
    document = {
        "gameObjects": [],
        "couplings": [
            {"b": {"gameObject": 2, "component": 1, "coordinate": "angle"}, "ratio": -3.0, "offset": 1.0,
             "a": {"gameObject": 1, "component": 1, "coordinate": "angle"}},
            {"b": {"gameObject": 1, "component": 1, "coordinate": "angle"}, "ratio": 2.0,
             "a": {"gameObject": 0, "component": 1, "coordinate": "angle"}},
        ],
    }  # fmt: skip
    one, two, three = (Coordinate(i, 1, "angle") for i in range(3))
    known = SceneKinematics(json.loads(json.dumps(document))).coupled({one: 5.0})
    assert known == {one: 5.0, two: 10.0, three: -29.0}


def test_links_of_one_name_in_models_beside_and_within_each_other_are_told_apart(tmp_path):
    """Also where fixed joints merge them into others, so that they are frames there."""
    inner = "<link name='l'/>"
    fixed = "<joint name='{0}' type='fixed'><parent>{1}</parent><child>{2}</child></joint>"
    path = tmp_path / "m.sdf"
    path.write_text(
        f"<sdf version='1.9'><model name='m'>{inner}<link name='t'/>"
        f"<model name='a'><pose>1 0 0 0 0 0</pose>{inner}<model name='b'><pose>0 2 0 0 0 0</pose>{inner}</model>"
        f"{fixed.format('f', 'l', 'b::l')}</model>"
        f"<model name='b'><pose>4 0 0 0 0 0</pose>{inner}</model>{fixed.format('k', 'l', 'b::l')}"
        f"{fixed.format('y', 'a::b::l', 't')}"
        "<joint name='j' type='revolute'><parent>l</parent><child>a::l</child><axis><xyz>0 0 1</xyz></axis></joint>"
        "</model></sdf>",
        encoding="utf-8",
    )
    kinefab.export(path, tmp_path / "m.kinefab")
    motion = SceneKinematics.load(tmp_path / "m.kinefab")
    places = {"m/l": (0, 0), "m/t": (0, 0), "m/a/l": (1, 0), "m/b/l": (4, 0), "m/a/b/l": (1, 2)}
    for name, (forward, left) in places.items():
        assert motion.placed[motion.object(name)][1] == pytest.approx((-left, 0.0, forward)), name
