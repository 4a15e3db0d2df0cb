"""From a Scene to a file: hierarchy, rigid groups, masses, colliders, couplings, freedoms, reports."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import trimesh

import kinefab
from kinefab.diagnostics import KinefabError, Outcome
from kinefab.model import (
    RX,
    TX,
    Constraint,
    ConstraintKind,
    Coupling,
    CouplingKind,
    DofRecord,
    Feature,
    FeatureKind,
    JointKind,
    MassProperties,
)
from kinefab.spatial import rotation_about, rotation_exp
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
    (collider,) = components(content, "Lid", "MeshCollider")
    assert collider["convex"] is True
    assert [o.outcome for o in result.report.outcomes] == [Outcome.KEPT]


def test_same_scene_gives_the_same_bytes(tmp_path):
    """Two exports to two places differ in nothing."""
    (tmp_path / "again").mkdir()
    first = kinefab.export(lid_scene(), tmp_path / "one.kinefab")
    second = kinefab.export(lid_scene(), tmp_path / "again" / "one.kinefab")
    assert first.path.read_bytes() == second.path.read_bytes()
    assert first.buffer.read_bytes() == second.buffer.read_bytes()


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
    content, result = exported(scene, tmp_path)
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


def chain(flexible: bool, extra: bool = False) -> kinefab.Scene:
    """Two fixed parts in an assembly, which hangs on a grounded post by a hinge."""
    scene = kinefab.Scene()
    top = scene.add_assembly("Top")
    post = scene.add_part("Post", BOX, parent=top, grounded=True)
    arm = scene.add_assembly("Arm", parent=top, translation=(1, 0, 0), flexible=flexible)
    one = scene.add_part("One", BOX, parent=arm, translation=(1, 0, 0))
    two = scene.add_part("Two", BOX, parent=arm, translation=(1.5, 0, 0))
    if extra:
        loose = scene.add_part("Loose", BOX, parent=arm, translation=(3, 0, 0))
        scene.add_hinge(two, loose, point=(2.5, 0, 0), axis=(0, 0, 1))
    if flexible:
        scene.add_fixed(one, two)
    scene.add_hinge(post, two, point=(0.5, 0, 0), axis=(0, 1, 0), limits=(-10, 80))
    return scene


@pytest.mark.parametrize("flexible", [False, True])
def test_group_that_fills_a_subtree_has_one_rigidbody_there(flexible, tmp_path):
    """Parts of a rigid assembly, or fixed to each other, share the assembly's Rigidbody; joints move there too."""
    content, _ = exported(chain(flexible), tmp_path)
    (body,) = components(content, "Arm", "Rigidbody")
    assert body["mass"] == pytest.approx(2 * 1000 * 0.006)
    assert np.allclose(body["centerOfMass"], (-0.25, 0, 0))
    steiner = 2 * 6 * 0.25**2  # two boxes of 6 kg, 0.25 m from their common centre
    assert body["inertiaTensor"][1] == pytest.approx(2 * 6 / 12 * (0.1**2 + 0.3**2) + steiner)
    (hinge,) = components(content, "Arm", "HingeJoint")
    assert np.allclose(hinge["anchor"], (0.5, 0, 0))
    for name in ("One", "Two"):
        assert components(content, name, "Rigidbody") == components(content, name, "FixedJoint") == []


def test_group_that_shares_its_subtree_is_held_by_fixed_joints(tmp_path):
    """With a loose part beside them, fixed parts keep a Rigidbody each and a FixedJoint to the first."""
    content, _ = exported(chain(True, extra=True), tmp_path)
    (fixed,) = components(content, "Two", "FixedJoint")
    assert content["gameObjects"][fixed["connectedBody"]]["name"] == "One"
    assert components(content, "Arm", "Rigidbody") == []


def test_part_fixed_to_the_ground_is_static(tmp_path):
    """What is fixed to the world, or to something grounded, gets no Rigidbody but keeps its collider."""
    scene = kinefab.Scene()
    post = scene.add_part("Post", BOX, grounded=True)
    plate = scene.add_part("Plate", BOX, translation=(0, 1, 0))
    scene.add_fixed(post, plate)
    content, _ = exported(scene, tmp_path)
    assert components(content, "Plate", "Rigidbody") == []
    assert len(components(content, "Plate", "MeshCollider")) == 1


def test_breakable_fixed_joint_stays_a_joint(tmp_path):
    """A fixed joint that may break is a FixedJoint between two Rigidbodies, not one group."""
    scene = kinefab.Scene()
    a, b = scene.add_part("A", BOX), scene.add_part("B", BOX, translation=(1, 0, 0))
    scene.joints[:] = [replace(scene.add_fixed(a, b), break_force=120.0)]
    content, _ = exported(scene, tmp_path)
    (fixed,) = components(content, "B", "FixedJoint")
    assert fixed["breakForce"] == 120 and fixed["connectedBody"] == 0


