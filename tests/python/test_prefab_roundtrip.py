"""A prefab read back is the scene that the same export writes as ``.kinefab``: every object, component and field."""

from __future__ import annotations

import json
import tarfile
from pathlib import Path

import kinefab
import numpy as np
import pytest
from golden import FIXTURES, golden_pairs
from kinefab.diagnostics import schema_directory
from prefab_reader import Node, Project, read_mesh, read_prefab
from prefab_scenes import rich_scene
from scenes import mesh_arrays, read
from unity_yaml import documents

DEFINITIONS = json.loads((schema_directory() / "scene.schema.json").read_text("utf-8"))["$defs"]
INFINITE = {"breakForce", "breakTorque", "maximumForce"}
ALSO = {"id", "name", "part", "connectedPart", "group", "because", "closure", "exact", "extras", "type", "mesh", "materials", "material"}
ALSO |= {"connectedBody", "constraints", "effort", "speed", "friction", "armature", "stated"}
"""What a scene file says beside Unity's own fields, and what is compared by what it means."""


def told(definition: str, entry: dict) -> dict:
    """An entry of a scene file with the defaults that its schema states."""
    found = {}
    for key, rule in DEFINITIONS[definition]["properties"].items():
        reference = rule.get("$ref", "").removeprefix("#/$defs/")
        nested = DEFINITIONS.get(reference, {}).get("type") == "object"
        if nested and reference != "extras":
            found[key] = told(reference, entry.get(key, {}))
        elif key in entry or "default" in rule:
            found[key] = entry.get(key, rule.get("default"))
        elif key in INFINITE:
            found[key] = float("inf")
    found.pop("extras", None)
    return found


def differences(expected, actual, where: str) -> list[str]:
    """Both as float32."""
    if isinstance(expected, dict):
        return [d for k in expected for d in differences(expected[k], actual.get(k), f"{where}.{k}")]
    if isinstance(expected, list):
        same = isinstance(actual, list) and np.array_equal(np.float32(expected), np.float32(actual))
        return [] if same else [f"{where}: {expected} became {actual}"]
    if isinstance(expected, (int, float)) and not isinstance(expected, bool):
        with np.errstate(over="ignore"):
            same = isinstance(actual, (int, float)) and np.float32(expected) == np.float32(actual)
        return [] if same else [f"{where}: {expected} became {actual}"]
    return [] if expected == actual else [f"{where}: {expected!r} became {actual!r}"]


def compared(scene_path: Path, prefab: Path, dialect: str = "2022") -> list[str]:
    content = read(scene_path)
    root, project = read_prefab(prefab)
    roots = [i for i, o in enumerate(content["gameObjects"]) if "parent" not in o]
    assert root.name == prefab.stem  # as an editor has it
    nodes: dict[int, Node] = {}
    found: list[str] = []
    single = len(roots) == 1 and content["gameObjects"][roots[0]].get("transform", {}) == {}
    assert single or root.transform["localPosition"] == [0, 0, 0]
    if single:
        content["gameObjects"][roots[0]]["name"] = prefab.stem

    def match(index: int, node: Node) -> None:
        nodes[index] = node
        children = [i for i, o in enumerate(content["gameObjects"]) if o.get("parent") == index]
        if len(children) != len(node.children):
            found.append(f"{node.name}: {len(children)} children became {len(node.children)}")
        for child, below in zip(children, node.children):
            match(child, below)

    for index, node in zip(roots, [root] if single else root.children, strict=True):
        match(index, node)
    assert len(nodes) == len(content["gameObjects"])
    for index, node in nodes.items():
        found += _object(index, node, nodes, content, scene_path, dialect)
    found += _clips(content, nodes, root, project)
    return found


