"""The CAD bundle: units, axes, hierarchy, bodies and masses."""

from __future__ import annotations

import json
import math

import kinefab
import numpy as np
import pytest
from jsonschema import Draft202012Validator
from kinefab import sources
from kinefab.diagnostics import KinefabError, Report, schema_directory
from kinefab.model import FeatureKind, JointKind, MeshKey, Motion
from source_bundles import FIXTURES, bundle, codes, part, read

COS30, SIN30 = math.sqrt(3.0) / 2.0, 0.5
SLIDER_X = 0.025 * COS30 + math.sqrt(0.09**2 - (0.025 * SIN30) ** 2)
"""Slider-crank: x = r cos q + sqrt(l^2 - (r sin q)^2), here r = 25 mm, l = 90 mm, q = 30 degrees."""


@pytest.fixture(scope="module")
def lever():
    report = Report()
    scene = sources.read(FIXTURES / "lever" / "lever.bundle.json", report)
    assert report.diagnostics == []
    return scene


@pytest.mark.parametrize(
    "name", ["lever/lever", "hinge_slider_zup/hinge_slider", "hinge_slider_yup/hinge_slider"]
)
def test_fixture_obeys_the_schema(name):
    """Every committed bundle is valid by schemas/bundle.schema.json."""
    schema = json.loads((schema_directory() / "bundle.schema.json").read_text(encoding="utf-8"))
    values = json.loads((FIXTURES / f"{name}.bundle.json").read_text(encoding="utf-8"))
    assert list(Draft202012Validator(schema).iter_errors(values)) == []


def test_a_configuration_is_the_sources(tmp_path):
    """Of a bundle and of its lines, and of the scene that is written of them."""
    values = json.loads((FIXTURES / "hinge_slider_yup" / "hinge_slider.bundle.json").read_text("utf-8"))
    values["meta"]["configuration"] = "Long arm"
    (tmp_path / "a.bundle.json").write_text(json.dumps(values), "utf-8")
    lines = (FIXTURES / "lever" / "lever.csv").read_text("utf-8").splitlines()
    lines.insert(next(i for i, line in enumerate(lines) if line.startswith("META")) + 1, "META;configuration;Long arm")
    (tmp_path / "a.csv").write_text("\n".join(lines) + "\n", "utf-8")
    for name in ("a.bundle.json", "a.csv"):
        report = Report()
        assert sources.read(tmp_path / name, report).source.configuration == "Long arm"
        assert report.diagnostics == []
    for mesh in (FIXTURES / "hinge_slider_yup").glob("*.obj"):
        (tmp_path / mesh.name).write_bytes(mesh.read_bytes())
    target = kinefab.export(tmp_path / "a.bundle.json", tmp_path / "a.kinefab").path
    assert json.loads(target.read_text("utf-8"))["source"]["configuration"] == "Long arm"


def test_z_up_centimetres_become_y_up_metres(lever):
    """A Z-up point (x, y, z) cm stands at (x, z, -y) / 100 m."""
    origins = {node.id: node.pose.translation for node in lever.nodes}
    assert origins["Lever/BarC:1"] == pytest.approx([0.025 * COS30, 0.008, -0.025 * SIN30], abs=1e-11)
    assert origins["Lever/SliderD:1"] == pytest.approx([SLIDER_X, 0.008, 0.0], abs=1e-11)
    assert SLIDER_X == pytest.approx(0.110778352, abs=1e-9)


def test_unturned_part_stays_unturned(lever):
    """A part with the world's axes in CAD has the identity rotation in the scene, whatever axis is up."""
    base = next(node for node in lever.nodes if node.name == "Base:1")
    assert np.array_equal(base.pose.rotation, np.eye(3))


def test_turned_part_turns_about_the_turned_axis(lever):
    """30 degrees about CAD's Z are 30 degrees about the scene's Y."""
    crank = next(node for node in lever.nodes if node.name == "Crank:1")
    expected = [[COS30, 0, SIN30], [0, 1, 0], [-SIN30, 0, COS30]]
    assert crank.pose.rotation == pytest.approx(np.array(expected), abs=1e-9)


def test_hierarchy_keeps_parents_first(lever):
    """Every node stands after its parent, and occurrence paths are kept as ids."""
    assert all(node.parent is None or node.parent < i for i, node in enumerate(lever.nodes))
    parents = {node.id: None if node.parent is None else lever.nodes[node.parent].id for node in lever.nodes}
    assert parents["Lever/Crank:1/Shaft:1"] == "Lever/Crank:1"
    assert [node.id for node in lever.nodes if node.grounded] == ["Lever/Base:1"]
    assert [node.id for node in lever.nodes if node.flexible] == ["Lever"]