def test_joint_inside_a_rigid_group_is_reported_as_redundant(tmp_path):
    """A hinge between parts of a rigid assembly has nothing to do and is named in the report."""
    scene = chain(False)
    scene.add_hinge(3, 4, point=(1.2, 0, 0), axis=(1, 0, 0), name="Idle")
    content, result = exported(scene, tmp_path)
    assert ("joint Idle", "JOINT_REDUNDANT") in {(o.feature, o.code) for o in result.report.outcomes}
    assert (
        len([c for o in content["gameObjects"] for c in o.get("components", []) if c["type"] == "HingeJoint"])
        == 1
    )


@pytest.mark.parametrize(
    "translations, rotations, kind, unlocked",
    [
        ([], [[0, 0, 2]], "HingeJoint", None),
        ([[0, 3, 0]], [], "ConfigurableJoint", {"xMotion"}),
        ([[0, 1, 0]], [[0, 1, 0]], "ConfigurableJoint", {"xMotion", "angularXMotion"}),
        ([[1, 0, 0], [0, 1, 0]], [[0, 0, 1]], "ConfigurableJoint", {"yMotion", "zMotion", "angularXMotion"}),
        ([], np.eye(3), "ConfigurableJoint", {"angularXMotion", "angularYMotion", "angularZMotion"}),
        ([[1, 0, 0]], [[0, 0, 1]], "ConfigurableJoint", {"yMotion", "angularXMotion"}),
    ],
)
def test_freedoms_listed_for_a_part_become_one_joint_to_the_ground(
    translations, rotations, kind, unlocked, tmp_path
):
    """The paper's way: just the listed freedoms are unlocked, whatever axes they are written in."""
    scene = kinefab.Scene()
    part = scene.add_part("Part", BOX, translation=(1, 2, 3))
    turn = rotation_about(np.array([0.0, 0, 1]), 0.4)
    directions = [
        np.reshape(v, (-1, 3)) @ turn.T for v in (np.array(translations, float), np.array(rotations, float))
    ]
    scene.dof_records.append(DofRecord(part, *directions, center=np.array([1.0, 2.0, 2.5])))
    content, _ = exported(scene, tmp_path)
    (joint,) = components(content, "Part", kind)
    if unlocked is not None:
        motions = [key for key in joint if key.endswith("Motion")]
        locked = {key for key in motions if joint[key] == "Locked"}
        names = {"xMotion", "yMotion", "zMotion", "angularXMotion", "angularYMotion", "angularZMotion"}
        assert names - locked == unlocked
    assert np.allclose(joint.get("connectedAnchor"), (-1, 2, 2.5))


def test_explicit_joint_wins_over_listed_freedoms(tmp_path):
    """A part with a joint keeps it; its record of freedoms is only checked against."""
    scene = lid_scene()
    scene.dof_records.append(DofRecord(1, np.zeros((0, 3)), np.eye(3)))
    content, result = exported(scene, tmp_path)
    assert len(components(content, "Lid", "HingeJoint")) == 1
    assert components(content, "Lid", "ConfigurableJoint") == []
    assert "freedoms of Lid" in {o.feature for o in result.report.outcomes if o.outcome is Outcome.KEPT}


def test_askew_freedoms_are_dropped_with_a_report(tmp_path):
    """A slide at 40 degrees to the rotation fits no single component."""
    scene = kinefab.Scene()
    part = scene.add_part("Part", BOX)
    slide = np.array([[math.cos(0.7), math.sin(0.7), 0]])
    scene.dof_records.append(DofRecord(part, slide, np.array([[1.0, 0, 0]])))
    _, result = exported(scene, tmp_path)
    assert [o.code for o in result.report.outcomes] == ["DOF_RECORD_INEXPRESSIBLE"]


def test_freedoms_of_a_flexible_assembly_are_dropped_with_a_report(tmp_path):
    """Its parts move on their own, so its freedoms are nobody's; that is said."""
    scene = kinefab.Scene()
    assembly = scene.add_assembly("Loose")
    scene.add_part("Part", BOX, parent=assembly)
    scene.dof_records.append(DofRecord(assembly, np.zeros((0, 3)), np.array([[1.0, 0, 0]])))
    _, result = exported(scene, tmp_path)
    assert [o.code for o in result.report.outcomes] == ["DOF_RECORD_INEXPRESSIBLE"]


