"""Onshape's parts as glTF: triangles, normals and colours reach the scene, whatever unit and axes the file has."""

from __future__ import annotations

import base64
import io
import json
import random

import kinefab
import numpy as np
import pytest
import trimesh
from cad.captures import capture
from cad.described import described
from cad.documented import untagged
from cad.gltf import exported
from cad.onshape import answers, boxed, masses, of_each_part, stl, weighed
from cad.tetrahedron import FACES, POINTS
from kinefab.capture.draft import WRONG_ANSWER
from kinefab.capture.looks import linear_rgba
from kinefab.capture.onshape.answers import Answers, Rest
from kinefab.capture.onshape.gltf import read_gltf
from kinefab.capture.run import drafted
from kinefab.diagnostics import Report
from test_capture_attack import WHERE, Server
from test_capture_matter import LINEAR, LOOK, machine, tetrahedron

SOLID, VOLUME = tetrahedron()[1], 0.03 * 0.02 * 0.05 / 6.0
Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Of a vector of the part that of the file."""
OWN = {"baseColorFactor": LINEAR, "metallicFactor": 0.25, "roughnessFactor": 0.4}
BLUE = {"baseColorFactor": [0.0, 0.0, 0.6, 1.0], "metallicFactor": 0.25, "roughnessFactor": 0.4}
ONE, TWO = [OWN] * 4, [OWN, BLUE, OWN, BLUE]


def answered(content: bytes, mass: dict | None = None, values: dict | None = None) -> dict:
    """The answers on a block that is the tetrahedron.  mass: the answer on its mass, by default that of the solid."""
    values = machine("mm", "Z") if values is None else values
    assembly = described(values)
    found = answers(assembly) | masses(assembly) | of_each_part(assembly, "gltf", content)
    stated = weighed(2.0, POINTS.mean(axis=0), SOLID, VOLUME) if mass is None else mass
    return found | {key: stated for key in found if key.startswith("mass ")}


def shown(path, folder):
    """The scene that a source is exported to, and the materials of its file."""
    target = folder / "x.kinefab"
    scene = kinefab.export(path, target).analysed.scene
    return scene, json.loads(target.read_text("utf-8")).get("materials", [])


def corners(scene) -> np.ndarray:
    """Every corner of the one part in its own frame before the turn to Y up, with its normal, sorted."""
    (node,) = [node for node in scene.nodes if node.bodies]
    mesh = scene.meshes[node.bodies[0].mesh]
    back = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    listed = np.hstack([mesh.vertices @ back.T, mesh.normals @ back.T])[mesh.faces].reshape(-1, 6)
    return listed[np.lexsort(np.round(listed, 5).T)]


def expected() -> np.ndarray:
    listed = []
    for face in FACES:
        a, b, c = POINTS[face]
        n = np.cross(b - a, c - a)
        listed += [np.hstack([p, n / np.linalg.norm(n)]) for p in (a, b, c)]
    found = np.array(listed)
    return found[np.lexsort(np.round(found, 5).T)]


@pytest.mark.parametrize("binary", [True, False], ids=["glb", "gltf"])
def test_the_double_is_a_gltf_to_others(binary):
    loaded = trimesh.load(
        io.BytesIO(exported(POINTS, FACES, TWO, binary)), file_type="glb" if binary else "gltf"
    )
    assert loaded.bounds == pytest.approx(np.array([POINTS.min(axis=0), POINTS.max(axis=0)]))


@pytest.mark.parametrize("binary", [True, False], ids=["glb", "gltf"])
def test_triangles_normals_and_the_colour_reach_the_scene(binary, tmp_path):
    report = Report()
    found = capture("onshape", answered(exported(POINTS, FACES, ONE, binary)), tmp_path, "Z", report)
    assert {d.code for d in report.diagnostics} <= {"CAPTURE_MEMBER_FAILED"}  # the mate values that are none
    scene, materials = shown(found.path, tmp_path)
    np.testing.assert_allclose(corners(scene), expected(), atol=1e-6)
    (material,) = materials
    assert material["name"] == LOOK["material"] and material["color"] == pytest.approx(LINEAR, abs=1e-5)
    assert (material["metallic"], material["smoothness"]) == pytest.approx((0.25, 0.6))


def test_faces_of_another_colour_are_submeshes(tmp_path):
    """A face may be a primitive of its own: those of one colour are put together."""
    found = capture("onshape", answered(exported(POINTS, FACES, TWO)), tmp_path, "Z")
    scene, materials = shown(found.path, tmp_path)
    np.testing.assert_allclose(corners(scene), expected(), atol=1e-6)
    (node,) = [node for node in scene.nodes if node.bodies]
    body = node.bodies[0]
    assert scene.meshes[body.mesh].face_counts == (2, 2)
    assert [scene.surfaces[i].color for i in body.surfaces] == [
        pytest.approx(LINEAR, abs=1e-5), pytest.approx(BLUE["baseColorFactor"])
    ]  # fmt: skip
    assert [m["name"] for m in materials] == [LOOK["material"], f"{LOOK['material']}, Block"]
    faces = scene.meshes[body.mesh].vertices[scene.meshes[body.mesh].faces]
    blue = {tuple(np.round(sorted(map(tuple, POINTS[FACES[i]])), 6).ravel()) for i in (1, 3)}
    back = faces[2:] @ np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]).T
    assert {tuple(np.round(sorted(map(tuple, f)), 6).ravel()) for f in back} == blue


@pytest.mark.parametrize("turned", [False, True], ids=["Z up", "Y up"])
@pytest.mark.parametrize(("unit", "words"), [(1.0, "metres"), (0.001, "millimetres"), (0.0254, "inches")])
def test_whatever_unit_and_axes_it_has(unit, words, turned, tmp_path):
    """What the program says of the part's mass tells; what is not as documented is told."""
    told = (Y_UP if turned else np.eye(3)) / unit
    report = Report()
    found = capture("onshape", answered(exported(POINTS, FACES, TWO, linear=told)), tmp_path, "Z", report)
    scene, _ = shown(found.path, tmp_path)
    np.testing.assert_allclose(corners(scene), expected(), atol=1e-6)
    said = [d.message for d in report.diagnostics if d.code == "CAPTURE_MESH_READING"]
    if unit == 1.0 and not turned:
        assert said == []
    else:
        assert len(said) == 1 and words in said[0] and ("Y up" in said[0]) == turned


