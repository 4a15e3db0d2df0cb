"""A stage read back is the scene that the same source gives directly: bodies, masses, joints, limits, drives, couplings,
colliders and meshes, where each stands in the world (``usd_roundtrip``)."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from golden import FIXTURES, golden_pairs
from kinefab.model import (
    RX,
    RY,
    RZ,
    TX,
    Body,
    Drive,
    Freedom,
    Joint,
    JointKind,
    MassProperties,
    Mesh,
    Motion,
    Node,
    Passive,
    Scene,
    freedoms_of,
)
from kinefab.spatial import Pose, rotation_exp
from prefab_scenes import rich_scene
from test_targets_gltf import robot

pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Usd  # noqa: E402
from usd_roundtrip import compared, there_and_back  # noqa: E402

TOOL = shutil.which("dotnet-kinefab")
BUNDLES = [bundle for bundle, _ in golden_pairs()]
SIMPLIFIED = 1e-3
"""Share of the size: a hull of more than 255 triangles is simplified, and which of its vertices go hangs on the last bit."""


def without_simplified(found: list[str]) -> list[str]:
    """Differences without those of simplified hulls."""
    told = [(d, d.rpartition(": ")[2]) for d in found]
    return [d for d, most in told if not (d.startswith("shapes[") and float(most) < SIMPLIFIED)]


@pytest.mark.parametrize("bundle", BUNDLES, ids=lambda b: b.name.split(".")[0])
def test_every_fixture_comes_back(tmp_path, bundle):
    options = {"colliders": "hull"} if "lever" in bundle.name else {}  # its pieces take long to cut
    direct, stage, back = there_and_back(bundle, tmp_path, **options)
    found = compared(direct.unity, stage, back.unity)
    assert (without_simplified(found) if "lever" in bundle.name else found) == []
    if TOOL:
        # What others imply is not written: less redundant.
        fewer = len(back.unity.couplings) < len(direct.unity.couplings)
        one, other = (_mobility(path) for path in (direct.path, back.path))
        assert one[:2] == other[:2] and (fewer or one == other)


def _mobility(path: Path) -> tuple[int, ...]:
    """Freedoms and those of first order, as C# counts them, whether it finds the file's own counts, and each island's."""
    done = subprocess.run([str(TOOL), "mobility", str(path), "--json"], capture_output=True, text=True)
    counted = json.loads(done.stdout)["mobility"]
    each = sorted((island["mobility"], island["redundant"]) for island in counted["islands"])
    return counted["mobility"], counted["firstOrderMobility"], done.returncode, *each


@pytest.mark.parametrize(
    "source",
    [
        "lever/lever.usda", "lever/lever.urdf", "lever/lever.sdf", "twins/arm.usda", "twins/arm.urdf", "twins/arm.sdf",
        "twins/fourbar.usda", "twins/fourbar.sdf", "freecad/couplings.FCStd", "freecad/slider.FCStd", "freecad/four_bar.FCStd",
    ],
)  # fmt: skip
def test_robots_and_machines_of_other_formats_come_back(tmp_path, source):
    """From every source's units and up axis."""
    direct, stage, back = there_and_back(FIXTURES / source, tmp_path)
    assert compared(direct.unity, stage, back.unity) == []


@pytest.mark.parametrize("ending", [".usdc", ".usdz"])
def test_the_crate_and_the_package_hold_the_same(tmp_path, ending):
    direct, stage, back = there_and_back(robot(), tmp_path, ending)
    assert compared(direct.unity, stage, back.unity) == []


@pytest.mark.parametrize("colliders", ["hull", "box", "mesh", "none"])
def test_every_kind_of_collider_comes_back(tmp_path, colliders):
    direct, stage, back = there_and_back(
        FIXTURES / "lever" / "lever.bundle.json", tmp_path, colliders=colliders
    )
    assert without_simplified(compared(direct.unity, stage, back.unity)) == []


