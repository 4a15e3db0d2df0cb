"""MJCF: poses, limits, signs, masses and loops against MuJoCo itself; springs, actuators, couplings, shapes and keyframes."""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.color import linear
from kinefab.diagnostics import Report
from kinefab.model import ColliderKind, Combine, JointKind, Motion
from kinefab.sources import read
from kinefab.sources.mjcf.engine import compile_model
from kinefab.sources.mjcf.files import scan
from kinefab.sources.robots.packages import Packages
from scene_kinematics import ROS, SceneKinematics, unity_point

mujoco = pytest.importorskip("mujoco", reason="mujoco (pip install mujoco) is not installed")

sys.path.append(str(Path(__file__).parents[2] / "python" / "bench"))
from engines.mjcf import MujocoModel  # noqa: E402
from scoring import scored  # noqa: E402

FIXTURES = Path(__file__).parents[2] / "fixtures"
MODELS = sorted([*(FIXTURES / "mjcf").glob("*.xml"), *(FIXTURES / "twins").glob("*.xml")])
TOOL = shutil.which("dotnet-kinefab")


def model(folder: Path, inner: str, head: str = "", tail: str = "") -> Path:
    path = folder / "m.xml"
    path.write_text(
        f"<mujoco model='m'>\n{head}<worldbody>\n{inner}\n</worldbody>\n{tail}</mujoco>", encoding="utf-8"
    )
    return path


def loaded(folder: Path, inner: str, head: str = "", tail: str = "", **options):
    report = Report()
    return read(model(folder, inner, head, tail), report, options=options), report


def codes(report: Report) -> set[str]:
    return {d.code for d in report.diagnostics}


BALL = "<geom type='sphere' size='.1'/>"


@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_it_moves_as_mujoco_moves_it(tmp_path, path):
    """50 configurations inside the limits, every body; masses, centres and inertias; ends of every range.

    The scene is moved by the forward kinematics of the tests, from its file alone.
    """
    result = kinefab.export(path, tmp_path / "scene.kinefab")
    told = {o.feature for o in result.report.outcomes if o.outcome.value != "kept"}
    found = scored(result.path, MujocoModel(path), 50, told)
    assert found["wrong"] == []
    assert max(found["fk"]) < 1e-9 and found["mass_error"] < 1e-9


@pytest.mark.skipif(TOOL is None, reason="dotnet-kinefab is not on the PATH")
@pytest.mark.parametrize("path", MODELS, ids=lambda p: p.stem)
def test_csharp_counts_mujocos_degrees_of_freedom(tmp_path, path):
    target = kinefab.export(path, tmp_path / "scene.kinefab").path
    said = subprocess.run([str(TOOL), "mobility", str(target), "--json"], capture_output=True, text=True)
    assert json.loads(said.stdout)["mobility"]["mobility"] == MujocoModel(path).mobility


def test_the_loop_closes_as_mujoco_closes_it(tmp_path):
    """Turned by its crank, the exported four-bar is a pose in which MuJoCo's constraints are met."""
    engine = MujocoModel(FIXTURES / "twins" / "fourbar.xml")
    engine._place({})
    assert engine.residual() < 1e-9
    assert engine.mobility == 1


def test_a_range_is_that_of_the_file_whatever_the_reference(tmp_path):
    """``ref`` is the coordinate at the exported pose: -10 to 80 degrees from 15 leave -25 and 65."""
    scene, _ = loaded(
        tmp_path, f"<body><joint name='j' axis='0 3 4' pos='.1 0 .2' range='-10 80' ref='15'/>{BALL}</body>"
    )
    freedom = scene.joints[0].freedoms[3]
    assert math.degrees(freedom.lower) == pytest.approx(-10.0) and math.degrees(
        freedom.upper
    ) == pytest.approx(80.0)
    assert math.degrees(freedom.at) == pytest.approx(15.0)
    target = kinefab.export(scene, tmp_path / "j.kinefab").path
    motion = SceneKinematics.load(target)
    coordinate, sense = motion.reading("j", unity_point([0.0, 0.6, 0.8], ROS), True, "body")
    assert sorted(sense * v for v in motion.range_of(coordinate)) == pytest.approx([-25.0, 65.0])


def test_passive_terms_and_springs(tmp_path):
    scene, _ = loaded(
        tmp_path,
        "<body><joint name='j' stiffness='3' springref='30' ref='10' damping='.5' armature='.02' frictionloss='.1'/>"
        + BALL + "</body>",
    )  # fmt: skip
    passive = scene.joints[0].freedoms[3].passive
    assert (passive.stiffness, passive.damping, passive.armature, passive.friction) == (3.0, 0.5, 0.02, 0.1)
    assert math.degrees(passive.rest) == pytest.approx(30.0)


ONE = f"<body><joint name='j'/>{BALL}</body>"


