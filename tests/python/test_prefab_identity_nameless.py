"""A second export of what has no names: whatever is still there keeps its fileID and guid, in a prefab and in a package."""

from __future__ import annotations

import itertools
import random
import re
import tarfile
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab import model
from kinefab.sources import read
from kinefab.spatial import Pose
from kinefab.targets.prefab.last import DOCUMENT, GUID

INERTIAL = '<inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
TARGETS = ["prefab", "unitypackage"]


def prefab_of(target: Path) -> str:
    if target.suffix == ".prefab":
        return target.read_text("ascii")
    with tarfile.open(target, "r:gz") as packed:
        for member in packed.getmembers():
            held = packed.extractfile(member)
            if member.name.endswith("/asset") and held is not None and b"GameObject:" in (text := held.read()):
                return text.decode("ascii")
    raise AssertionError("no prefab in the package")


def guids_of(target: Path) -> dict[str, str]:
    """By the asset's name."""
    if target.suffix == ".prefab":
        metas = target.with_suffix("").rglob("*.meta")
        return {p.name.removesuffix(".meta"): GUID.search(p.read_text("utf-8"))[1] for p in metas}
    with tarfile.open(target, "r:gz") as packed:
        named = [m for m in packed.getmembers() if m.name.endswith("/pathname")]
        return {packed.extractfile(m).read().decode().rpartition("/")[2]: m.name.partition("/")[0] for m in named}


def numbers(text: str, kind: str, field: str) -> dict[str, int]:
    """fileIDs of documents of a class, by one of their fields."""
    heads = list(DOCUMENT.finditer(text))
    found: dict[str, int] = {}
    for head, end in zip(heads, [*(h.start() for h in heads[1:]), len(text)]):
        own = re.search(rf"^  {field}: (.*)$", text[head.end() : end], re.MULTILINE)
        if head[2] == kind and own is not None:
            found[own[1]] = int(head[1])
    return found


def box(size: float, at: float = 0.0, tag: str = "collision", name: str = "") -> str:
    named = f' name="{name}"' if name else ""
    return f'<{tag}{named}><origin xyz="{at} 0 0"/><geometry><box size="{size} .1 .1"/></geometry></{tag}>'


def robot(*shapes: str, link: str = "l1") -> str:
    return (
        f'<robot name="Bot"><link name="base">{INERTIAL}{box(0.7)}</link><link name="{link}">{INERTIAL}{"".join(shapes)}</link>'
        f'<joint name="j" type="revolute"><parent link="base"/><child link="{link}"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1.5" effort="10" velocity="1"/></joint></robot>'
    )


def exported(folder: Path, text: str, target: str) -> tuple[str, kinefab.ExportResult]:
    (folder / "Bot.urdf").write_text(text, encoding="utf-8")
    path = folder / f"Bot.{target}"
    result = kinefab.export(folder / "Bot.urdf", path)
    return prefab_of(path), result


