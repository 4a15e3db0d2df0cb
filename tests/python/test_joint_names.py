"""A joint's own name reaches everyone who reads about it: the scene, inspect, draw, analyse."""

from __future__ import annotations

import json

import kinefab
import pytest
from command_line import LEVER, run
from golden import unnamed
from scenes import exported, lid_scene, read
from source_bundles import bundle, frame, part
from source_bundles import read as read_bundle

NAMES = ["Eccentric pin", "Shaft", "Slide", "Slider pin"]
"""Of the lever's joints."""


def test_names_of_the_lever_reach_scene_and_views(tmp_path):
    """In each component, in the text and the JSON of inspect, in the picture's legend."""
    scene, picture = tmp_path / "lever.kinefab", tmp_path / "lever.svg"
    assert run("export", LEVER, "-o", scene).returncode == 0
    written = [
        c for o in read(scene)["gameObjects"] for c in o.get("components", []) if c["type"].endswith("Joint")
    ]
    assert sorted(c["name"] for c in written) == NAMES
    told = json.loads(run("inspect", scene, "--json").stdout)["joints"]
    assert sorted(joint["name"] for joint in told) == NAMES
    text = run("inspect", scene).stdout
    assert run("draw", scene, "-o", picture).returncode == 0
    for name in NAMES:
        assert f"{name}: Lever/" in text
        assert f">{name} " in picture.read_text("utf-8")


def test_names_of_the_lever_reach_the_analysis():
    """In the table beside what the joint is, and in the JSON."""
    table = run("analyse", LEVER).stdout
    assert "Shaft: revolute" in table and "Slide: prismatic" in table
    told = json.loads(run("analyse", LEVER, "--json").stdout)["joints"]
    assert sorted(joint["name"] for joint in told) == NAMES


@pytest.mark.parametrize("named", [True, False])
def test_a_joint_without_a_name_writes_none(tmp_path, named):
    """Only what the source says; an id is no name."""
    joint = {"id": "J", "type": "revolute", "a": "ground", "b": "Arm", "frameA": frame((0, 0, 0), (0, 0, 1))}
    scene, _ = read_bundle(
        bundle(part("Arm"), joints=[joint | ({"name": 'Pin "A"'} if named else {})]), tmp_path
    )
    content, result = exported(scene, tmp_path)
    (written,) = [c for c in content["gameObjects"][0]["components"] if c["type"] == "HingeJoint"]
    assert written["id"] == "J" and written.get("name") == ('Pin "A"' if named else None)
    assert content["version"] == "1.1"
    older = json.loads(unnamed(result.path.read_text("utf-8")))
    assert older["version"] == "1.0" and "name" not in older["gameObjects"][0]["components"][-1]


def test_a_script_names_its_joints(tmp_path):
    """As in the README: the hinge of the lid."""
    content, _ = exported(lid_scene(), tmp_path)
    (hinge,) = [c for o in content["gameObjects"] for c in o["components"] if c["type"] == "HingeJoint"]
    assert (hinge["id"], hinge["name"]) == ("Hinge", "Hinge")


def test_names_of_format_1_0_are_read_as_before(tmp_path):
    """They stood in the extras of the component."""
    path = kinefab.export(lid_scene(), tmp_path / "lid.kinefab").path
    document = read(path)
    for entry in document["gameObjects"]:
        entry.pop("role", None)
        for component in entry.get("components", ()):
            component.pop("id", None)
            if name := component.pop("name", None):
                component["extras"] = {"name": name}
    document["version"] = "1.0"
    path.write_text(json.dumps(document), "utf-8")
    assert kinefab.motion(path).coordinates[0].name == "Hinge"
    again = read(kinefab.export(path, tmp_path / "again.kinefab").path)
    (hinge,) = [c for o in again["gameObjects"] for c in o.get("components", ()) if c["type"] == "HingeJoint"]
    assert "name" not in hinge and hinge["extras"] == {"name": "Hinge"}