def test_screw_is_a_cylindrical_joint_and_a_coupling(tmp_path):
    """A right-handed lead of 3 mm a turn couples x to angularX with -3 mm a turn: the mirror turns the screw."""
    scene = kinefab.Scene()
    nut = scene.add_part("Nut", BOX)
    scene.add_joint(JointKind.SCREW, None, nut, point=(0, 0, 0), axis=(0, 1, 0), name="Screw", lead=0.003)
    scene.couplings.append(Coupling("S", CouplingKind.SCREW, "Screw", RX, "Screw", TX, 0.003 / (2 * math.pi)))
    content, _ = exported(scene, tmp_path)
    (coupling,) = content["couplings"]
    assert coupling["a"]["coordinate"] == "angularX" and coupling["b"]["coordinate"] == "x"
    assert coupling["ratio"] == pytest.approx(-0.003 / 360)


def test_screw_without_a_stated_coupling_gets_one_from_its_lead(tmp_path):
    """A left-handed lead of 3 mm a turn becomes a coupling that is zero at the exported pose."""
    scene = kinefab.Scene()
    nut = scene.add_part("Nut", BOX)
    scene.add_joint(JointKind.SCREW, None, nut, point=(0, 0, 0), axis=(0, 1, 0), name="Screw", lead=-0.003)
    content, _ = exported(scene, tmp_path)
    (coupling,) = content["couplings"]
    assert (coupling["kind"], coupling["a"]["coordinate"], coupling["b"]["coordinate"]) == ("screw", "angularX", "x")
    assert coupling["ratio"] == pytest.approx(0.003 / 360, rel=1e-11) and "offset" not in coupling


def test_small_coupling_ratio_keeps_its_digits(tmp_path):
    """A lead of 1 um a turn is 2.777...e-9 m a degree: no fixed number of decimals may cut it."""
    scene = kinefab.Scene()
    nut = scene.add_part("Nut", BOX)
    scene.add_joint(JointKind.SCREW, None, nut, point=(0, 0, 0), axis=(0, 1, 0), name="Screw", lead=1e-6)
    content, _ = exported(scene, tmp_path)
    assert content["couplings"][0]["ratio"] == pytest.approx(-1e-6 / 360, rel=1e-11)


def test_gear_between_hinges_keeps_its_ratio_in_degrees(tmp_path):
    """q_b = -2 q_a between two hinges stays -2, as hinge angles read CAD angles; a rack's unit is per degree."""
    scene = kinefab.Scene()
    parts = [scene.add_part(name, BOX, translation=(x, 0, 0)) for name, x in (("A", 0), ("B", 1), ("R", 2))]
    for part in parts[:2]:
        scene.add_hinge(None, part, point=(part, 0, 0), axis=(0, 0, 1), name=f"H{part}")
    scene.add_slider(None, parts[2], point=(2, 0, 0), axis=(1, 0, 0), name="S")
    scene.couplings.append(Coupling("G", CouplingKind.GEAR, "H0", RX, "H1", RX, -2.0))
    scene.couplings.append(Coupling("K", CouplingKind.RACK, "H1", RX, "S", TX, 0.05))
    content, _ = exported(scene, tmp_path)
    assert content["couplings"][0]["ratio"] == pytest.approx(-2.0)
    assert content["couplings"][1]["ratio"] == pytest.approx(0.05 * math.pi / 180)
    assert content["couplings"][1]["b"]["coordinate"] == "x"


def test_coupling_starts_from_the_angles_at_export(tmp_path):
    """With q_a = 20 and q_b = 10 degrees at export, q_b = -2 q_a + 50 holds there: no offset is left; 55 leaves 5."""
    for offset, left in ((50, 0), (55, 5)):
        scene = kinefab.Scene()
        for name, angle in (("A", 20), ("B", 10)):
            part = scene.add_part(
                name, BOX, rotation=rotation_about(np.array([0.0, 0, 1]), math.radians(angle))
            )
            joint = scene.add_hinge(None, part, point=(0, 0, 0), axis=(0, 0, 1), name=name)
            scene.joints[-1] = replace(joint, frame_b=joint.frame_a)  # zero where the part stands unturned
        scene.couplings.append(Coupling("G", CouplingKind.GEAR, "A", RX, "B", RX, -2.0, math.radians(offset)))
        content, _ = exported(scene, tmp_path)
        assert content["couplings"][0].get("offset", 0) == pytest.approx(left)


def test_coupling_on_a_missing_joint_is_dropped_with_a_report(tmp_path):
    """A coupling whose joint has no component is named in the report."""
    scene = lid_scene()
    scene.couplings.append(Coupling("G", CouplingKind.GEAR, "Hinge", RX, "Nowhere", RX, 1.0))
    content, result = exported(scene, tmp_path)
    assert "couplings" not in content
    assert "COUPLING_WITHOUT_JOINT" in {o.code for o in result.report.outcomes}


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
    assert [o.code for o in result.report.outcomes] == ["JOINT_WITHOUT_BODY"]


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
