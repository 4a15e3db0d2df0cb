"""What a scene file keeps of its source beside Unity's fields counts until a program changes those."""

from __future__ import annotations

import copy
import json
import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.spatial import rotation_about

Change = Callable[[dict[str, Any]], None]


def door() -> kinefab.Scene:
    """A frame of 3 kg that stands, a door on a hinge of -10 to 80 degrees that stands at 20, and a bolt on a slide of 0 to 0.3 m."""
    scene = kinefab.Scene()
    frame = scene.add_part("Frame", trimesh.creation.box((0.1, 2.0, 0.1)), translation=(-0.45, 0, 0), mass=3.0, grounded=True)
    leaf = scene.add_part("Leaf", trimesh.creation.box((0.8, 2.0, 0.04)), mass=9.0)
    bolt = scene.add_part("Bolt", trimesh.creation.box((0.2, 0.02, 0.02)), mass=0.2)
    scene.add_hinge(frame, leaf, point=(-0.4, 0.3, 0), axis=(0, 1, 0), limits=(-10, 80), name="Hinge")
    scene.add_slider(leaf, bolt, point=(0.3, 0, 0), axis=(1, 0, 0), limits=(0, 0.3), name="Slide")
    hinge = scene.joints[0]
    back = kinefab.Pose(rotation_about(np.array([1.0, 0.0, 0.0]), -np.radians(20.0)))
    scene.joints[0] = replace(hinge, frame_b=hinge.frame_b @ back)
    return scene


def written(folder: Path) -> tuple[Path, dict[str, Any]]:
    path = kinefab.export(door(), folder / "door.kinefab").path
    return path, json.loads(path.read_text("utf-8"))


def component(document: dict[str, Any], kind: str) -> dict[str, Any]:
    return next(c for entry in document["gameObjects"] for c in entry.get("components", ()) if c["type"] == kind)


def read(path: Path, document: dict[str, Any]) -> kinefab.Scene:
    path.write_text(json.dumps(document), "utf-8")
    return kinefab.sources.read(path, kinefab.Report())


def joint(scene: kinefab.Scene, name: str) -> kinefab.Joint:
    return next(joint for joint in scene.joints if joint.name == name)


def test_an_unchanged_scene_has_the_sources_joints_masses_and_choices(tmp_path: Path):
    source, (path, document) = door(), written(tmp_path)
    scene = read(path, document)
    assert [(own.id, own.a, own.b) for own in scene.joints] == [(own.id, own.a, own.b) for own in source.joints]
    for own, other in zip(scene.joints, source.joints):
        assert np.allclose(own.frame_a.rotation, other.frame_a.rotation) and np.allclose(own.frame_b.rotation, other.frame_b.rotation)
        assert own.freedoms == other.freedoms
    assert scene.nodes[0].mass is not None and scene.nodes[0].mass.mass == 3.0
    assert all(node.colliders is None for node in scene.nodes)


def range_of_the_hinge(document: dict[str, Any]) -> None:
    component(document, "HingeJoint")["limits"]["max"] += 5.0


def axis_of_the_hinge(document: dict[str, Any]) -> None:
    component(document, "HingeJoint")["axis"] = [0, 0.6, 0.8]


def place_of_the_leaf(document: dict[str, Any]) -> None:
    entry = next(entry for entry in document["gameObjects"] if entry["id"] == "Leaf")
    entry["transform"] = {"localRotation": [0, 0.1, 0, 0.99498743710662]}


def sides_of_the_hinge(document: dict[str, Any]) -> None:
    del component(document, "HingeJoint")["connectedPart"]


@pytest.mark.parametrize("change", [range_of_the_hinge, axis_of_the_hinge, place_of_the_leaf, sides_of_the_hinge])
def test_a_changed_joint_is_what_its_component_says(change: Change, tmp_path: Path):
    path, document = written(tmp_path)
    change(document)
    bare = copy.deepcopy(document)
    del component(bare, "HingeJoint")["extras"]
    told, untold = (joint(read(path, own), "Hinge") for own in (document, bare))
    assert told.freedoms == untold.freedoms
    assert np.array_equal(told.frame_b.rotation, untold.frame_b.rotation)


def test_a_joints_own_words_are_the_components(tmp_path: Path):
    path, document = written(tmp_path)
    
    component(document, "HingeJoint").update(name="Pivot", breakForce=40.0, enableCollision=True)
    own = joint(read(path, document), "Pivot")
    assert (own.break_force, own.collide) == (40.0, True)
    assert own.freedoms == joint(door(), "Hinge").freedoms


def box_of_the_frame(document: dict[str, Any]) -> None:
    component(document, "BoxCollider")["size"][1] *= 2.0


def trigger(document: dict[str, Any]) -> None:
    component(document, "BoxCollider")["isTrigger"] = True


@pytest.mark.parametrize("change", [box_of_the_frame, trigger])
def test_a_changed_collider_is_stated(change: Change, tmp_path: Path):
    path, document = written(tmp_path)
    change(document)
    scene = read(path, document)
    changed = [node for node in scene.nodes if node.colliders is not None]
    assert len(changed) == 1 and changed[0].colliders is not None
    assert changed[0].colliders[0].trigger is (change is trigger)


WRONG: list[Any] = [None, True, -1, 1e39, 0.5, "", "hinge", [], [1, 2], [0, 0, 0, 0], {}, {"x": 1}, [[1, 0], [0]], 10**300]


@pytest.mark.parametrize("seed", range(120))
def test_what_is_no_sound_joint_or_mass_is_none(seed: int, tmp_path: Path):
    """One value of what stands beside, replaced by another: nothing is raised, and the joint is the source's or the component's."""
    draw = random.Random(seed)
    path, document = written(tmp_path)
    bare = copy.deepcopy(document)
    places: list[tuple[Any, Any]] = []
    for entry in document["gameObjects"]:
        for own in (entry, *entry.get("components", ())):
            waiting: list[tuple[Any, Any]] = [(own["extras"], "asStated")] if "asStated" in own.get("extras", {}) else []
            while waiting:
                at, key = waiting.pop()
                places.append((at, key))
                value = at[key]
                waiting += [(value, inner) for inner in (value if isinstance(value, dict) else range(len(value)) if isinstance(value, list) else ())]
    at, key = draw.choice(places)
    at[key] = draw.choice(WRONG)
    for entry in bare["gameObjects"]:
        for own in (entry, *entry.get("components", ())):
            own.pop("extras", None)
    scene, plain = read(path, document), read(path, bare)
    for own, component_says in zip(sorted(scene.joints, key=lambda j: j.id), sorted(plain.joints, key=lambda j: j.id)):
        assert own.id == component_says.id
        source = joint(door(), own.name)
        assert own.freedoms in (source.freedoms, component_says.freedoms)