@pytest.mark.parametrize("mass", ["overridden", "none"])
def test_where_the_mass_tells_nothing_the_box_does(mass, tmp_path):
    said = weighed(7.0, np.array([3.0, 3.0, 3.0]), np.eye(3), 0.0)
    if mass == "none":
        said = {"bodies": {"JHD": {"hasMass": False, "mass": [0.0] * 3}}}
    held = answered(exported(POINTS, FACES, ONE, linear=Y_UP), said)
    where = next(key.partition(" ")[2] for key in held if key.startswith("gltf "))
    held[f"box {where}"] = boxed(POINTS)
    report = Report()
    scene, _ = shown(capture("onshape", held, tmp_path, "Z", report).path, tmp_path)
    np.testing.assert_allclose(corners(scene), expected(), atol=1e-6)
    assert "CAPTURE_MESH_READING" in {d.code for d in report.diagnostics}


def test_the_box_is_asked_for_only_then(tmp_path):
    sound = answered(exported(POINTS, FACES, ONE))
    capture("onshape", sound, tmp_path, "Z")
    asked: list[str] = []
    from kinefab.capture.draft import Draft
    from kinefab.capture.onshape.capture import capture as run

    def fetch(question: str):
        asked.append(question.partition(" ")[0])
        found = sound[question]
        return base64.b64decode(found["base64"]) if "base64" in found else found

    run(Answers(fetch=fetch), Draft("Onshape", "m", "Z"))
    assert sorted(asked) == ["definition", "features", "gltf", "mass", "matevalues", "name", "parts"]


def test_what_fits_in_no_reading_is_told_and_read_as_documented(tmp_path):
    held = answered(exported(POINTS, FACES, ONE), weighed(2.0, np.array([0.5, 0.0, 0.0]), SOLID, VOLUME))
    report = Report()
    scene, _ = shown(capture("onshape", held, tmp_path, "Z", report).path, tmp_path)
    np.testing.assert_allclose(corners(scene), expected(), atol=1e-6)
    assert "CAPTURE_MESH_UNSETTLED" in {d.code for d in report.diagnostics}


