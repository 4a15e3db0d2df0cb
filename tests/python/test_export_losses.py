"""What Unity cannot express is reported, marked, and under strict refused."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import kinefab
import libraries
import numpy as np
import pytest
from command_line import runner
from kinefab.cli import app
from kinefab.diagnostics import KinefabError, Outcome, Report
from kinefab.model import RX, Drive, Freedom, JointKind, Motion, Passive
from kinefab.pipeline import prepared
from kinefab.spatial import Pose, rotation_about
from scenes import BOX, components, exported, lid_scene


def test_strict_refuses_what_would_be_approximated(tmp_path):
    """A one-sided limit is approximated with a warning, and with strict nothing is written."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX)
    one_sided = Freedom(Motion.LIMITED, lower=0.0)
    scene.add_joint(JointKind.PRISMATIC, None, part, point=(0, 0, 0), axis=(1, 0, 0), name="S", tx=one_sided)
    content, result = exported(scene, tmp_path)
    assert components(content, "P", "ConfigurableJoint")[0]["exact"] is False
    assert "JOINT_LIMIT_ONE_SIDED" in [entry.get("code") for entry in content["report"]]
    with pytest.raises(KinefabError):
        kinefab.export(scene, tmp_path / "strict.kinefab", kinefab.ExportOptions(strict=True))
    assert not (tmp_path / "strict.kinefab").exists()


@pytest.mark.parametrize(
    "kind, freedoms, code",
    [
        (JointKind.CYLINDRICAL, {"rx": Freedom(Motion.LIMITED, -4.0, 4.0)}, "JOINT_LIMIT_BEYOND_TURN"),
        (JointKind.UNIVERSAL, {"rz": Freedom(Motion.LIMITED, -0.2, 1.4)}, "JOINT_LIMIT_ASYMMETRIC"),
        (
            JointKind.SPHERICAL,
            {
                "ry": Freedom(Motion.LIMITED, -0.2, 0.2, stiffness=5.0),
                "rz": Freedom(Motion.LIMITED, -0.2, 0.2),
            },
            "JOINT_LIMIT_SPRING_SHARED",
        ),
        (JointKind.SPHERICAL, {"ry": Freedom(Motion.LIMITED, -0.2, 0.2)}, "JOINT_LIMIT_ELEVATION"),
        (JointKind.SPHERICAL, {"ry": Freedom(Motion.LIMITED, upper=0.2)}, "JOINT_LIMIT_BEYOND_TURN"),  # and is free
        (JointKind.PLANAR, {n: Freedom(Motion.LIMITED, -0.2, 0.2) for n in ("ty", "tz")}, "JOINT_LIMITS_SHARED"),
        (JointKind.SPHERICAL, {"ry": Freedom(Motion.FREE, drive=Drive(stiffness=2.0))}, "JOINT_DRIVE_SHARED"),
        (JointKind.PRISMATIC, {"tx": Freedom(Motion.FREE, drive=Drive(target_velocity=1.0, motor=True))}, "JOINT_MOTOR_AS_DRIVE"),
        (JointKind.PRISMATIC, {"tx": Freedom(Motion.LIMITED, 0.3, 0.5)}, None),
    ],
)  # fmt: skip
def test_what_one_component_cannot_express_is_reported(kind, freedoms, code, tmp_path):
    """Each loss has its code and marks the component as not exact."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX, density=1000.0)
    scene.add_joint(kind, None, part, point=(0, 0, 0), axis=(1, 0, 0), name="J", **freedoms)
    content, result = exported(scene, tmp_path)
    (joint,) = components(content, "P", "ConfigurableJoint")
    if code is None:
        assert [d.code for d in result.report.diagnostics] == ["JOINT_OUTSIDE_LIMITS"]
        return
    assert [o.code for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == [code]
    assert joint["exact"] is False


def test_what_the_coordinates_of_a_joint_differ_in_comes_back_of_the_scene(tmp_path):
    """By coordinate: two turns of different efforts, and a slide that turns as well."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    cross, drill = (scene.add_part(name, BOX, translation=(0, i, 0)) for i, name in enumerate(("Cross", "Drill")))
    first, second = Passive(friction=0.2, effort=20.0, speed=0.5), Passive(effort=0.0, armature=1.5e-7)
    turns = {"rx": Freedom(Motion.FREE, passive=first), "rz": Freedom(Motion.FREE, passive=second)}
    scene.add_joint("universal", base, cross, point=(0, 0, 0), axis=(1, 0, 0), secondary=(0, 0, 1), name="Cardan", **turns)
    feed, spin = Passive(friction=3.0, speed=0.25), Passive(effort=8.0, speed=0.25)
    moves = {"tx": Freedom(Motion.FREE, passive=feed), "rx": Freedom(Motion.FREE, passive=spin)}
    scene.add_joint("cylindrical", base, drill, point=(0, 1, 0), axis=(1, 0, 0), name="Quill", **moves)
    content, result = exported(scene, tmp_path)
    assert {o.outcome for o in result.report.outcomes} == {Outcome.KEPT} and content["version"] == "1.1"
    joints = {c["name"]: c for o in content["gameObjects"] for c in o["components"] if c["type"].endswith("Joint")}
    quarter = pytest.approx(math.degrees(0.25))
    assert joints["Quill"]["stated"] == {"x": {"speed": 0.25, "friction": 3}, "angularX": {"effort": 8, "speed": quarter}}
    assert len(joints["Cardan"]["stated"]) == 2 and not joints["Cardan"].keys() & {"effort", "speed", "friction", "armature"}
    by_file = {joint.name: joint for joint in kinefab.sources.read(result.path, kinefab.Report()).joints}
    for name, stated in (("Cardan", (first, second)), ("Quill", (feed, spin))):
        back = [by_file[name].freedoms[i].passive for i in by_file[name].unlocked]
        assert [(p.friction, p.armature, p.effort) for p in back] == [(p.friction, p.armature, p.effort) for p in stated]
        assert [p.speed for p in back] == pytest.approx([p.speed for p in stated])


