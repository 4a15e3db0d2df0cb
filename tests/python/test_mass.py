"""Masses, moments of inertia, principal axes and collision hulls, against closed forms."""

from __future__ import annotations

import math
from importlib.util import find_spec

import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import Report
from kinefab.geometry import primitives
from kinefab.geometry.hulls import collision_hulls, hull_of_points
from kinefab.geometry.mass import (
    combined,
    is_possible,
    moved,
    principal,
    shape_properties,
    solid_properties,
    stretched,
)
from kinefab.geometry.weighing import weigh
from kinefab.model import Body, MassProperties, Mesh, Node, Scene
from kinefab.spatial import Pose, rotation_exp, rotation_log


def volume(mesh: Mesh) -> float:
    return solid_properties(mesh.vertices, mesh.faces, 1.0).mass


def weighed(vertices, faces, **body):
    report = Report()
    mesh = Mesh("m", np.array(vertices, float), np.array(faces))
    scene = Scene(
        nodes=[Node("P", "P", bodies=(Body("b", 0, **{"density": 1000.0, **body}),))], meshes=[mesh]
    )
    return weigh(scene, 1000.0, report), report


def test_mass_of_a_cylinder_is_its_closed_form():
    """A fine cylinder approaches m r^2 / 2 about its axis and m (3 r^2 + h^2) / 12 across."""
    shape = trimesh.creation.cylinder(0.1, 0.4, sections=720)
    shape.apply_translation((100.0, 0, 0))  # far from the origin
    scene, _ = weighed(shape.vertices, shape.faces, density=7850.0)
    mass = scene.nodes[0].mass
    expected = 7850 * math.pi * 0.01 * 0.4
    assert mass.mass == pytest.approx(expected, rel=1e-4)
    across = expected * (3 * 0.01 + 0.16) / 12
    assert np.allclose(np.diag(mass.inertia), [across, across, expected * 0.01 / 2], rtol=1e-4)
    assert np.allclose(mass.center, (100, 0, 0), atol=1e-9)


def test_open_mesh_takes_the_mass_of_its_hull_with_a_warning():
    """A cube without its lid weighs what the full cube weighs, and says so."""
    box = trimesh.creation.box((1, 1, 1))
    scene, report = weighed(box.vertices, box.faces[2:])
    assert scene.nodes[0].mass.mass == pytest.approx(1000)
    assert [d.code for d in report.diagnostics] == ["MESH_OPEN"]


def test_shells_wound_against_each_other_weigh_as_their_hull():
    """A cube and a long bar turned inside out enclose a volume above 0, and a moment of inertia below it, which no scene may
    have."""
    cube, bar = trimesh.creation.box((1, 1, 1)), trimesh.creation.box((0.3, 0.3, 10))
    vertices = np.concatenate([cube.vertices, bar.vertices + (3.0, 0.0, 0.0)])
    for turn in (1, -1):
        faces = np.concatenate([cube.faces, bar.faces[:, ::-1] + len(cube.vertices)])[:, ::turn]
        scene, report = weighed(vertices, faces)
        hull = trimesh.convex.convex_hull(vertices)
        assert scene.nodes[0].mass.mass == pytest.approx(1000 * hull.volume)
        assert is_possible(scene.nodes[0].mass.inertia)
        assert [d.code for d in report.diagnostics] == ["MESH_OPEN"]


def test_repeated_vertices_do_not_make_a_mesh_open():
    """A skin whose every triangle has vertices of its own is closed all the same."""
    box = trimesh.creation.box((1, 2, 3))
    scene, report = weighed(box.vertices[box.faces].reshape(-1, 3), np.arange(36).reshape(-1, 3))
    assert scene.nodes[0].mass.mass == pytest.approx(6000) and report.diagnostics == []


def test_inside_out_mesh_is_turned_with_a_warning():
    """Negative volume is no mass: the winding is wrong, and is turned."""
    box = trimesh.creation.box((1, 2, 3))
    scene, report = weighed(box.vertices, box.faces[:, ::-1])
    assert scene.nodes[0].mass.mass == pytest.approx(6000) and volume(scene.meshes[0]) == pytest.approx(6)
    assert [d.code for d in report.diagnostics] == ["MESH_INSIDE_OUT"]