def test_parent_may_stand_after_its_child(tmp_path):
    """A bundle lists components in any order; the scene has the parent first."""
    top = {**part("Top"), "kind": "assembly"}
    scene, _ = read(bundle(part("Top/Leaf", parent="Top"), top), tmp_path)
    assert [(node.id, node.parent) for node in scene.nodes] == [("Top", None), ("Top/Leaf", 0)]


def test_body_reference_takes_world_vertices_to_the_node(lever):
    """The eccentric pin's point in the OBJ (world, cm) lands on the bar's own origin."""
    bar = next(node for node in lever.nodes if node.name == "BarC:1")
    reference = bar.bodies[0].reference
    on_pin = np.array([2.5 * COS30, 2.5 * SIN30, 0.8, 1.0])
    assert reference.to_node @ on_pin == pytest.approx([0, 0, 0, 1], abs=1e-11)
    assert np.linalg.det(reference.to_node[:3, :3]) == pytest.approx(1e-6)
    assert (reference.path.name, reference.key, reference.keyed_by) == (
        "lever.obj",
        "BarC_1_Bar",
        MeshKey.OBJECT,
    )


def test_every_body_is_in_the_mesh_file(lever):
    """Each reference names an ``o`` of the OBJ, and each ``o`` is named once."""
    keys = [body.reference.key for node in lever.nodes for body in node.bodies]
    text = (FIXTURES / "lever" / "lever.obj").read_text(encoding="utf-8")
    assert sorted(keys) == sorted(line[2:] for line in text.splitlines() if line.startswith("o "))


def test_mirrored_part_bakes_the_mirror(tmp_path):
    """A left-handed triad gives a proper pose, and the mirror goes into the mesh; world points stay put."""
    mirrored = part("Cover", (1, 2, 3), bodies=[{"id": "Cover"}], definition="Cover.ipt")
    mirrored["pose"].update(x=[0, 0, 1], y=[0, 1, 0], z=[1, 0, 0])
    values = bundle(mirrored)
    values["meta"]["mesh"] = {"files": ["c.obj"], "units": "m", "coordinates": "part"}
    scene, report = read(values, tmp_path)
    node = scene.nodes[0]
    assert codes(report) == ["POSE_MIRRORED"]
    assert np.linalg.det(node.pose.rotation) == pytest.approx(1.0)
    to_node = node.bodies[0].reference.to_node
    assert np.linalg.det(to_node[:3, :3]) == pytest.approx(-1.0)
    at = node.pose.point((to_node @ [0.1, 0.2, 0.3, 1.0])[:3])
    assert at == pytest.approx([1.3, 2.2, 3.1])
    assert node.definition != "Cover.ipt"


def test_mesh_unit_may_differ_from_the_bundle_unit(tmp_path):
    """Inventor's interface speaks centimetres while the OBJ may be in millimetres or inches."""
    values = bundle(part("A", (1, 0, 0), bodies=[{"id": "A"}]), length="cm")
    values["meta"]["mesh"] = {"files": ["a.obj"], "units": "in", "coordinates": "world"}
    scene, _ = read(values, tmp_path)
    to_node = scene.nodes[0].bodies[0].reference.to_node
    assert to_node @ [1, 0, 0, 1] == pytest.approx([0.0254 - 0.01, 0, 0, 1])


@pytest.mark.parametrize(
    ("layout", "component_file", "body", "expected"),
    [
        ("single", None, {"id": "B"}, ("all.obj", "B")),
        ("single", None, {"id": "B", "meshKey": "K"}, ("all.obj", "K")),
        ("per_part", "meshes\\p.obj", {"id": "B"}, ("meshes/p.obj", None)),
        ("per_body", None, {"id": "B", "file": "b.stl"}, ("b.stl", None)),
    ],
)
def test_mesh_layout_names_file_and_key(tmp_path, layout, component_file, body, expected):
    """A body is found by file and name as the mesh export was laid out."""
    values = bundle(part("A", bodies=[body], **({"file": component_file} if component_file else {})))
    files = ["all.obj"] if layout == "single" else []
    values["meta"]["mesh"] = {"files": files, "units": "m", "layout": layout, "coordinates": "part"}
    scene, report = read(values, tmp_path)
    reference = scene.nodes[0].bodies[0].reference
    assert codes(report) == []
    assert (reference.path.relative_to(tmp_path).as_posix(), reference.key) == expected