@pytest.mark.parametrize(
    "actuator, expected",
    [
        ("<position joint='j' kp='10' kv='2' gear='3'/>", (90.0, 18.0, 0.0, 0.0, math.inf)),
        ("<velocity joint='j' kv='2' gear='3'/>", (0.0, 18.0, 0.0, 0.0, math.inf)),
        ("<position joint='j' kp='10' forcerange='-4 4' gear='-2'/>", (40.0, 0.0, 0.0, 0.0, 8.0)),
        ("<position joint='j' kp='10' ctrlrange='.5 2'/>", (10.0, 0.0, 0.5, 0.0, math.inf)),
        (
            "<general joint='j' gainprm='6' biastype='affine' biasprm='1 -5 -.5' ctrlrange='2 3'/>",
            (5.0, 0.5, 2.6, 0.0, math.inf),
        ),
        (
            "<position joint='j' kp='10'/><velocity joint='j' kv='2' ctrlrange='3 4'/>",
            (10.0, 2.0, 0.6, 0.0, math.inf),
        ),
    ],
)
def test_actuators_are_drives_where_unitys_law_is_theirs(tmp_path, actuator, expected):
    """force = gear (gain u + b0 + b1 gear q + b2 gear qdot), against k (target - q) + d (speed - qdot)."""
    scene, report = loaded(tmp_path, ONE, tail=f"<actuator>{actuator}</actuator>")
    drive = scene.joints[0].freedoms[3].drive
    found = (drive.stiffness, drive.damping, drive.target, drive.target_velocity, drive.max_force)
    assert found == pytest.approx(expected)
    assert "MJCF_ACTUATOR" not in codes(report)


def test_what_bounds_the_actuators_of_a_joint_bounds_its_drive(tmp_path):
    """MuJoCo clips their sum; Unity's drive has a largest force, but none for a spring of the joint beside it."""
    head = "<body><joint name='j' actuatorfrcrange='-5 5'{}/>" + BALL + "</body>"
    tail = "<actuator><position joint='j' kp='10' forcerange='-8 8'/><motor joint='j' ctrlrange='-2 2'/></actuator>"

    def written(more: str, ends: str):
        (path := tmp_path / "e").mkdir(exist_ok=True)
        result = kinefab.export(
            model(path, head.format(more).replace("-5 5", ends), tail=tail), tmp_path / "e.kinefab"
        )
        content = json.loads(result.path.read_text(encoding="utf-8"))
        parts = [c for entry in content["gameObjects"] for c in entry.get("components", ())]
        (joint,) = (c for c in parts if c["type"] == "ConfigurableJoint")
        return joint["angularXDrive"], {d.code for d in result.report.diagnostics}

    drive, told = written("", "-5 5")
    assert drive == {"positionSpring": 10, "maximumForce": 5}
    assert "JOINT_EFFORT_DROPPED" not in told and "MJCF_EFFORT_UNEVEN" not in told
    drive, told = written(" damping='1'", "-5 5")
    assert drive["maximumForce"] == 8 and "JOINT_PASSIVE_DROPPED" in told
    drive, told = written("", "-5 6")
    assert drive["maximumForce"] == 6 and "MJCF_EFFORT_UNEVEN" in told


def test_two_clipped_actuators_of_a_joint_are_not_one_drive(tmp_path):
    """clip(10 (u - q), 4) + clip(-2 qdot, 1) is no clip of the sum."""
    position, velocity = "<position joint='j' kp='10'{}/>", "<velocity joint='j' kv='2'/>"
    for bound, told in (("", False), (" forcerange='-4 4'", True)):
        _, report = loaded(tmp_path, ONE, tail=f"<actuator>{position.format(bound)}{velocity}</actuator>")
        assert ("MJCF_ACTUATOR" in codes(report)) is told


@pytest.mark.parametrize(
    "actuator, word",
    [
        ("<motor joint='j' gear='5' ctrlrange='-2 1'/>", "effort"),
        ("<intvelocity joint='j' kp='3' actrange='-1 1'/>", "integrator"),
        ("<damper joint='j' kv='3' ctrlrange='0 1'/>", "affine"),
        ("<position joint='j' kp='3' forcerange='-1 4'/>", "both sides"),
        ("<position joint='j' kp='3' timeconst='.1'/>", "lag"),
        ("<motor site='s' gear='1 0 0 0 0 0'/>", "site"),
        ("<motor tendon='t' gear='2'/>", "tendon"),
    ],
)
def test_other_actuators_are_told_with_their_numbers(tmp_path, actuator, word):
    scene, report = loaded(
        tmp_path,
        ONE.replace("<geom", "<site name='s'/><geom"),
        tail=f"<tendon><fixed name='t'><joint joint='j' coef='2'/></fixed></tendon><actuator>{actuator}</actuator>",
    )
    (found,) = (d for d in report.diagnostics if d.code == "MJCF_ACTUATOR")
    assert word in found.message and "gear" in found.message
    if word == "effort":
        assert scene.joints[0].freedoms[3].passive.effort == 10.0


TWO = (
    f"<body><joint name='j' ref='20'/>{BALL}</body><body pos='1 0 0'><joint name='k' ref='-5'/>{BALL}</body>"
    f"<body pos='2 0 0'><joint name='l' type='slide'/>{BALL}</body>"
)


def test_joint_equalities_are_couplings(tmp_path):
    """q_j - 20 = 0.1 rad + 2 (q_k + 5), angles of the file in degrees."""
    scene, report = loaded(
        tmp_path,
        TWO,
        tail="<equality><joint name='e' joint1='j' joint2='k' polycoef='.1 2 0 0 0'/></equality>",
    )
    (coupling,) = scene.couplings
    assert (coupling.id, coupling.joint, coupling.terms[0].joint) == ("e", "j", "k")
    assert coupling.terms[0].ratio == pytest.approx(2.0)
    assert coupling.offset == pytest.approx(math.radians(20.0) + 0.1 + 2.0 * math.radians(5.0))
    assert "MJCF_POLYNOMIAL" not in codes(report)