def test_pieces_of_a_hollow_part_come_back(tmp_path):
    """A stage says that the part is to be cut, and it is cut alike again."""
    pytest.importorskip("coacd", reason="coacd is not installed")
    scene = scene_of(JointKind.REVOLUTE)
    corner = [trimesh.creation.box((0.3, 0.05, 0.1)), trimesh.creation.box((0.05, 0.3, 0.1))]
    corner[0].apply_translation((0.125, 0.0, 0.0))
    corner[1].apply_translation((0.0, 0.175, 0.0))
    whole = trimesh.util.concatenate(corner)
    scene.meshes.append(Mesh("Angle", np.array(whole.vertices), np.array(whole.faces)))
    scene.nodes[1] = replace(scene.nodes[1], bodies=(Body("Angle", 0),))
    direct, stage, back = there_and_back(scene, tmp_path)
    assert compared(direct.unity, stage, back.unity) == []
    assert sum(type(c).__name__ == "MeshCollider" for o in back.unity.gameObjects for c in o.components) > 1


def test_one_of_everything_comes_back(tmp_path):
    """Vertex colours apart: who reads a stage takes them for the surface's colour."""
    scene = rich_scene(tmp_path)
    scene.meshes[3] = replace(scene.meshes[3], colors=None)
    direct, stage, back = there_and_back(scene, tmp_path)
    assert without_simplified(compared(direct.unity, stage, back.unity)) == []


def scene_of(kind: JointKind, *, grounded: bool = True, **freedoms: Freedom) -> Scene:
    """Two bodies askew in the world, exported away from the joint's zero; limits and targets of no symmetry."""
    base = Pose(rotation_exp(np.array([0.4, -0.3, 0.7])), np.array([0.3, -0.2, 0.5]))
    frame_a = Pose(rotation_exp(np.array([-0.2, 0.9, 0.3])), np.array([0.05, 0.02, -0.03]))
    frame_b = Pose(rotation_exp(np.array([0.5, 0.1, -0.6])), np.array([-0.04, 0.01, 0.06]))
    q = {
        name: value
        for name, value in zip(("tx", "ty", "tz", "rx", "ry", "rz"), (0.03, -0.02, 0.01, 0.3, -0.2, 0.1))
    }
    unlocked = [i for i, f in enumerate(freedoms_of(kind, **freedoms)) if f.motion is not Motion.LOCKED]
    values = np.array([v if i in unlocked else 0.0 for i, v in enumerate(q.values())])
    turn = np.eye(3)
    for i in (RX, RY, RZ):
        turn = rotation_exp(np.eye(3)[i - RX] * values[i]) @ turn
    other = base @ frame_a @ Pose(turn, values[:3]) @ frame_b.inverse()
    mass = MassProperties(
        1.5,
        np.array([0.01, -0.02, 0.03]),
        np.array([[0.02, 0.001, 0.0], [0.001, 0.03, 0.0], [0.0, 0.0, 0.04]]),
    )
    nodes = [Node("A", "A", pose=base, mass=mass, grounded=grounded), Node("B", "B", pose=other, mass=mass)]
    joint = Joint(
        "J", kind, 0, 1, frame_a, frame_b, freedoms_of(kind, **freedoms), break_force=300.0, break_torque=40.0
    )
    return Scene(nodes, joints=[joint])  # fmt: skip


def limited(low: float, high: float, **more) -> Freedom:
    return Freedom(Motion.LIMITED, low, high, **more)