A, B, C = box(0.1, 0.0), box(0.2, 0.1), box(0.3, 0.2)
CHANGES = {
    "one put in front": (robot(box(0.5, 0.5), A, B, C), {0.1, 0.2, 0.3}),
    "one put in the middle": (robot(A, box(0.5, 0.5), B, C), {0.1, 0.2, 0.3}),
    "the first left out": (robot(B, C), {0.2, 0.3}),
    "the middle one left out": (robot(A, C), {0.1, 0.3}),
    "turned round": (robot(C, B, A), {0.1, 0.2, 0.3}),
    "one moved": (robot(A, box(0.2, 0.4), C), {0.1, 0.2, 0.3}),
    "one moved and one put in front": (robot(box(0.5, 0.5), A, box(0.2, 0.4), C), {0.1, 0.2, 0.3}),
    "one left out, one put in, turned round": (robot(C, box(0.5, 0.5), A), {0.1, 0.3}),
    "the link renamed": (robot(A, B, C, link="arm"), {0.1, 0.2, 0.3}),
    "one given a name": (robot(A, box(0.2, 0.1, name="Stop"), C), {0.1, 0.2, 0.3}),
}


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("change", CHANGES)
def test_collisions_of_a_link_are_known_by_what_they_are(tmp_path, change, target):
    """Everything of the prefab that is still there keeps its number, in the first export after the change and in those after it."""
    after, kept = CHANGES[change]
    first, _ = exported(tmp_path, robot(A, B, C), target)
    second, _ = exported(tmp_path, after, target)
    sizes = {size: f"{{x: 0.1, y: 0.1, z: {size}}}" for size in kept}
    before, now = (numbers(text, "BoxCollider", "m_Size") for text in (first, second))
    assert {s: now[sizes[s]] for s in kept} == {s: before[sizes[s]] for s in kept}
    gone = set(before.values()) - {before[sizes[s]] for s in kept} - {before["{x: 0.1, y: 0.1, z: 0.7}"]}
    assert not gone & set(now.values()), "what is new has not the number of what has gone"
    if "renamed" in change:
        was, own = (numbers(text, "GameObject", "m_Name") for text in (first, second))
        assert own["arm"] == was["l1"]
        for kind in ("Rigidbody", "HingeJoint", "Transform"):
            owners = [numbers(text, kind, "m_GameObject") for text in (first, second)]
            assert owners[1][f"{{fileID: {own['arm']}}}"] == owners[0][f"{{fileID: {own['arm']}}}"]
    assert exported(tmp_path, after, target)[0] == second
    heads = [int(head[1]) for head in DOCUMENT.finditer(second)]
    assert len(heads) == len(set(heads))


@pytest.mark.parametrize("target", TARGETS)
def test_visuals_keep_their_objects_and_their_meshes(tmp_path, target):
    """Their objects by their shape and place, their meshes' guids by what uses them."""
    drawn = [box(size, at, "visual") for size, at in ((0.1, 0.0), (0.2, 0.1), (0.3, 0.2))]
    first, _ = exported(tmp_path, robot(*drawn), target)
    guids = guids_of(tmp_path / f"Bot.{target}")
    second, _ = exported(tmp_path, robot(box(0.5, 0.5, "visual"), drawn[2], drawn[0], drawn[1]), target)
    before, now = (numbers(text, "Transform", "m_LocalPosition") for text in (first, second))
    assert before.items() <= now.items()
    assert set(guids.values()) <= set(guids_of(tmp_path / f"Bot.{target}").values())
    meshes = [numbers(text, "MeshFilter", "m_Mesh") for text in (first, second)]
    assert meshes[0].items() <= meshes[1].items()


def test_two_that_are_alike_and_moved_are_told(tmp_path):
    exported(tmp_path, robot(box(0.1, 0.0), box(0.1, 0.5)), "prefab")
    _, result = exported(tmp_path, robot(box(0.1, 0.2), box(0.1, 0.9)), "prefab")
    assert [d.code for d in result.report.diagnostics if d.code == "TARGET_IDENTITY_UNSURE"]
    _, result = exported(tmp_path, robot(box(0.1, 0.9), box(0.1, 0.2)), "prefab")
    assert not [d.code for d in result.report.diagnostics if d.code == "TARGET_IDENTITY_UNSURE"]


def bolts(places: list[tuple[float, float, float]], shuffled: int | None = None) -> model.Scene:
    """Copies of a bolt below a plate, as a reader makes them that counts: ids say nothing."""
    scene = kinefab.Scene()
    plate = scene.add_part("Plate", trimesh.creation.box((1, 1, 0.1)))
    bolt = scene.add_part("Bolt", trimesh.creation.cylinder(0.05, 0.3))
    made = scene.nodes[bolt]
    scene.nodes = scene.nodes[:bolt]
    order = list(range(len(places)))
    if shuffled is not None:
        random.Random(shuffled).shuffle(order)
    for number, i in enumerate(order, 1):
        id = f"Plate/Bolt:{number}"
        scene.nodes.append(
            model.Node(id, f"Bolt:{number}", parent=plate, pose=Pose(np.eye(3), np.array(places[i])), bodies=made.bodies, definition="Bolt")
        )
        scene.counted.add(id)
    return scene