def test_a_part_that_cannot_tell_is_read_as_the_others_have_told(tmp_path):
    """An octahedron about its centre is the same in all axes; the tetrahedron beside it shows that the files are Y up."""
    values = machine("mm", "Z")
    values["components"].append(
        {**values["components"][1], "id": "M/Ball", "name": "Ball", "definition": "Ball"}
    )
    held = answered(exported(POINTS, FACES, ONE, linear=Y_UP), values=values)
    ends = 0.01 * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1.0]])
    sides = [[x, y, z] if (x + y + z) % 2 == 0 else [y, x, z] for x in (0, 1) for y in (2, 3) for z in (4, 5)]
    flat = exported(ends, sides, [OWN] * 7 + [BLUE], linear=Y_UP)  # one side is blue: which one is to be kept
    for key in held:
        if " EBall " in key and key.startswith("gltf "):
            held[key] = {"base64": base64.b64encode(flat).decode()}
        elif " EBall " in key and key.startswith("mass "):
            held[key] = weighed(2.0, np.zeros(3), 2.0 * 0.2 * 0.01**2 * np.eye(3), 4.0 / 3.0 * 0.01**3)
    found = capture("onshape", held, tmp_path, "Z")
    text = next(t for p in found.files if "\no Ball\n" in (t := p.read_text("utf-8")))
    points = np.array([line.split()[1:] for line in text.splitlines() if line.startswith("v ")], dtype=float)
    last = [line for line in text.splitlines() if line.startswith("f ")][-1]
    blue = points[[int(word.partition("/")[0]) - 1 for word in last.split()[1:]]]
    np.testing.assert_allclose(
        sorted(map(tuple, np.round(blue, 6))), sorted(map(tuple, ends[sides[-1]])), atol=1e-6
    )


def test_colours_as_screens_have_them_are_seen_as_such(tmp_path):
    srgb = [v / 255.0 for v in LOOK["srgb"]]
    paints = [{"baseColorFactor": srgb}, {"baseColorFactor": [0.5, 0.5, 0.5, 1.0]}] * 2
    report = Report()
    found = capture("onshape", answered(exported(POINTS, FACES, paints)), tmp_path, "Z", report)
    assert "CAPTURE_COLORS_READ" in {d.code for d in report.diagnostics}
    _, materials = shown(found.path, tmp_path)
    assert [m["color"] for m in materials] == [
        pytest.approx(LINEAR, abs=1e-5), pytest.approx(linear_rgba([0.5, 0.5, 0.5, 1.0]), abs=1e-5)
    ]  # fmt: skip


@pytest.mark.parametrize("lost", ["missing", "broken", "draco"])
def test_without_a_gltf_the_stl_is_taken_and_it_is_told(lost, tmp_path):
    content = exported(POINTS, FACES, ONE, binary=lost != "draco")
    content = content[: len(content) // 2] if lost == "broken" else content
    if lost == "draco":
        document = json.loads(content) | {"extensionsRequired": ["KHR_draco_mesh_compression"]}
        content = json.dumps(document).encode()
    held = answered(content) | stl(described(machine("mm", "Z")), POINTS, FACES)
    if lost == "missing":
        for key in [key for key in held if key.startswith("gltf ")]:
            held[key] = {"failed": "gone"}
    report = Report()
    scene, materials = shown(capture("onshape", held, tmp_path, "Z", report).path, tmp_path)
    assert "CAPTURE_NO_GLTF" in {d.code for d in report.diagnostics}
    (node,) = [node for node in scene.nodes if node.bodies]
    assert np.ptp(scene.meshes[node.bodies[0].mesh].vertices, axis=0) == pytest.approx([0.03, 0.05, 0.02])
    assert [m["name"] for m in materials] == [LOOK["material"]]


def test_nodes_place_their_meshes():
    """A matrix goes by columns; rotation, scale and translation are applied in that order; a mirror turns the winding."""
    half = float(np.sqrt(0.5))
    placed = read_gltf(
        exported(
            POINTS, FACES, ONE,
            node={"rotation": [0.0, 0.0, half, half], "scale": [2.0, 1.0, -1.0], "translation": [1.0, 0.0, 0.0]},
        )
    )  # fmt: skip
    wanted = POINTS * [2.0, 1.0, -1.0] @ np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]) + [
        1.0,
        0.0,
        0.0,
    ]
    assert {tuple(p) for p in np.round(placed.points, 5)} == {tuple(p) for p in np.round(wanted, 5)}
    a, b, c = (placed.points[placed.faces[:, i]] for i in range(3))
    assert np.einsum("ij,ij->i", a - [1, 0, 0], np.cross(b - [1, 0, 0], c - [1, 0, 0])).sum() > 0.0
    outward = np.cross(b - a, c - a)
    assert np.all(np.einsum("ij,ij->i", outward, placed.normals[placed.faces[:, 0]]) > 0.0)
    matrix = [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, -1, 0, 1, 0, 0, 1]
    again = read_gltf(exported(POINTS, FACES, ONE, node={"matrix": matrix}))
    np.testing.assert_allclose(again.points, placed.points, atol=1e-7)