def test_a_joint_in_full_is_kept_and_its_effort_is_a_feature_of_its_own(tmp_path):
    """In the file's own report as well."""
    scene = kinefab.Scene()
    weak = Freedom(Motion.FREE, passive=Passive(effort=5.0))
    scene.add_joint(
        "revolute", None, scene.add_part("P", BOX), point=(0, 0, 0), axis=(1, 0, 0), name="J", rx=weak
    )
    content, kept = exported(scene, tmp_path)
    shape = ("collider P/P", "kept")
    assert [(o.feature, o.outcome.value) for o in kept.report.outcomes] == [shape, ("joint J", "kept")]
    assert [(e["feature"], e["outcome"]) for e in content["report"]] == [shape, ("joint J", "kept")]
    (hinge,) = [c for o in content["gameObjects"] for c in o.get("components", ()) if c["type"] == "HingeJoint"]
    assert hinge["effort"] == 5 and content["version"] == "1.1"
    lost = ("largest effort of joint J", "dropped")
    result = kinefab.export(scene, tmp_path / "a.prefab")
    assert [(o.feature, o.outcome.value) for o in result.report.outcomes] == [shape, lost, ("joint J", "kept")]
    assert result.report.outcomes[1].message.startswith("Joint J states a largest effort (5) of rx")
    by_scene = kinefab.export(kept.path, tmp_path / "b.prefab").report.outcomes
    assert sorted((o.feature, o.outcome.value) for o in by_scene) == sorted([shape, lost, ("joint J", "kept")])


