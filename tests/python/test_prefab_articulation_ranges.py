"""Ranges that a ConfigurableJoint cannot hold and a link can: each target decides, and tells."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import Report
from kinefab.sources import read


@pytest.fixture
def robot() -> kinefab.Scene:
    """A hinge from -11 to 225 degrees with a drive of a largest torque, which no HingeJoint has."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", trimesh.creation.box((0.1, 0.1, 0.1)), grounded=True)
    arm = scene.add_part("Arm", trimesh.creation.box((0.3, 0.05, 0.05)), translation=(0.2, 0.1, 0))
    drive = kinefab.Drive(stiffness=100.0, damping=5.0, max_force=50.0)
    scene.add_hinge(
        base, arm, point=(0, 0.1, 0), axis=(0, 1, 0), limits=(-11, 225), drive=drive, name="Turn"
    )
    return scene


def test_a_link_holds_what_a_joint_cannot(robot: kinefab.Scene, tmp_path: Path):
    options = kinefab.ExportOptions(writing={"physics": "articulation"})
    result = kinefab.export(robot, tmp_path / "r.prefab", options)
    text = "".join(p.read_text(encoding="utf-8") for p in tmp_path.rglob("*.prefab"))
    ends = {
        (float(low), float(high))
        for low, high in re.findall(r"lowerLimit: (\S+)\s+upperLimit: (\S+)", text)
        if float(low) != float(high)
    }
    assert any(sorted((abs(a), abs(b))) == pytest.approx([11.0, 225.0], abs=1e-3) for a, b in ends)
    assert "JOINT_LIMIT_BEYOND_TURN" not in {d.code for d in result.report.diagnostics}


def test_a_scene_file_keeps_the_range_beside_the_joint_and_tells(robot: kinefab.Scene, tmp_path: Path):
    result = kinefab.export(robot, tmp_path / "r.kinefab")
    objects = json.loads((tmp_path / "r.kinefab").read_text(encoding="utf-8"))["gameObjects"]
    (joint,) = (c for o in objects for c in o.get("components", ()) if c["type"] == "ConfigurableJoint")
    assert joint["extras"]["angularXRange"] == pytest.approx([-11.0, 225.0], abs=1e-6)
    assert "JOINT_LIMIT_BEYOND_TURN" in {d.code for d in result.report.diagnostics}


SWINGS = (-70.0, 20.0)
SECOND = (-0.2, 3.0, 1.0)


def shoulder(a_stands: bool, b_stands: bool) -> kinefab.Scene:
    """A universal joint of which the second axis goes further to one side."""
    scene = kinefab.Scene()
    box = trimesh.creation.box((0.1, 0.1, 0.1))
    parts = [
        scene.add_part("A", box, translation=(0, 0.2, 0), grounded=a_stands),
        scene.add_part("B", box, translation=(0.2, 0, 0.1), grounded=b_stands),
    ]
    low, high = np.radians(SWINGS)
    swing = kinefab.model.Freedom(kinefab.model.Motion.LIMITED, float(low), float(high))
    scene.add_joint("universal", *parts, point=(0.1, 0.1, 0), axis=(1, 0, 0.2), secondary=SECOND, name="Shoulder")
    joint = scene.joints[-1]
    scene.joints[-1] = replace(joint, freedoms=(*joint.freedoms[:5], swing))
    return scene


def swing_of(path: Path) -> tuple[float, float]:
    """The range of B against A about the second axis, degrees, as a written scene is read again."""
    scene = read(path, Report())
    (joint,) = scene.joints
    (index,) = (i for i, f in enumerate(joint.freedoms) if f.motion is kinefab.model.Motion.LIMITED)
    axis = (scene.pose(joint.a) @ joint.frame_a).rotation[:, index - 3]
    along = float(axis @ SECOND) / float(np.linalg.norm(SECOND))
    assert abs(along) == pytest.approx(1.0)
    b_in_a = scene.name(joint.a) == "A" or scene.name(joint.b) == "B"
    sense = np.sign(along) * (1.0 if b_in_a else -1.0)
    limits = joint.freedoms[index]
    low, high = sorted(sense * end for end in np.degrees((limits.lower, limits.upper)))
    return low, high


@pytest.mark.parametrize("stands", [(True, False), (False, True), (False, False)])
def test_a_swing_further_to_one_side_is_kept_beside_the_joint(tmp_path: Path, stands: tuple[bool, bool]):
    result = kinefab.export(shoulder(*stands), tmp_path / "r.kinefab")
    assert swing_of(tmp_path / "r.kinefab") == pytest.approx(SWINGS)
    assert "JOINT_LIMIT_ASYMMETRIC" in {d.code for d in result.report.diagnostics}


def test_a_link_holds_a_swing_further_to_one_side(tmp_path: Path):
    options = kinefab.ExportOptions(writing={"physics": "articulation"})
    for stands in ((True, False), (False, False)):
        result = kinefab.export(shoulder(*stands), tmp_path / "r.kinefab", options)
        assert swing_of(tmp_path / "r.kinefab") == pytest.approx(SWINGS)
        assert "JOINT_LIMIT_ASYMMETRIC" not in {d.code for d in result.report.diagnostics}


def test_a_link_that_swings_the_other_way_round_tells(tmp_path: Path):
    """Its parent is the joint's second side, and seen from there the twist turns the swing's axis."""
    options = kinefab.ExportOptions(writing={"physics": "articulation"})
    result = kinefab.export(shoulder(False, True), tmp_path / "r.kinefab", options)
    assert "JOINT_LIMIT_ASYMMETRIC" in {d.code for d in result.report.diagnostics}


def test_a_link_holds_one_swing_beside_a_free_one(tmp_path: Path):
    """A ConfigurableJoint then limits how far X rises; a link has ends about each axis."""
    scene = shoulder(True, False)
    limited = scene.joints[0].freedoms[5]
    free = kinefab.model.FREE
    even = replace(limited, lower=-0.5, upper=0.5)
    kind = kinefab.model.JointKind.SPHERICAL
    freedoms = (*scene.joints[0].freedoms[:3], free, even, free)
    scene.joints[0] = replace(scene.joints[0], kind=kind, freedoms=freedoms)
    assert "JOINT_LIMIT_ELEVATION" in codes(scene, tmp_path, "rigidbody")
    assert "JOINT_LIMIT_ELEVATION" not in codes(scene, tmp_path, "articulation")


def codes(scene: kinefab.Scene, folder: Path, physics: str) -> set[str]:
    options = kinefab.ExportOptions(writing={"physics": physics})
    return {d.code for d in kinefab.export(scene, folder / "r.kinefab", options).report.diagnostics}