HINGE = limited(math.radians(-10), math.radians(80), drive=Drive(0.4, 0.2, 30.0, 4.0, 7.0), restitution=0.3)
SLIDE = limited(-0.02, 0.1, drive=Drive(0.05, -0.1, 300.0, 20.0, 50.0), stiffness=900.0, damping=3.0)
CASES = {
    "hinge": (JointKind.REVOLUTE, {"rx": HINGE}),
    "spring hinge": (JointKind.REVOLUTE, {"rx": Freedom(Motion.FREE, drive=Drive(0.7, 0.0, 12.0, 0.5))}),
    "hinge of one end": (JointKind.REVOLUTE, {"rx": limited(-0.2, math.inf)}),
    "hinge beyond a turn": (JointKind.REVOLUTE, {"rx": limited(5.0, 7.5, at=0.3 + 2.0 * math.pi)}),
    "motor": (JointKind.REVOLUTE, {"rx": Freedom(Motion.FREE, drive=Drive(target_velocity=-0.6, max_force=8.0, motor=True))}),
    "accelerated": (JointKind.REVOLUTE, {"rx": Freedom(Motion.FREE, drive=Drive(0.2, 0.3, 9.0, 2.0, 5.0, True))}),
    "passive": (JointKind.REVOLUTE, {"rx": Freedom(Motion.FREE, passive=Passive(2.0, 0.3, 0.1, 0.05, 0.002, 9.0, 3.0))}),
    "slide": (JointKind.PRISMATIC, {"tx": SLIDE}),
    "hinge about Z": (JointKind.GENERAL, {"rz": HINGE}),
    "pipe": (JointKind.CYLINDRICAL, {"tx": SLIDE, "rx": HINGE}),
    "ball": (JointKind.SPHERICAL, {}),
    "ball in a cone": (JointKind.SPHERICAL, {"ry": limited(-0.6, 0.6), "rz": limited(-0.6, 0.6)}),
    "ball in an oval": (JointKind.SPHERICAL, {"ry": limited(-0.6, 0.6), "rz": limited(-0.9, 0.9)}),
    "ball with twist": (JointKind.SPHERICAL, {"rx": limited(-0.1, 0.7), "ry": limited(-0.6, 0.6), "rz": limited(-0.6, 0.6)}),
    "universal": (JointKind.UNIVERSAL, {"rz": limited(-0.3, 0.3)}),
    "two swings": (JointKind.GENERAL, {"ry": Freedom(Motion.FREE), "rz": limited(-0.8, 0.4)}),
    "pin in a slot": (JointKind.PIN_SLOT, {"ty": limited(-0.03, 0.03)}),
    "plane": (JointKind.PLANAR, {}),
    "point on a line": (JointKind.POINT_ON_LINE, {"tx": SLIDE}),
    "fixed": (JointKind.FIXED, {}),
    "turned to one value": (JointKind.CYLINDRICAL, {"rx": limited(0.3, 0.3)}),
}  # fmt: skip


@pytest.mark.parametrize("grounded", [True, False], ids=["on the ground", "between bodies"])
@pytest.mark.parametrize("name", CASES)
def test_a_joint_has_the_signs_it_had(tmp_path, name, grounded):
    kind, freedoms = CASES[name]
    direct, stage, back = there_and_back(scene_of(kind, grounded=grounded, **freedoms), tmp_path)
    assert compared(direct.unity, stage, back.unity) == []
    assert (
        len([c for o in direct.unity.gameObjects for c in o.components if type(c).__name__.endswith("Joint")])
        == 1
    )


def test_a_screw_is_a_screw_again(tmp_path):
    scene = scene_of(JointKind.SCREW)
    scene.joints[0] = replace(scene.joints[0], lead=-0.004)
    _, _, back = there_and_back(scene, tmp_path)
    (joint,) = [j for j in back.analysed.scene.joints if j.kind is not JointKind.FIXED]
    assert joint.kind is JointKind.SCREW and joint.lead == pytest.approx(-0.004, rel=1e-6)
    (coupling,) = back.unity.couplings
    assert coupling.coordinate.coordinate == "x" and coupling.terms[0].coordinate.coordinate == "angularX"


