"""A second export updates the first: what is still there keeps the numbers by which Unity knows it."""

from __future__ import annotations

import re
import shutil
import zipfile
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from golden import FIXTURES
from kinefab import model
from kinefab.spatial import Pose
from prefab_reader import BUILT_IN, Project
from prefab_scenes import block, rich_scene
from unity_yaml import documents, mapping


def numbers(folder: Path, scene: model.Scene) -> tuple[dict[str, int], dict[str, str], dict[str, list[int]]]:
    """By the source's ids: fileIDs of GameObjects, guids of files, fileIDs of the components of each object by class."""
    folder.mkdir(exist_ok=True)
    result = kinefab.export(scene, folder / "Rich.prefab")
    found = {d.file_id: d for d in documents((folder / "Rich.prefab").read_text("utf-8"))}
    from prefab_reader import read_prefab

    root, _ = read_prefab(folder / "Rich.prefab")
    objects: dict[str, int] = {}
    kinds: dict[str, list[int]] = {}

    def walk(node, index: int) -> None:
        own = result.unity.gameObjects[index].id
        objects[own] = node.file_id
        for reference in found[node.file_id].fields["m_Component"]:
            component = found[int(reference["component"]["fileID"])]
            kinds.setdefault(f"{own} {component.kind}", []).append(component.file_id)
        below = [i for i, o in enumerate(result.unity.gameObjects) if o.parent == index]
        for child, i in zip(node.children, below, strict=True):
            walk(child, i)

    walk(root, 0)
    guids = {
        p.relative_to(folder).as_posix(): str(mapping(p.read_text("utf-8"))["guid"])
        for p in folder.rglob("*.meta")
    }
    return objects, guids, kinds


def test_what_survives_keeps_its_numbers(tmp_path):
    first = rich_scene(tmp_path)
    second = rich_scene(tmp_path)
    nodes = list(second.nodes)
    nodes[3] = replace(
        nodes[3], pose=Pose(np.eye(3), np.array([5.0, 6.0, 7.0])), name="Renamed"
    )  # moved and renamed
    second.joints = [j for j in second.joints if j.id not in ("Wheel", "Snap")]
    second.couplings = []
    second.animations = []
    extra = model.Node(
        "Top/A new one",
        "Arm",
        parent=0,
        pose=Pose(np.eye(3), np.array([0.0, 2.0, 0.0])),
        bodies=(model.Body("New", 4),),
    )
    second.meshes.append(block("New", (0.1, 0.2, 0.3)))
    gone = 5
    shift = [i if i < gone else i - 1 for i in range(len(nodes))]
    second.nodes = [n for i, n in enumerate(nodes) if i != gone]
    second.nodes.insert(1, extra)  # before the others: nothing may follow the order
    shift = [i if i < 1 else i + 1 for i in shift]
    second.nodes = [replace(n, parent=None if n.parent is None else 0) for n in second.nodes]
    second.joints = [replace(j, a=None if j.a is None else shift[j.a], b=shift[j.b]) for j in second.joints]
    objects, guids, kinds = numbers(tmp_path / "a", first)
    objects2, guids2, kinds2 = numbers(tmp_path / "b", second)
    same = objects.keys() & objects2.keys()
    assert same >= {"kinefab:ground", "Top", "Top/Base", "Top/Arm:1", "Top/Arm:2", "Top/Slider", "Top/Fan"}
    assert {k: objects[k] for k in same} == {k: objects2[k] for k in same}
    for key in (k for k in kinds if k in kinds2 and k.rpartition(" ")[0] in same):
        assert set(kinds2[key]) <= set(kinds[key]) or set(kinds[key]) <= set(kinds2[key]), key
    for path in (
        "Rich.prefab.meta",
        "Rich.meta",
        "Rich/Meshes/Arm.asset.meta",
        "Rich/Meshes/Ball.asset.meta",
        "Rich/Materials/Lamp.mat.meta",
    ):
        assert guids[path] == guids2[path]
    assert {k: v for k, v in guids2.items() if k in guids} == {k: guids[k] for k in guids if k in guids2}
    assert len(set(guids2.values())) == len(guids2)


