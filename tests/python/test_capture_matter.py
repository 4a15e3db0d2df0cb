"""Mass, centre, inertia, material and colour: the same part captured through each double is what the bundle says."""

from __future__ import annotations

import json

import kinefab
import numpy as np
import pytest
from cad.captures import capture, scene_differences
from cad.described import described
from cad.fusion import Fusion
from cad.gltf import exported
from cad.inventor import Inventor
from cad.onshape import answers as onshape
from cad.onshape import boxes, masses, of_each_part
from cad.solidworks import SolidWorks
from cad.tetrahedron import FACES, POINTS, fusion_bodies, inventor_bodies, solidworks_bodies
from kinefab.capture.draft import BodyMesh, Draft, exchanged
from kinefab.capture.looks import look
from kinefab.capture.masses import mass_record, mesh_tensor, together
from kinefab.diagnostics import Report
from kinefab.geometry.mass import combined
from kinefab.model import MassProperties
from test_capture_kinds import TURN

PROGRAMS = ("inventor", "solidworks", "fusion", "onshape")
LOOK = {"material": "Steel, mild", "srgb": [200, 100, 50, 128]}
LINEAR = [0.57758, 0.127438, 0.031896, 128 / 255]
TENSOR = [0.0031, 0.0052, 0.0060, 0.0004, 0.0007, -0.0002]


def part(unit: float, mirrored: bool = False) -> dict:
    """A block on a hinge, turned and shifted; unit: metres of the bundle's unit of length."""
    pose = {"o": (np.array([0.7, 0.1, -0.4]) / unit).tolist(), **dict(zip("xyz", TURN))}
    if mirrored:
        pose["x"] = [-v for v in pose["x"]]
    mass = {
        "in": "part", "mass": 2.5, "center": (np.array([0.006, 0.003, 0.011]) / unit).tolist(),
        "inertia": (np.array(TENSOR) / unit**2).tolist(),
    }  # fmt: skip
    return {
        "id": "M/Block", "name": "Block", "kind": "part", "parent": "M", "definition": "Block", "pose": pose,
        "mass": mass, "look": LOOK,
    }  # fmt: skip


def machine(length: str, up: str, mirrored: bool = False) -> dict:
    unit = {"mm": 0.001, "m": 1.0, "in": 0.0254}[length]
    root = {"id": "M", "kind": "assembly", "flexible": True}
    identity = {"o": [0.0] * 3, "x": [1.0, 0.0, 0.0], "y": [0.0, 1.0, 0.0], "z": [0.0, 0.0, 1.0]}
    meta = {
        "format": "kinefab.bundle",
        "version": "1.0",
        "units": {"length": length, "angle": "rad"},
        "up": up,
    }
    return {"meta": meta, "components": [root | {"pose": identity}, part(unit, mirrored)]}


def record(program: str, values: dict, meshed: bool):
    assembly = described(values)
    if program == "inventor":
        return Inventor(assembly, facets=inventor_bodies if meshed else None).record()
    if program == "solidworks":
        return SolidWorks(assembly, solidworks_bodies if meshed else None).record()
    if program == "fusion":
        return Fusion(assembly, bodies=fusion_bodies if meshed else None).record()
    drawn = exported(POINTS, FACES, [{"baseColorFactor": LINEAR}] * 4)
    bodies = of_each_part(assembly, "gltf", drawn) | boxes(assembly, POINTS) if meshed else {}
    return onshape(assembly) | masses(assembly) | bodies


def plain(values: dict) -> dict:
    """The bundle without what only the doubles read."""
    return {
        **values,
        "components": [{k: v for k, v in c.items() if k != "look"} for c in values["components"]],
    }


@pytest.mark.parametrize("program", PROGRAMS)
@pytest.mark.parametrize(("length", "up"), [("mm", "Z"), ("m", "Y"), ("in", "Z")])
@pytest.mark.parametrize("mirrored", [False, True], ids=["as drawn", "mirrored"])
def test_mass_centre_and_inertia_are_those_of_the_bundle(program, length, up, mirrored, tmp_path):
    values, report = machine(length, up, mirrored), Report()
    found = capture(program, record(program, values, False), tmp_path, up, report)
    # of a mirrored part of SolidWorks the original is not there, and the word is kept
    known = {"CAPTURE_MEMBER_FAILED", "CAPTURE_PATTERN_FREE"}
    assert {d.code for d in report.diagnostics} <= known
    differences = scene_differences(plain(values), found.path, tmp_path)
    assert [d for d in differences if "extras/mirrored" not in d] == []
    scene = json.loads((found.path.with_name(found.path.name + ".kinefab")).read_text("utf-8"))
    bodies = [c for g in scene["gameObjects"] for c in g.get("components", []) if c["type"] == "Rigidbody"]
    assert [body["mass"] for body in bodies] == [2.5]
    i = np.array(
        [
            [TENSOR[0], TENSOR[3], TENSOR[5]],
            [TENSOR[3], TENSOR[1], TENSOR[4]],
            [TENSOR[5], TENSOR[4], TENSOR[2]],
        ]
    )
    assert np.sort(bodies[0]["inertiaTensor"]) == pytest.approx(np.linalg.eigvalsh(i), rel=1e-6)