def test_mass_comes_into_the_node_in_kilograms_and_metres(tmp_path):
    """Grams, millimetres and Z up: centre and tensor are scaled and turned with the axes."""
    mass = {"in": "part", "mass": 500.0, "center": [10, 20, 30], "inertia": [1e6, 2e6, 2.5e6, 1e5, 2e5, 3e5]}
    values = bundle(part("A", mass=mass), up="Z", length="mm")
    values["meta"]["units"]["mass"] = "g"
    scene, _ = read(values, tmp_path)
    found = scene.nodes[0].mass
    assert found.mass == pytest.approx(0.5)
    assert found.center == pytest.approx([0.01, 0.03, -0.02])
    # (x, y, z) -> (x, z, -y): Ixx stays, Iyy and Izz change places, Ixy <- Ixz, Ixz <- -Ixy, Iyz <- -Iyz; g
    # mm^2 = 1e-9.
    expected = 1e-9 * np.array([[1e6, 3e5, -1e5], [3e5, 2.5e6, -2e5], [-1e5, -2e5, 2e6]])
    assert found.inertia == pytest.approx(expected, rel=1e-12)


def test_a_large_machine_in_small_units_has_its_inertia(tmp_path):
    """A crane of 50 t and 20 m has moments beyond 1e15 g mm^2; what no unit makes a body of is told."""
    mass = {"in": "part", "mass": 5e7, "center": [0, 0, 0], "inertia": [2e14, 1.7e15, 1.8e15, 0, 0, 0]}
    values = bundle(part("Boom", mass=mass), up="Y", length="mm")
    values["meta"]["units"]["mass"] = "g"
    scene, report = read(values, tmp_path)
    assert codes(report) == [] and scene.nodes[0].mass.inertia[1, 1] == pytest.approx(1.7e6)
    mass["inertia"][0] = 1e30
    with pytest.raises(KinefabError) as caught:
        read(values, tmp_path)
    assert [d.code for d in caught.value.diagnostics] == ["BUNDLE_NUMBER_RANGE"]


@pytest.mark.parametrize(
    ("up", "forward", "expected"),
    [
        ("Y", None, (1, 2, 3)),
        ("Z", None, (1, 3, -2)),
        ("Z", "X", (2, 3, 1)),
        ("X", None, (-2, 1, 3)),
        ("Y", "-Z", (-1, 2, -3)),
    ],
)
def test_up_and_forward_turn_the_world(tmp_path, up, forward, expected):
    """The declared up axis becomes +Y and the forward axis +Z, by a rotation."""
    values = bundle(part("A", (1, 2, 3)), up=up)
    if forward:
        values["meta"]["forward"] = forward
    scene, _ = read(values, tmp_path)
    assert scene.nodes[0].pose.translation == pytest.approx(expected)


def test_lever_holds_the_hinge_and_slider_of_the_paper(lever):
    """Shaft hinge about the vertical, two pins, and a slide along X limited to 65 .. 115 mm."""
    joints = {joint.name: joint for joint in lever.joints}
    assert [joint.kind for joint in lever.joints].count(JointKind.REVOLUTE) == 3
    slide = joints["Slide"]
    axis = lever.pose(slide.a).direction(slide.frame_a.rotation[:, 0])
    assert axis == pytest.approx([1, 0, 0], abs=1e-9)
    assert (slide.freedoms[0].lower, slide.freedoms[0].upper) == pytest.approx((0.065, 0.115))
    assert all(joint.freedoms[3].motion is Motion.FREE for name, joint in joints.items() if name != "Slide")
    assert joints["Shaft"].because == ("Insert:1",)


def test_lever_keeps_its_constraints_as_stated(lever):
    """Nine constraints with both sides' geometry in their nodes' frames; both sides meet in the world."""
    assert [c.kind.value for c in lever.constraints].count("insert") == 5
    for constraint in lever.constraints:
        first, second = (lever.pose(f.node).point(f.point) for f in constraint.features)
        assert first == pytest.approx(second, abs=1e-9)
    shaft = lever.constraints[0].features[0]
    assert (shaft.kind, shaft.radius) == (FeatureKind.CIRCLE, pytest.approx(0.006))


def test_lever_lists_the_instantaneous_pole_of_the_bar(lever):
    """The bar's DOF centre lies above the slider on the crank's line: (x_D, x_D tan 30)."""
    bar = next(record for record in lever.dof_records if lever.nodes[record.node].name == "BarC:1")
    assert bar.center == pytest.approx([SLIDER_X, 0.0, -SLIDER_X * math.tan(math.radians(30))], abs=1e-10)
    assert bar.rotations == pytest.approx(np.array([[0.0, 1.0, 0.0]]))


def test_reading_twice_gives_the_same_scene():
    """Two runs agree to the last bit."""
    scenes = [sources.read(FIXTURES / "lever" / "lever.bundle.json", Report()) for _ in range(2)]
    first, second = (
        [node.pose.rotation.tobytes() + node.pose.translation.tobytes() for node in s.nodes] for s in scenes
    )
    assert first == second
    assert scenes[0].source == scenes[1].source