def test_a_polynomial_is_its_tangent_and_told(tmp_path):
    scene, report = loaded(
        tmp_path,
        TWO,
        tail="<equality><joint name='e' joint1='j' joint2='k' polycoef='0 1 .5 0 0'/></equality>",
    )
    assert scene.couplings[0].terms[0].ratio == pytest.approx(1.0)
    assert "MJCF_POLYNOMIAL" in codes(report)


def test_a_polynomial_is_its_tangent_at_the_exported_pose(tmp_path):
    """At q_k + 5 = 0.4 rad, q_j - 20 is 0.1 + 2 x + 0.5 x x = 0.98 and grows 2.4 times as fast."""
    key = f"<keyframe><key qpos='{math.radians(20) + 0.98} {math.radians(-5) + 0.4} 0'/></keyframe>"
    law = "<equality><joint name='e' joint1='j' joint2='k' polycoef='.1 2 .5 0 0'/></equality>"
    scene, _ = loaded(tmp_path, TWO, tail=law + key, keyframe="0")
    (coupling,) = scene.couplings
    assert coupling.terms[0].ratio == pytest.approx(2.4)
    at = coupling.offset + 2.4 * (math.radians(-5) + 0.4)
    assert at == pytest.approx(math.radians(20) + 0.98)


def test_one_joint_of_an_equality_is_held(tmp_path):
    scene, _ = loaded(tmp_path, TWO, tail="<equality><joint joint1='l' polycoef='.25 1 0 0 0'/></equality>")
    freedom = next(j for j in scene.joints if j.id == "l").freedoms[0]
    assert (freedom.motion, freedom.lower, freedom.upper) == (Motion.LIMITED, 0.25, 0.25)


def test_fixed_tendons_are_couplings_of_several_terms(tmp_path):
    """2 j + 3 k - 4 l keeps its length: j follows the others."""
    tail = (
        "<tendon><fixed name='t'><joint joint='j' coef='2'/><joint joint='k' coef='3'/><joint joint='l' coef='-4'/>"
        "</fixed></tendon><equality><tendon name='e' tendon1='t'/></equality>"
    )
    scene, _ = loaded(tmp_path, TWO, tail=tail)
    (coupling,) = scene.couplings
    assert {(t.joint, t.ratio) for t in coupling.terms} == {("k", -1.5), ("l", 2.0)}
    assert coupling.offset == pytest.approx(math.radians(20.0) - 1.5 * math.radians(5.0))


def test_a_tendon_follows_another_from_where_both_are_at_rest(tmp_path):
    """2 j - 2 * 20 = 0.1 + 0.5 (3 k - 4 l + 3 * 5), angles of the file in degrees: neither is zero at rest."""
    tail = (
        "<tendon><fixed name='t'><joint joint='j' coef='2'/></fixed>"
        "<fixed name='u'><joint joint='k' coef='3'/><joint joint='l' coef='-4'/></fixed></tendon>"
        "<equality><tendon name='e' tendon1='t' tendon2='u' polycoef='.1 .5 0 0 0'/></equality>"
    )
    scene, _ = loaded(tmp_path, TWO, tail=tail)
    (coupling,) = scene.couplings
    assert coupling.joint == "j" and {(t.joint, t.ratio) for t in coupling.terms} == {
        ("k", 0.75),
        ("l", -1.0),
    }
    assert coupling.offset == pytest.approx(math.radians(20.0) + 0.05 + 0.75 * math.radians(5.0))


def test_spatial_tendons_are_told_with_their_numbers(tmp_path):
    tail = "<tendon><spatial name='t' stiffness='7' range='0 2' limited='true'><site site='a'/><site site='b'/></spatial></tendon>"
    inner = f"<site name='a'/><body><joint name='j'/><site name='b' pos='1 0 0'/>{BALL}</body>"
    _, report = loaded(tmp_path, inner, tail=tail)
    (found,) = (d for d in report.diagnostics if d.code == "MJCF_TENDON")
    assert "range 0 2" in found.message and "stiffness 7" in found.message


LOOP = (
    f"<body name='a'><joint name='j'/>{BALL}</body><body name='b' pos='1 0 0'><joint name='k'/>{BALL}</body>"
)


@pytest.mark.parametrize(
    "equality, kind",
    [
        ("<connect name='e' body1='a' body2='b' anchor='.5 .1 0'/>", JointKind.SPHERICAL),
        ("<weld name='e' body1='a' body2='b'/>", JointKind.FIXED),
        ("<weld name='e' body1='a' body2='b' relpose='1 0 0 .8 .6 0 0' anchor='.1 0 0'/>", JointKind.FIXED),
        (
            "<connect name='e' body1='a' body2='b' anchor='.5 .1 0'/><connect body1='a' body2='b' anchor='.5 .1 1'/>",
            JointKind.REVOLUTE,
        ),
    ],
)
def test_equalities_of_bodies_are_joints_that_close_loops(tmp_path, equality, kind):
    scene, _ = loaded(tmp_path, LOOP, tail=f"<equality>{equality}</equality>")
    (joint,) = (j for j in scene.joints if j.id == "e")
    assert joint.kind is kind and joint.collide