@pytest.mark.parametrize("program", PROGRAMS)
def test_material_and_colour(program, tmp_path):
    """Screens' bytes become the linear numbers of a bundle, opacity its alpha."""
    values, report = machine("mm", "Z"), Report()
    found = capture(program, record(program, values, True), tmp_path, "Z", report)
    assert [d.code for d in report.diagnostics if d.code != "CAPTURE_MEMBER_FAILED"] == []
    bundle = json.loads(found.path.read_text("utf-8"))
    (material,) = bundle["materials"]
    assert material["name"] == LOOK["material"] and material["color"] == pytest.approx(LINEAR, abs=1e-5)
    (made,) = [c for c in bundle["components"] if c["kind"] == "part"]
    assert [body["material"] for body in made["bodies"]] == [LOOK["material"]]
    kinefab.export(found.path, tmp_path / "x.kinefab")
    shown = json.loads((tmp_path / "x.kinefab").read_text("utf-8"))["materials"]
    assert [m["name"] for m in shown] == [LOOK["material"]]
    assert shown[0]["color"] == pytest.approx(LINEAR, abs=1e-5)


@pytest.mark.parametrize("program", ["inventor", "solidworks", "fusion"])
@pytest.mark.parametrize("count", [0, 3])
def test_colours_of_single_faces_are_told(program, count, tmp_path):
    """The body has one; a body with a colour of its own is none of them.  Onshape's keep theirs."""
    values, report = machine("mm", "Z"), Report()
    values["components"][1]["look"] = {**LOOK, "painted": count}
    found = capture(program, record(program, values, True), tmp_path, "Z", report)
    told = [d.message for d in report.diagnostics if d.code == "CAPTURE_FACE_COLORS"]
    assert [message.startswith("3 of the faces") for message in told] == ([True] if count else [])
    lost = [o.outcome.value for o in found.draft.report.outcomes if o.feature.startswith("colours of")]
    assert lost == (["approximated"] if count else [])


def tetrahedron() -> tuple[BodyMesh, np.ndarray]:
    """A mesh, and its tensor for a mass of 2 from points that are spread evenly in it, by the closed form of a tetrahedron."""
    mesh = BodyMesh("T", (POINTS + [0.1, -0.2, 0.3]).ravel().tolist(), [i for face in FACES for i in face])
    center = POINTS.mean(axis=0)
    spread = sum(np.outer(p - center, p - center) for p in POINTS) * 2.0 / 20.0
    return mesh, np.trace(spread) * np.eye(3) - spread


def test_the_tensor_of_a_mesh_is_that_of_the_solid():
    mesh, expected = tetrahedron()
    xx, yy, zz, xy, yz, xz = mesh_tensor([mesh], 2.0) or []
    assert np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) == pytest.approx(expected, abs=1e-12)
    assert mesh_tensor([], 2.0) is None


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_where_the_principal_moments_leave_the_sign_open_the_mesh_tells_it(sign):
    """With one product alone both signs have the same principal moments."""
    points = POINTS @ np.diag([1.0, 1.0, 0.0]) + [[0, 0, 0], [0, 0, 0], [0, 0, 0], [0.01, 0.0066666667, 0.05]]
    mesh = BodyMesh("T", points.ravel().tolist(), [i for face in FACES for i in face])
    tensor = mesh_tensor([mesh], 2.0)
    assert tensor is not None and abs(tensor[3]) > 1e-5
    given = [*tensor[:3], *(sign * v for v in tensor[3:])]
    xx, yy, zz, xy, yz, xz = tensor
    principal = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]).tolist()
    draft = Draft("X", "m", "Z")
    center = points.mean(axis=0).tolist()
    found = mass_record(draft, "T", 2.0, center, given, principal, "centre", [mesh])
    assert found["inertia"] == pytest.approx(tensor) and draft.report.diagnostics == []


@pytest.mark.parametrize("factor", [100.0, 0.01])
def test_a_centre_in_another_unit_than_the_mesh_is_told(factor):
    mesh, tensor = tetrahedron()
    moments = np.linalg.eigvalsh(tensor).tolist()
    center = ((POINTS.mean(axis=0) + [0.1, -0.2, 0.3]) * factor).tolist()
    draft = Draft("X", "m", "Z")
    mass_record(draft, "T", 2.0, center, [*moments, 0.0, 0.0, 0.0], moments, "centre", [mesh])
    assert [d.code for d in draft.report.diagnostics] == ["CAPTURE_CENTER"]