def test_a_part_with_a_definition_shares_its_mesh_s_guid(tmp_path):
    """Whichever of its occurrences is the first."""

    def machine(*names: str) -> model.Scene:
        scene = model.Scene(meshes=[block("Bolt", (0.1, 0.1, 0.2))])
        for i, name in enumerate(names):
            pose = Pose(np.eye(3), np.array([float(i), 0, 0]))
            scene.nodes.append(
                model.Node(name, "Bolt", pose=pose, definition="bolt.ipt", bodies=(model.Body("b", 0),))
            )
        return scene

    _, guids, _ = numbers(tmp_path / "a", with_root(machine("A", "B", "C")))
    _, again, _ = numbers(tmp_path / "b", with_root(machine("B", "C")))
    assert guids["Rich/Meshes/Bolt.asset.meta"] == again["Rich/Meshes/Bolt.asset.meta"]
    assert sum("Bolt.asset" in path for path in guids) == 1


LINK = (
    '<link name="{0}"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    '<visual><origin xyz="{2} 0 0"/><geometry>{1}</geometry></visual></link>'
)
JOINT = (
    '<joint name="to {0}" type="revolute"><parent link="base"/><child link="{0}"/>'
    '<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="1" velocity="1"/></joint>'
)
BOX, FILE = '<box size="0.1 0.2 0.3"/>', '<mesh filename="wheel.stl" scale="1 {0} 1"/>'


def mesh_guids(folder: Path, links: dict[str, tuple[str, float]]) -> dict[str, list[str]]:
    """Guids of the meshes of a robot whose links have (geometry, offset)."""
    folder.mkdir(exist_ok=True)
    trimesh.creation.icosphere(1, 0.1).export(folder / "wheel.stl")
    parts = [
        LINK.format(name, *given) + ("" if name == "base" else JOINT.format(name))
        for name, given in links.items()
    ]
    (folder / "robot.urdf").write_text(f'<robot name="r">{"".join(parts)}</robot>')
    kinefab.export(folder / "robot.urdf", folder / "Robot.prefab")
    return shown_guids(folder / "Robot.prefab")


def shown_guids(prefab: Path) -> dict[str, list[str]]:
    """Of the meshes, by the names of the objects that show or touch them."""
    found = {d.file_id: d for d in documents(prefab.read_text("utf-8"))}
    shown: dict[str, list[str]] = {}
    for d in found.values():
        if d.kind in ("MeshFilter", "MeshCollider"):
            owner = found[int(d.fields["m_GameObject"]["fileID"])].fields["m_Name"]
            shown.setdefault(f"{owner} {d.kind}", []).append(str(d.fields["m_Mesh"]["guid"]))
    return shown


def test_a_mesh_s_guid_does_not_hang_on_who_else_uses_it(tmp_path):
    """Shared by a file, by a size, or mirrored; users come before and go."""
    left, right = FILE.format("1"), FILE.format("-1")
    links = {
        n: (g, 0.0)
        for n, g in (("base", BOX), ("b", left), ("c", left), ("d", BOX), ("e", right), ("f", right))
    }
    before = {guid for guids in mesh_guids(tmp_path / "a", links).values() for guid in guids}
    assert len(before) == 3
    for name, change in (
        ("gone", {k: v for k, v in links.items() if k not in ("b", "e")}),
        ("new", {"a": (left, 0.0), **links, "A": (BOX, 0.0), "a2": (right, 0.0)}),
        ("moved within its link", {**links, "b": (left, 0.5)}),
    ):
        after = mesh_guids(tmp_path / name, change)
        assert {guid for guids in after.values() for guid in guids} == before, name


CUBE = """
def Xform "{0}" (prepend apiSchemas = ["PhysicsRigidBodyAPI"])
{{
    def Cube "geo"
    {{
        double size = 0.1
        double3 xformOp:scale = (1, {1}, 1)
        uniform token[] xformOpOrder = ["xformOp:scale"]
    }}
}}
"""


