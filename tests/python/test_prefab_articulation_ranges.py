"""Ranges that a ConfigurableJoint cannot hold and a link can: each target decides, and tells."""

from __future__ import annotations

import json
import re
from pathlib import Path

import kinefab
import pytest
import trimesh


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