def test_a_joint_to_the_world_alone_comes_back(tmp_path):
    """No part stands on the ground, so no prim does for it."""
    scene = scene_of(JointKind.REVOLUTE, rx=HINGE)
    (joint,) = scene.joints
    world = scene.nodes[0].pose @ joint.frame_a
    scene = Scene([scene.nodes[1]], joints=[replace(joint, a=None, b=0, frame_a=world)])
    direct, stage, back = there_and_back(scene, tmp_path)
    assert compared(direct.unity, stage, back.unity) == []


def test_velocities_come_back(tmp_path):
    scene = scene_of(JointKind.REVOLUTE)
    dynamics = kinefab.model.Dynamics(
        False, False, 0.1, 0.2, np.array([0.1, 0.2, -0.3]), np.array([0.4, -0.5, 0.6]), 40.0
    )
    scene.nodes[1] = replace(scene.nodes[1], dynamics=dynamics)
    _, _, back = there_and_back(scene, tmp_path)
    found = next(n.dynamics for n in back.analysed.scene.nodes if n.name == "B")
    assert np.allclose(found.velocity, dynamics.velocity) and np.allclose(
        found.angular_velocity, dynamics.angular_velocity
    )
    assert found.max_angular_velocity == pytest.approx(40.0, rel=1e-6)
    assert not found.gravity and (found.linear_damping, found.angular_damping) == pytest.approx((0.1, 0.2))


def test_a_clip_comes_back(tmp_path):
    """Of a kinematic body, below a tree of its own."""
    scene = rich_scene(tmp_path)
    moves, turns = scene.animations[0].tracks[0].translations, scene.animations[0].tracks[0].rotations
    nodes = [
        scene.nodes[0],
        replace(scene.nodes[5], bodies=(), dynamics=kinefab.model.Dynamics(kinematic=True)),
    ]
    nodes[1] = replace(nodes[1], mass=MassProperties(1.0, np.zeros(3), np.eye(3) * 0.01))
    clip = kinefab.model.AnimationClip(
        "Open", scene.animations[0].times, (kinefab.model.Track(1, moves, turns),)
    )
    direct, _, back = there_and_back(Scene(nodes, animations=[clip]), tmp_path)
    (one,), (other,) = direct.unity.animations, back.unity.animations
    assert other.times == pytest.approx(one.times, abs=1e-12)
    (first,), (second,) = one.tracks, other.tracks
    assert np.allclose(first.localPosition, second.localPosition, atol=1e-12)
    assert np.allclose(first.localRotation, second.localRotation, atol=1e-12)


