"""glTF and USD from a scene file are those from its source, node by node and number by number: every fixture, and machines at random.

USD's layers are looked at as the target fills them, through a stand-in for usd-core (``usd_stand_in``), whether that is installed or not.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import kinefab
import numpy as np
import pytest
import trimesh
from articulations import machine
from kinefab.geometry.looks.gltf_document import gltf_document
from kinefab.model import Body, Collider, ColliderKind, Mesh, PhysicsMaterial
from kinefab.spatial import rotation_exp
from test_sources_kinefab_options import SOURCES

CLOSE = 1e-9
"""Of numbers: a scene file has twelve digits of each."""
ROUNDED = 1e-6
"""Of numbers of meshes and what is made of them, which have 32 bits in it."""
IDENTITY = {"translation": (0.0, 0.0, 0.0), "rotation": (0.0, 0.0, 0.0, 1.0)}
PLACED = {"xformOp:translate": (0.0, 0.0, 0.0), "xformOp:orient": (1.0, 0.0, 0.0, 0.0)}
TURNS = ("rotation", "xformOp:orient", "Rot0", "Rot1", "principalAxes", "inertiaOrientation")
"""Ends of the names of quaternions, of which each and its negative are one rotation."""


def apart(one: Any, other: Any, where: str = "") -> Iterator[str]:
    """Places at which two values differ."""
    if isinstance(one, dict) and isinstance(other, dict):
        for key in sorted(one.keys() | other.keys()):
            usual = (IDENTITY | PLACED).get(key)
            yield from apart(one.get(key, usual), other.get(key, usual), f"{where}/{key}")
    elif isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        if one.shape != other.shape or not np.allclose(one, other, rtol=ROUNDED, atol=ROUNDED):
            yield f"{where}: arrays"
    elif isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        if len(one) != len(other):
            yield f"{where}: {one}, {other}"
        elif where.endswith(TURNS) and one and np.dot(one, other) < 0.0:
            yield from apart([-value for value in one], other, where)
        else:
            for index, pair in enumerate(zip(one, other)):
                yield from apart(*pair, f"{where}/{index}")
    elif isinstance(one, (int, float)) and isinstance(other, (int, float)):
        if one != other and not abs(one - other) <= CLOSE * max(1.0, abs(one)):
            yield f"{where}: {one}, {other}"
    elif one != other:
        yield f"{where}: {one}, {other}"


def glb(path: Path) -> tuple[dict[str, Any], list[np.ndarray]]:
    """The document, and the numbers of its accessors; images as bytes of theirs."""
    document = gltf_document(path)
    data = path.read_bytes()
    start = 20 + int.from_bytes(data[12:16], "little") + 8
    views = [
        data[start + view.get("byteOffset", 0) :][: view["byteLength"]] for view in document.pop("bufferViews", [])
    ]
    widths = {5126: "<f4", 5125: "<u4", 5123: "<u2", 5121: "<u1"}
    accessors = document.get("accessors", [])
    numbers = [np.frombuffer(views[a["bufferView"]], widths[a["componentType"]]) for a in accessors]
    for accessor in accessors:
        accessor["numbers"] = [np.array(accessor.pop(end, ()), dtype=np.float64) for end in ("min", "max")]
    return document, numbers


def exported(source: object, target: Path, options: kinefab.ExportOptions) -> Path | list[str]:
    """The file that is written, or why none is."""
    target.parent.mkdir(parents=True, exist_ok=True)
    try:
        return kinefab.export(source, target, options).path  # pyright: ignore[reportArgumentType]
    except kinefab.KinefabError as error:
        return sorted(f"{finding.code} {finding.message}" for finding in error.diagnostics)


def roads(
    source: object, folder: Path, name: str, container: str, options: kinefab.ExportOptions
) -> Iterator[Path | list[str]]:
    """What is written from the source, and from its scene file."""
    yield exported(source, folder / "direct" / name, options)
    scene = exported(source, folder / container / "scene.kinefab", replace(options, writing={"container": container}))
    yield scene if isinstance(scene, list) else exported(scene, folder / "again" / name, kinefab.ExportOptions())


@pytest.fixture(scope="module")
def layers() -> Iterator[Any]:
    """The stand-in's ``Sdf``; the modules that know it are gone afterwards."""
    stand_in = str(Path(__file__).with_name("usd_stand_in"))

    def taken() -> dict[str, Any]:
        found = [name for name in sys.modules if name.partition(".")[0] == "pxr" or name.startswith("kinefab.targets.usd")]
        return {name: sys.modules.pop(name) for name in found}

    before = taken()
    sys.path.insert(0, stand_in)
    try:
        import pxr.Sdf  # pyright: ignore

        yield pxr.Sdf
    finally:
        sys.path.remove(stand_in)
        taken()
        sys.modules.update(before)


