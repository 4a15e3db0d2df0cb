"""Mesh files to bodies: OBJ's traps, names, units and shared meshes."""

from __future__ import annotations

import math
import struct
from pathlib import Path

import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import Report, Severity
from kinefab.geometry.files import FORMATS, read_mesh_file, transformed
from kinefab.geometry.hulls import collision_hulls
from kinefab.geometry.loading import MeshFiles, load_geometry
from kinefab.geometry.looks.shading import shaded
from kinefab.geometry.mass import solid_properties
from kinefab.geometry.pieces import Piece, joined
from kinefab.geometry.wavefront import tables
from kinefab.model import Body, Mesh, MeshKey, MeshReference, Node, Scene
from kinefab.spatial import Pose, rotation_exp

CUBE = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
QUADS = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]


def cube_lines(first: int, shift: float = 0.0, scale: float = 1.0) -> tuple[list[str], list[str]]:
    """(vertex lines, quad lines) of a unit cube whose first vertex has number ``first``."""
    vertices = [f"v {scale * x + shift} {scale * y} {scale * z}" for x, y, z in CUBE]
    faces = ["f " + " ".join(str(i + first - 1) for i in quad) for quad in QUADS]
    return vertices, faces


def write(path: Path, *lines, end="\n") -> Path:
    flat = [line for item in lines for line in ([item] if isinstance(item, str) else item)]
    path.write_bytes(end.join([*flat, ""]).encode())
    return path


def load(path: Path, *keys, definition=None, unit=1.0, keyed_by=MeshKey.OBJECT, poses=None):
    """A scene with one part for each key, its geometry loaded; and the report."""
    nodes = []
    for i, key in enumerate(keys):
        to_node = np.eye(4) * [unit, unit, unit, 1.0]
        if poses is not None:
            inverse = poses[i].inverse()
            to_node[:3, :3], to_node[:3, 3] = inverse.rotation * unit, inverse.translation
        reference = MeshReference(path, to_node, key, keyed_by, f"bundle#/{i}")
        nodes.append(
            Node(f"P{i}", f"P{i}", definition=definition, bodies=(Body(str(key), reference=reference),))
        )
    report = Report()
    scene = load_geometry(Scene(nodes=nodes), MeshFiles(report), report, lambda *_: None)
    return scene, report


def meshes(scene) -> list[Mesh | None]:
    return [None if b.mesh is None else scene.meshes[b.mesh] for n in scene.nodes for b in n.bodies]


def volume(mesh: Mesh) -> float:
    return solid_properties(mesh.vertices, mesh.faces, 1.0).mass


def two_cubes(path, head_one, head_two, end="\n"):
    """A cube of side 1 at x = 0 and one of side 2 at x = 10, under the given statements."""
    v1, f1 = cube_lines(1)
    v2, f2 = cube_lines(9, 10.0, 2.0)
    return write(path, head_one, v1, f1, head_two, v2, f2, end=end)


@pytest.mark.parametrize(
    "one, two",
    [
        (["o A", "usemtl Steel"], ["o B", "usemtl Steel"]),  # one material for both
        (["o A", "g whole"], ["o B"]),  # a group that must not leak into the next object
        (["g A"], ["g B"]),
        (["o A", "g A"], ["o B", "g B"]),
        (["usemtl Steel", "o A"], ["o B"]),
    ],
)
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_obj_bodies_stay_apart(tmp_path, one, two, end):
    """Whatever o, g and usemtl say, each name has its own triangles."""
    scene, report = load(two_cubes(tmp_path / "a.obj", one, two, end), "B", "A")
    assert [volume(m) for m in meshes(scene)] == pytest.approx([8, 1])
    loose = {d.code for d in report.diagnostics}
    assert loose == ({"BODY_MATCHED_LOOSELY"} if one[0].startswith("g") else set())