def test_what_a_source_states_of_a_joint_comes_back_of_the_scene(tmp_path):
    """Degrees a second in the file, radians in the model; a slide in metres; links are bounded as of the source."""
    scene = kinefab.Scene()
    turning = Passive(friction=0.2, armature=1.5e-7, effort=20.0, speed=0.5)
    sliding = Passive(friction=3.0, speed=0.25)
    base = scene.add_part("Base", BOX, grounded=True)
    arm, carriage = (scene.add_part(name, BOX, translation=(0, i, 0)) for i, name in enumerate(("Arm", "Carriage")))
    turn, slide = (Freedom(Motion.FREE, passive=passive) for passive in (turning, sliding))
    scene.add_joint("revolute", base, arm, point=(0, 0, 0), axis=(1, 0, 0), name="Turn", rx=turn)
    scene.add_joint("prismatic", base, carriage, point=(0, 1, 0), axis=(1, 0, 0), name="Slide", tx=slide)
    content, result = exported(scene, tmp_path)
    joints = {c["name"]: c for o in content["gameObjects"] for c in o["components"] if c["type"].endswith("Joint")}
    stated = ("effort", "speed", "friction", "armature")
    assert [joints["Turn"].get(f) for f in stated] == [20, pytest.approx(math.degrees(0.5)), 0.2, 1.5e-7]
    assert [joints["Slide"].get(f) for f in stated] == [None, 0.25, 3, None]
    found = {joint.name: joint for joint in kinefab.sources.read(result.path, kinefab.Report()).joints}
    back = found["Turn"].freedoms[3].passive
    assert (back.friction, back.armature, back.effort) == (0.2, 1.5e-7, 20.0)
    assert back.speed == pytest.approx(0.5) and found["Turn"].id == "Turn"
    assert found["Slide"].freedoms[0].passive == sliding


def test_what_differs_among_a_joints_freedoms_stands_in_the_scene_and_in_no_prefab(tmp_path):
    scene = kinefab.Scene()
    stiff, loose = (Freedom(Motion.FREE, passive=Passive(friction=value)) for value in (2.0, 1.0))
    part = scene.add_part("P", BOX)
    scene.add_joint("spherical", None, part, point=(0, 0, 0), name="J", rx=stiff, ry=loose, rz=loose)
    content, result = exported(scene, tmp_path)
    (joint,) = components(content, "P", "ConfigurableJoint")
    assert joint["stated"] == {"angularX": {"friction": 2}, "angularY": {"friction": 1}, "angularZ": {"friction": 1}}
    for source, lost in ((result, 0), (kinefab.export(scene, tmp_path / "a.prefab"), 3), (kinefab.export(result.path, tmp_path / "b.prefab"), 3)):
        assert sum(o.code == "JOINT_FRICTION_DROPPED" for o in source.report.outcomes) == lost


def test_what_several_freedoms_lose_are_several_features(tmp_path):
    """A counted loss is one thing that a person can find, by the freedom's own name where it has one."""
    scene = kinefab.Scene()
    rough = Freedom(Motion.FREE, passive=Passive(friction=0.1))
    named = replace(rough, name="travel")
    part = scene.add_part("P", BOX, density=700.0)
    scene.add_joint("cylindrical", None, part, point=(0, 0, 0), axis=(1, 0, 0), name="J", tx=named, rx=rough)
    result = kinefab.export(scene, tmp_path / "a.prefab")
    became = {o.feature: o.outcome.value for o in result.report.outcomes}
    assert became == {
        "friction of joint J, travel": "dropped",
        "friction of joint J, rx": "dropped",
        "joint J": "kept",
        "collider P/P": "kept",
    }


EFFORT = """<robot name="r"><link name="base"/>
<link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><cylinder radius="0.1" length="1"/></geometry></collision></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="10" velocity="2"/><dynamics friction="0.5"/></joint></robot>"""