@pytest.mark.parametrize("target", TARGETS)
@pytest.mark.parametrize("seed", range(3))
def test_occurrences_without_names_keep_their_numbers(tmp_path, seed, target):
    """One put in, one taken out, one moved a little, all in another order."""
    places = [(0.1 * i, 0.2 * (i % 3), 0.05) for i in range(8)]
    path = tmp_path / f"Bolts.{target}"
    kinefab.export(bolts(places), path)
    before, guids = numbers(prefab_of(path), "Transform", "m_LocalPosition"), guids_of(path)
    moved = (places[2][0] + 0.01, *places[2][1:])
    result = kinefab.export(bolts([*places[:2], moved, *places[3:5], *places[6:], (2.0, 2.0, 2.0)], shuffled=seed), path)
    now = numbers(prefab_of(path), "Transform", "m_LocalPosition")
    assert guids == guids_of(path)

    def key(place):  # of Unity's hand, as it is written
        return next(k for k in itertools.chain(now, before) if np.allclose([float(x.split(":")[1]) for x in k.strip("{}").split(",")], place))

    x = np.array([-1.0, 1.0, 1.0])
    for i in (0, 1, 3, 4, 6, 7):
        assert now[key(x * places[i])] == before[key(x * places[i])]
    assert now[key(x * moved)] == before[key(x * places[2])]
    # What came may be what went, carried far away: it is told.
    assert now[key(x * (2, 2, 2))] == before[key(x * places[5])]
    assert [d for d in result.report.diagnostics if d.code == "TARGET_IDENTITY_UNSURE"]


def test_occurrences_that_step_names_after_their_product_are_counted():
    """The reader's part, which needs no OpenCASCADE: names that writers invent say nothing."""
    from kinefab.sources.reading.source_frame import SourceFrame
    from kinefab.sources.step.records import Occurrence, Tree
    from kinefab.sources.step.scene import scene_nodes

    names = [("", "Frame", None), ("NAUO1", "Bolt", 0), ("NAUO2", "Bolt", 0), ("Bolt", "Bolt", 0), ("Left", "Bolt", 0), ("Left", "Bolt", 0)]
    tree = Tree([Occurrence(name, parent, np.eye(3, 4), product, f"0:{i}") for i, (name, product, parent) in enumerate(names)], [])
    nodes, _, _, counted = scene_nodes(tree, SourceFrame(), "a.step", False, kinefab.Report())
    assert [node.id for node in nodes if node.id not in counted] == ["Frame/Left"]
    assert counted >= {"Frame/Bolt", "Frame/Bolt:2", "Frame/Bolt:3", "Frame/Left:2"}


def test_readers_say_what_they_count(tmp_path):
    collision = '<collision{}><geometry><sphere><radius>{}</radius></sphere></geometry></collision>'
    shapes = collision.format(' name="Own"', 0.1) + collision.format("", 0.2)
    (tmp_path / "a.sdf").write_text(f'<sdf version="1.9"><model name="m"><link name="l">{shapes}</link></model></sdf>')
    scene = read(tmp_path / "a.sdf", kinefab.Report())
    assert [id.rpartition(":")[2] for id in scene.counted] == ["collision"]


def test_a_damaged_or_foreign_prefab_is_no_last_export(tmp_path):
    first, _ = exported(tmp_path, robot(A, B), "prefab")
    for text in ("", "%YAML 1.1\n--- !u!1 &12\nGameObject:\n", first[: len(first) // 2], first.replace("m_Father", "m_Mother")):
        (tmp_path / "Bot.prefab").write_text(text)
        exported(tmp_path, robot(A, B), "prefab")
        heads = [int(head[1]) for head in DOCUMENT.finditer((tmp_path / "Bot.prefab").read_text())]
        assert len(heads) == len(set(heads))
    (tmp_path / "Bot.unitypackage").write_bytes(b"no package")
    exported(tmp_path, robot(A, B), "unitypackage")
