"""What UsdPhysics itself has no word for stands beside it: read back it is what it was, and an engine's own words tell the rest."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import Outcome, Report
from kinefab.model import (
    RX,
    RY,
    RZ,
    TX,
    Collider,
    ColliderKind,
    Coupling,
    CouplingKind,
    Drive,
    Freedom,
    Joint,
    Motion,
    Passive,
    Scene,
    SphericalDrive,
    Term,
)
from kinefab.sources import read
from kinefab.spatial import rotation_exp

pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Usd, UsdPhysics

BOX = trimesh.creation.box((0.1, 0.2, 0.3))
TURN = np.array([0.3, -0.2, 0.5])


def pair(kind: str, **freedoms: Freedom) -> Scene:
    """Two parts off every axis, and a joint between them."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    arm = scene.add_part("Arm", BOX, translation=(0.3, 0.1, 0.2))
    scene.add_joint(kind, base, arm, point=(0.15, 0.1, 0.1), axis=(1, 2, 3), name="Joint")
    joint = scene.joints[0]
    given = list(joint.freedoms)
    for name, freedom in freedoms.items():
        given[("tx", "ty", "tz", "rx", "ry", "rz").index(name)] = freedom
    scene.joints[0] = replace(joint, freedoms=tuple(given))
    return scene


def written(scene: Scene, folder: Path) -> tuple[Path, list[tuple[str, str]]]:
    result = kinefab.export(scene, folder / "Pair.usda")
    return result.path, [(o.feature, o.code) for o in result.report.outcomes if o.outcome.value != "kept"]


def back(path: Path) -> Joint:
    report = Report()
    (joint,) = [j for j in read(path, report).joints if j.name == "Joint"]
    report.raise_for_errors()
    return joint


def turning(**passive: float) -> Freedom:
    return Freedom(Motion.LIMITED, math.radians(-10), math.radians(80), passive=Passive(**passive))


def test_friction_armature_and_speed_of_a_joint_of_two_turns(tmp_path):
    x, z = turning(friction=0.75, armature=0.02), turning(friction=0.5, speed=3.0)
    path, lost = written(pair("universal", rx=x, rz=z), tmp_path)
    assert lost == []
    found = sorted((f.passive for f in back(path).freedoms if f.passive), key=lambda p: p.friction)
    assert [p.friction for p in found] == pytest.approx([0.5, 0.75])
    assert [p.armature for p in found] == pytest.approx([0.0, 0.02])
    assert [p.speed for p in found] == pytest.approx([3.0, math.inf])


def test_of_a_joint_that_slides_too_they_stand_there_and_engines_take_none(tmp_path):
    slide = Freedom(Motion.LIMITED, -0.02, 0.1, passive=Passive(friction=12.0))
    path, lost = written(pair("cylindrical", tx=slide, rx=turning(friction=0.5, effort=9.0)), tmp_path)
    assert sorted(lost) == [
        ("friction, armature and largest speed of joint Joint, rx", "TARGET_FEATURE_APPROXIMATED"),
        ("friction, armature and largest speed of joint Joint, tx", "TARGET_FEATURE_APPROXIMATED"),
        ("the largest effort of rx of joint Joint", "TARGET_FIELD_DROPPED"),
    ]
    freedoms = back(path).freedoms
    assert freedoms[TX].passive.friction == 12.0 and freedoms[RX].passive.friction == 0.5


def test_a_hinge_says_its_friction_to_physx_too(tmp_path):
    path, _ = written(pair("revolute", rx=turning(friction=0.75)), tmp_path)
    stage = Usd.Stage.Open(str(path))
    (prim,) = [p for p in stage.Traverse() if p.GetName() == "Joint"]
    names = [f"physxJointAxis:angular:{kind}FrictionEffort" for kind in ("static", "dynamic")]
    assert [prim.GetAttribute(name).Get() for name in (*names, "newton:friction")] == [0.75] * 3
    assert "PhysxJointAxisAPI:angular" in prim.GetMetadata("apiSchemas").GetAddedOrExplicitItems()


def test_one_drive_about_all_three_rotations_is_one_again(tmp_path):
    scene = pair("spherical")
    given = SphericalDrive(rotation_exp(TURN), np.array([0.1, 0.7, -0.4]), 9.0, 0.5, 4.0)
    scene.joints[0] = replace(scene.joints[0], slerp=given)
    path, lost = written(scene, tmp_path)
    assert lost == [("joint Joint", "TARGET_FEATURE_APPROXIMATED")]
    found = back(path)
    assert found.slerp is not None and all(f.drive is None for f in found.freedoms)
    original = scene.joints[0].frame_a.rotation
    same = lambda turn, frame: frame @ turn @ frame.T  # noqa: E731
    assert np.allclose(
        same(found.slerp.target, found.frame_a.rotation), same(given.target, original), atol=1e-6
    )
    assert np.allclose(
        found.frame_a.rotation @ found.slerp.target_velocity, original @ given.target_velocity, atol=1e-6
    )
    numbers = (found.slerp.stiffness, found.slerp.damping, found.slerp.max_force)
    assert numbers == pytest.approx((9.0, 0.5, 4.0), rel=1e-6)