def test_obj_objects_of_one_name_are_taken_in_order_and_reported(tmp_path):
    """Two objects called Solid, wanted twice, pair by order with a warning each."""
    scene, report = load(two_cubes(tmp_path / "a.obj", "o Solid", "o Solid"), "Solid", "Solid")
    assert [volume(m) for m in meshes(scene)] == pytest.approx([1, 8])
    assert [d.code for d in report.diagnostics] == ["BODY_MATCHED_LOOSELY"] * 2


def test_obj_sections_of_one_name_are_one_body_where_one_is_wanted(tmp_path):
    """A name that opens two sections and is wanted once means both, with a warning; wanted thrice it is an error."""
    path = two_cubes(tmp_path / "a.obj", "o Solid", "o Solid")
    scene, report = load(path, "Solid")
    assert volume(meshes(scene)[0]) == pytest.approx(9)
    assert [d.code for d in report.diagnostics] == ["BODY_MATCHED_LOOSELY"]
    scene, report = load(path, "Solid", "Solid", "Solid")
    assert meshes(scene) == [None] * 3
    assert {d.code for d in report.diagnostics if d.severity is Severity.ERROR} == {"BODY_NAME_AMBIGUOUS"}


def test_obj_negative_indices_count_from_the_face(tmp_path):
    """-1 is the vertex above the face, not the last one of the file."""
    v1, _ = cube_lines(1)
    v2, _ = cube_lines(9, 10.0, 2.0)
    back = ["f " + " ".join(str(i - 9) for i in quad) for quad in QUADS]
    scene, _ = load(write(tmp_path / "a.obj", "o A", v1, back, "o B", v2, back), "A", "B")
    assert [volume(m) for m in meshes(scene)] == pytest.approx([1, 8])


def test_obj_continued_lines_and_polygons(tmp_path):
    """A pentagon prism with faces over two lines comes out as triangles of the right volume."""
    ring = [(math.cos(0.4 * math.pi * k), math.sin(0.4 * math.pi * k)) for k in range(5)]
    vertices = [f"v {x} {y} {z}" for z in (0, 2) for x, y in ring]
    sides = [f"f {k + 1} {(k + 1) % 5 + 1} \\\n {(k + 1) % 5 + 6} {k + 6}" for k in range(5)]
    path = write(tmp_path / "a.obj", "o P", vertices, "f 5 4 3 2 1", "f 6 7 8 9 10", sides)
    scene, _ = load(path, "P")
    (mesh,) = meshes(scene)
    assert len(mesh.faces) == 3 + 3 + 10
    assert volume(mesh) == pytest.approx(2 * 2.5 * math.sin(0.4 * math.pi))


def test_obj_comments_may_stand_behind_what_they_are_about(tmp_path):
    lines = ["o A", "v 0 0 0 # corner", "v 1 0 0", "v 0 1 0", "f 1 2 3 # the only face", "f 3 2 1# its back"]
    scene, _ = load(write(tmp_path / "a.obj", lines), "A")
    assert scene.meshes[0].faces.tolist() == [[0, 1, 2], [2, 1, 0]]


def test_obj_material_change_makes_a_submesh_not_a_body(tmp_path):
    """One object in two materials is one mesh with two runs of faces."""
    v, f = cube_lines(1)
    (tmp_path / "m.mtl").write_text("newmtl Red\nKd 0.8 0.1 0.2\nd 0.5\nnewmtl Grey\nKd 0.5 0.5 0.5\n")
    path = write(tmp_path / "a.obj", "mtllib m.mtl", "o A", v, "usemtl Red", f[:2], "usemtl Grey", f[2:])
    scene, _ = load(path, "A")
    (mesh,) = meshes(scene)
    assert mesh.face_counts == (4, 8)
    body = scene.nodes[0].bodies[0]
    assert [scene.surfaces[m].name for m in body.surfaces] == ["Red", "Grey"]
    assert scene.surfaces[body.surfaces[0]].color == pytest.approx((0.60383, 0.01002, 0.03310, 0.5), abs=1e-5)