@pytest.mark.parametrize("binary", [True, False])
def test_a_broken_file_is_refused_not_followed(binary):
    """Bytes and numbers exchanged at random: read, or one of the errors that a capture takes for a wrong answer."""
    sound, chance = exported(POINTS, FACES, TWO, binary), random.Random(5)
    for _ in range(600):
        broken = bytearray(sound)
        for _ in range(chance.choice((1, 3, 20))):
            broken[chance.randrange(len(broken))] = chance.choice(b"0123456789-[]{},\x00\xff")
        if chance.random() < 0.2:
            del broken[chance.randrange(len(broken)) :]
        try:
            shape = read_gltf(bytes(broken))
            assert shape.faces.max() < len(shape.points)
        except WRONG_ANSWER:
            pass


@pytest.mark.parametrize("damage", [b"\x01\x00\xa0\x7f", b"\x00\x00\x80\xff"])
def test_a_corner_that_is_nowhere_is_refused(damage):
    """A signalling NaN, of which numpy warned on some machines, and an infinite one: both were taken for places."""
    sound = bytearray(exported(POINTS, FACES, TWO, True))
    at = sound.index(np.asarray(POINTS, np.float32)[-1:].tobytes())
    sound[at : at + 4] = damage
    with pytest.raises(ValueError, match="no number"):
        read_gltf(bytes(sound))


def test_saved_gltf_is_a_source_with_its_looks(tmp_path):
    values = machine("mm", "Z")
    for word, answer in answers(described(values)).items():
        (tmp_path / f"{word}.json").write_text(json.dumps(answer), "utf-8")
    (tmp_path / "EBlock_JHD.glb").write_bytes(exported(POINTS, FACES, TWO))
    scene, materials = shown(tmp_path / "definition.json", tmp_path)
    np.testing.assert_allclose(corners(scene), expected(), atol=1e-6)
    assert [m["color"] for m in materials] == [
        pytest.approx(LINEAR, abs=1e-5), pytest.approx(BLUE["baseColorFactor"])
    ]  # fmt: skip


def test_what_is_asked_of_the_server():
    with Server(lambda path: (200, {}, b"{}")) as server:
        rest = Rest(server.base, WHERE, ("a", "b"))
        rest.fetch("gltf d m e p List_A=B;c=1")
        rest.fetch("box d v/x e p default")
    (gltf, _), (box, _) = server.asked
    assert gltf.startswith("/api/parts/d/d/m/m/e/e/partid/p/gltf?") and "outputFaceAppearances=true" in gltf
    assert "configuration=List_A%3DB%3Bc%3D1" in gltf and "chordTolerance=0.0001" in gltf
    assert box.startswith("/api/parts/d/d/v/x/e/e/partid/p/boundingboxes?")


@pytest.mark.parametrize("binary", [True, False])
def test_a_blanked_record_has_no_names_in_its_files(binary, tmp_path):
    content = exported(POINTS, FACES, TWO, binary, node={"name": "Secret lever"})
    held = answered(content)
    for key in held:
        if key.startswith("parts "):
            held[key] = [
                {**held[key][0], "partNumber": "Secret number", "customProperties": {"a": "Secret value"}}
            ]
    sound = capture_onshape_record(held, tmp_path, False)
    assert "Secret number" in sound.read_text("utf-8")
    blank = json.loads(capture_onshape_record(held, tmp_path, True).read_text("utf-8"))
    files = b"".join(
        base64.b64decode(v["base64"]) for k, v in blank["answers"].items() if k.startswith("gltf ")
    )
    assert b"baseColorFactor" in files and b"Secret" not in files and b"Part 1" not in files
    assert "Secret" not in json.dumps(blank)
    again = capture("onshape", blank["answers"], tmp_path, "Z")
    (mesh,) = again.draft.meshes.values()
    assert [count for count, _ in mesh[0].runs] == [2, 2] and mesh[0].normals


def capture_onshape_record(held: dict, folder, blank: bool):
    """What a capture over the network would record of these answers."""
    path = folder / f"{blank}.record.json"
    drafted("onshape", Answers(untagged(held)), Report(), "Z", path, blank)
    return path