def test_a_slide_is_driven_beside_one_drive_about_all_three_rotations(tmp_path):
    scene = pair("point_on_line", tx=Freedom(Motion.FREE, drive=Drive(0.3, 0.1, 20.0, 2.0, 50.0)))
    scene.joints[0] = replace(
        scene.joints[0], slerp=SphericalDrive(rotation_exp(TURN), np.zeros(3), 9.0, 0.5)
    )
    path, _ = written(scene, tmp_path)
    found = back(path)
    assert found.slerp is not None and found.freedoms[TX].drive is not None
    driven = found.freedoms[TX].drive
    told = (driven.target, driven.target_velocity, driven.stiffness, driven.damping, driven.max_force)
    assert told == pytest.approx((0.3, 0.1, 20.0, 2.0, 50.0), rel=1e-6)


@pytest.mark.parametrize(
    "name, value", [("drive:rotY:physics:stiffness", 3.0), ("drive:rotZ:physics:targetPosition", 90.0),
                    ("kinefab:slerp:target", (math.nan, 0.0, 0.0))]
)  # fmt: skip
def test_drives_that_somebody_changed_are_three(tmp_path, name, value):
    scene = pair("spherical")
    given = SphericalDrive(rotation_exp(TURN), np.zeros(3), 9.0, 0.5)
    scene.joints[0] = replace(scene.joints[0], slerp=given)
    path, _ = written(scene, tmp_path)
    stage = Usd.Stage.Open(str(path))
    (prim,) = [p for p in stage.Traverse() if p.GetName() == "Joint"]
    prim.GetAttribute(name).Set(value)
    stage.Save()
    found = back(path)
    assert found.slerp is None and all(found.freedoms[i].drive is not None for i in (RX, RY, RZ))


def boxes() -> Scene:
    """Three parts that collide as boxes: two in a group that ignores the third's, one of them twice over by a pair."""
    scene = kinefab.Scene()
    for k, group in enumerate(("arms", "arms", "tools")):
        part = scene.add_part(f"Part {k}", BOX, translation=(k, 0.1, 0.2))
        shape = Collider(ColliderKind.BOX, size=(0.1, 0.2, 0.3 + k), group=group)
        scene.nodes[part] = replace(scene.nodes[part], colliders=(shape,))
    return scene


@pytest.mark.parametrize(
    "extras",
    [
        {"collisionGroups": {"arms": ["tools", "gone"], "tools": []}},
        {"collisionMasks": {"arms": [2, 1], "tools": [4, 1]}},
    ],
)
def test_collision_groups_and_pairs_are_those_of_the_source(tmp_path, extras):
    scene = boxes()
    scene.extras = {**extras, "ignoreCollision": [["Part 0", "Part 1"], ["Part 0", "nobody"]]}
    path, lost = written(scene, tmp_path)
    assert lost == [("filtered pair Part 0 and nobody", "TARGET_FIELD_DROPPED")]
    stage = Usd.Stage.Open(str(path))
    found = {
        p.GetName(): UsdPhysics.CollisionGroup(p)
        for p in stage.Traverse()
        if p.IsA(UsdPhysics.CollisionGroup)
    }
    assert {n: len(g.GetCollidersCollectionAPI().GetIncludesRel().GetTargets()) for n, g in found.items()} == {
        "arms": 2, "tools": 1,
    }  # fmt: skip
    table = UsdPhysics.CollisionGroup.ComputeCollisionGroupTable(stage)
    paths = {name: group.GetPath() for name, group in found.items()}
    assert not table.IsCollisionEnabled(paths["arms"], paths["tools"])
    own = "collisionMasks" not in extras  # masks of 2 and 1 keep arms from each other too
    assert table.IsCollisionEnabled(paths["arms"], paths["arms"]) is own
    read_back = read(path, Report())
    groups = {
        node.name: node.colliders[0].group.rpartition("/")[2] for node in read_back.nodes if node.colliders
    }
    assert groups == {"Part 0": "arms", "Part 1": "arms", "Part 2": "tools"}
    ignored = {
        k.rpartition("/")[2]: [o.rpartition("/")[2] for o in v]
        for k, v in read_back.extras["collisionGroups"].items()
    }
    assert "tools" in ignored["arms"] and ("arms" in ignored["arms"]) is not own
    (pair,) = read_back.apart
    first, second = read_back.nodes[pair.a].id, read_back.nodes[pair.b].id
    assert {first.rpartition("/")[2], second.rpartition("/")[2]} == {"Part_0", "Part_1"}