def test_an_equality_that_is_not_active_is_a_joint_switched_off(tmp_path):
    tail = "<equality><connect name='e' active='false' body1='a' body2='b' anchor='.5 .1 0'/></equality>"
    scene, _ = loaded(tmp_path, LOOP, tail=tail)
    assert [j.enabled for j in scene.joints] == [True, True, False]


def test_several_joints_of_a_body(tmp_path):
    """Slides and a hinge are one joint, as are two hinges at right angles; three hinges have light bodies between."""
    inner = (
        f"<body name='p'><joint name='x' type='slide' axis='1 0 0'/><joint name='z' type='slide' axis='0 0 1'/>"
        f"<joint name='t' axis='0 1 0' range='-10 80'/>{BALL}"
        f"<body name='q' pos='0 0 1'><joint name='u' axis='0 0 1'/><joint name='v' axis='1 0 0' range='-10 80'/>{BALL}"
        f"<body name='r' pos='0 0 1'><joint name='a' axis='1 0 0' range='-5 5'/><joint name='b' axis='0 1 0' range='-10 80'/>"
        f"<joint name='c' axis='0 0 1'/>{BALL}</body></body></body>"
    )
    scene, report = loaded(tmp_path, inner)
    assert [(j.id, j.kind) for j in scene.joints] == [
        ("x+z+t", JointKind.PLANAR),
        ("u+v", JointKind.UNIVERSAL),
        ("a+b", JointKind.UNIVERSAL),
        ("c", JointKind.REVOLUTE),
    ]
    assert "MJCF_MIDDLE_BODY" in codes(report)
    assert scene.joints[0].freedoms[3].upper == pytest.approx(math.radians(80.0))


def test_a_ball_with_spring_and_limit(tmp_path):
    scene, report = loaded(
        tmp_path, f"<body><joint type='ball' name='j' range='0 40' stiffness='2' damping='.3'/>{BALL}</body>"
    )
    (joint,) = scene.joints
    assert joint.kind is JointKind.SPHERICAL and (joint.slerp.stiffness, joint.slerp.damping) == (2.0, 0.3)
    assert "MJCF_BALL_LIMIT" in codes(report)


def test_shapes_say_what_is_drawn_and_what_is_touched(tmp_path):
    head = (
        "<asset><mesh name='t' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/><hfield name='h' nrow='2' ncol='3' size='1 2 .5 .1' "
        "elevation='0 1 2 3 4 5'/></asset>"
    )
    inner = (
        "<geom type='plane' size='3 4 1' name='floor'/><geom type='hfield' hfield='h' name='hill'/>"
        "<body name='b'><freejoint/><geom name='box' type='box' size='.1 .2 .3' friction='.7' contype='2' conaffinity='5'/>"
        "<geom name='skin' type='mesh' mesh='t' contype='0' conaffinity='0'/>"
        "<geom name='hull' type='mesh' mesh='t' group='3'/><geom name='pill' type='capsule' size='.1 .2'/>"
        "<geom name='egg' type='ellipsoid' size='.1 .2 .3'/><geom name='rod' type='cylinder' fromto='0 0 0 1 0 0' size='.1'/>"
        "<geom name='ghost' size='.1' group='4' contype='0' conaffinity='0'/></body>"
    )
    scene, report = loaded(tmp_path, inner, head)
    world, body = (next(n for n in scene.nodes if n.name == name) for name in ("world", "b"))
    assert [c.kind for c in world.colliders] == [ColliderKind.BOX, ColliderKind.MESH]
    assert scene.meshes[world.colliders[1].mesh].vertices[:, 2].max() == pytest.approx(0.5)
    assert {b.name for b in body.bodies} == {"box", "skin", "pill", "egg", "rod"}
    touched = {c.name: c for c in body.colliders}
    assert set(touched) == {"box", "hull", "pill", "egg", "rod"}
    assert touched["box"].size == (0.2, 0.4, 0.6) and touched["box"].group == "contype 2 conaffinity 5"
    material = touched["box"].material
    assert (material.dynamic_friction, material.friction_combine) == (0.7, Combine.MAXIMUM)
    assert touched["hull"].kind is ColliderKind.HULL and touched["pill"].length == pytest.approx(0.4)
    assert "MJCF_GEOM_UNSEEN" in codes(report)
    assert scene.extras["collisionMasks"] == {"contype 2 conaffinity 5": [2, 5]}


TOUCHING = """<geom name="floor" type="plane" size="1 1 1"/>
<body name="a"><joint name="ja" axis="0 1 0"/><geom name="ga" size=".1"/>
<body name="b" pos="0 0 1"><joint name="jb" axis="0 1 0"/><geom name="gb" size=".1" contype="0" conaffinity="0"/></body></body>"""


def collide(scene) -> dict[str, bool]:
    return {joint.id: joint.collide for joint in scene.joints}


def test_what_is_joined_to_the_world_collides_with_it(tmp_path):
    """MuJoCo's filter of parents leaves out the world and what is welded to it."""
    assert collide(loaded(tmp_path, TOUCHING)[0]) == {"ja": True, "jb": False}
    excluded = loaded(tmp_path, TOUCHING, tail="<contact><exclude body1='world' body2='a'/></contact>")[0]
    assert collide(excluded) == {"ja": False, "jb": False}
    switched = loaded(tmp_path, TOUCHING, head="<option><flag filterparent='disable'/></option>")[0]
    assert collide(switched) == {"ja": True, "jb": True}