def test_the_summary_the_report_and_the_page_agree(tmp_path):
    """A URDF's joint that is carried over in full, its effort and friction too."""
    (tmp_path / "r.urdf").write_text(EFFORT, "utf-8")
    scene, listed = tmp_path / "r.kinefab", tmp_path / "r.json"
    source = tmp_path / "r.urdf"
    said = runner().invoke(app, ["export", str(source), "-o", str(scene), "--report", str(listed)])
    outcomes = json.loads(listed.read_text("utf-8"))["outcomes"]
    became = {o["feature"]: o["outcome"] for o in outcomes}
    assert became["joint shoulder"] == "kept" and len(became) == len(outcomes)
    lost: set[str] = set()
    assert {feature for feature, outcome in became.items() if outcome == "dropped"} == lost
    words = ("kept", "approximated", "dropped")
    counts = ", ".join(f"{list(became.values()).count(word)} {word}" for word in words)
    assert f"features: {counts}." in said.stderr
    assert counts in runner().invoke(app, ["inspect", str(scene)]).stdout
    page = kinefab.view(scene, tmp_path / "r.html").read_text("utf-8")
    data = re.search(r'<script id="data" type="application/json">(.*?)</script>', page, re.DOTALL)
    shown = json.loads(data[1])["report"]
    assert {e["feature"]: e["outcome"] for e in shown} == became
    assert {e["feature"] for e in shown if e["joints"] == [0]} == lost | {"joint shoulder"}
    words = runner().invoke(app, ["report", str(scene), "-o", str(tmp_path / "p.html")])
    assert words.exit_code == 0 and f"{counts}." in (tmp_path / "p.html").read_text("utf-8")


@pytest.mark.parametrize("ending", ["kinefab", "glb", "prefab"])
def test_a_joint_that_reader_and_target_keep_is_counted_once(ending, tmp_path):
    """The reader of FreeCAD's documents says what became of each of its joints, and so does what writes them."""
    source = Path(__file__).parents[2] / "fixtures" / "freecad" / "four_bar.FCStd"
    result = kinefab.export(source, tmp_path / f"a.{ending}")
    joints = [o.feature for o in result.report.outcomes if o.feature.startswith("joint ")]
    assert len(joints) >= 4 and sorted(set(joints)) == sorted(joints)


def test_reversed_limits_are_an_error(tmp_path):
    """A lower limit above the upper one stops the export."""
    scene = lid_scene()
    scene.joints[0] = replace(
        scene.joints[0],
        freedoms=(
            *scene.joints[0].freedoms[:3],
            Freedom(Motion.LIMITED, 1.0, 0.5),
            *scene.joints[0].freedoms[4:],
        ),
    )
    with pytest.raises(KinefabError) as caught:
        kinefab.export(scene, tmp_path / "x.kinefab")
    assert [d.code for d in caught.value.diagnostics] == ["JOINT_LIMITS_REVERSED"]


@pytest.mark.parametrize("end", [math.inf, -math.inf, math.nan])
def test_limits_without_a_number_between_them_are_an_error_on_every_road(tmp_path, end):
    """Before anything is worked out with them; of a URDF they are left out and told, as reversed ones."""
    scene = lid_scene()
    freedoms = list(scene.joints[0].freedoms)
    freedoms[RX] = Freedom(Motion.LIMITED, end, end)
    scene.joints[0] = replace(scene.joints[0], freedoms=tuple(freedoms))
    roads = (
        lambda: kinefab.export(scene, tmp_path / "r.kinefab"),
        lambda: kinefab.export(scene, tmp_path / "r.glb"),
        lambda: kinefab.motion(scene),
        lambda: prepared(scene, kinefab.ExportOptions(), Report()),
    )
    for road in roads:
        with pytest.raises(KinefabError) as caught:
            road()
        assert [d.code for d in caught.value.diagnostics] == ["JOINT_LIMITS_REVERSED"]
    path = tmp_path / "r.urdf"
    path.write_text(
        '<robot name="r"><link name="a"/><link name="b"/><joint name="J" type="revolute"><parent link="a"/>'
        f'<child link="b"/><axis xyz="0 0 1"/><limit lower="{end}" upper="{end}" effort="1" velocity="1"/></joint></robot>'
    )
    if math.isinf(end):
        codes = {o.code for o in kinefab.export(path, tmp_path / "r.kinefab").report.outcomes}
        assert "LIMITS_REVERSED_DROPPED" in codes


