"""From a Scene to a file: hierarchy, meshes, masses, colliders, constraints, reports."""

from __future__ import annotations

import math
from dataclasses import replace

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import KinefabError, Outcome
from kinefab.model import Constraint, ConstraintKind, Feature, FeatureKind, MassProperties
from kinefab.spatial import rotation_exp
from scenes import BOX, components, exported, lid_scene, mesh_arrays, world_pose
from unity_semantics import M, matrix, mirrored


def test_lid_becomes_a_hinge_on_a_static_box(tmp_path):
    """The box stays static; the lid gets mass 1.68 kg, a convex collider and a hinge of 0..110 degrees."""
    content, result = exported(lid_scene(), tmp_path)
    assert components(content, "Box", "Rigidbody") == []
    (body,) = components(content, "Lid", "Rigidbody")
    assert body["mass"] == pytest.approx(0.4 * 0.02 * 0.3 * 700)
    expected = [body["mass"] / 12 * (p * p + q * q) for p, q in ((0.02, 0.3), (0.4, 0.3), (0.4, 0.02))]
    assert body["inertiaTensor"] == pytest.approx(expected)
    (hinge,) = components(content, "Lid", "HingeJoint")
    assert hinge["limits"] == {"max": 110} and hinge["useLimits"] is True
    assert "connectedBody" not in hinge
    (collider,) = components(content, "Lid", "BoxCollider")
    assert sorted(collider["size"]) == pytest.approx([0.02, 0.3, 0.4])
    assert {o.outcome for o in result.report.outcomes} == {Outcome.KEPT}


def test_same_scene_gives_the_same_bytes(tmp_path):
    """Two exports to two places differ in nothing."""
    (tmp_path / "again").mkdir()
    first = kinefab.export(lid_scene(), tmp_path / "one.kinefab")
    second = kinefab.export(lid_scene(), tmp_path / "again" / "one.kinefab")
    assert first.path.read_bytes() == second.path.read_bytes()
    assert first.files[1].read_bytes() == second.files[1].read_bytes()


def test_nested_poses_compose_to_the_mirrored_world_poses(tmp_path):
    """Whatever the nesting, each object's world pose in Unity is the mirror of its CAD pose."""
    rng = np.random.default_rng(2)
    scene = kinefab.Scene()
    parent, expected = None, []
    for i in range(5):
        pose = dict(translation=rng.normal(size=3), rotation=rotation_exp(rng.normal(size=3)))
        parent = scene.add_assembly(f"A{i}", parent=parent, **pose)
        expected.append(mirrored((pose["rotation"], pose["translation"])))
    content, _ = exported(scene, tmp_path)
    for i, (rotation, position) in enumerate(expected):
        got = world_pose(content, i)
        assert np.allclose(got[0], rotation, atol=1e-10) and np.allclose(got[1], position, atol=1e-10)


def test_mesh_is_mirrored_and_wound_outwards_for_unity(tmp_path):
    """Vertices have X negated, and Unity's normals (the component cross product) still point outwards."""
    shape = trimesh.creation.annulus(0.1, 0.3, 0.5)
    shape.apply_translation((0.2, 0.3, 0.4))
    scene = kinefab.Scene()
    scene.add_part("Ring", shape)
    content, result = exported(scene, tmp_path, smooth=None)
    positions, faces = mesh_arrays(result.path, content, 0)
    assert np.allclose(positions, np.array(shape.vertices) * (-1, 1, 1), atol=1e-7)
    a, b, c = (positions[faces[:, i]].astype(float) for i in range(3))
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0 == pytest.approx(shape.volume, rel=1e-5)


def test_inertia_of_a_turned_part_is_principal_and_mirrored(tmp_path):
    """A wedge's tensor comes back from its principal moments, their rotation and the mirror."""
    points = np.array([[0, 0, 0], [0.4, 0, 0], [0, 0.3, 0], [0.05, 0.06, 0.5]])
    wedge = trimesh.convex.convex_hull(points)
    scene = kinefab.Scene()
    scene.add_part("Wedge", wedge, density=2000)
    content, _ = exported(scene, tmp_path)
    (body,) = components(content, "Wedge", "Rigidbody")
    wedge.density = 2000
    axes = matrix(body.get("inertiaTensorRotation", (0, 0, 0, 1)))
    moments = body["inertiaTensor"]
    assert np.allclose(axes @ np.diag(moments) @ axes.T, M @ wedge.moment_inertia @ M, rtol=1e-9, atol=1e-12)
    assert np.allclose(body["centerOfMass"], M @ wedge.center_mass, atol=1e-12)
    assert max(moments) <= sum(moments) - max(moments)


def test_constraints_are_written_through_in_unitys_frame(tmp_path):
    """An angle constraint keeps its id and words; its points are mirrored and its value is in degrees."""
    scene = lid_scene()
    line = Feature(1, FeatureKind.LINE, np.array([0.1, 0.2, 0.3]), np.array([0.6, 0.0, 0.8]))
    plane = Feature(None, FeatureKind.PLANE, np.array([1.0, 0, 0]), np.array([0.0, 1.0, 0]))
    scene.constraints.append(
        Constraint(
            "Angle:1", ConstraintKind.ANGLE, (line, plane), math.radians(30), raw_kind="Angle", where="x"
        )
    )
    content, _ = exported(scene, tmp_path)
    (entry,) = content["constraints"]
    assert entry["value"] == pytest.approx(30) and entry["rawKind"] == "Angle"
    assert entry["features"][0] == {
        "gameObject": 1, "kind": "line", "point": [-0.1, 0.2, 0.3], "direction": [-0.6, 0, 0.8]
    }  # fmt: skip
    assert "gameObject" not in entry["features"][1]