def test_a_stated_pair_collides_across_a_joint_and_in_spite_of_masks(tmp_path):
    tail = "<contact><pair name='p' geom1='ga' geom2='gb'/><exclude body1='a' body2='b'/></contact>"
    scene, report = loaded(tmp_path, TOUCHING, tail=tail)
    (pair,) = scene.colliding
    assert {scene.nodes[pair.a].name, scene.nodes[pair.b].name} == {"a", "b"}
    assert (pair.reason, scene.apart, collide(scene)["jb"]) == ("contact pair p", [], True)
    assert "contact pair p" in {o.feature for o in report.outcomes if not o.code}


def test_contact_excludes_are_pairs_of_nodes(tmp_path):
    scene, report = loaded(tmp_path, LOOP, tail="<contact><exclude body1='a' body2='b'/></contact>")
    (pair,) = scene.apart
    assert {scene.nodes[pair.a].name, scene.nodes[pair.b].name} == {"a", "b"}
    assert "ignoreCollision" not in scene.extras and "MJCF_COLLISION_FILTER" not in codes(report)


KEYED = "<keyframe><key name='home' qpos='.5' ctrl='.3'/><key qpos='-.2'/></keyframe>"


def test_a_keyframe_is_the_pose(tmp_path):
    tail = KEYED + "<actuator><position joint='j' kp='10'/></actuator>"
    plain, _ = loaded(tmp_path, ONE, tail=tail)
    home, _ = loaded(tmp_path, ONE, tail=tail, keyframe="home")
    second, _ = loaded(tmp_path, ONE, tail=tail, keyframe="1")
    assert plain.offers == {"keyframe": ("home", "1")}
    assert [s.joints[0].freedoms[3].at for s in (plain, home, second)] == pytest.approx([0.0, 0.5, -0.2])
    assert home.joints[0].freedoms[3].drive.target == pytest.approx(0.3)


def test_mocap_bodies_are_moved_by_scripts(tmp_path):
    scene, _ = loaded(tmp_path, f"<body name='guide' mocap='true'>{BALL}</body>")
    node = next(n for n in scene.nodes if n.name == "guide")
    assert node.dynamics.kinematic and not node.grounded


def test_what_a_mocap_body_leads_is_no_freedom(tmp_path):
    """MuJoCo has no degrees of freedom for it, and for what is welded to it none that are left."""
    inner = (
        f"<body name='guide' mocap='true' pos='0 0 1'>{BALL}</body>"
        f"<body name='arm' pos='.3 0 1'><joint name='h' axis='0 1 0' range='-10 80'/>{BALL}</body>"
        f"<body name='led' pos='.3 1 1'><freejoint/>{BALL}</body>"
    )
    scene, _ = loaded(tmp_path, inner, tail="<equality><weld body1='guide' body2='led'/></equality>")
    found = analyse(scene)
    assert (found.mobility, found.first_order) == (1, 1)
    left = {scene.nodes[f.node].name: f.dof for f in found.freedoms}
    assert (left["guide"], left["led"], left["arm"]) == (0, 0, 1)
    assert not {d.code for d in found.report.diagnostics}


@pytest.mark.parametrize("other", ["", "body2='other'"])
@pytest.mark.parametrize("kind", ["connect anchor='.1 -.2 .03'", "weld"])
def test_what_holds_a_mocap_body_where_it_is_led_is_left_out_and_told(tmp_path, kind, other):
    """Held to the world or to another one it has no freedom in MuJoCo that the equality could take."""
    inner = (
        f"<body name='guide' mocap='true' pos='0 0 1'>{BALL}</body>"
        f"<body name='other' mocap='true' pos='.3 -.1 1'>{BALL}</body>"
        f"<body name='arm' pos='.3 1 1'><joint name='h' axis='0 1 0' range='-10 80'/>{BALL}</body>"
    )
    path = model(tmp_path, inner, tail=f"<equality><{kind} body1='guide' {other}/></equality>")
    result = kinefab.export(path, tmp_path / "scene.kinefab")
    told = [(o.feature, o.where) for o in result.report.outcomes if o.code == "JOINT_BETWEEN_LED"]
    assert told == [(f"joint {kind.split()[0]} guide {'other' if other else 'world'}", "m.xml:5")]
    bodies = json.loads(result.path.read_text("utf-8"))["gameObjects"]
    led = {o["name"] for o in bodies for c in o.get("components", ()) if c.get("isKinematic")}
    assert {"guide", "other"} <= led  # each for itself
    if TOOL is not None:
        done = subprocess.run([TOOL, "validate", str(result.path), "--strict", "--json"], capture_output=True)
        assert json.loads(done.stdout)["diagnostics"] == []


def test_gravity_and_bodies_that_carry_themselves(tmp_path):
    inner = f"<body name='a' gravcomp='1'><freejoint/>{BALL}</body><body name='b' pos='1 0 0' gravcomp='.3'><freejoint/>{BALL}</body>"
    scene, report = loaded(tmp_path, inner, "<option gravity='1 2 -3' timestep='.005'/>")
    assert scene.physics.gravity == pytest.approx((2.0, -3.0, 1.0)) and scene.physics.fixed_timestep == 0.005
    assert [n.dynamics.gravity for n in scene.nodes if n.name in "ab"] == [False, True]
    assert [d.code for d in report.diagnostics if d.code == "MJCF_GRAVITY"] == ["MJCF_GRAVITY"]


