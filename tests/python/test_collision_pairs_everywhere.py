"""For every fixture: the bodies that pass through each other in the exported scene are those of the source, counted from its own text."""

from __future__ import annotations

import json
import xml.etree.ElementTree as xml
from dataclasses import replace
from itertools import combinations
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from gltf_pairs import GltfPairs
from kinefab.diagnostics import Report
from kinefab.geometry.looks.gltf_document import gltf_document
from kinefab.model import AnimationClip, Apart, Collider, ColliderKind, Constraint, Coupling, Joint, Node, NodeKind
from kinefab.pipeline import prepared
from kinefab.spatial import Pose
from random_machines import Machine, built_machine, standing_machine
from stage_pairs import StagePairs

ROOT = Path(__file__).parents[2]
BUNDLES = sorted((ROOT / "fixtures").glob("*/*.bundle.json"))
ROBOTS = sorted([*(ROOT / "fixtures").glob("*/*.urdf"), *(ROOT / "fixtures").glob("*/*.sdf")])
BESIDE = {"distance", "tangent", "angle", "parallel", "perpendicular", "symmetry", "lock_orientation"}
"""Kinds that say nothing of one body standing in another (``schemas/SPEC.md``, section 7): only where a joint holds what they state
do the two pass through each other, as no engine lets those of a joint collide."""
PAIRLESS = {"linear", "other", "ground"}
LOCKS = ("Locked", "Limited")
Pair = frozenset[int]


class Written:
    """A scene file.  body: for each object what moves with it, as the lowest object of all that FixedJoints hold together."""

    def __init__(self, path: Path):
        self.objects = json.loads(path.read_text(encoding="utf-8"))["gameObjects"]
        self.index = {entry["id"]: i for i, entry in enumerate(self.objects)}
        own: list[int | None] = []
        for i, entry in enumerate(self.objects):
            parent = entry.get("parent")
            has = any(c["type"] == "Rigidbody" for c in entry.get("components", ()))
            own.append(i if has else None if parent is None else own[parent])
        welded = {i: i for i in own if i is not None}
        for i, component in self.components("FixedJoint"):
            a, b = (welded[own[k]] for k in (i, component["connectedBody"]))  # pyright: ignore
            welded = {k: min(a, b) if v in (a, b) else v for k, v in welded.items()}
        self.body = [None if i is None else welded[i] for i in own]
        self.led = {
            self.body[i] for i, c in self.components("Rigidbody") if c.get("isKinematic", False)
        }

    def components(self, *kinds: str):
        for i, entry in enumerate(self.objects):
            for component in entry.get("components", ()):
                if component["type"] in kinds:
                    yield i, component

    def pair(self, a: int, b: int) -> Pair | None:
        """Of two objects, where they are two bodies of which one moves."""
        found = {self.body[a], self.body[b]}
        return None if len(found) < 2 or None in found or found <= self.led else frozenset(found)  # pyright: ignore

    def held(self) -> set[Pair | None]:
        """Pairs of bodies of which a joint holds something."""
        return {
            self.pair(i, c["connectedBody"])
            for i, c in self.components("HingeJoint", "ConfigurableJoint")
            if "connectedBody" in c and (c["type"] == "HingeJoint" or any(word in c.values() for word in LOCKS))
        }

    def apart(self, among: set[int], holding: bool = True) -> set[Pair]:
        """Pairs of bodies that a joint keeps from colliding.  holding: also those of joints that hold something."""
        found = {
            self.pair(i, c["connectedBody"])
            for i, c in self.components("HingeJoint", "ConfigurableJoint")
            if "connectedBody" in c and not c.get("enableCollision", False)
            if holding or "apart" in c.get("extras", {})
        }
        bodies = {self.body[i] for i in among}
        return {pair for pair in found if pair is not None and pair <= bodies}


def exported(source: Path | kinefab.Scene, folder: Path, closures: str = "exact") -> Written:
    kinefab.export(source, folder / "scene.kinefab", kinefab.ExportOptions(colliders="box", closures=closures))
    return Written(folder / "scene.kinefab")


@pytest.mark.parametrize("source", BUNDLES, ids=lambda path: path.name.split(".")[0])
def test_bundle(source: Path, tmp_path: Path):
    bundle = json.loads(source.read_text(encoding="utf-8"))
    scene = exported(source, tmp_path)
    parts = {c["id"]: scene.index[c["id"]] for c in bundle["components"] if c["id"] in scene.index}
    stated = [c for c in bundle.get("constraints", ()) if c["kind"] not in PAIRLESS and not c.get("suppressed", False)]

    def pairs(constraints: list[dict]) -> set[Pair | None]:
        """Of what each joins, what a coupling counts against included."""
        sides = [[parts.get(c[side]["component"]) for side in "abc" if side in c] for c in constraints]
        sides += [[parts.get(j[side]) for side in "ab"] for j in bundle.get("joints", ())]
        return {scene.pair(a, b) for own in sides for a, b in combinations(own, 2) if a is not None and b is not None} - {None}

    beside = [c for c in stated if c["kind"] in BESIDE]
    within = pairs([c for c in stated if c not in beside])
    assert scene.apart(set(parts.values())) == within | (pairs(beside) & scene.held())
    assert scene.apart(set(parts.values()), holding=False) <= within