def test_a_shape_of_usd_is_what_it_measures(tmp_path):
    """The cubes of a robot are one mesh, whose guid stays whichever of them comes or goes; scales stand above it."""
    pytest.importorskip("pxr", reason="usd-core is not installed")
    found: list[set[str]] = []
    for parts in ({"A": 1, "B": 2, "C": 3}, {"B": 2, "C": 3}, {"A": 1, "A0": 1, "B": 2}, {"C": 7}):
        cubes = "".join(CUBE.format(*part) for part in parts.items())
        text = f'#usda 1.0\n(metersPerUnit = 1)\ndef Xform "R"\n{{\n{cubes}}}\n'
        (tmp_path / "r.usda").write_text(text)
        kinefab.export(tmp_path / "r.usda", tmp_path / "Robot.prefab")
        shown = shown_guids(tmp_path / "Robot.prefab")
        found.append({guid for guids in shown.values() for guid in guids})
    assert len(found[0]) == 1 and all(guids == found[0] for guids in found)


def test_a_mesh_s_guid_does_not_hang_on_colliders(tmp_path):
    """Nor a hull's on whether all users of the mesh are hulls."""
    ball = trimesh.creation.icosphere(1, 0.1)
    found: list[dict[str, list[str]]] = []
    for i, shape in enumerate(("auto", "box", "mesh", "auto")):
        scene = kinefab.Scene()
        base = scene.add_part("Base", ball, grounded=i < 3)
        for name in ("Arm", "Leg"):
            part = scene.add_part(name, ball, translation=(1, 0, 0))
            scene.add_hinge(base, part, point=(0, 0, 0), axis=(0, 0, 1))
        options = kinefab.ExportOptions(colliders=kinefab.ColliderShape(shape))
        kinefab.export(scene, tmp_path / "Machine.prefab", options)
        found.append(shown_guids(tmp_path / "Machine.prefab"))
    drawn = [{k: v for k, v in guids.items() if "Filter" in k} for guids in found]
    assert drawn[0] == drawn[1] == drawn[2] == drawn[3] and len(drawn[0]) == 3
    assert found[0]["Arm MeshCollider"] == found[3]["Arm MeshCollider"]


def with_root(scene: model.Scene) -> model.Scene:
    """Something that stands on the ground, so that one root is above all."""
    scene.nodes.append(model.Node("Base", "Base", grounded=True))
    return scene


def test_two_prefabs_of_two_names_share_no_asset(tmp_path):
    for name in ("One", "Two"):
        kinefab.export(rich_scene(tmp_path), tmp_path / f"{name}.prefab")
    guids = [str(mapping(p.read_text("utf-8"))["guid"]) for p in tmp_path.rglob("*.meta")]
    assert len(set(guids)) == len(guids)


@pytest.mark.parametrize("suffix", [".prefab", ".unitypackage"])
def test_prefab_and_package_have_the_same_numbers(tmp_path, suffix):
    import tarfile

    kinefab.export(rich_scene(tmp_path), tmp_path / "Rich.prefab")
    kinefab.export(rich_scene(tmp_path), tmp_path / "Rich.unitypackage")
    with tarfile.open(tmp_path / "Rich.unitypackage") as tar:
        held = {m.name: tar.extractfile(m).read() for m in tar if m.isfile()}
        folders = [m.name for m in tar.getmembers() if m.isdir()]  # as the editor has them, each before what it holds
        assert folders == list(dict.fromkeys(m.name.partition("/")[0] for m in tar.getmembers()))
        assert all(m.mtime == 0 and m.uid == m.gid == 0 for m in tar.getmembers())
    names = [n.partition("/")[0] for n in held]
    assert names == sorted(names)
    paths = {g: held[f"{g}/pathname"].decode() for g in set(names)}
    assert len(set(paths.values())) == len(paths)
    for guid, path in paths.items():
        if path == "Assets/Kinefab":
            continue
        own = tmp_path / path.removeprefix("Assets/Kinefab/")
        assert Path(f"{own}.meta").read_bytes() == held[f"{guid}/asset.meta"]
        assert own.is_dir() or own.read_bytes() == held[f"{guid}/asset"]
        assert own.is_dir() == (f"{guid}/asset" not in held)