@pytest.mark.parametrize("shape, moving, static", [("none", None, None), ("box", "BoxCollider", "BoxCollider"),
                                                   ("hull", "MeshCollider", "MeshCollider"), ("mesh", "MeshCollider", "MeshCollider")])  # fmt: skip
def test_collider_option_decides_the_shape(shape, moving, static, tmp_path):
    """Each body gets the asked-for collider; a moving body never gets a concave one, and that is reported."""
    content, result = exported(lid_scene(), tmp_path, colliders=kinefab.ColliderShape(shape))
    for name, kind in (("Lid", moving), ("Box", static)):
        found = [
            c
            for o in content["gameObjects"]
            if o["name"] == name
            for c in o["components"]
            if "Collider" in c["type"]
        ]
        assert [c["type"] for c in found] == ([kind] if kind else [])
    if shape == "mesh":
        assert components(content, "Lid", "MeshCollider")[0]["convex"] is True
        assert "convex" not in components(content, "Box", "MeshCollider")[0]
        assert "COLLIDER_NOT_CONVEX" in {o.code for o in result.report.outcomes}
    if shape == "box":
        assert components(content, "Lid", "BoxCollider")[0]["size"] == [0.4, 0.02, 0.3]


def test_suppressed_part_is_an_inactive_object_and_its_joint_is_reported(tmp_path):
    """A suppressed part stays in the hierarchy, inactive and without physics."""
    scene = lid_scene()
    scene.nodes[1] = replace(scene.nodes[1], suppressed=True)
    content, result = exported(scene, tmp_path)
    assert content["gameObjects"][1]["active"] is False
    assert components(content, "Lid", "Rigidbody") == []
    assert [o.code for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == ["JOINT_WITHOUT_BODY"]


def test_given_mass_is_kept_and_an_impossible_one_refused(tmp_path):
    """A stated mass wins over the mesh; one that breaks the triangle inequality is an error and writes nothing."""
    scene = kinefab.Scene()
    scene.add_part("P", BOX, mass=MassProperties(2.5, np.array([0.1, 0, 0]), np.diag([3.0, 4.0, 5.0])))
    content, _ = exported(scene, tmp_path)
    (body,) = components(content, "P", "Rigidbody")
    assert (body["mass"], body["inertiaTensor"], body["centerOfMass"]) == (2.5, [3, 4, 5], [-0.1, 0, 0])
    scene.nodes[0] = replace(scene.nodes[0], mass=MassProperties(2.5, np.zeros(3), np.diag([1.0, 1.0, 5.0])))
    with pytest.raises(KinefabError) as caught:
        kinefab.export(scene, tmp_path / "none.kinefab")
    assert [d.code for d in caught.value.diagnostics] == ["MASS_IMPOSSIBLE"]
    assert not (tmp_path / "none.kinefab").exists()


def test_bodies_of_a_part_are_children_with_stable_unique_ids(tmp_path):
    """Several bodies become children of the part, named after themselves even where names repeat."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX)
    names = ("skin", "skin", "skin#2")
    scene.nodes[part] = replace(
        scene.nodes[part], bodies=tuple(replace(scene.nodes[part].bodies[0], name=n) for n in names)
    )
    content, _ = exported(scene, tmp_path)
    ids = [o["id"] for o in content["gameObjects"]]
    assert ids == ["P", "P/body:skin", "P/body:skin#2", "P/body:skin#2#2"]
    assert all(o["parent"] == 0 for o in content["gameObjects"][1:])
    (body,) = components(content, "P", "Rigidbody")
    assert body["mass"] == pytest.approx(18)


def test_empty_mesh_is_refused_by_the_builder():
    """A part made of nothing, or with a density of nothing, is a programmer's mistake."""
    scene = kinefab.Scene()
    with pytest.raises(ValueError):
        scene.add_part("P", trimesh.Trimesh())
    with pytest.raises(ValueError):
        scene.add_part("P", BOX, density=0.0)


def test_given_mass_of_a_nested_assembly_is_not_added_to_that_of_its_parts(tmp_path):
    """A rigid assembly of a 5 kg sub-assembly (its part alone: 1 kg) and a 2 kg part weighs 7 kg."""
    given = lambda mass: MassProperties(mass, np.zeros(3), mass * np.eye(3))  # noqa: E731
    scene = kinefab.Scene()
    outer = scene.add_assembly("Outer")
    inner = scene.add_assembly("Inner", parent=outer)
    scene.nodes[outer] = replace(scene.nodes[outer], flexible=False)
    scene.nodes[inner] = replace(scene.nodes[inner], flexible=False, mass=given(5.0))
    for name, parent, mass in (("P", inner, 1.0), ("Q", outer, 2.0)):
        part = scene.add_part(name, parent=parent)
        scene.nodes[part] = replace(scene.nodes[part], mass=given(mass))
    content, _ = exported(scene, tmp_path)
    bodies = [c for o in content["gameObjects"] for c in o.get("components", ()) if c["type"] == "Rigidbody"]
    assert [body["mass"] for body in bodies] == [7]