def test_a_name_that_usd_cannot_show_is_told(tmp_path):
    names = {"line\nbreak": "line_break", "\u202eback": "_back", " ": "_", "plain": None, "Größe 1": None}
    scene = Scene(nodes=[kinefab.model.Node(f"N{i}", name) for i, name in enumerate(names)])
    result = kinefab.export(scene, tmp_path / "a.usda")
    told = [o.feature for o in result.report.outcomes if o.code == "TARGET_NAME_CHANGED"]
    assert told == [f"name of N{i}" for i, changed in enumerate(names.values()) if changed]
    messages = [d.message for d in result.report.diagnostics if d.code == "TARGET_NAME_CHANGED"]
    assert all(changed in message for changed, message in zip(filter(None, names.values()), messages))


def test_a_name_with_spaces_and_joiners_of_other_scripts_stays(tmp_path):
    """isprintable() says no to an ideographic space, and the part was then called ``___1``."""
    names = ["部品\u30001", "Pièce\u00a02", "\u0646\u0645\u06cc\u200c\u062e"]
    scene = Scene(nodes=[kinefab.model.Node(f"N{i}", name) for i, name in enumerate(names)])
    result = kinefab.export(scene, tmp_path / "a.usda")
    assert not [o for o in result.report.outcomes if o.code == "TARGET_NAME_CHANGED"]
    back = kinefab.export(result.path, tmp_path / "a.kinefab")
    assert set(names) <= {o.name for o in back.unity.gameObjects}


def test_what_is_coupled_has_ends_that_engines_take_and_kinefab_reads_as_none(tmp_path: Path):
    """PhysX refuses a mimic of joints without finite ranges, of any that the articulation excludes, and across articulations."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    parts = [scene.add_part(f"W{i}", BOX, translation=(i, 0.3, 0.2)) for i in range(1, 5)]
    for i, part in enumerate(parts):
        scene.add_hinge(base, part, point=(i + 1, 0.3, 0), axis=(1, 2, 3), name=f"J{i}")
    sided = Freedom(Motion.LIMITED, math.radians(-10.0), math.inf)
    free = scene.joints[1].freedoms
    scene.joints[1] = replace(scene.joints[1], freedoms=(*free[:RX], sided, *free[RX + 1 :]))
    scene.joints[2] = replace(scene.joints[2], break_force=5.0)
    ids = [joint.id for joint in scene.joints]
    tie = Coupling("C1", CouplingKind.GEAR, ids[1], RX, (Term(ids[0], RX, -2.0),))
    scene.couplings = [tie, replace(tie, id="C2", joint=ids[2])]
    result = kinefab.export(scene, tmp_path / "gears.usda")
    stage = Usd.Stage.Open(str(result.path))
    ranges = {
        p.GetName(): [p.GetAttribute(f"physics:{end}Limit").Get() for end in ("lower", "upper")]
        for p in stage.Traverse()
        if p.GetTypeName() == "PhysicsRevoluteJoint"
    }
    most = pytest.approx(1e30, rel=1e-6)
    assert ranges["J0"] == [-ranges["J0"][1], most] and ranges["J1"] == [pytest.approx(-10.0), most]
    assert ranges["J2"] == ranges["J3"] == [-math.inf, math.inf]  # the one that breaks is in no articulation
    outcomes = {o.feature: (o.outcome, o.code) for o in result.report.outcomes if "coupling" in o.feature}
    assert outcomes["coupling C1"][0] is Outcome.KEPT
    assert outcomes["coupling C2"] == (Outcome.APPROXIMATED, "TARGET_FEATURE_APPROXIMATED")
    again = {joint.name: joint for joint in read(result.path, Report()).joints}
    assert again["J0"].freedoms[RX].motion is Motion.FREE
    back = again["J1"].freedoms[RX]
    assert (back.lower, back.upper) == (pytest.approx(math.radians(-10.0)), math.inf)
    hung = replace(scene, joints=[replace(joint, a=None) for joint in scene.joints], couplings=[tie])
    told = kinefab.export(hung, tmp_path / "apart.usda").report.outcomes
    assert [o.outcome for o in told if o.feature == "coupling C1"] == [Outcome.APPROXIMATED]