@pytest.mark.parametrize(
    "change, what",
    [
        ({"stiffness": -1.5}, "stiffness of -1.5"),
        ({"damping": -0.25}, "damping of -0.25"),
        ({"stiffness": 1e300}, "stiffness of 1e+300"),
        ({"target": -1e300}, "target of -1e+300"),
        ({"target_velocity": math.nan}, "target velocity of nan"),
        ({"max_force": -3.0}, "largest force of -3"),
    ],
)
def test_a_drive_that_unity_cannot_hold_is_left_out_and_told(tmp_path, change, what):
    """A pose as it stands and limits of -10 to 80 stay; beside it a spring below zero that the drive's own outweighs."""
    scene = lid_scene()
    hinge = Freedom(Motion.LIMITED, math.radians(-10), math.radians(80), at=0.0)
    good = Drive(0.3, 0.0, 5.0, 2.0)
    springs = []
    for more in ({"drive": replace(good, **change)}, {"passive": Passive(-1.5)}, {}):
        freedoms = list(scene.joints[0].freedoms)
        freedoms[RX] = replace(hinge, **{"drive": good, **more})
        scene.joints[0] = replace(scene.joints[0], freedoms=tuple(freedoms))
        content, result = exported(scene, tmp_path)
        (joint,) = components(content, "Lid", "HingeJoint")
        assert (joint["limits"]["min"], joint["limits"]["max"]) in ((-10, 80), (-80, 10))
        told = [o.message for o in result.report.outcomes if o.code == "JOINT_DRIVE_IMPOSSIBLE"]
        assert (len(told) == 1 and what in told[0] and "motor" not in joint) if "drive" in more else not told
        springs.append(joint.get("spring", {}).get("spring", 0.0))
    assert springs[0] == 0.0 and springs[1] == pytest.approx(springs[2] * 3.5 / 5.0) != 0.0


@pytest.mark.parametrize("what", ["force", "torque"])
@pytest.mark.parametrize(
    ("value", "kept"),
    [(0.0, False), (-1.0, False), (1e-46, False), (math.nan, False), (3.5, True), (1e39, False)],
)
def test_a_joint_does_not_break_at_nothing(tmp_path, what, value, kept):
    """Zero and less would break it at once, and C# refuses a scene that says so."""
    scene = lid_scene()
    scene.joints[0] = replace(scene.joints[0], **{f"break_{what}": value})
    content, result = exported(scene, tmp_path)
    (joint,) = components(content, "Lid", "HingeJoint")
    assert joint.get(f"break{what.title()}") == (value if kept else None)
    told = [o.outcome for o in result.report.outcomes if o.code == "JOINT_BREAKS_AT_NOTHING"]
    assert told == ([] if kept or value > 1.0 else [Outcome.APPROXIMATED])


@pytest.mark.parametrize("ending", ["kinefab", pytest.param("usda", marks=libraries.usd), "glb"])
@pytest.mark.parametrize(
    "drive, aims, kept",
    [
        ({"target": 20}, ["target"], False),
        ({"target_velocity": -20, "target": 20}, ["target", "target velocity"], False),
        ({"target": 20, "damping": 4.0}, ["target"], True),
        ({"target_velocity": -20, "stiffness": 4.0}, ["target velocity"], True),
        ({"target_velocity": -20, "target": 5, "motor": True, "max_force": 4.0}, ["target"], True),
        ({"target": 20, "stiffness": 4.0}, [], True),
        ({"target_velocity": -20, "damping": 4.0}, [], True),
        ({"stiffness": 0.0}, [], True),
    ],
)
def test_a_drive_with_an_aim_and_nothing_that_takes_it_there_is_told(tmp_path, drive, aims, kept, ending):
    """A target without a stiffness, a speed without a damping: in Unity, and everywhere, it does nothing."""
    scene = kinefab.Scene()
    lid = scene.add_part("Lid", BOX)
    scene.add_hinge(None, lid, point=(0, 0, 0), axis=(0, 1, 0), limits=(-10, 80), drive=drive)
    result = kinefab.export(scene, tmp_path / f"lid.{ending}")
    told = [d for d in result.report.diagnostics if d.code == "JOINT_DRIVE_IDLE"]
    assert len(told) == len(aims) and all(f" a {aim} for rx" in d.message for d, aim in zip(told, aims))
    if ending == "kinefab":
        joint = next(c for e in result.unity.gameObjects for c in e.components if hasattr(c, "breakForce"))
        assert (getattr(joint, "useSpring", True) or joint.useMotor) is kept