def test_obj_missing_material_library_is_a_warning(tmp_path):
    """The shape is loaded, and the missing library is named."""
    v, f = cube_lines(1)
    scene, report = load(write(tmp_path / "a.obj", "mtllib gone.mtl", "o A", v, f), "A")
    assert volume(meshes(scene)[0]) == pytest.approx(1)
    assert [d.code for d in report.diagnostics] == ["MATERIALS_MISSING"]


def test_obj_normals_and_texture_coordinates_stay_with_their_corners(tmp_path):
    """Corners that differ in vt or vn are different vertices; normals keep their direction."""
    v, _ = cube_lines(1)
    normals = ["vn 1 0 0", "vn 0 1 0"]
    path = write(
        tmp_path / "a.obj",
        "o A",
        v,
        "vt 0 0",
        "vt 1 0",
        "vt 0 1",
        normals,
        "f 5/1/1 7/2/1 8/3/1",
        "f 3/1/2 4/2/2 8/3/2",
    )
    scene, _ = load(path, "A")
    (mesh,) = meshes(scene)
    assert len(mesh.vertices) == 6
    corner = [np.flatnonzero((mesh.vertices == (1, 1, 1)).all(axis=1))][0]
    assert sorted(map(tuple, mesh.normals[corner])) == [(0, 1, 0), (1, 0, 0)]
    assert mesh.uvs[0].shape == (6, 2)


@pytest.mark.parametrize("named", ["v", "vt", "vn", "vt vn"])
def test_an_obj_is_read_as_trimesh_reads_it(tmp_path, named):
    """Corner by corner the same place, texture coordinates and normal, by another reader; colours beside places are no places."""
    rng = np.random.default_rng(3)
    rows = [f"v {x} {y} {z} 0.5 0.5 0.5" for x, y, z in rng.normal(size=(20, 3)).tolist()]
    rows += [f"vt {u} {v}" for u, v in rng.uniform(size=(15, 2)).tolist()]
    rows += [f"vn {x} {y} {z}" for x, y, z in rng.normal(size=(12, 3)).tolist()]
    form = {"v": "{}", "vt": "{}/{}", "vn": "{0}//{2}", "vt vn": "{}/{}/{}"}[named]
    corners = rng.integers(1, [21, 16, 13], size=(40, 3, 3)).tolist()
    faces = ["f " + " ".join(form.format(*corner) for corner in face) for face in corners]
    path = write(tmp_path / "a.obj", "o A", rows, faces)
    (piece,) = read_mesh_file(path, Report(), "here").pieces
    other = trimesh.load_mesh(path, process=False)
    assert np.array_equal(piece.vertices[piece.faces], np.asarray(other.vertices)[other.faces])
    assert (piece.uv is not None, piece.normals is not None) == ("vt" in named, "vn" in named)
    if piece.uv is not None:
        assert np.array_equal(piece.uv[piece.faces], other.visual.uv[other.faces])
    if piece.normals is not None:
        numbers = np.array(corners)[:, :, 2] - 1
        stated = np.array([row.split()[1:] for row in rows if row.startswith("vn")], dtype=float)
        assert np.array_equal(piece.normals[piece.faces], stated[numbers])