@pytest.mark.parametrize(
    "source", ["lever/lever.FCStd", "freecad/linked.FCStd", "freecad/distance_lines.FCStd"]
)
def test_a_freecad_document_whose_labels_change_keeps_its_numbers(tmp_path, source):
    """Labels are what users write; the names that FreeCAD gave stay.  The third has a middle body named after its joint."""
    pytest.importorskip("OCP")  # shapes are most of what there is to number
    label = re.compile(r'(name="Label"[^>]*>\s*<String value=")([^"]*)"')
    for other in (FIXTURES / source).parent.glob("*.FCStd"):  # documents that it links to
        shutil.copy(other, tmp_path)
    changed = tmp_path / Path(source).name
    with zipfile.ZipFile(FIXTURES / source) as old, zipfile.ZipFile(changed, "w") as new:
        for item in old.infolist():
            data = old.read(item)
            if item.filename == "Document.xml":
                data = label.sub(lambda found: f'{found[1]}Neu - {found[2][::-1]}"', data.decode()).encode()
            new.writestr(item, data)
    found = []
    for folder, document in (("old", FIXTURES / source), ("new", changed)):
        (tmp_path / folder).mkdir()
        prefab = kinefab.export(document, tmp_path / folder / "Machine.prefab").path
        text = prefab.read_text("utf-8")
        metas = sorted((tmp_path / folder).rglob("*.meta"))
        guids = {str(mapping(meta.read_text("utf-8"))["guid"]) for meta in metas}
        found.append(({(d.kind, d.file_id) for d in documents(text)}, guids))
        assert ("Neu - " in text) == (folder == "new")
    assert len(found[0][0]) > 20 and found[0] == found[1]


def test_two_prefabs_of_one_name_in_a_project_share_no_guid(tmp_path):
    """Unity would give one of them new guids, and its prefab would show the other's meshes.  What each has it keeps, whoever goes."""
    assets = tmp_path / "Assets"
    one, two = assets / "One" / "Robot.prefab", assets / "Two" / "Robot.prefab"
    for target in (one, two):
        target.parent.mkdir(parents=True)
        kinefab.export(rich_scene(tmp_path), target)
    first, second = Project(one.parent).paths, Project(two.parent).paths
    assert len(first) == len(second) >= 20 and not first.keys() & second.keys()
    (assets / "x").mkdir()
    for target in (one, two, assets / "x" / ".." / "One" / "Robot.prefab"):
        kinefab.export(rich_scene(tmp_path), target)
    assert (Project(one.parent).paths, Project(two.parent).paths) == (first, second)
    shutil.rmtree(one.parent)
    kinefab.export(rich_scene(tmp_path), two)
    assert Project(two.parent).paths == second
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    assert Project(assets / "Robot").paths.keys() < first.keys()


@pytest.mark.parametrize("came", ["renamed", "in a package"])
def test_a_prefab_keeps_its_guids_to_itself_when_it_is_renamed(tmp_path, came):
    """In the editor, which keeps guids; a package leaves no manifest."""
    assets = tmp_path / "Assets"
    assets.mkdir()
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    old = Project(assets).paths.keys()
    if came == "renamed":
        for end in ("", ".meta", ".prefab", ".prefab.meta"):
            (assets / f"Robot{end}").rename(assets / f"Arm{end}")
    else:
        (assets / "Robot" / ".kinefab.json").unlink()
        (assets / "Kinefab").mkdir()
        for end in ("", ".meta", ".prefab", ".prefab.meta"):
            (assets / f"Robot{end}").rename(assets / "Kinefab" / f"Robot{end}")
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    assert old < Project(assets).paths.keys()
    assert len(Project(assets).paths) == 2 * len(old)