def stage(layers: Any) -> dict[str, Any]:
    """The last layer: of each prim, by its path, all that it says."""
    found: dict[str, Any] = {"samples": layers.Layer.last.samples, "default": layers.Layer.last.defaultPrim}
    waiting = [layers.Layer.last.pseudoRoot]
    while waiting:
        prim = waiting.pop()
        waiting += prim.nameChildren.values()
        said: dict[str, Any] = {
            "kind": (prim.specifier, prim.kind, prim.instanceable, prim.active),
            "children": list(prim.nameChildren),
            "references": [str(own.primPath) for own in prim.referenceList.prependedItems],
            **prim.infos,
            **prim.customData,
        }
        for name, own in prim.attributes.items():
            said[name] = own.default
            said[f"{name} as"] = (own.kind, own.variability, own.custom, own.infos, list(map(str, own.connectionPathList.explicitItems)))
        for name in (*PLACED, "xformOpOrder"):  # that an operation which is nothing is not written says nothing
            said.pop(f"{name} as", None)
        said.pop("xformOpOrder", None)
        said |= {name: list(map(str, own.targetPathList.explicitItems)) for name, own in prim.relationships.items()}
        found[str(prim.path)] = said
    return found


CHOICES = [kinefab.ExportOptions(), kinefab.ExportOptions(closures="minimal")]


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_a_gltf_of_a_scene_is_that_of_the_source(source: Path, tmp_path: Path):
    for options, container in zip(CHOICES, ("text", "binary")):
        direct, again = roads(source, tmp_path, "scene.glb", container, options)
        if isinstance(direct, list) or isinstance(again, list):
            assert direct == again
        else:
            assert not list(apart(glb(direct), glb(again)))


@pytest.mark.parametrize("source", SOURCES, ids=lambda path: f"{path.parent.name}-{path.name}")
def test_a_stage_of_a_scene_is_that_of_the_source(source: Path, tmp_path: Path, layers: Any):
    stages: list[object] = []
    for path in roads(source, tmp_path, "scene.usda", "binary", CHOICES[0]):
        stages.append(path if isinstance(path, list) else stage(layers))
    assert not list(apart(*stages))


def solid(draw: random.Random, number: int) -> Mesh:
    """A box, a ball, a capsule, a tube or a wedge, turned and shifted in its own frame or not."""
    kind = draw.choice(["box", "ball", "capsule", "tube", "wedge"])
    made: trimesh.Trimesh = {
        "box": lambda: trimesh.creation.box((0.2, 0.1, 0.05)),
        "ball": lambda: trimesh.creation.icosphere(3, 0.07),
        "capsule": lambda: trimesh.creation.capsule(0.2, 0.03),
        "tube": lambda: trimesh.creation.annulus(0.05, 0.06, 0.1),
        "wedge": lambda: trimesh.convex.convex_hull([(0, 0, 0), (0.2, 0, 0), (0, 0.1, 0), (0, 0, 0.1), (0.2, 0, 0.1)]),
    }[kind]()
    vertices = np.array(made.vertices, dtype=np.float64)
    if draw.random() < 0.5:
        vertices = vertices @ rotation_exp(np.array([0.3, -0.2, 0.5])).T + np.array([0.1, 0.0, -0.05])
    return Mesh(f"{kind}{number}", vertices, np.array(made.faces, dtype=np.int64))


def stated(draw: random.Random) -> Collider:
    pose = kinefab.Pose(rotation_exp(np.array([0.0, 0.0, draw.choice([0.0, 0.4])])), np.array([0.0, 0.1, 0.0]))
    common = {"trigger": draw.random() < 0.2, "group": draw.choice(["", "a", "b"]), "enabled": draw.random() < 0.9}
    if draw.random() < 0.5:
        return Collider(ColliderKind.BOX, pose, size=(0.1, 0.2, 0.3), material=PhysicsMaterial("rubber", 0.9, 1.1, 0.2), **common)
    kind = draw.choice([ColliderKind.CAPSULE, ColliderKind.SPHERE])
    return Collider(kind, pose, radius=0.05, length=0.2 if kind is ColliderKind.CAPSULE else 0.0, **common)


def clothed(seed: int) -> kinefab.Scene:
    """A machine whose parts have bodies, with colliders of their source or without."""
    scene, draw = machine(seed), random.Random(seed)
    for i, node in enumerate(scene.nodes):
        bodies: list[Body] = []
        for k in range(draw.choice([0, 1, 1, 2])):
            scene.meshes.append(solid(draw, k))
            away = kinefab.Pose(translation=np.array([0.2, 0.1, 0.3])) if draw.random() < 0.3 else kinefab.Pose()
            bodies.append(Body(f"body{k}", len(scene.meshes) - 1, pose=away))
        own = (stated(draw),) if draw.random() < 0.3 else None
        scene.nodes[i] = replace(node, bodies=tuple(bodies), colliders=own)
    return scene


@pytest.mark.parametrize("seed", range(16))
@pytest.mark.parametrize("make", [machine, clothed])
def test_targets_of_a_random_machines_scene_are_those_of_the_machine(
    make: Callable[[int], kinefab.Scene], seed: int, tmp_path: Path, layers: Any
):
    source = make(seed)
    direct, again = roads(source, tmp_path, "scene.glb", "text", CHOICES[0])
    if isinstance(direct, list) or isinstance(again, list):
        assert direct == again
    else:
        assert not list(apart(glb(direct), glb(again)))
    stages: list[object] = []
    for path in roads(source, tmp_path, "scene.usda", "text", CHOICES[0]):
        stages.append(path if isinstance(path, list) else stage(layers))
    assert not list(apart(*stages))