def _object(index, node, nodes, content, scene_path, dialect) -> list[str]:
    entry = content["gameObjects"][index]
    where = entry["id"]
    name = entry["name"].replace("/", "_")
    found = [] if node.name == name or node.name.startswith(f"{name}~") else [f"{where}: named {node.name}"]
    found += differences(entry.get("active", True), node.active, f"{where}.active")
    found += differences(told("transform", entry.get("transform", {})), node.transform, where)
    components = [c for c in node.components if c["type"] not in ("Animation", "MonoBehaviour")]
    expected = entry.get("components", [])
    if [c["type"] for c in expected] != [c["type"] for c in components]:
        return [*found, f"{where}: {[c['type'] for c in components]}"]
    for wanted, component in zip(expected, components):
        own = f"{where} {wanted['type']}"
        fields = {k: v for k, v in told(wanted["type"], wanted).items() if k not in ALSO}
        if wanted["type"].endswith("Joint") and fields.pop("enabled") is not True:
            found.append(f"{own}: no joint of Unity's can be switched off")
        for lost in ("maxAngularVelocity", "solverIterations", "solverVelocityIterations"):
            fields.pop(lost, None)  # a prefab has no place for them
        if dialect == "2021":
            for newer in (
                "centerOfMass",
                "inertiaTensor",
                "inertiaTensorRotation",
                "extendedLimits",
                "useAcceleration",
            ):
                fields.pop(newer, None)
        found += differences(fields, component, own)
        if "connectedBody" in component:
            other = wanted.get("connectedBody")
            found += differences(
                None if other is None else nodes[other].file_id, component["connectedBody"], own
            )
        if "material" in component:
            found += _physics(wanted, component["material"], content, own)
        if "mesh" in wanted:
            found += _mesh(wanted["mesh"], component["mesh"], content, scene_path, own)
        if wanted["type"] == "MeshRenderer":
            names = [
                content["materials"][m]["name"].replace("#", "_") for m in wanted["materials"]
            ]  # as files are called
            read_names = [str(m.fields["m_Name"]) for m in component["materials"]]
            found += [] if names == read_names else [f"{own}: {names} became {read_names}"]
    return found


def _physics(wanted: dict, read_back, content: dict, where: str) -> list[str]:
    """A collider's physics material: words of the scene are numbers of Unity's, and Unity 6 calls its fields otherwise."""
    if "material" not in wanted:
        return [] if read_back is None else [f"{where}: a physics material"]
    entry = told("physicsMaterial", content["physicsMaterials"][wanted["material"]])
    fields = {key.removeprefix("m_")[0].lower() + key.removeprefix("m_")[1:]: value for key, value in read_back.fields.items()}
    words = ["Average", "Multiply", "Minimum", "Maximum"]
    found = [] if str(fields["name"]) == entry["name"] else [f"{where}: named {fields['name']}"]
    for key in ("dynamicFriction", "staticFriction", "bounciness"):
        found += differences(entry[key], float(fields[key]), f"{where}.{key}")
    for key in ("frictionCombine", "bounceCombine"):
        found += differences(words.index(entry[key]), int(fields[key]), f"{where}.{key}")
    return found


def _mesh(index: int, mesh: dict, content: dict, scene_path: Path, where: str) -> list[str]:
    entry = content["meshes"][index]
    positions, triangles = mesh_arrays(scene_path, content, index)
    found = [] if np.array_equal(positions, mesh["channels"][0]) else [f"{where}: positions"]
    starts = np.cumsum([0, *(s["indexCount"] for s in entry["submeshes"])])
    for k, own in enumerate(mesh["submeshes"]):
        if not np.array_equal(triangles.reshape(-1)[starts[k] : starts[k + 1]], own.reshape(-1)):
            found.append(f"{where}: triangles of submesh {k}")
    data = (scene_path.parent / content["buffers"][0]["uri"]).read_bytes()
    for key, channel, width in (("normals", 1, 3), ("uv", 4, 2)):
        if key in entry:
            read_back = mesh["channels"][channel]
            wanted = np.frombuffer(data, "<f4", read_back.size, entry[key]["offset"]).reshape(-1, width)
            found += [] if np.array_equal(wanted, read_back) else [f"{where}: {key}"]
    found += [] if len(mesh["submeshes"]) == len(entry["submeshes"]) else [f"{where}: submeshes"]
    found += [] if mesh["short"] == (entry["indexFormat"] == "uint16") else [f"{where}: index format"]
    low, high = positions.min(axis=0), positions.max(axis=0)
    for center, extent in (mesh["bounds"],):
        close = np.allclose([center, extent], [(low + high) / 2, (high - low) / 2], rtol=1e-6, atol=1e-9)
        found += [] if close else [f"{where}: bounds"]
    return found