def test_a_prefab_renamed_with_its_folder_is_updated_in_place(tmp_path):
    """In the editor, which keeps guids: scenes and variants refer to it by them.  Whoever takes its old name gets others."""
    assets = tmp_path / "Assets"
    assets.mkdir()
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    old = {guid: path.relative_to(assets).as_posix() for guid, path in Project(assets).paths.items()}
    for end in ("", ".meta", ".prefab", ".prefab.meta"):
        (assets / f"Robot{end}").rename(assets / f"Arm{end}")
    scene = rich_scene(tmp_path)
    scene.nodes[2] = replace(scene.nodes[2], pose=Pose(translation=np.array([0.1, 0.2, 0.3])))
    renamed = {guid: path.replace("Robot", "Arm", 1) for guid, path in old.items()}
    for _ in range(2):
        kinefab.export(scene, assets / "Arm.prefab")
        found = {g: p.relative_to(assets).as_posix() for g, p in whole(assets).paths.items()}
        assert found == renamed
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    kinefab.export(scene, assets / "Arm.prefab")
    found = {g: p.relative_to(assets).as_posix() for g, p in whole(assets).paths.items()}
    assert renamed.items() <= found.items() and len(found) == 2 * len(old)


def whole(assets: Path) -> Project:
    """The project, in which no guid stands twice and every reference leads to a file."""
    project = Project(assets)
    for path in (p for p in project.paths.values() if p.suffix in (".prefab", ".mat")):
        guids = set(re.findall(r"guid: (\w+)", path.read_text("utf-8")))
        assert guids <= project.paths.keys() | set(BUILT_IN), path
    return project


def moved(assets: Path, old: str, new: str) -> None:
    """As the editor moves: the meta goes along."""
    (assets / new).parent.mkdir(exist_ok=True)
    for end in ("", ".meta"):
        (assets / f"{old}{end}").rename(assets / f"{new}{end}")


@pytest.mark.parametrize(
    "old, new",
    [
        ("Robot.prefab", "Prefabs/Robot.prefab"),
        ("Robot.prefab", "Robot 2.prefab"),
        ("Robot/Materials/Lamp.mat", "Shared/Lamp.mat"),
        ("Robot/Meshes/Arm.asset", "Robot/Meshes/Boom.asset"),
        ("Robot/Meshes", "Robot/Shapes"),
    ],
)
def test_what_was_moved_in_the_editor_is_not_written_a_second_time(tmp_path, old, new):
    """Unity would give one of the two another guid; and the prefab that was moved lost its meshes to one of other guids."""
    assets = tmp_path / "Assets"
    assets.mkdir()
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    moved(assets, old, new)
    before = {p: p.read_bytes() for p in assets.rglob("*") if p.is_file()}
    with pytest.raises(kinefab.KinefabError) as caught:
        kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    (found,) = caught.value.diagnostics
    assert found.code == "TARGET_ASSET_MOVED"
    assert found.message.startswith(f"{assets / new} ") and f"{assets / old}," in found.message
    assert {p: p.read_bytes() for p in assets.rglob("*") if p.is_file()} == before
    moved(assets, new, old)
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    whole(assets)


@pytest.mark.parametrize(
    "old, new, target",
    [
        ("Robot.prefab", "Prefabs/Robot.prefab", "Prefabs/Robot.prefab"),
        ("Robot", "Data/Robot", "Robot.prefab"),
        ("Robot", "Old", "Robot.prefab"),
    ],
)
def test_a_prefab_without_its_folder_gets_another(tmp_path, old, new, target):
    """The one that stays behind keeps its guids, the prefab its own, by which scenes know it."""
    assets = tmp_path / "Assets"
    assets.mkdir()
    kinefab.export(rich_scene(tmp_path), assets / "Robot.prefab")
    guid = (assets / "Robot.prefab.meta").read_text()
    moved(assets, old, new)
    before = Project(assets).paths
    for _ in range(2):
        kinefab.export(rich_scene(tmp_path), assets / target)
        after = whole(assets).paths
        assert before.items() <= after.items() and len(after) == 2 * len(before) - 1  # the prefab
    assert (assets / f"{target}.meta").read_text() == guid