def links_of(root: xml.Element, source: Path) -> tuple[dict[str, str], set[frozenset[str]]]:
    """Links by the ids of their objects, and the pairs that the file keeps apart.

    URDF: what a joint connects.  SDF: the same, and all links of one model, as ``self_collide`` is false by default.
    """
    if source.suffix == ".urdf":
        ids = {link.attrib["name"]: link.attrib["name"] for link in root.iter("link")}
        sides = [[joint.find(end) for end in ("parent", "child")] for joint in root.iter("joint")]
        return ids, {frozenset(end.attrib["link"] for end in pair if end is not None) for pair in sides}
    ids, found = dict[str, str](), set[frozenset[str]]()
    for model in root.iter("model"):
        assert model.find("model") is None and model.find("self_collide") is None
        own = [link.attrib["name"] for link in model.findall("link")]
        ids |= {f"{model.attrib['name']}/{name}": f"{model.attrib['name']}/{name}" for name in own}
        found |= {frozenset(f"{model.attrib['name']}/{name}" for name in pair) for pair in combinations(own, 2)}
    return ids, found


@pytest.mark.parametrize("source", ROBOTS, ids=lambda path: path.parent.name + "-" + path.name)
def test_robot(source: Path, tmp_path: Path):
    root = xml.parse(source).getroot()
    shaped = {
        link.attrib["name"] for link in root.iter("link") if link.find("collision") is not None
    }
    ids, pairs = links_of(root, source)
    scene = exported(source, tmp_path)
    present = {name: scene.index[id] for name, id in ids.items() if id in scene.index and name.split("/")[-1] in shaped}
    kept = [tuple(pair) for pair in pairs if len(pair) == 2 and set(pair) <= set(present)]
    expected = {scene.pair(present[a], present[b]) for a, b in kept} - {None}
    assert scene.apart(set(present.values())) == expected


BESIDE_IT = Pose(np.eye(3), np.array([0.5, 0.25, -0.125]))
COPY = "copy of "


def twice(scene: kinefab.Scene) -> kinefab.Scene:
    """The scene with a copy of everything in it, half a metre beside it."""
    count = len(scene.nodes)

    def on(node: int | None) -> int | None:
        return None if node is None else node + count

    def node(own: Node) -> Node:
        made = replace(own, id=COPY + own.id, parent=on(own.parent), pose=BESIDE_IT @ own.pose)
        return replace(made, helps=on(own.helps))

    def joint(own: Joint) -> Joint:
        moved = {"a": on(own.a), "b": on(own.b)}
        moved |= {"frame_a": BESIDE_IT @ own.frame_a} if own.a is None else {}
        moved |= {"frame_b": BESIDE_IT @ own.frame_b} if own.b is None else {}
        return replace(own, id=COPY + own.id, **moved)

    def constraint(own: Constraint) -> Constraint:
        features = [replace(f, node=on(f.node)) for f in own.features]
        features = [
            replace(f, point=BESIDE_IT.point(f.point)) if f.node is None else f for f in features
        ]
        return replace(own, id=COPY + own.id, features=tuple(features))

    def coupling(own: Coupling) -> Coupling:
        terms = tuple(replace(term, joint=COPY + term.joint) for term in own.terms)
        return replace(own, id=COPY + own.id, joint=COPY + own.joint, terms=terms)

    def clip(own: AnimationClip) -> AnimationClip:
        return replace(own, tracks=tuple(replace(track, node=track.node + count) for track in own.tracks))

    return replace(
        scene,
        nodes=[*scene.nodes, *map(node, scene.nodes)],
        joints=[*scene.joints, *map(joint, scene.joints)],
        constraints=[*scene.constraints, *map(constraint, scene.constraints)],
        couplings=[*scene.couplings, *map(coupling, scene.couplings)],
        dof_records=[],
        animations=[*scene.animations, *map(clip, scene.animations)],
        apart=[*scene.apart, *(replace(pair, a=pair.a + count, b=pair.b + count) for pair in scene.apart)],
    )


def passing(scene: Written, parts: set[str]) -> set[frozenset[str]]:
    """Pairs of parts that a joint keeps from colliding, by their ids."""
    there = [i for i, entry in enumerate(scene.objects) if entry["id"].removeprefix(COPY) in parts]
    kept = scene.apart(set(there))
    return {
        frozenset((scene.objects[a]["id"], scene.objects[b]["id"]))
        for a, b in combinations(there, 2)
        if scene.pair(a, b) in kept
    }


@pytest.mark.parametrize("source", [*BUNDLES, *ROBOTS], ids=lambda path: path.name.removesuffix(".bundle.json"))
def test_of_two_machines_neither_passes_the_other(source: Path, tmp_path: Path):
    """Of a scene and its copy: within each the same pairs as when it stands alone, and none between the two."""
    scene = prepared(source, kinefab.ExportOptions(), Report())
    parts = {node.id for node in scene.nodes if node.kind is NodeKind.PART}
    alone = passing(exported(scene, tmp_path), parts)
    copied = {frozenset(COPY + name for name in pair) for pair in alone}
    assert passing(exported(twice(scene), tmp_path), parts) == alone | copied