@pytest.mark.parametrize("ending", [".usda", ".usdc", ".usdz"])
def test_clips_stand_one_after_another_and_come_back(tmp_path, ending):
    """Each with its name, its times, its repeat and only what it moves; what a clip does not move rests while it plays."""
    turned = np.array([[0.0, 0.0, 0.0, 1.0], [0.0, np.sin(0.4), 0.0, np.cos(0.4)]])
    there = np.array([[1.0, 0.0, 0.0], [1.5, 0.25, 0.0]])
    nodes = [
        Node(
            name,
            name,
            pose=Pose(np.eye(3), there[0] if name == "A" else np.zeros(3)),
            mass=MassProperties(1.0, np.zeros(3), np.eye(3) * 0.01),
            dynamics=kinefab.model.Dynamics(kinematic=True),
        )
        for name in "ABC"
    ]
    track = kinefab.model.Track
    clips = [
        kinefab.model.AnimationClip("Open", np.array([0.5, 1.0 / 3.0 + 1.0]), (track(0, there),)),
        kinefab.model.AnimationClip(
            "Turn é", np.array([0.0, 2.0]), (track(2, None, turned),), kinefab.model.Repeat.LOOP
        ),
        kinefab.model.AnimationClip(
            "Both",
            np.array([1.0, 1.7, 3.0]),
            (track(0, there[[0, 1, 0]]), track(1, None, turned[[1, 0, 1]])),
            kinefab.model.Repeat.PING_PONG,
        ),
    ]
    direct = kinefab.export(Scene(nodes, animations=clips), tmp_path / "direct.kinefab")
    path = tmp_path / f"clips{ending}"
    told = kinefab.export(Scene(nodes, animations=clips), path)
    assert [o.code for o in told.report.outcomes if o.feature.startswith("clip")] == [
        "TARGET_CLIP_IN_LINE"
    ] * 3
    back = kinefab.export(path, tmp_path / "back.kinefab")
    stage = Usd.Stage.Open(str(path))
    assert stage.GetStartTimeCode() == 30.0 and stage.GetEndTimeCode() == pytest.approx(
        80 + 1 + 120 + 1 + 120
    )
    names = {entry.id: entry.name for entry in back.unity.gameObjects}
    assert len(back.unity.animations) == 3
    for one, other in zip(direct.unity.animations, back.unity.animations):
        assert (one.name, one.wrapMode) == (other.name, other.wrapMode)
        assert other.times == pytest.approx(one.times, abs=1e-12)
        sides = []
        for result, clip in ((direct, one), (back, other)):
            objects = result.unity.gameObjects
            sides.append({objects[t.gameObject].name: t for t in clip.tracks})
        assert sides[0].keys() == sides[1].keys()
        for name in sides[0]:
            for key in ("localPosition", "localRotation"):
                first, second = (getattr(side[name], key) for side in sides)
                assert bool(first) == bool(second) and np.allclose(first or 0, second or 0, atol=1e-12)
    assert set(names.values()) >= {"A", "B", "C"}


def test_clips_that_the_layer_tells_wrongly_are_one(tmp_path):
    """What somebody else wrote there, or an edit: no number, no keys within, a repeat that is none."""
    there = np.array([[0.0, 0.0, 0.0], [1.5, 0.25, 0.0]])
    mass = MassProperties(1.0, np.zeros(3), np.eye(3) * 0.01)
    still = Node("A", "A", mass=mass, dynamics=kinefab.model.Dynamics(kinematic=True))
    clip = kinefab.model.AnimationClip("Open", np.array([0.0, 1.0]), (kinefab.model.Track(0, there),))
    kinefab.export(Scene([still], animations=[clip]), tmp_path / "a.usda")
    text = (tmp_path / "a.usda").read_text()
    assert 'string repeat = "once"' in text
    for old, new in (
        ('string repeat = "once"', 'string repeat = "never"'),
        ("double end = 60", "double end = -60"),
        ("double start = 0", 'string start = "0"'),
        ('string name = "Open"', "int name = 3"),
        ("dictionary clip0 = {", "dictionary clip0 = {} \n dictionary other = {"),
    ):
        assert old in text
        (tmp_path / "b.usda").write_text(text.replace(old, new))
        (found,) = kinefab.export(tmp_path / "b.usda", tmp_path / "b.kinefab").unity.animations
        assert found.name == "Animation" and found.times == pytest.approx([0.0, 1.0])


def test_gravity_and_step_come_back(tmp_path):
    scene = scene_of(JointKind.REVOLUTE)
    scene.physics = kinefab.model.Physics((1.0, -3.0, 2.0), 0.004)
    direct, stage, back = there_and_back(scene, tmp_path)
    assert compared(direct.unity, stage, back.unity) == [] and direct.unity.physics.fixedTimestep == 0.004


def test_couplings_of_slides_and_turns_come_back(tmp_path):
    """A rack in metres a degree, and a chain in which one joint leads two."""
    source = FIXTURES / "freecad" / "couplings.FCStd"
    direct, stage, back = there_and_back(source, tmp_path)
    assert len(direct.unity.couplings) >= 2
    assert compared(direct.unity, stage, back.unity) == []
    assert TX in {f for c in direct.analysed.scene.couplings for f in (c.freedom, c.terms[0].freedom)}