@pytest.mark.parametrize("program", ["inventor", "fusion"])
def test_an_appearance_without_a_documented_colour_is_told(program, tmp_path):
    answers, report = record(program, machine("mm", "Z"), True), Report()
    for entry in answers:
        for key in [key for key in entry if key.startswith(('Item("', "itemById("))]:
            entry['Item("odd_color")' if key.startswith("Item") else 'itemById("odd")'] = entry.pop(key)
    found = capture(program, answers, tmp_path, "Z", report)
    assert "CAPTURE_NO_COLOR" in [d.code for d in report.diagnostics]
    assert [m["name"] for m in json.loads(found.path.read_text("utf-8"))["materials"]] == [LOOK["material"]]


@pytest.mark.parametrize("program", PROGRAMS)
def test_a_part_without_a_mass_has_none(program, tmp_path):
    """Onshape has none without a material; others may answer zero, or nothing."""
    values = machine("m", "Z")
    answers, report = record(program, values, True), Report()
    for entry in answers if isinstance(answers, list) else ():
        for key in entry.keys() & {"Mass", "mass"}:
            entry[key] = 0.0
    if program == "onshape":
        for key in [key for key in answers if key.startswith("mass ")]:
            answers[key] = {"bodies": {"JHD": {"hasMass": False, "mass": [0.0, 0.0, 0.0]}}}
    found = capture(program, answers, tmp_path, "Z", report)
    assert [d.code for d in report.diagnostics if d.code != "CAPTURE_MEMBER_FAILED"] == []
    assert not any("mass" in c for c in json.loads(found.path.read_text("utf-8"))["components"])


def test_one_material_in_two_colours_is_two():
    draft = Draft("X", "m", "Z")
    red, blue = [1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 1.0, 1.0]
    names = [
        look(draft, "Steel", color, part)
        for color, part in ((red, "A"), (blue, "B"), (red, "C"), (blue, "B"))
    ]
    assert names == ["Steel", "Steel, B", "Steel", "Steel, B"]
    assert [look(draft, "", color, "A") for color in (red, blue, red)] == ["A", "A (2)", "A"]
    assert look(draft, "", None, "A") is None


@pytest.mark.parametrize("program", ["inventor", "fusion"])
def test_parts_that_are_called_alike_are_two(program, tmp_path):
    """Files of one name in two folders; components of linked designs."""
    values = machine("mm", "Z")
    root, first = values["components"]
    second = {
        **first,
        "id": "M/Other",
        "name": "Other",
        "definition": "Other",
        "mass": {**first["mass"], "mass": 4.0},
    }
    third = {**first, "id": "M/Third", "name": "Third"}
    values["components"] = [root, first, second, third]
    values["componentNames"] = {"Block": "Part1", "Other": "Part1"}
    found = capture(program, record(program, values, True), tmp_path, "Z")
    made = [c for c in json.loads(found.path.read_text("utf-8"))["components"] if c["kind"] == "part"]
    assert [c["definition"] for c in made] == ["Part1", "Part1 (2)", "Part1"]
    assert [c["mass"]["mass"] for c in made] == [2.5, 4.0, 2.5]
    assert made[0]["file"] == made[2]["file"] != made[1]["file"]


def test_bodies_weighed_each_are_one_by_the_parallel_axis_theorem():
    """As the package's own, which shares no code with what runs inside a program."""
    listed = [
        (2.0, [0.3, -0.1, 0.5], [0.3, 0.4, 0.5, 0.01, -0.02, 0.03]),
        (5.0, [-0.2, 0.7, 0.1], [0.6, 0.5, 0.7, -0.03, 0.01, 0.02]),
    ]
    tensor = lambda t: np.array([[t[0], t[3], t[5]], [t[3], t[1], t[4]], [t[5], t[4], t[2]]])  # noqa: E731
    records = [
        {"mass": m, "center": c, "inertia": t, "extras": {"reading": "as listed"}} for m, c, t in listed
    ]
    found = together(records)
    wanted = combined([MassProperties(m, np.array(c), tensor(t)) for m, c, t in listed])
    assert found["mass"] == wanted.mass and np.allclose(found["center"], wanted.center)
    assert np.allclose(tensor(found["inertia"]), wanted.inertia)


def test_a_joint_seen_from_its_other_side_counts_the_other_way():
    dof = {"name": "rz", "value": 0.3, "min": -0.2, "max": 1.4, "minEnabled": True, "maxEnabled": True}
    seen = exchanged(
        {"id": "j", "a": "A", "b": "ground", "frameA": {"o": 1}, "frameB": {"o": 2}, "dof": [dof]}
    )
    assert (seen["a"], seen["b"], seen["frameA"]["o"], seen["frameB"]["o"]) == ("ground", "A", 2, 1)
    assert seen["dof"] == [dof | {"value": -0.3, "min": -1.4, "max": 0.2}]
    assert exchanged({"a": "A", "b": "ground", "frameA": {"o": 1}}) == {
        "a": "ground",
        "b": "A",
        "frameA": {"o": 1},
    }