def test_textures_are_files_or_bytes(tmp_path):
    head = (
        "<asset><texture name='made' type='2d' builtin='checker' rgb1='1 0 0' rgb2='0 0 1' width='4' height='4'/>"
        "<material name='m' texture='made' texrepeat='2 3' rgba='1 1 1 1' metallic='.4' roughness='.2'/>"
        "<mesh name='t' vertex='0 0 0 1 0 0 0 1 0 0 0 1'/></asset>"
    )
    inner = "<geom type='plane' size='1 1 1' material='m'/><body><freejoint/><geom type='mesh' mesh='t' material='m'/></body>"
    scene, report = loaded(tmp_path, inner, head)
    textured = next(s for s in scene.surfaces if s.color_texture is not None)
    assert textured.color_texture.data.startswith(b"\x89PNG") and textured.color_texture.scale == (2.0, 3.0)
    assert (textured.metallic, textured.smoothness) == pytest.approx((0.4, 0.8))
    assert "MJCF_TEXTURE" in codes(report)


def test_a_colour_of_bytes_is_cut_and_told(tmp_path):
    head = "<asset><material name='m' rgba='255 128 0 255'/></asset>"
    inner = "<geom size='1' material='m'/><body><geom name='g' size='1' rgba='0 .5 2 1'/><geom size='2' material='m'/></body>"
    scene, report = loaded(tmp_path, inner, head)
    assert sorted(s.color for s in scene.surfaces) == [pytest.approx((0, linear(0.5), 1, 1)), (1, 1, 0, 1)]
    lost = [o.feature for o in report.outcomes if o.code == "COLOR_CLAMPED"]
    assert sorted(lost) == ["colour of geom g", "colour of material m"]


@pytest.mark.parametrize(
    ("flip", "scale", "offset"),
    [
        ("", (2.0, 3.0), (0.0, 0.0)),
        ("hflip='true'", (-2.0, 3.0), (1.0, 0.0)),
        ("vflip='true'", (2.0, -3.0), (0.0, 1.0)),
    ],
)
def test_a_texture_is_flipped_as_mujoco_flips_it(tmp_path, flip, scale, offset):
    """The file stays as it is: what it is laid on by turns round, u' = 1 - repeat u.  Layers that do not colour are told."""
    (tmp_path / "t.png").write_bytes(b"")
    mesh = "<mesh name='q' vertex='0 0 0 1 0 0 0 1 0 0 0 1' face='0 2 1 0 1 3 0 3 2 1 2 3' texcoord='0 0 1 0 0 1 1 1'/>"
    head = (
        f"<asset><texture name='t' type='2d' file='t.png' {flip}/><texture name='bumps' type='2d' file='t.png'/>{mesh}"
        "<material name='m' texrepeat='2 3'><layer texture='t' role='rgba'/><layer texture='bumps' role='normal'/></material></asset>"
    )
    geom = "<geom type='mesh' mesh='q' material='m'/>"
    scene, report = loaded(tmp_path, f"<body>{geom}</body><body pos='2 0 0'>{geom}</body>", head)
    (surface,) = scene.surfaces
    assert surface.color_texture is not None
    assert (surface.color_texture.scale, surface.color_texture.offset) == (scale, offset)
    lost = [o.feature for o in report.outcomes if o.code == "MJCF_LEFT_OUT"]
    assert lost == ["normal texture bumps of material m"]


def test_what_has_no_place_is_left_out_by_name(tmp_path):
    _, report = loaded(tmp_path, ONE, tail="<sensor><jointpos name='s' joint='j'/></sensor>")
    assert [d.message for d in report.diagnostics if d.code == "MJCF_LEFT_OUT"] == [
        "The sensor s was left out: Unity's scenes have no place for it."
    ]


def test_what_has_no_name_is_told_at_its_line(tmp_path):
    """A sensor with a name and one without, an equality, an actuator and a tendon without; the head takes a line."""
    tail = (
        "<sensor>\n<jointpos name='s' joint='j'/>\n<jointvel joint='j'/></sensor>\n"
        "<equality><joint joint1='j' joint2='k' polycoef='0 .5 .3 0 0'/></equality>\n"
        "<actuator><intvelocity joint='j' kp='3' actrange='-1 1'/></actuator>\n"
        "<tendon><fixed armature='.3' stiffness='7' springlength='.1 .4'><joint joint='k' coef='2'/></fixed></tendon>\n"
    )
    inner = f"<body name='a'><joint name='j'/>{BALL}<body name='b'><joint name='k'/>{BALL}</body></body>"
    _, report = loaded(tmp_path, inner, tail=tail)
    places = {d.code: d.where for d in report.diagnostics}
    sensors = [d.where for d in report.diagnostics if d.code == "MJCF_LEFT_OUT"]
    assert sensors == ["m.xml:6", "m.xml:7"]
    assert (places["MJCF_POLYNOMIAL"], places["MJCF_ACTUATOR"]) == ("m.xml:8", "m.xml:9")
    (tendon,) = (d for d in report.diagnostics if d.code == "MJCF_TENDON")
    assert tendon.where == "m.xml:10"
    assert all(word in tendon.message for word in ("armature 0.3", "stiffness 7", "springlength 0.1 0.4"))