@pytest.mark.parametrize("form", ["{}", "{}/{}", "{0}//{2}", "{}/{}/{}", "-{}"])
def test_an_obj_of_any_polygons_is_the_same_at_once_and_line_by_line(tmp_path, monkeypatch, form):
    """What is read as one table, in pieces of a few lines, against the text in which each fan of triangles is written out; two corners
    are no face, and materials and bodies get the triangles of their own lines."""
    rng = np.random.default_rng(5)
    rows = [
        f"{word} {a} {b} {c}" for word in ("v", "vt", "vn") for a, b, c in rng.normal(size=(9, 3)).tolist()
    ]
    polygons = [rng.permutation(9)[: rng.integers(2, 8)] + 1 for _ in range(40)]
    polygons[20:] = [p[:3] if form == "{}" else p for p in polygons[20:]]
    corners = [[form.format(k, 10 - k, k % 9 + 1) for k in polygon] for polygon in polygons]
    statements = {0: ["o A", "usemtl red"], 11: ["usemtl blue"], 25: ["o B"], 33: ["usemtl red"]}
    whole, cut = ([*rows] for _ in range(2))
    for i, polygon in enumerate(corners):
        whole += [*statements.get(i, []), "f " + " ".join(polygon)]
        fan = [f"f {polygon[0]} {polygon[k]} {polygon[k + 1]}" for k in range(1, len(polygon) - 1)]
        cut += [*statements.get(i, []), *(line + " # one" for line in fan)]
    monkeypatch.setattr(tables, "AT_ONCE", 3)
    monkeypatch.setattr(tables, "BLOCK", 50)
    once, by_line = (
        read_mesh_file(write(tmp_path / name, lines), Report(), "x")
        for name, lines in (("a.obj", whole), ("b.obj", cut))
    )
    assert [p.face_counts for p in once.pieces] == [p.face_counts for p in by_line.pieces]
    assert len(once.pieces) == 2 and once.pieces[0].surfaces == ("red", "blue")
    for one, other in zip(once.pieces, by_line.pieces):
        for values in ("vertices", "uv", "normals"):
            ours, theirs = getattr(one, values), getattr(other, values)
            assert (ours is None) == (theirs is None)
            assert ours is None or np.array_equal(ours[one.faces], theirs[other.faces])


def test_obj_corners_that_name_different_things_keep_their_places(tmp_path):
    """Where only some corners have texture coordinates the others have 0 0, and a body without any has none; of normals a body
    has all or none.  A coordinate of u alone has v = 0."""
    v, _ = cube_lines(1)
    rows = [
        "vt 0.25 0.75",
        "vt 0.5 1",
        "vn 0 0 1",
        "f 5/1 7 8/2",
        "f 3/1 4 8",
        "o B",
        "f 5//1 7//1 8//1",
        "o C",
        "f 5/2/1 7/2/1 8/1/1",
    ]
    mixed = write(tmp_path / "a.obj", "o A", v, *rows)
    first, second, third = read_mesh_file(mixed, Report(), "here").pieces
    places = np.array([row.split()[1:] for row in v], dtype=float)
    assert np.array_equal(first.vertices[first.faces], places[[[4, 6, 7], [2, 3, 7]]])
    shown = [[[0.25, 0.75], [0.0, 0.0], [0.5, 1.0]], [[0.25, 0.75], [0.0, 0.0], [0.0, 0.0]]]
    assert first.normals is None and first.uv[first.faces].tolist() == shown
    assert second.uv is None and second.normals[second.faces].tolist() == [[[0.0, 0.0, 1.0]] * 3]
    assert third.uv[third.faces].tolist() == [[[0.5, 1.0], [0.5, 1.0], [0.25, 0.75]]]
    assert third.normals[third.faces].tolist() == [[[0.0, 0.0, 1.0]] * 3]
    assert np.array_equal(third.vertices[third.faces], places[[[4, 6, 7]]])
    alone = write(tmp_path / "b.obj", "o A", v, "vt 0.5", "vt 1 1", "f 5/1 7/2 8/1")
    (piece,) = read_mesh_file(alone, Report(), "here").pieces
    assert piece.uv[piece.faces[0]].tolist() == [[0.5, 0.0], [1.0, 1.0], [0.5, 0.0]]


def test_a_part_keeps_its_texture_coordinates_beside_bodies_that_have_none(tmp_path):
    """A file whose bodies become one part: a truck with an image on its sides and plain windows."""
    v, _ = cube_lines(1)
    rows = [
        "o Body",
        *v,
        "vt 0.25 0.75",
        "vt 1 0",
        "usemtl paint",
        "f 1/1 2/2 3/1",
        "o Glass",
        *v,
        "usemtl glass",
        "f 9 10 12",
    ]
    file = write(tmp_path / "truck.obj", *rows)
    body, glass = read_mesh_file(file, Report(), "here").pieces
    assert glass.uv is None
    whole = joined([body, glass])
    assert (
        np.array_equal(whole.uv[whole.faces[0]], body.uv[body.faces[0]])
        and not whole.uv[whole.faces[1]].any()
    )
    assert joined([glass, glass]).uv is None


