"""Several joints of one freedom between the same two bodies: MuJoCo's add up, all others hold together."""

from __future__ import annotations

import math

import kinefab
import numpy as np
import pytest
from kinefab.sources.robots.rigid_links import STAND_IN_SHARE
from scene_kinematics import SceneKinematics, about, difference, unity_point, unity_pose
from usd_stages import body, codes, joint, scene_of, stage

pytest.importorskip("pxr", reason="usd-core is not installed")

X, Y, Z = np.eye(3)
MARKED = '"MjcJointAPI", "NewtonJointAPI"'
POINT = np.array([0.3, -0.2, 0.5])


def place(axis: str, limits=(-40, 70)) -> str:
    return (
        f'uniform token physics:axis = "{axis}"\n point3f physics:localPos0 = (0.3, -0.2, 0.5)\n'
        f" float physics:lowerLimit = {limits[0]}\n float physics:upperLimit = {limits[1]}\n"
    )


def two_hinges(schemas: str = MARKED, second: str = "Y") -> str:
    """Bodies A and B, B on two hinges."""
    return stage(
        body("A")
        + body("B", at=POINT)
        + joint("PhysicsRevoluteJoint", "first", place("X"), "/A", schemas=schemas)
        + joint("PhysicsRevoluteJoint", "second", place(second), "/A", schemas=schemas)
    )


def moved(folder, text: str) -> SceneKinematics:
    scene, _ = scene_of(folder, text)
    assert scene is not None
    return SceneKinematics.load(kinefab.export(scene, folder / "scene.kinefab").path)


def test_hinges_that_add_up_turn_one_in_the_other(tmp_path):
    """B turns about X of A by the first, and about its own Y by the second: R = Rx Ry."""
    motion = moved(tmp_path, two_hinges())
    random = np.random.default_rng(5)
    for _ in range(20):
        angles = random.uniform(-0.6, 1.2, 2)
        values = {}
        for name, axis, angle in zip(("first", "second"), (X, Y), angles):
            coordinate, sense = motion.reading(name, unity_point(axis), True, "B")
            values[coordinate] = sense * math.degrees(angle)
        expected = unity_pose(about(X, angles[0]) @ about(Y, angles[1]), POINT)
        assert max(difference(expected, motion.pose_of("B", motion.poses(values)))) < 1e-6


def test_slides_and_a_hinge_that_add_up_keep_their_ranges(tmp_path):
    text = stage(
        body("A")
        + body("B", at=POINT)
        + joint("PhysicsPrismaticJoint", "x", place("X", (-0.25, 0.5)), "/A", schemas=MARKED)
        + joint("PhysicsPrismaticJoint", "y", place("Y", (-0.5, 0.75)), "/A", schemas=MARKED)
        + joint("PhysicsRevoluteJoint", "turn", place("Z"), "/A", schemas=MARKED)
    )
    motion = moved(tmp_path, text)
    for name, axis, is_angle, ends in (
        ("x", X, False, (-0.25, 0.5)),
        ("y", Y, False, (-0.5, 0.75)),
        ("turn", Z, True, (-40.0, 70.0)),
    ):
        coordinate, sense = motion.reading(name, unity_point(axis), is_angle, "B")
        assert motion.range_of(coordinate) == pytest.approx(sorted(sense * end for end in ends)), name


def test_light_bodies_stand_between_them_and_are_told(tmp_path):
    scene, report = scene_of(tmp_path, two_hinges())
    (middle,) = (node for node in scene.nodes if node.id == "B first")
    assert middle.mass.mass == pytest.approx(STAND_IN_SHARE * 2.0) and middle.colliders == ()
    told = [o for o in report.outcomes if o.code == "USD_JOINTS_STACKED"]
    assert [(o.feature, o.outcome.value) for o in told] == [("joints of B", "approximated")]


@pytest.mark.parametrize("second", ["Y", "X"])
def test_joints_that_nothing_marks_hold_together_and_are_told(tmp_path, second):
    """Two hinges across each other leave nothing, two on one axis are one."""
    scene, report = scene_of(tmp_path, two_hinges(schemas="", second=second))
    assert "USD_JOINTS_INTERSECT" in codes(report)
    result = kinefab.export(scene, tmp_path / "scene.kinefab")
    (made,) = SceneKinematics.load(result.path).joints
    assert made.kind == ("FixedJoint" if second == "Y" else "HingeJoint")


def test_joints_that_add_up_away_from_their_zero_are_told(tmp_path):
    text = two_hinges().replace("(0.3, -0.2, 0.5)", "(0.3, -0.2, 0.6)", 1)
    assert "USD_JOINTS_INTERSECT" in codes(scene_of(tmp_path, text)[1])