def test_flat_mesh_has_no_volume_and_no_hull():
    """A single rectangle gets a warning instead of a mass, and a box instead of a hull."""
    scene, report = weighed([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    assert scene.nodes[0].mass is None
    assert [d.code for d in report.diagnostics] == ["MESH_WITHOUT_VOLUME"]
    assert collision_hulls(scene, [(0, "b")], report) == {}
    assert report.diagnostics[-1].code == "HULL_FLAT"


def test_combined_mass_is_that_of_the_whole():
    """Two halves of a box, one of them turned in its own frame, weigh as the whole."""
    whole, half = trimesh.creation.box((2, 0.6, 0.4)), trimesh.creation.box((1, 0.6, 0.4))
    of = lambda m: solid_properties(np.array(m.vertices), np.array(m.faces), 500.0)  # noqa: E731
    turned = Pose(rotation_exp(np.array([math.pi, 0, 0])), np.array([-0.5, 0, 0]))
    total = combined([moved(of(half), turned), moved(of(half), Pose(np.eye(3), np.array([0.5, 0, 0])))])
    expected = of(whole)
    assert total.mass == pytest.approx(expected.mass)
    assert np.allclose(total.inertia, expected.inertia) and np.allclose(total.center, 0)


def askew() -> tuple[np.ndarray, np.ndarray]:
    """A tetrahedron without any symmetry, away from the origin."""
    vertices = np.array([[0.3, -0.2, 0.5], [1.7, 0.1, 0.4], [0.5, 1.1, 0.9], [0.2, 0.3, 2.6]])
    return vertices, np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])


def same(one: MassProperties, other: MassProperties) -> bool:
    return bool(
        np.isclose(one.mass, other.mass)
        and np.allclose(one.center, other.center)
        and np.allclose(one.inertia, other.inertia)
    )


TURNED = Pose(rotation_exp(np.array([0.4, -1.1, 0.7])), np.array([3.0, -1.0, 0.5]))


@pytest.mark.parametrize("scale", [(1.0, 1.0, 1.0), (2.0, 2.0, 2.0), (0.5, 3.0, 1.5), (0.5, -3.0, 1.5)])
def test_what_is_stretched_and_moved_weighs_as_its_vertices_do(scale):
    """Mass by the volume, products and centre by the axes they belong to; a mirror turns nothing inside out."""
    vertices, faces = askew()
    shape = solid_properties(vertices, faces, 700.0)
    assert shape.mass > 0.0
    there = TURNED.point(vertices * scale)
    wound = faces if np.prod(scale) > 0.0 else faces[:, ::-1]
    assert same(moved(stretched(shape, scale), TURNED), solid_properties(there, wound, 700.0))


def test_bodies_of_a_part_are_weighed_where_they_stand_each_with_its_own_scale_and_density():
    """Three of one mesh, which is wound inwards, in one part; none may be taken for the other."""
    vertices, faces = askew()
    mesh = Mesh("m", vertices, faces[:, ::-1], np.tile([0.0, 0.6, -0.8], (4, 1)))
    bodies = (
        Body("one", 0, pose=TURNED, scale=(0.5, 3.0, 1.5), density=700.0),
        Body("two", 0, pose=TURNED, scale=(0.5, 3.0, 2.0), density=700.0),
        Body("three", 0, pose=TURNED, scale=(0.5, 3.0, 2.0)),
    )
    nodes = [Node("P", "P", bodies=bodies), *(Node(b.name, b.name, bodies=(b,)) for b in bodies)]
    scene = weigh(Scene(nodes=nodes, meshes=[mesh]), 1200.0, Report())
    expected = [
        solid_properties(TURNED.point(vertices * body.scale), faces, body.density or 1200.0)
        for body in bodies
    ]
    for node, own in zip(scene.nodes, (combined(expected), *expected)):
        assert same(node.mass, own)
    (turned,) = scene.meshes
    assert np.array_equal(turned.faces, faces) and np.allclose(turned.normals, [0.0, -0.6, 0.8])


