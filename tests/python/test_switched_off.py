"""A joint that the source switches off: in a .kinefab and USD it stays as it is, nothing is counted by it, other targets tell that they leave it out."""

from __future__ import annotations

import json
import math
import random
from dataclasses import replace
from pathlib import Path
from typing import Any

import kinefab
import pytest
import trimesh
from kinefab.diagnostics import Outcome, Report
from kinefab.model import Coupling, CouplingKind, Scene, Term
from kinefab.sources import read
from kinefab.views.overview import describe
from random_mechanisms import mechanism



def box() -> trimesh.Trimesh:
    return trimesh.creation.box((0.1, 0.3, 0.2))


def door(off: bool = True) -> Scene:
    """A base, a door on it and a leaf on the door, all off the axes; a latch and a stay that are switched off."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", box(), grounded=True)
    wing = scene.add_part("Door", box(), translation=(0.4, 1.0, 0.05))
    leaf = scene.add_part("Leaf", box(), translation=(0.9, 1.1, 0.1))
    scene.add_hinge(base, wing, point=(0.2, 1, 0), axis=(0, 1, 0.2), limits=(0, 110), name="Hinge")
    scene.add_hinge(wing, leaf, point=(0.6, 1, 0.02), axis=(0, 1, 0.1), name="Fold")
    if off:
        scene.add_fixed(wing, leaf, name="Latch")
        scene.add_hinge(None, leaf, point=(1, 1, 0.3), axis=(1, 0.2, 0), limits=(-10, 20), name="Stay")
        scene.joints[-2:] = [replace(joint, enabled=False) for joint in scene.joints[-2:]]
    return scene


def exported(source: Any, path: Path, **options: Any) -> tuple[dict[str, Any], kinefab.ExportResult]:
    result = kinefab.export(source, path, kinefab.ExportOptions(**options))
    return json.loads(path.read_text("utf-8")) if path.suffix == ".kinefab" else {}, result


def joints(content: dict[str, Any]) -> list[dict[str, Any]]:
    return [c for entry in content["gameObjects"] for c in entry["components"] if c["type"].endswith("Joint")]


def dropped(result: kinefab.ExportResult) -> list[tuple[str, str]]:
    return [(o.feature, o.code) for o in result.report.outcomes if o.outcome is Outcome.DROPPED]


def test_a_scene_has_them_and_counts_nothing_by_them(tmp_path):
    content, result = exported(door(), tmp_path / "door.kinefab")
    without, _ = exported(door(off=False), tmp_path / "without.kinefab")
    assert [(c["name"], c.get("enabled", True)) for c in joints(content)] == [
        ("Hinge", True), ("Fold", True), ("Latch", False), ("Stay", False),
    ]  # fmt: skip
    assert content["analysis"] == without["analysis"] and content["analysis"]["mobility"] == 2
    on = [c for c in joints(content) if c.get("enabled", True)]
    assert on == joints(without), "what is counted of those that hold is the same"
    assert dropped(result) == []
    assert {o.feature: o.code for o in result.report.outcomes}["joint Latch"] == "JOINT_DISABLED"


@pytest.mark.parametrize("kind", ["revolute", "prismatic", "cylindrical", "spherical", "universal", "fixed", "planar"])
@pytest.mark.parametrize("ground", [False, True])
def test_it_is_the_component_that_would_hold(tmp_path, kind, ground):
    """Field by field that of the same joint switched on, but for what the analysis finds of that."""
    found = []
    for enabled in (True, False):
        scene = kinefab.Scene()
        base = scene.add_part("Base", box(), grounded=True, translation=(0.1, 0.2, 0.3))
        leaf = scene.add_part("Leaf", box(), translation=(0.9, 1.1, 0.1))
        scene.add_joint(kind, None if ground else base, leaf, point=(0.6, 1, 0.02), axis=(0.3, 1, 0.1), name="Stay")
        scene.joints[0] = replace(scene.joints[0], enabled=enabled, because=("Mate:1",))
        content, _ = exported(scene, tmp_path / f"{enabled}.kinefab")
        found.append([{k: v for k, v in c.items() if k not in ("enabled", "because")} for c in joints(content)])
    on, off = found
    assert len(off) == 1
    assert on == off or kind == "fixed"  # which is no joint where it holds: base and leaf are one body


@pytest.mark.parametrize("ending", [".prefab", ".glb", ".unitypackage"])
def test_what_has_no_such_joint_says_so(tmp_path, ending):
    _, result = exported(door(), tmp_path / f"door{ending}")
    assert [(f, c) for f, c in dropped(result) if f.startswith("joint")] == [
        ("joint Latch", "JOINT_DISABLED_DROPPED"), ("joint Stay", "JOINT_DISABLED_DROPPED"),
    ]  # fmt: skip


def test_a_prefab_is_the_same_without_them(tmp_path):
    for folder, off in (("a", True), ("b", False)):
        (tmp_path / folder).mkdir()
        exported(door(off), tmp_path / folder / "Door.prefab")
    assert (tmp_path / "a" / "Door.prefab").read_bytes() == (tmp_path / "b" / "Door.prefab").read_bytes()


def test_links_leave_them_out_and_say_so(tmp_path):
    content, result = exported(door(), tmp_path / "door.kinefab", writing={"physics": "articulation"})
    assert not joints(content)
    assert [c for _, c in dropped(result)] == ["JOINT_DISABLED_DROPPED", "JOINT_DISABLED_DROPPED"]


def test_a_scene_is_read_back_with_them(tmp_path):
    path = tmp_path / "door.kinefab"
    first, _ = exported(door(), path)
    scene = read(path, Report())
    assert {joint.name: joint.enabled for joint in scene.joints} == {
        "Hinge": True, "Fold": True, "Latch": False, "Stay": False,
    }  # fmt: skip
    (tmp_path / "again").mkdir()
    again, _ = exported(path, tmp_path / "again" / "door.kinefab")
    assert again == first
    anew, _ = exported(path, tmp_path / "again" / "door.kinefab", closures="minimal")
    assert sorted((c["name"], c.get("enabled", True)) for c in joints(anew)) == [
        ("Fold", True), ("Hinge", True), ("Latch", False), ("Stay", False),
    ]  # fmt: skip
    driven = kinefab.motion(path)
    assert len(driven.coordinates) == 2


def test_a_coupling_that_counts_by_one_is_none(tmp_path):
    """Somebody switches off the joint of a geared pair: the scene keeps both, what cannot tells of both."""
    scene = door(off=False)
    gear = Coupling("Gear", CouplingKind.GEAR, scene.joints[1].id, 3, (Term(scene.joints[0].id, 3, 2.0),), 0.0)
    scene.couplings.append(gear)
    path = tmp_path / "door.kinefab"
    content, _ = exported(scene, path)
    for component in joints(content):
        if component["name"] == "Fold":
            component["enabled"] = False
    content["version"] = "1.1"
    path.write_text(json.dumps(content), "utf-8")
    (tmp_path / "again").mkdir()
    again, _ = exported(path, tmp_path / "again" / "door.kinefab")
    assert again["couplings"] == content["couplings"]
    for name in ("Door.prefab", "door.glb"):
        _, result = exported(path, tmp_path / name)
        assert ("joint Fold", "JOINT_DISABLED_DROPPED") in dropped(result)
        assert any(feature == "coupling Gear" for feature, _ in dropped(result)), name
    assert len(kinefab.motion(path).coordinates) == 1


def test_two_sides_of_one_body_are_told(tmp_path):
    scene = kinefab.Scene()
    a = scene.add_part("A", box())
    b = scene.add_part("B", box(), translation=(0.5, 0, 0))
    scene.add_fixed(a, b, name="Weld")
    scene.add_hinge(a, b, point=(0.2, 0, 0), axis=(0, 0, 1), name="Spare")
    scene.joints[-1] = replace(scene.joints[-1], enabled=False)
    _, result = exported(scene, tmp_path / "pair.kinefab")
    assert dropped(result) == [("joint Spare", "JOINT_DISABLED_DROPPED")]


def test_what_is_driven_is_not_held_by_them(tmp_path):
    assert kinefab.motion(door()).mobility == 2


@pytest.mark.parametrize(("kind", "code"), [("free", "JOINT_REMOVES_NOTHING"), ("planar", "JOINT_WITHOUT_BODY")])
def test_what_would_be_no_component_is_none(tmp_path, kind, code):
    scene = kinefab.Scene()
    part = scene.add_part("A", box(), translation=(0.5, 0, 0))
    scene.add_joint(kind, None, part, point=(0.2, 0, 0), axis=(0, 0, 1), name="Spare")
    scene.joints[0] = replace(scene.joints[0], enabled=False)
    scene.nodes[0] = replace(scene.nodes[0], suppressed=kind == "planar")
    content, result = exported(scene, tmp_path / "a.kinefab")
    assert not joints(content) and dropped(result) == [("joint Spare", code)]


def test_inspect_says_that_it_is_switched_off(tmp_path):
    content, _ = exported(door(), tmp_path / "door.kinefab")
    assert [joint["enabled"] for joint in describe(content)["joints"]] == [True, True, False, False]


def test_usd_keeps_them(tmp_path):
    pytest.importorskip("pxr", reason="usd-core is not installed")
    path = kinefab.export(door(), tmp_path / "door.usda").path
    report = Report()
    scene = read(path, report)
    report.raise_for_errors()
    assert {joint.name: joint.enabled for joint in scene.joints if joint.name} == {
        "Hinge": True, "Fold": True, "Latch": False, "Stay": False,
    }  # fmt: skip
    (stay,) = (joint for joint in scene.joints if joint.name == "Stay")
    assert [math.degrees(x) for x in (stay.freedoms[3].lower, stay.freedoms[3].upper)] == pytest.approx([-10, 20])


@pytest.mark.parametrize("seed", range(12))
def test_a_random_mechanism_is_the_one_without_them(tmp_path, seed):
    """Every object, component and count, whichever joints are off; of the source alone the two differ."""
    chance, found = random.Random(seed), []
    off = {joint.id for joint in mechanism(seed).joints if chance.random() < 0.4}
    for name in ("off", "without"):
        scene = mechanism(seed)
        if name == "off":
            scene.joints = [replace(joint, enabled=joint.id not in off) for joint in scene.joints]
        else:
            scene.joints = [joint for joint in scene.joints if joint.id not in off]
        content, _ = exported(scene, tmp_path / f"{name}.kinefab")
        for entry in content["gameObjects"]:
            entry["components"] = [c for c in entry.get("components", ()) if c.get("enabled", True)]
        found.append({key: content.get(key) for key in ("gameObjects", "couplings", "analysis", "ignoredCollisions")})
    assert found[0] == found[1]