@pytest.mark.parametrize(
    "lines, code",
    [
        (["o A", "v 0 0 0", "v ", "v 1 0 0", "v 0 1 0", "f 1 2 3"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 99999999999999999999"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 9"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 99999999999"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f 0 1 2"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f -4 -2 -1"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0", "f a b c"], "GEOMETRY_UNREADABLE"),
        (["o A", "v 0 0 0", "v 1 0 0", "v 0 1 0"], "GEOMETRY_EMPTY"),
        (["o A", "v nan 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 3"], "GEOMETRY_NOT_FINITE"),
        (["o A", "v 1e42 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 3"], "GEOMETRY_NOT_FINITE"),
        (["o A", "v 1e300 0 0", "v 1 0 0", "v 0 1 0", "f 1 2 3"], "GEOMETRY_NOT_FINITE"),
        ([], "GEOMETRY_EMPTY"),
    ],
)
def test_damaged_obj_is_a_diagnostic(tmp_path, lines, code):
    """Faces without vertices, index 0, words for numbers, no faces, NaN, nothing: each has its code and place."""
    path = tmp_path / "a.obj"
    path.write_text("\n".join(lines))
    scene, report = load(path, "A")
    assert [d.code for d in report.diagnostics] == [code]
    assert report.diagnostics[0].where == "bundle#/0"
    assert meshes(scene) == [None]


def test_missing_and_unknown_files_are_diagnostics(tmp_path):
    """A file that is not there, and formats that nothing here reads, say what to do instead."""
    for name, code in (
        ("a.obj", "GEOMETRY_UNREADABLE"),
        ("a.fbx", "GEOMETRY_FORMAT_UNKNOWN"),
        ("a.step", "GEOMETRY_FORMAT_UNKNOWN"),
    ):
        _, report = load(tmp_path / name, "A")
        assert [d.code for d in report.diagnostics] == [code]
    assert "pip install cadquery-ocp-novtk" in report.diagnostics[0].remedy


def test_body_that_is_not_in_the_file_lists_near_names(tmp_path):
    """A misspelt body is an error with what comes close."""
    scene, report = load(
        two_cubes(tmp_path / "a.obj", "o Lever_Arm", "o Lever_Grip"), "Lever_Arn", "Lever_Grip", "x"
    )
    errors = [d for d in report.diagnostics if d.code == "BODY_NOT_IN_FILE"]
    assert len(errors) == 2 and "Lever_Arm" in errors[0].message


@pytest.mark.parametrize(
    "wanted, named", [("Arm:1", "Arm_1"), ("arm 1", "Arm_1"), ("Gr\u00fcn.ipt:1", "Gru\u0308n_1")]
)
def test_names_that_differ_in_spelling_only_are_matched_and_reported(tmp_path, wanted, named):
    """Separators, case, Unicode form and file extensions may differ; the report says so."""
    scene, report = load(two_cubes(tmp_path / "a.obj", f"o {named}", "o Other"), wanted, "Other")
    assert [volume(m) for m in meshes(scene)] == pytest.approx([1, 8])
    assert [d.code for d in report.diagnostics] == ["BODY_MATCHED_LOOSELY"]


def test_bodies_in_no_part_are_a_warning(tmp_path):
    """What the assembly does not name is counted."""
    _, report = load(two_cubes(tmp_path / "a.obj", "o A", "o B"), "A")
    assert [d.code for d in report.diagnostics] == ["BODY_UNUSED"]