def test_what_mujoco_is_asked_to_leave_away_is_told(tmp_path):
    head = "<option wind='1 -2 3' viscosity='.01'><flag limit='disable' contact='disable'/></option>"
    tail = "<custom><numeric name='gains' data='1 2'/></custom>"
    _, report = loaded(tmp_path, ONE, head=head, tail=tail)
    told = {(o.feature, o.where) for o in report.outcomes if o.code == "MJCF_LEFT_OUT"}
    assert told == {
        ("wind 1 -2 3", "m.xml:2"),
        ("viscosity 0.01", "m.xml:2"),
        ("flag limit='disable'", "m.xml:2"),
        ("flag contact='disable'", "m.xml:2"),
        ("numeric gains", "m.xml:5"),
    }


def test_plug_ins_are_left_out_by_number(tmp_path):
    """The model has no names of them."""
    grid = "".join(
        f"<config key='{k}' value='{v}'/>"
        for k, v in (("size", "2 2"), ("fov", "10 10"), ("gamma", "0"), ("nchannel", "1"))
    )
    text = (
        "<mujoco><extension><plugin plugin='mujoco.sensor.touch_grid'/></extension><worldbody><body name='a'><joint/>"
        "<geom size='.1'/><site name='s'/></body></worldbody><sensor><plugin name='p' plugin='mujoco.sensor.touch_grid' "
        f"objtype='site' objname='s'>{grid}</plugin></sensor></mujoco>"
    )
    path = tmp_path / "m.xml"
    path.write_text(text, encoding="utf-8")
    read(path, report := Report())
    assert "plugin 0" in {o.feature for o in report.outcomes if o.code == "MJCF_LEFT_OUT"}


@pytest.mark.parametrize("ending", [".mjcf", ".XML"])
def test_a_model_by_another_ending_is_read_with_what_it_includes(tmp_path, ending):
    """MuJoCo 4 opens what ends in ``.xml`` alone; what stands beside under that name is not taken for it."""
    (tmp_path / "part.xml").write_text(
        f"<mujoco><worldbody><body name='p'><joint name='j'/>{BALL}</body></worldbody></mujoco>",
        encoding="utf-8",
    )
    (tmp_path / "m.xml").write_text("<mujoco/>", encoding="utf-8")
    path = tmp_path / f"m{ending}"
    path.write_text("<mujoco><include file='part.xml'/></mujoco>", encoding="utf-8")
    assert [j.id for j in read(path, Report()).joints] == ["j"]


def test_nothing_of_the_model_is_random(tmp_path):
    path = FIXTURES / "mjcf" / "zoo.xml"
    for name in "ab":
        (tmp_path / name).mkdir()
        kinefab.export(path, tmp_path / name / "s.kinefab")
    first, second = ({p.name: p.read_bytes() for p in (tmp_path / name).iterdir()} for name in "ab")
    assert first == second and len(first) == 2


def test_a_bent_damper_is_told(tmp_path):
    """MuJoCo 4 takes polynomials; older ones refuse the second number."""
    if not hasattr(mujoco.MjModel, "dof_dampingpoly"):
        pytest.skip("this mujoco has straight dampers only")
    _, report = loaded(tmp_path, f"<body><joint name='j' damping='1 .5'/>{BALL}</body>")
    assert "MJCF_NONLINEAR" in codes(report)


def test_a_weld_that_is_not_kept_holds_the_bodies_as_they_stand(tmp_path):
    tail = "<equality><weld name='e' body1='a' body2='b' relpose='2 0 0 1 0 0 0'/></equality>"
    scene, report = loaded(tmp_path, LOOP, tail=tail)
    (joint,) = (j for j in scene.joints if j.id == "e")
    ends = [scene.pose(n) @ f for n, f in ((joint.a, joint.frame_a), (joint.b, joint.frame_b))]
    assert ends[0].translation == pytest.approx(ends[1].translation)
    (found,) = (d for d in report.diagnostics if d.code == "MJCF_WELD_APART")
    assert "1 m" in found.message


@pytest.mark.parametrize(("scale", "kind"), [("0", JointKind.SPHERICAL), (".5", JointKind.FIXED)])
def test_a_weld_without_torques_holds_a_point(tmp_path, scale, kind):
    scene, _ = loaded(
        tmp_path,
        LOOP,
        tail=f"<equality><weld name='e' body1='a' body2='b' torquescale='{scale}'/></equality>",
    )
    assert next(j for j in scene.joints if j.id == "e").kind is kind


def test_what_mujocos_parser_does_not_mind_is_read(tmp_path):
    """No blank between attributes, two dashes in a comment."""
    scene, _ = loaded(
        tmp_path, "<!-- a -- b -->" + ONE.replace("<joint name='j'/>", "<joint name='j'axis='0 1 0'/>")
    )
    assert [j.id for j in scene.joints] == ["j"]