BOX = Collider(ColliderKind.BOX, size=(0.1, 0.1, 0.1))


def shaped(source: Path) -> tuple[kinefab.Scene, set[str]]:
    """The source's scene, in which each part collides, and its parts."""
    scene = prepared(source, kinefab.ExportOptions(), Report())
    for i, node in enumerate(scene.nodes):
        if node.kind is NodeKind.PART and not node.bodies and not node.colliders:
            scene.nodes[i] = replace(node, colliders=(BOX,))
    return scene, {node.id for node in scene.nodes if node.kind is NodeKind.PART}


@pytest.mark.parametrize("seed", range(30))
def test_random_machines_pass_their_own_bases_alone(seed: int, tmp_path: Path):
    machine = standing_machine(seed)
    written = exported(machine.scene, tmp_path)
    assert passing(written, machine.parts) == machine.passing


MACHINES = [*map(standing_machine, range(30)), *map(built_machine, range(30))]
"""Of those with parts below parts it is the scene that says which is built onto which."""


@pytest.mark.parametrize("machine", MACHINES, ids=range(len(MACHINES)))
def test_gltf_says_the_pairs_of_random_machines(machine: Machine, tmp_path: Path):
    kinefab.export(machine.scene, tmp_path / "a.glb", kinefab.ExportOptions(colliders="box"))
    found = GltfPairs(gltf_document(tmp_path / "a.glb")).passing(machine.parts)
    assert found == passing(exported(machine.scene, tmp_path), machine.parts)


@pytest.mark.parametrize("machine", MACHINES, ids=range(len(MACHINES)))
def test_a_stage_says_the_pairs_of_random_machines(machine: Machine, tmp_path: Path):
    pytest.importorskip("pxr")
    kinefab.export(machine.scene, tmp_path / "a.usda", kinefab.ExportOptions(colliders="box"))
    found = StagePairs(tmp_path / "a.usda").passing(machine.parts)
    assert found == passing(exported(machine.scene, tmp_path), machine.parts)


@pytest.mark.parametrize("closures", ["exact", "minimal"])
@pytest.mark.parametrize("source", [*BUNDLES, *ROBOTS], ids=lambda path: path.name.removesuffix(".bundle.json"))
def test_gltf_says_the_same_pairs(source: Path, closures: str, tmp_path: Path):
    scene, parts = shaped(source)
    kinefab.export(scene, tmp_path / "a.glb", kinefab.ExportOptions(colliders="box", closures=closures))
    found = GltfPairs(gltf_document(tmp_path / "a.glb")).passing(parts)
    assert found == passing(exported(scene, tmp_path, closures), parts)


@pytest.mark.parametrize("ending", ["glb", "usda"])
def test_a_pair_with_an_assembly_is_one_with_all_that_stands_in_it(ending: str, tmp_path: Path):
    """The assembly's own object touches nothing, and is no body where it stands."""
    scene = kinefab.Scene()
    frame = scene.add_part("Frame", trimesh.creation.box((0.1, 0.1, 0.1)), grounded=True)
    table = len(scene.nodes)
    scene.nodes.append(Node("Table", "Table", NodeKind.ASSEMBLY, flexible=False, grounded=True))
    for name, x in (("Top", 0.5), ("Leg", 0.7)):
        part = scene.add_part(name, trimesh.creation.box((0.1, 0.1, 0.1)), translation=(x, 0, 0))
        scene.nodes[part] = replace(scene.nodes[part], parent=table)
    arm = scene.add_part("Arm", trimesh.creation.box((0.1, 0.1, 0.1)), translation=(0, 0.2, 0))
    scene.add_hinge(frame, arm, point=(0, 0, 0), axis=(0, 0, 1))
    scene.apart.append(Apart(arm, table, "contact exclude"))
    expected = {frozenset(("Arm", name)) for name in ("Frame", "Top", "Leg")}
    assert passing(exported(scene, tmp_path), {"Frame", "Top", "Leg", "Arm"}) == expected
    if ending == "usda":
        pytest.importorskip("pxr")
    kinefab.export(scene, tmp_path / f"a.{ending}")
    parts = {"Frame", "Top", "Leg", "Arm"}
    found = GltfPairs(gltf_document(tmp_path / "a.glb")) if ending == "glb" else StagePairs(tmp_path / "a.usda")
    assert found.passing(parts) == expected


@pytest.mark.parametrize("closures", ["exact", "minimal"])
@pytest.mark.parametrize("source", [*BUNDLES, *ROBOTS], ids=lambda path: path.name.removesuffix(".bundle.json"))
def test_a_stage_says_the_same_pairs(source: Path, closures: str, tmp_path: Path):
    pytest.importorskip("pxr")
    scene, parts = shaped(source)
    kinefab.export(scene, tmp_path / "a.usda", kinefab.ExportOptions(colliders="box", closures=closures))
    assert StagePairs(tmp_path / "a.usda").passing(parts) == passing(exported(scene, tmp_path, closures), parts)
