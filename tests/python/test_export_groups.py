"""Rigid groups in the exported scene: Rigidbodies, joints that hold them, freedoms a source lists."""

from __future__ import annotations

import math
from dataclasses import replace

import kinefab
import numpy as np
import pytest
from kinefab.diagnostics import Outcome
from kinefab.model import DofRecord
from kinefab.spatial import rotation_about
from scene_kinematics import SceneKinematics
from scenes import BOX, components, exported, lid_scene


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


@pytest.mark.parametrize("joined", [False, True])
def test_a_rigid_assembly_of_which_no_part_is_there_is_no_body(joined, tmp_path):
    """All its parts suppressed, it would fall by itself, with six freedoms; one that a joint is on is something."""
    scene = kinefab.Scene()
    door = scene.add_part("Door", BOX)
    scene.add_hinge(None, door, point=(0, 0, 0), axis=(0, 1, 0))
    empty = scene.add_assembly("Empty", flexible=False)
    gone = scene.add_part("Gone", BOX, parent=empty)
    scene.nodes[gone] = replace(scene.nodes[gone], suppressed=True)
    scene.dof_records.append(DofRecord(empty, np.eye(3), np.eye(3)))
    if joined:
        scene.add_slider(door, empty, point=(0, 0, 0), axis=(1, 0, 0))
    content, result = exported(scene, tmp_path)
    assert content["analysis"]["mobility"] == 1 + joined
    assert len(components(content, "Empty", "Rigidbody")) == joined
    assert [d.code for d in result.report.diagnostics if d.code == "MASS_UNKNOWN"] == [
        "MASS_UNKNOWN"
    ] * joined


def test_part_fixed_to_the_ground_is_static(tmp_path):
    """What is fixed to the world, or to something grounded, gets no Rigidbody but keeps its collider."""
    scene = kinefab.Scene()
    post = scene.add_part("Post", BOX, grounded=True)
    plate = scene.add_part("Plate", BOX, translation=(0, 1, 0))
    scene.add_fixed(post, plate)
    content, _ = exported(scene, tmp_path)
    assert components(content, "Plate", "Rigidbody") == []
    assert len(components(content, "Plate", "BoxCollider")) == 1


@pytest.mark.parametrize("ground", ["body", "world"])
def test_what_is_grounded_below_what_moves_stays(ground, tmp_path):
    """Below it in the source's tree only: Unity carries a child along with its parent's Transform, a kinematic one too."""
    scene = kinefab.Scene()
    arm = scene.add_part("Arm", BOX, translation=(0, 1, 0))
    post = scene.add_part("Post", BOX, parent=arm, grounded=True)
    scene.add_part("Foot", BOX, parent=post, grounded=True, translation=(0, -1, 0))
    scene.add_hinge(post, arm, point=(0, 0.5, 0), axis=(0, 0, 1), limits=(-10, 80))
    content, result = exported(scene, tmp_path, ground=ground)
    names = [entry["name"] for entry in content["gameObjects"]]
    above = {entry["name"]: entry.get("parent") for entry in content["gameObjects"]}
    assert above["Post"] == (names.index("Ground") if ground == "body" else None)
    assert above["Foot"] == names.index("Post")
    assert components(content, "Post", "Rigidbody") == components(content, "Foot", "Rigidbody") == []
    place = SceneKinematics(content).placed[names.index("Foot")][1]
    assert place == pytest.approx([0.0, -1.0, 0.0])
    assert [o.feature for o in result.report.outcomes if o.code == "GROUNDED_STANDS_BESIDE"] == [
        "part Arm/Post"
    ]
    (moved,) = components(content, "Arm", "Rigidbody")
    assert not moved.get("isKinematic", False)


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
    assert [o.code for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == ["DOF_RECORD_INEXPRESSIBLE"]


def test_freedoms_of_a_flexible_assembly_are_dropped_with_a_report(tmp_path):
    """Its parts move on their own, so its freedoms are nobody's; that is said."""
    scene = kinefab.Scene()
    assembly = scene.add_assembly("Loose")
    scene.add_part("Part", BOX, parent=assembly)
    scene.dof_records.append(DofRecord(assembly, np.zeros((0, 3)), np.array([[1.0, 0, 0]])))
    _, result = exported(scene, tmp_path)
    assert [o.code for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == ["DOF_RECORD_INEXPRESSIBLE"]
