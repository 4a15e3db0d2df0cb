"""Meshes that nothing could draw: told and left out, by every target, whoever made the scene."""

from __future__ import annotations

import json
import struct
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import Report
from kinefab.geometry.contact import decomposition
from kinefab.geometry.files import read_mesh_file
from kinefab.geometry.primitives import box
from kinefab.model import Body, Collider, ColliderKind, Mesh, Node, Scene
from kinefab.unity.scene import BoxCollider

BOX = box((1.0, 2.0, 3.0))
assert BOX.normals is not None
COUNT = len(BOX.vertices)
LEFT = np.column_stack([BOX.normals[:, [1, 2, 0]], np.ones(COUNT)])
"""Tangents of unit length."""


def machine(mesh: Mesh) -> Scene:
    """A part that shows the mesh and touches with it, beside one that is sound."""
    collider = Collider(ColliderKind.HULL, mesh=0)
    nodes = [
        Node("Bad", "Bad", bodies=(Body("b", 0),), colliders=(collider,)),
        Node("Good", "Good", bodies=(Body("b", 1),)),
    ]
    return Scene(nodes=nodes, meshes=[mesh, BOX])


def nan(width: int) -> np.ndarray:
    values = np.zeros((COUNT, width))
    values[3, 1] = np.nan
    return values


def primitives(path: Path) -> list[dict]:
    length = struct.unpack("<I", path.read_bytes()[12:16])[0]
    document = json.loads(path.read_bytes()[20 : 20 + length])
    return [primitive for mesh in document["meshes"] for primitive in mesh["primitives"]]


@pytest.mark.parametrize(
    ("mesh", "detail"),
    [
        (replace(BOX, faces=np.zeros((0, 3), dtype=np.int64)), "it has no triangles"),
        (Mesh("none", np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64)), "it has no triangles"),
        (replace(BOX, faces=np.array([[0, 1, COUNT]])), "a triangle names a vertex that is not there"),
        (replace(BOX, faces=np.array([[0, 1, -1]])), "a triangle names a vertex that is not there"),
    ],
)
@pytest.mark.parametrize("ending", ["kinefab", "prefab", "glb", "usda"])
def test_a_mesh_of_no_use_is_left_out(tmp_path, mesh, detail, ending):
    if ending == "usda":
        pytest.importorskip("pxr", reason="usd-core is not installed")
    result = kinefab.export(machine(mesh), tmp_path / f"a.{ending}")
    (told,) = [d for d in result.report.diagnostics if d.code == "MESH_UNSOUND"]
    assert detail in told.message and mesh.name in told.message


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("normals", nan(3)),
        ("normals", np.zeros((2, 3))),
        ("uvs", (nan(2),)),
        ("colors", nan(4)),
        ("tangents", nan(4)),
        ("tangents", 2.0 * LEFT),
        ("tangents", LEFT * [1, 1, 1, 0]),
    ],
)
def test_what_a_mesh_is_drawn_by_is_left_out_where_it_is_unsound(tmp_path, name, values):
    result = kinefab.export(machine(replace(BOX, **{name: values})), tmp_path / "a.glb")
    told = [o.feature for o in result.report.outcomes if o.code == "MESH_UNSOUND"]
    assert f"{name} of mesh box" in told
    field = {"uvs": "TEXCOORD_0", "colors": "COLOR_0", "tangents": "TANGENT"}.get(name)
    assert all(field not in primitive["attributes"] for primitive in primitives(tmp_path / "a.glb")[:1])
    kinefab.export(machine(replace(BOX, **{name: values})), tmp_path / "a.prefab")
    assert all("0000c07f" not in path.read_text() for path in tmp_path.rglob("*.asset"))


def test_tangents_need_normals_and_colours_end_at_one(tmp_path):
    scene = machine(replace(BOX, normals=None, tangents=LEFT, colors=np.full((COUNT, 4), 2.5)))
    result = kinefab.export(scene, tmp_path / "a.prefab")
    told = [o.feature for o in result.report.outcomes if o.code == "MESH_UNSOUND"]
    assert told == ["tangents of mesh box"]
    colors = result.unity.meshes[0].colors
    assert colors is not None and (colors == 1.0).all()


def test_vertices_that_are_no_numbers_are_errors(tmp_path):
    for value in (np.nan, np.inf, 1e30):
        scene = machine(replace(BOX, vertices=BOX.vertices * value))
        with pytest.raises(kinefab.KinefabError) as caught:
            kinefab.export(scene, tmp_path / "a.prefab")
        assert [d.code for d in caught.value.diagnostics] == ["GEOMETRY_NOT_FINITE"]
    assert not list(tmp_path.iterdir())


def test_a_sound_scene_is_itself():
    from kinefab.diagnostics import Report
    from kinefab.geometry.looks.soundness import with_sound_meshes

    scene = machine(replace(BOX, tangents=LEFT, colors=np.full((COUNT, 4), 0.5)))
    assert with_sound_meshes(scene, Report()) is scene