@pytest.mark.parametrize("suffix", [s for s in FORMATS if s not in (".obj", ".dae", ".3mf", ".gltf")])
def test_every_plain_format_gives_the_same_solid(tmp_path, suffix):
    """A box of 0.1 x 0.2 x 0.3 m has 6 litres in each format."""
    path = tmp_path / f"a{suffix}"
    trimesh.creation.box((0.1, 0.2, 0.3)).export(path)
    scene, report = load(path, None)
    assert volume(meshes(scene)[0]) == pytest.approx(0.006, rel=1e-6)
    assert report.diagnostics == []


def test_glb_nodes_are_bodies_at_their_place(tmp_path):
    """Two nodes of one geometry are two bodies, each moved by its own transform."""
    scene = trimesh.Scene()
    box = trimesh.creation.box((1, 1, 1))
    scene.add_geometry(
        box,
        node_name="Left",
        geom_name="Box",
        transform=trimesh.transformations.translation_matrix((-5, 0, 0)),
    )
    scene.add_geometry(
        box,
        node_name="Right",
        geom_name="Box",
        transform=trimesh.transformations.translation_matrix((5, 0, 0)),
    )
    scene.export(tmp_path / "a.glb")
    found, _ = load(tmp_path / "a.glb", "Right", "Left")
    assert [float(m.vertices[:, 0].mean()) for m in meshes(found)] == pytest.approx([5, -5])


def test_world_coordinates_become_local_and_equal_parts_share_a_mesh(tmp_path):
    """Three occurrences in world millimetres come back to one mesh in metres in the part's frame."""
    rng = np.random.default_rng(6)
    shape = trimesh.creation.annulus(3, 9, 20)
    poses = [Pose(rotation_exp(rng.normal(size=3)), rng.normal(size=3)) for _ in range(3)]
    lines, first = [], 1
    for i, pose in enumerate(poses):
        lines += [
            f"o P{i}",
            *("v %.6f %.6f %.6f" % tuple(1000 * pose.point(p / 1000)) for p in shape.vertices),
        ]
        lines += ["f %d %d %d" % tuple(f + first) for f in shape.faces]
        first += len(shape.vertices)
    scene, report = load(
        write(tmp_path / "a.obj", lines), "P0", "P1", "P2", definition="ring", unit=1e-3, poses=poses
    )
    assert [b.mesh for n in scene.nodes for b in n.bodies] == [0, 0, 0] and len(scene.meshes) == 1
    assert np.allclose(scene.meshes[0].vertices, shape.vertices / 1000, atol=1e-8)
    assert report.diagnostics == []


def test_occurrence_that_differs_from_its_definition_is_reported(tmp_path):
    """Two cubes of one definition but different size point to a wrong unit or pose."""
    _, report = load(two_cubes(tmp_path / "a.obj", "o A", "o B"), "A", "B", definition="cube")
    assert [d.code for d in report.diagnostics] == ["BODY_SHAPE_DIFFERS"]


def test_mirrored_part_is_baked_with_its_winding_turned(tmp_path):
    """A mirroring map keeps the outside outside."""
    reference = MeshReference(two_cubes(tmp_path / "a.obj", "o A", "o B"), np.diag([-1.0, 1, 1, 1]), "B")
    report = Report()
    scene = Scene(nodes=[Node("P", "P", bodies=(Body("B", reference=reference),))])
    scene = load_geometry(scene, MeshFiles(report), report, lambda *_: None)
    assert volume(scene.meshes[0]) == pytest.approx(8)
    assert scene.meshes[0].vertices[:, 0].min() == -12


def test_normals_of_a_stretched_mesh_stay_across_it():
    """Normals go by the inverse transpose: a slope of 1:1 stretched fourfold in height leans accordingly."""
    slope = Piece(
        np.array([[0.0, 0, 0], [1, -1, 0], [0, 0, 1]]),
        np.array([[0, 1, 2]]),
        np.full((3, 3), (0.5**0.5, 0.5**0.5, 0)),
    )
    found = transformed(slope, np.diag([1.0, 4.0, 1.0, 1.0]))
    assert np.allclose(found.normals, np.array([4, 1, 0]) / 17**0.5)
    assert np.allclose(found.normals @ (found.vertices[1] - found.vertices[0]), 0)