def _clips(content: dict, nodes: dict[int, Node], root: Node, project: Project) -> list[str]:
    players = [c for c in root.components if c["type"] == "Animation"]
    if not content.get("animations"):
        return ["an Animation without clips"] if players else []
    (player,) = players
    clips = [project.asset(r) for r in player["fields"]["m_Animations"]]
    found = []
    for wanted, clip in zip(content["animations"], clips, strict=True):
        fields = clip.fields
        mode = {"Once": "1", "Loop": "2", "PingPong": "4"}[wanted.get("wrapMode", "Once")]
        if (
            fields["m_Legacy"] != "1"
            or fields["m_WrapMode"] != mode
            or str(fields["m_Name"]) != wanted["name"]
        ):
            found.append(f"clip {wanted['name']}")
        curves = {"localPosition": fields["m_PositionCurves"], "localRotation": fields["m_RotationCurves"]}
        for kind, read_curves in curves.items():
            tracks = [t for t in wanted["tracks"] if kind in t]
            for track, curve in zip(tracks, read_curves, strict=True):
                assert _at(root, str(curve["path"])) is nodes[track["gameObject"]]
                keys = curve["curve"]["m_Curve"]
                times = [float(np.float32(k["time"])) for k in keys]
                values = [[float(np.float32(x)) for x in k["value"].values()] for k in keys]
                found += differences(wanted["times"], times, f"{wanted['name']}.times")
                for a, b in zip(track[kind], values, strict=True):
                    turned_back = kind == "localRotation" and np.dot(a, b) < 0
                    found += differences(a, [-x for x in b] if turned_back else b, f"{wanted['name']}.{kind}")
    return found


def _at(node: Node, path: str) -> Node:
    for name in path.split("/") if path else []:
        (node,) = [child for child in node.children if child.name == name]
    return node


def both(source, folder: Path, dialect: str = "2022", **options) -> tuple[Path, Path]:
    scene, prefab = folder / "both.kinefab", folder / "out" / "both.prefab"
    prefab.parent.mkdir(exist_ok=True)
    kinefab.export(source, scene, kinefab.ExportOptions(**options))
    kinefab.export(source, prefab, kinefab.ExportOptions(**options, writing={"unity": dialect}))
    return scene, prefab


@pytest.mark.parametrize("dialect", ["2021", "2022", "6"])
def test_one_of_everything_comes_back(tmp_path, dialect):
    assert compared(*both(rich_scene(tmp_path), tmp_path, dialect), dialect) == []


@pytest.mark.parametrize("colliders", ["box", "mesh", "none"])
def test_the_lever_comes_back_with_every_kind_of_collider(tmp_path, colliders):
    assert compared(*both(FIXTURES / "lever" / "lever.bundle.json", tmp_path, colliders=colliders)) == []


@pytest.mark.parametrize("bundle", [b for b, _ in golden_pairs()], ids=lambda b: b.name.split(".")[0])
def test_every_fixture_comes_back(tmp_path, bundle):
    assert compared(*both(bundle, tmp_path)) == []


@pytest.mark.parametrize(
    "source",
    [
        "twins/arm.usda",
        "lever/lever.usda",
        "freecad/couplings.FCStd",
        "lever/lever.FCStd",
        "twins/arm.urdf",
        "lever/lever.urdf",
    ],
)
def test_robots_and_machines_of_other_formats_come_back(tmp_path, source):
    """A USD robot, a FreeCAD machine, a URDF arm; the package holds what the prefab's folder holds, byte for byte."""
    if source.endswith(".usda"):
        pytest.importorskip("pxr", reason="usd-core is not installed")
    scene, prefab = both(FIXTURES / source, tmp_path, colliders="hull")
    assert compared(scene, prefab) == []
    options = kinefab.ExportOptions(colliders="hull")
    package = kinefab.export(FIXTURES / source, tmp_path / "both.unitypackage", options).path
    with tarfile.open(package) as archive:
        packed = {archive.extractfile(e).read() for e in archive.getmembers() if e.name.endswith("/asset")}
    assert prefab.read_bytes() in packed
    glb = kinefab.export(FIXTURES / source, tmp_path / "both.glb", options)
    names = {
        node["name"]
        for node in json.loads(
            glb.path.read_bytes()[20:].split(b"\0")[0][
                : int.from_bytes(glb.path.read_bytes()[12:16], "little")
            ]
        )["nodes"]
    }
    assert {node.name for node in glb.analysed.scene.nodes} <= names


def test_a_mesh_of_many_vertices_has_wide_indices(tmp_path):
    scene = kinefab.Scene()
    count = 69_999
    points = np.random.default_rng(0).random((count, 3))
    faces = np.arange(count).reshape(-1, 3)
    from kinefab import model

    scene.meshes.append(model.Mesh("Cloud", points, faces))
    scene.nodes.append(model.Node("Cloud", "Cloud", grounded=True, bodies=(model.Body("b", 0),)))
    result = kinefab.export(scene, tmp_path / "cloud.prefab", kinefab.ExportOptions(colliders="none"))
    (path,) = [p for p in result.files if p.suffix == ".asset"]
    (document,) = documents(path.read_text("utf-8"))
    mesh = read_mesh(document)
    assert not mesh["short"] and mesh["submeshes"][0].max() == faces.max()
    assert len(mesh["channels"][0]) == count
