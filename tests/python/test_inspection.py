"""What the reading of a written scene refuses."""

from __future__ import annotations

import json
import os
from pathlib import Path

import kinefab
import pytest
from kinefab.diagnostics import diagnostic_table
from kinefab.unity.back.scene_file import read_scene
from kinefab.views.overview import overview, picture


@pytest.mark.parametrize("number", ["NaN", "-Infinity", "1e999"])
@pytest.mark.parametrize("show", [lambda path: overview(path, True), picture], ids=["inspect", "draw"])
def test_number_that_is_not_finite_is_a_finding(tmp_path, number, show):
    """Python's JSON would let them pass, and write them on into what is no JSON."""
    path = tmp_path / "bad.kinefab"
    scene = {"format": "kinefab.scene", "version": "1.0", "gameObjects": [], "extras": {"own": "MARK"}}
    path.write_text(json.dumps(scene).replace('"MARK"', number), encoding="utf-8")
    with pytest.raises(kinefab.KinefabError) as raised:
        show(path)
    (found,) = raised.value.diagnostics
    assert found.code == ("NUMBER_NOT_FINITE" if number == "1e999" else "JSON_SYNTAX")
    assert found.where == f"{path}#/extras/own"


def test_a_folder_is_a_finding(tmp_path):
    (tmp_path / "folder.kinefab").mkdir()
    with pytest.raises(kinefab.KinefabError, match="SOURCE_IS_FOLDER"):
        read_scene(tmp_path / "folder.kinefab")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes with a name")
def test_a_pipe_is_a_finding_and_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "pipe.kinefab")
    with pytest.raises(kinefab.KinefabError, match="SCENE_UNREADABLE.*no regular file"):
        read_scene(tmp_path / "pipe.kinefab")


def test_a_path_that_no_system_takes_is_a_finding(tmp_path):
    with pytest.raises(kinefab.KinefabError, match="SCENE_UNREADABLE"):
        read_scene(tmp_path / "a\0b.kinefab")


BODY = {"type": "Rigidbody"}


def part(*components):
    return {"id": "a", "name": "a", "components": [BODY, *components]}


@pytest.mark.parametrize("index", [-1, 1, True, 0.5, "a"])
@pytest.mark.parametrize(
    "fields, place",
    [
        ({"gameObjects": [{"id": "a", "name": "a", "parent": "MARK"}]}, "gameObjects/0/parent"),
        ({"gameObjects": [part({"type": "HingeJoint", "connectedBody": "MARK"})]},
         "gameObjects/0/components/1/connectedBody"),
        ({"gameObjects": [part({"type": "MeshFilter", "mesh": "MARK"})]}, "gameObjects/0/components/1/mesh"),
        ({"gameObjects": [part({"type": "MeshRenderer", "materials": ["MARK"]})], "materials": [{"name": "m"}]},
         "gameObjects/0/components/1/materials/0"),
        ({"gameObjects": [], "materials": [{"name": "m", "colorTexture": {"image": "MARK"}}]},
         "materials/0/colorTexture/image"),
    ],
)  # fmt: skip
def test_index_that_leads_nowhere_is_a_finding(tmp_path, fields, place, index):
    """Told with its place; also a negative one, which Python would count from the end of the list."""
    path = tmp_path / "bad.kinefab"
    scene = {"format": "kinefab.scene", "version": "1.0", **fields}
    path.write_text(json.dumps(scene).replace('"MARK"', json.dumps(index)), encoding="utf-8")
    with pytest.raises(kinefab.KinefabError) as raised:
        read_scene(path)
    (found,) = raised.value.diagnostics
    leads_nowhere = "PARENT_NOT_EARLIER" if place.endswith("parent") else "REFERENCE_UNRESOLVED"
    assert found.code == (leads_nowhere if type(index) is int else "TYPE_MISMATCH")
    assert found.where == f"{path}#/{place}"


def test_what_is_lost_for_one_reason_is_told_once_with_its_code_and_remedy(tmp_path):
    """A sentence of 350 characters stood there once for each part, without the code and what to do."""
    hollow = {"code": "COLLIDERS_NOT_CUT", "message": "Hollow."}
    remedy = diagnostic_table()["COLLIDERS_NOT_CUT"]["remedy"]
    report = [
        {"feature": "collider A", "outcome": "approximated", **hollow},
        {"feature": "joint C", "outcome": "dropped", "code": "UNIT_UNKNOWN", "message": "Its unit."},
        {"feature": "collider B", "outcome": "approximated", **hollow},
        {"feature": "joint D", "outcome": "dropped"},
        {"feature": "joint F", "outcome": "dropped", "code": "OF_TOMORROW", "message": "New."},
        {"feature": "joint E", "outcome": "kept"},
    ]
    path = tmp_path / "a.kinefab"
    scene = {"format": "kinefab.scene", "version": "1.0", "gameObjects": [], "report": report}
    path.write_text(json.dumps(scene), encoding="utf-8")
    assert overview(path, False).splitlines()[-6:] == [
        f"  approximated 2 features COLLIDERS_NOT_CUT: Hollow. {remedy}",
        "    collider A",
        "    collider B",
        "  dropped joint C UNIT_UNKNOWN: Its unit.",
        "  dropped joint D",
        "  dropped joint F OF_TOMORROW: New.",
    ]


def test_a_joint_is_told_with_what_it_leaves_and_what_it_does_in_a_loop():
    lever = Path(__file__).resolve().parents[2] / "fixtures" / "lever" / "lever.kinefab"
    told = overview(lever, False).splitlines()
    assert "  Lever/Crank:1 -> world: HingeJoint, turn X" in told
    assert sum(line.endswith(", closes a loop") for line in told) == 1