def test_pose_that_does_not_meet_its_joint_is_reported_in_metres_and_degrees(tmp_path):
    """A lid lifted by 2 mm off its hinge is a warning that says so."""
    scene = lid_scene()
    lifted = scene.nodes[1].pose
    scene.nodes[1] = replace(
        scene.nodes[1], pose=type(lifted)(lifted.rotation, lifted.translation + (0, 0.002, 0))
    )
    _, result = exported(scene, tmp_path)
    (finding,) = result.report.diagnostics
    assert finding.code == "JOINT_POSE_GAP" and "0.002 m" in finding.message


def test_joint_of_six_freedoms_needs_no_component(tmp_path):
    """A free joint is dropped with a remark, not exported as a component that does nothing."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX)
    scene.add_joint(JointKind.FREE, None, part, point=(0, 0, 0), name="F")
    _, result = exported(scene, tmp_path)
    assert [o.code for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == ["JOINT_REMOVES_NOTHING"]


def test_mass_that_nobody_gives_is_reported(tmp_path):
    """A lone part of nothing gets Unity's 1 kg with a warning; one that moves with others adds nothing, and says so."""
    scene = kinefab.Scene()
    scene.add_part("Ghost")
    content, result = exported(scene, tmp_path)
    assert [o.code for o in result.report.outcomes if o.code != "COLLIDER_RECOGNISED"] == ["MASS_UNKNOWN"]
    assert components(content, "Ghost", "Rigidbody") == [{"type": "Rigidbody"}]
    scene = kinefab.Scene()
    pair = scene.add_assembly("Pair", flexible=False)
    scene.add_part("Solid", BOX, parent=pair, density=1000.0)
    scene.add_part("Label", parent=pair)
    content, result = exported(scene, tmp_path)
    assert [d.code for d in result.report.diagnostics] == ["MASS_LEFT_OUT"]
    assert components(content, "Pair", "Rigidbody")[0]["mass"] == pytest.approx(6)


def test_asymmetric_swing_takes_its_larger_side(tmp_path):
    """-80..20 degrees becomes +-80, so that nothing the source allows is blocked."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX)
    swing = Freedom(Motion.LIMITED, math.radians(-80), math.radians(20))
    scene.add_joint(JointKind.UNIVERSAL, None, part, point=(0, 0, 0), name="J", rz=swing)
    content, _ = exported(scene, tmp_path)
    assert components(content, "P", "ConfigurableJoint")[0]["angularZLimit"] == {"limit": 80}


def test_drive_on_a_locked_freedom_is_mentioned(tmp_path):
    """A drive that cannot move anything is left out with a remark."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX, density=1000.0)
    held = Freedom(drive=Drive(stiffness=3.0))
    scene.add_joint(JointKind.PRISMATIC, None, part, point=(0, 0, 0), name="J", ty=held)
    content, result = exported(scene, tmp_path)
    assert [d.code for d in result.report.diagnostics] == ["JOINT_DRIVE_LOCKED"]
    assert "yDrive" not in components(content, "P", "ConfigurableJoint")[0]
    told = kinefab.export(scene, tmp_path / "scene.glb").report.diagnostics
    assert [d.code for d in told] == ["JOINT_DRIVE_LOCKED"]


def test_ball_joint_exported_at_a_swing_reports_where_its_limits_start(tmp_path):
    """Unity's cone stands about the exported pose; away from the joint's zero that is another cone."""
    scene = kinefab.Scene()
    part = scene.add_part("P", BOX)
    cone = Freedom(Motion.LIMITED, -0.9, 0.9)
    joint = scene.add_joint(JointKind.SPHERICAL, None, part, point=(0, 0, 0), name="J", ry=cone, rz=cone)
    tilted = Pose(rotation_about(np.array([0.0, 1.0, 0.0]), 0.3), np.zeros(3))
    scene.joints[0] = replace(joint, frame_b=joint.frame_a @ tilted)
    _, result = exported(scene, tmp_path)
    assert "JOINT_ZERO_SHIFTED" in [o.code for o in result.report.outcomes]