@pytest.mark.parametrize(
    "kind, size",
    [
        ("box", (0.4, 0.7, 1.1)),
        ("ellipsoid", (0.4, 0.7, 1.1)),
        ("sphere", (0.4,)),
        ("cylinder", (0.4, 1.1)),
        ("capsule", (0.4, 1.1)),
        ("cone", (0.4, 1.1)),
    ],
)
def test_a_named_shape_weighs_as_its_mesh_does(kind, size):
    """But for the 48 sides of what is round."""
    mesh = getattr(primitives, kind)(*((size,) if len(size) == 3 else size))
    found, of_mesh = shape_properties(kind, size), solid_properties(mesh.vertices, mesh.faces, 1.0)
    assert found.mass == pytest.approx(of_mesh.mass, rel=0.01)
    assert np.allclose(found.center, of_mesh.center, atol=1e-3)
    assert np.allclose(np.diag(found.inertia), np.diag(of_mesh.inertia), rtol=0.02)


def test_of_all_namings_of_the_principal_axes_the_nearest_is_taken():
    """A tensor that is turned far has the names, and the hand, of the axes that are nearest to the given ones."""
    rng = np.random.default_rng(4)
    quarters = [rotation_exp(np.array(v) * math.pi / 2) for v in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    for _ in range(50):
        r = rotation_exp(rng.normal(size=3))
        tensor = r @ np.diag([5.0, 1.5, 4.0]) @ r.T
        moments, axes = principal(tensor)
        assert np.allclose(axes @ np.diag(moments) @ axes.T, tensor)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        away = float(np.linalg.norm(rotation_log(axes)))
        others = [axes @ a @ b for a in quarters for b in (np.eye(3), *quarters)]
        assert all(away < float(np.linalg.norm(rotation_log(other))) + 1e-9 for other in others)


def test_principal_axes_are_a_proper_rotation_near_the_part_frame():
    """Moments and axes rebuild the tensor; the axes are right-handed and turned as little as can be."""
    rng = np.random.default_rng(3)
    for _ in range(50):
        r = rotation_exp(rng.uniform(-0.3, 0.3, 3))
        tensor = r @ np.diag([5.0, 1.0, 3.0]) @ r.T
        moments, axes = principal(tensor)
        assert np.allclose(axes @ np.diag(moments) @ axes.T, tensor)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        assert np.allclose(moments, [5, 1, 3]) and np.allclose(axes, r)


def test_impossible_masses_among_sound_ones_are_told_each():
    """Sound ones are seen in one stack, the others one by one."""
    sound, inertia = np.diag([3.0, 4.0, 5.0]), np.diag([1.0, 1.0, 2.1])
    given = [
        (2.0, sound),
        (0.0, sound),
        (2.0, inertia),
        (np.nan, sound),
        (1e-39, sound),
        (2.0, sound * 1e-39),
    ]
    nodes = [Node(f"N{i}", f"N{i}", mass=MassProperties(m, np.zeros(3), t)) for i, (m, t) in enumerate(given)]
    report = Report()
    weigh(Scene(nodes=nodes), 1000.0, report)
    named = [d.message.split(" for ")[1].split(":")[0] for d in report.diagnostics]
    assert named == [f"N{i}" for i in range(1, 6)]
    assert {d.code for d in report.diagnostics} == {"MASS_IMPOSSIBLE"}


def test_inertia_that_no_body_has_is_known():
    """The largest moment may not exceed the sum of the others, and none may be zero or less."""
    assert is_possible(np.diag([3.0, 4.0, 5.0])) and is_possible(np.diag([1.0, 1.0, 2.0]))
    assert not is_possible(np.diag([1.0, 1.0, 2.1])) and not is_possible(np.diag([0.0, 1.0, 1.0]))
    assert not is_possible(np.diag([-1.0, 4.0, 4.0]))


def test_large_hull_is_reduced_to_what_unity_takes():
    """A fine cylinder's hull ends below 256 triangles, within a hundredth of its radius, and is reported."""
    shape = trimesh.creation.cylinder(0.1, 0.4, sections=300)
    mesh = Mesh("m", np.array(shape.vertices), np.array(shape.faces))
    report = Report()
    hull = collision_hulls(Scene(meshes=[mesh]), [(0, "P/b")], report)[0]
    assert 200 < len(hull.faces) <= 255
    assert volume(hull) == pytest.approx(shape.volume, rel=0.01)
    (finding,) = report.diagnostics
    assert finding.code == "HULL_SIMPLIFIED" and "P/b" in finding.message


def test_hull_is_wound_outwards():
    """The hull of random points has the volume that trimesh finds."""
    points = np.random.default_rng(8).normal(size=(200, 3))
    vertices, faces = hull_of_points(points)
    expected = trimesh.convex.convex_hull(points).volume
    assert solid_properties(vertices, faces, 1.0).mass == pytest.approx(expected)
    assert isinstance(solid_properties(vertices, faces, 1.0), MassProperties)


@pytest.mark.skipif(find_spec("manifold3d") is None, reason="manifold3d is not installed")
def test_a_fine_tube_without_ends_is_weighed_as_its_hull():
    """Thirty thousand points stand on each of its two flat faces: qhull alone would take minutes."""
    around = np.linspace(0.0, 2.0 * np.pi, 30_000, endpoint=False)
    rim = np.column_stack([0.1 * np.cos(around), 0.1 * np.sin(around)])
    vertices = np.vstack([np.column_stack([rim, np.full(len(rim), z)]) for z in (0.0, 0.4)])
    here = np.arange(len(rim))
    there = np.roll(here, -1)
    wall = [
        np.column_stack([here, there, here + len(rim)]),
        np.column_stack([there, there + len(rim), here + len(rim)]),
    ]
    scene, report = weighed(vertices, np.vstack(wall))
    mass = scene.nodes[0].mass
    area = 0.5 * len(rim) * 0.01 * math.sin(2.0 * math.pi / len(rim))
    assert mass.mass == pytest.approx(1000.0 * area * 0.4, rel=1e-6)
    assert np.allclose(mass.center, (0.0, 0.0, 0.2), atol=1e-6)
    assert [d.code for d in report.diagnostics] == ["MESH_OPEN"]


def test_parts_that_move_without_a_stated_density_are_told_once():
    """The density taken for them, how many and the first; what states a mass or a density, or stands still, is not counted."""
    shape = trimesh.creation.box((0.1, 0.2, 0.3))
    mesh = Mesh("m", np.array(shape.vertices, float), np.array(shape.faces))
    stated = MassProperties(2.0, np.zeros(3), np.eye(3) * 0.02)
    nodes = [
        Node("Ground", "Ground", grounded=True, bodies=(Body("b", 0),)),
        Node("Steel", "Steel", bodies=(Body("b", 0, density=7850.0),)),
        Node("Given", "Given", mass=stated, bodies=(Body("b", 0),)),
        Node("Half", "Half", bodies=(Body("b", 0, density=7850.0), Body("c", 0)), where="robot.step:7"),
        Node("None", "None", bodies=(Body("b", 0),)),
    ]
    report = Report()
    scene = weigh(Scene(nodes=nodes, meshes=[mesh]), 2700.0, report)
    (told,) = report.diagnostics
    assert (told.code, told.severity.value, told.where) == ("DENSITY_ASSUMED", "info", "robot.step:7")
    assert "2 part(s)" in told.message and "Half" in told.message and "2700 kg/m^3" in told.message
    assert scene.nodes[4].mass is not None and scene.nodes[4].mass.mass == pytest.approx(0.006 * 2700)
    others = Report()
    weigh(Scene(nodes=nodes[:3], meshes=[mesh]), 2700.0, others)
    assert others.diagnostics == []