def test_an_obj_with_numbers_that_are_none(tmp_path):
    lines = ["v 0 0 0", "v 1 0 0", "v 0 1 0", "v 0 0 1", "vt nan 0", "vt 1 0", "vn nan 0 1", "vn 0 0 1"]
    lines += ["f 1/1/1 3/2/1 2/2/2", "f 1/1/1 2/2/2 4/2/2", "f 1/1/1 4/2/1 3/2/2", "f 2/1/1 3/2/2 4/2/2"]
    (tmp_path / "part.obj").write_text("\n".join(lines) + "\n")
    scene = kinefab.Scene()
    scene.add_part("Part", tmp_path / "part.obj", unit="m")
    result = kinefab.export(scene, tmp_path / "a.prefab")
    told = {o.feature.partition(" ")[0] for o in result.report.outcomes if o.code == "MESH_UNSOUND"}
    assert told == {"normals", "uvs"}
    mesh = result.unity.meshes[0]
    assert mesh.normals is not None and np.isfinite(mesh.normals).all() and not mesh.uvs


STRAY = np.vstack([BOX.vertices, [[7.0, -8.0, 9.0]]])


def of_a_file(folder: Path) -> Scene:
    """As parts in glTF have it that share one list of vertices; here a PLY with one vertex too many."""
    head = f"ply\nformat ascii 1.0\nelement vertex {COUNT + 1}\nproperty float x\nproperty float y\nproperty float z\n"
    head += f"element face {len(BOX.faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    rows = [" ".join(map(str, v)) for v in STRAY] + [" ".join(map(str, (3, *f))) for f in BOX.faces]
    (folder / "part.ply").write_text(head + "\n".join(rows) + "\n")
    scene = kinefab.Scene()
    scene.add_part("Part", folder / "part.ply", translation=(0, 5, 0))
    return scene


def of_nouns(_: Path) -> Scene:
    one = np.ones(COUNT + 1)
    mesh = Mesh(
        "M",
        STRAY,
        BOX.faces,
        np.outer(one, (0, 0, 1)),
        (np.outer(one, (0.5, 1)),),
        None,
        np.outer(one, (1, 0, 0, 1)),
    )
    return Scene(nodes=[Node("Part", "Part", bodies=(Body("b", 0),))], meshes=[mesh])


@pytest.mark.parametrize("made", [of_a_file, of_nouns])
@pytest.mark.parametrize("shape", ["hull", "box"])
def test_a_vertex_that_no_triangle_names_is_left_out(tmp_path, made, shape):
    """What collides would go round it."""
    found = kinefab.export(made(tmp_path), tmp_path / "a.kinefab", kinefab.ExportOptions(colliders=shape))
    for mesh in found.unity.meshes:
        vertices = np.reshape(mesh.vertices, (-1, 3))
        assert len(vertices) in (COUNT, 8) and np.abs(vertices).max(axis=0).tolist() == [0.5, 1.0, 1.5]
        assert mesh.normals is None or len(mesh.normals) == len(mesh.vertices)
    sizes = [c.size for o in found.unity.gameObjects for c in o.components if isinstance(c, BoxCollider)]
    assert sizes == ([(1.0, 2.0, 3.0)] if shape == "box" else [])


def test_lines_are_not_cut_into_pieces(tmp_path, monkeypatch):
    """Triangles that are none, as wires are drawn: CoACD ends the process where it is handed nothing."""
    monkeypatch.setattr(decomposition, "_libraries", lambda: ["coacd"])
    monkeypatch.setattr(decomposition, "_by_coacd", lambda *given: pytest.fail("there is nothing to cut"))
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 5]], dtype=float)
    wires = Mesh("wires", corners, np.array([[0, 0, 1], [1, 1, 2], [2, 2, 3], [3, 3, 0]]))
    options = kinefab.ExportOptions(colliders="decompose")
    scene = replace(machine(wires), nodes=[Node("Bad", "Bad", bodies=(Body("b", 0),))])
    result = kinefab.export(scene, tmp_path / "a.kinefab", options)
    assert "COLLIDER_HOLLOW_AS_HULL" in [d.code for d in result.report.diagnostics]


def test_what_trimesh_logs_of_a_texture_does_not_reach_the_user(tmp_path):
    """Its traceback of a bump map outside the folder; the loss is a finding."""
    import subprocess
    import sys

    ask = "import logging, kinefab.geometry.files as f, pathlib, sys\n"
    ask += "f._trimesh_scene(pathlib.Path(sys.argv[1]), None)\nlogging.getLogger('trimesh').error('heard')"
    (tmp_path / "a.stl").write_text(
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"
    )
    run = subprocess.run([sys.executable, "-c", ask, str(tmp_path / "a.stl")], capture_output=True, text=True)
    assert run.returncode == 0 and "heard" not in run.stderr, run.stderr


def test_a_ply_of_unlike_polygons_says_what_to_do(tmp_path):
    """Blender writes them unless told to triangulate; trimesh calls such a file one of unexpected length."""
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
    head += "element face 2\nproperty list uchar uint vertex_indices\nend_header\n"
    corners = np.arange(15, dtype="<f4").tobytes()
    faces = (
        bytes([4])
        + np.array([0, 1, 2, 3], "<u4").tobytes()
        + bytes([3])
        + np.array([0, 3, 4], "<u4").tobytes()
    )
    (tmp_path / "part.ply").write_bytes(head.encode() + corners + faces)
    report = Report()
    assert read_mesh_file(tmp_path / "part.ply", report, "x") is None
    (found,) = report.diagnostics
    assert found.code == "GEOMETRY_UNREADABLE" and "triangulate" in found.message