@pytest.mark.parametrize("discarded", [False, True])
def test_the_model_is_what_mujoco_compiles(tmp_path, discarded):
    """But for its meshes' hulls, which are not asked for: numbers of every geom, also of what is attached and repeated."""
    part = (
        '<mujoco><default><geom contype="2" conaffinity="5"/></default><worldbody><body name="hand"><joint/>'
        '<geom size="0.1"/><geom name="seen" size="0.2" contype="0" conaffinity="0"/></body></worldbody></mujoco>'
    )
    (tmp_path / "part.xml").write_text(part)
    text = (
        f'<mujoco><compiler discardvisual="{str(discarded).lower()}"/><asset><model name="part" file="part.xml"/>'
        '<mesh name="wedge" vertex="0 0 0  1 0 0  0 2 0  0 0 3" face="0 2 1  0 1 3  0 3 2  1 2 3"/></asset><worldbody>'
        '<geom name="floor" type="plane" size="1 1 1" conaffinity="0"/>'
        '<body name="arm"><joint/><geom type="mesh" mesh="wedge" contype="4"/>'
        '<frame pos="1 2 3"><attach model="part" body="hand" prefix="L_"/></frame></body>'
        '<replicate count="3" offset="1 0 0"><body><joint/><geom type="mesh" mesh="wedge" conaffinity="6"/></body></replicate>'
        "</worldbody></mujoco>"
    )
    path = tmp_path / "whole.xml"
    path.write_text(text)
    report, packages = Report(), Packages(tmp_path, ())
    ours = compile_model(scan(path, packages, report), packages, "", report).model
    theirs = mujoco.MjModel.from_xml_path(str(path))
    assert ours.ngeom == theirs.ngeom == (6 if discarded else 7)
    for name in ("geom_contype", "geom_conaffinity", "geom_pos", "geom_size", "body_mass", "body_inertia"):
        assert np.array_equal(getattr(ours, name), getattr(theirs, name)), name
    assert (ours.mesh_graphadr[0] < 0) == (not discarded)


def test_a_ball_without_range_is_fixed(tmp_path):
    """As of a default class that limits hinges: the analysis and the joints agree that nothing turns there."""
    inner = '<body><joint type="ball" limited="true" range="0 0"/><geom size="0.1"/></body>'
    scene, _ = loaded(tmp_path, inner)
    (joint,) = scene.joints
    assert joint.kind is JointKind.FIXED and analyse(scene).mobility == 0


@pytest.mark.parametrize("turn", ["0 0 0", "0 0 180", "90 0 0", "0 90 90", "40 120 200"])
@pytest.mark.parametrize("points", [1, 2])
def test_an_equality_closes_its_loop_whatever_it_leaves_free(tmp_path, points, turn):
    """Two connects are a hinge like the joints of the tree, and these carry the bodies all the same."""
    rod = "<body name='rod' pos='-.1 .3 0'><joint name='b' axis='0 0 -1'/><geom size='.02'/></body>"
    bodies = (
        f"<body name='crank'><joint name='a' axis='0 0 1' range='-30 60'/><geom size='.02'/>{rod}</body>"
        "<body name='lever' pos='-.8 0 0'><joint name='c' axis='0 0 1'/><geom size='.02'/></body>"
    )
    ends = "".join(f"<connect body1='rod' body2='lever' anchor='-.6 .2 {z}'/>" for z in (0.0, 0.1)[:points])
    bodies = f"<body name='base' pos='.4 -.1 .2' euler='{turn}'><geom size='.02'/>{bodies}</body>"
    path = model(tmp_path, bodies, tail=f"<equality>{ends}</equality>")
    target = kinefab.export(path, tmp_path / "loop.kinefab").path
    motion = SceneKinematics.load(target)
    assert [tuple(j.fields["because"]) for j in motion.joints if j.closure] == [("connect rod lever",)]
    assert scored(target, MujocoModel(path), 20, set())["wrong"] == []


def test_what_has_no_name_keeps_its_identity_where_others_are_put_in_before_it(tmp_path):
    """It is known by its kind or its mesh, by the named body above it, by what it holds together."""
    mesh = "<asset><mesh name='horn' vertex='0 0 0 .3 0 0 0 .2 0 0 0 .1'/></asset>"

    def identities(folder, first="", more="", held=""):
        folder.mkdir()
        inner = (
            f"{first}<body name='arm' pos='0 0 1'>{more}<joint axis='0 1 0' range='-10 80'/><geom size='.1'/>"
            "<geom type='mesh' mesh='horn'/><geom type='capsule' size='.1 .3'/><geom name='box' type='box' size='.1 .2 .3'/>"
            f"<body pos='.3 0 0'><joint axis='0 1 0'/>{BALL}<body pos='.3 0 0'><joint axis='0 1 0'/>{BALL}</body></body></body>"
            f"<body name='b' pos='2 0 0'><freejoint/>{BALL}</body><body name='c' pos='2 1 0'><freejoint/>{BALL}</body>"
        )
        tail = f"<equality>{held}<weld body1='b' body2='c'/><joint joint1='x'/></equality>"
        inner += f"<body pos='3 0 0'><joint name='x' type='slide'/>{BALL}</body>"
        path = model(folder, inner, head=mesh, tail=tail)
        scene = json.loads(kinefab.export(path, folder / "m.kinefab").path.read_text("utf-8"))
        joints = {
            (o["name"], c["name"])
            for o in scene["gameObjects"]
            for c in o.get("components", ())
            if "Joint" in c["type"] and "name" in c.get("extras", {})
        }
        return {o["id"] for o in scene["gameObjects"]} | joints

    before = identities(tmp_path / "before")
    assert {"m/arm/body:horn", "m/arm/body:box", "m/arm body_2/body:sphere"} <= before
    other = "<body name='other' pos='5 0 0'><freejoint/><geom type='box' size='.1 .1 .1'/></body>"
    after = identities(
        tmp_path / "after",
        first=other,
        more="<geom type='ellipsoid' size='.1 .2 .3'/><geom type='box' size='.3 .2 .1'/>",
        held="<weld body1='other' body2='b'/>",
    )
    assert before <= after