@pytest.mark.parametrize(
    "text", ["v 0 0 0\nv 1 0 0\nf 1 2 3\n", "f 1 2 3\n", "v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n"]
)
def test_an_obj_cut_short_says_so(tmp_path, text):
    """The message tells of the file, not of the parser's insides."""
    path, report = tmp_path / "cut.obj", Report()
    path.write_text(text)
    assert read_mesh_file(path, report, "here") is None
    (found,) = report.diagnostics
    assert (
        found.code == "GEOMETRY_UNREADABLE"
        and "cut short" in found.message
        and "NoneType" not in found.message
    )


def test_usd_is_not_promised(tmp_path):
    """No reader takes USD, so the advice is another format."""
    report = Report()
    assert read_mesh_file(tmp_path / "a.usd", report, "here") is None
    (found,) = report.diagnostics
    assert found.code == "GEOMETRY_FORMAT_UNKNOWN" and "Export glTF or OBJ" in str(found)


def test_a_hull_does_not_hang_on_vertices_that_are_repeated_for_their_normals():
    """Of more vertices than Unity takes, so that it is simplified."""
    ball = trimesh.creation.icosphere(2)
    plain = Mesh("Ball", np.asarray(ball.vertices), np.asarray(ball.faces, dtype=np.int64))
    split = shaded(plain, 1.0)
    assert len(split.vertices) > 3 * len(plain.vertices)
    (one,), (other,) = (
        collision_hulls(Scene(meshes=[mesh]), [(0, "ball")], Report()).values() for mesh in (plain, split)
    )
    assert np.array_equal(one.vertices, other.vertices) and np.array_equal(one.faces, other.faces)


TRIANGLE = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
FACET = b"facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"


def _binary(head: bytes, count: int, body: bytes) -> bytes:
    return head.ljust(80, b"\0") + struct.pack("<I", count) + body


@pytest.mark.parametrize(
    ("data", "said"),
    [
        (_binary(b"", 4, 2 * TRIANGLE + TRIANGLE[:20]), "it ends at byte 204 of 284, those of the 4 triangles"),
        (_binary(b"solid of a CAD program", 3, 2 * TRIANGLE), "it ends at byte 184 of 234"),
        (_binary(b"", 4_000_000_000, 2 * TRIANGLE), "it ends at byte 184 of 200000000084"),
        (b"\0" * 40, "it ends at byte 40, inside the 84 bytes of its head"),
        (_binary(b"", 1, 2 * TRIANGLE), "end at byte 134; the file goes on to byte 184"),
        (b"solid x\n" + FACET + b"facet normal 0 0 1\nouter", "before the line 'endsolid'"),
        (b"solid x\n" + FACET + b"endsol", "before the line 'endsolid'"),
        (b"solid x\n" + FACET + b"endsolid facet\nsolid y\n" + FACET, "before the line 'endsolid'"),
    ],
)
def test_an_stl_that_is_cut_short_says_where_it_ends(data, said, tmp_path):
    path, report = tmp_path / "part.stl", Report()
    path.write_bytes(data)
    assert read_mesh_file(path, report, "part.stl") is None
    assert [d.code for d in report.diagnostics] == ["GEOMETRY_UNREADABLE"]
    assert said in report.diagnostics[0].message


@pytest.mark.parametrize(
    ("data", "triangles"),
    [
        (_binary(b"solid of a CAD program", 2, 2 * TRIANGLE), 2),
        (b"solid x\n" + FACET + b"endsolid facet\n", 1),
        (b"  SOLID x\n" + FACET.upper() + b"ENDSOLID\nsolid y\n" + FACET + b"endsolid y", 2),
    ],
)
def test_a_whole_stl_is_read_however_it_begins(data, triangles, tmp_path):
    path, report = tmp_path / "part.stl", Report()
    path.write_bytes(data)
    found = read_mesh_file(path, report, "part.stl")
    assert not report.diagnostics and sum(len(piece.faces) for piece in found.pieces) == triangles
