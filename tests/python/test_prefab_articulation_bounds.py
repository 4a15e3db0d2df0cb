"""Largest effort and speed of a source's joint on the links of ``--physics articulation``, in both of Unity's targets."""

from __future__ import annotations

import json
import math
from pathlib import Path

import kinefab
import pytest
from kinefab.model import RX, RY, RZ, TX, Drive, Passive
from test_prefab_articulation import ARTICULATED, BOX, arm, exported, link, mass, nodes_of
from test_prefab_articulation_told import changed, told

UNLIMITED = 3.4028235e38


def links(scene, folder: Path) -> dict[str, dict]:
    """Of the ``.kinefab``, by the names of their objects."""
    kinefab.export(scene, folder / "arm.kinefab", kinefab.ExportOptions(writing=ARTICULATED))
    objects = json.loads((folder / "arm.kinefab").read_text(encoding="utf-8"))["gameObjects"]
    found = {o["name"]: c for o in objects for c in o.get("components", ())}
    return {name: c for name, c in found.items() if c["type"] == "ArticulationBody"}


def by_scene(scene, folder: Path) -> dict[str, dict]:
    """The same from a scene file of bodies and joints."""
    made = folder / "made"
    made.mkdir(exist_ok=True)
    return links(kinefab.export(scene, made / "arm.kinefab").path, folder)


@pytest.mark.parametrize("name, part, freedom", [("Shoulder", "Upper", RX), ("Rail", "Fore", TX)])
def test_effort_is_the_drive_s_largest_force_and_speed_the_joint_s(tmp_path, name, part, freedom):
    scene = changed(arm(), name, freedom, passive=Passive(damping=0.7, effort=12.0, speed=1.5))
    root, result = exported(scene, tmp_path)
    drive = link(nodes_of(root)[part])["m_XDrive"]
    assert (float(drive["forceLimit"]), float(drive["damping"])) == pytest.approx((12.0, 0.7))
    assert told(result) == [
        (f"maxJointVelocity of link {part}", "TARGET_FIELD_DROPPED", told(result)[0][2])
    ]
    own = links(scene, tmp_path)[part]
    assert (own["xDrive"]["forceLimit"], own["xDrive"]["damping"], own["maxJointVelocity"]) == (12.0, 0.7, 1.5)


def test_a_joint_without_an_effort_is_not_held_and_one_of_zero_is(tmp_path):
    root, _ = exported(arm(), tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_XDrive"]["forceLimit"]) == pytest.approx(UNLIMITED)
    root, _ = exported(changed(arm(), "Shoulder", RX, passive=Passive(effort=0.0)), tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_XDrive"]["forceLimit"]) == 0.0
    assert by_scene(changed(arm(), "Shoulder", RX, passive=Passive(effort=0.0)), tmp_path)["Upper"]["xDrive"]["forceLimit"] == 0.0


@pytest.mark.parametrize("most, effort", [(7.0, 12.0), (math.inf, 12.0), (20.0, 12.0)])
def test_the_least_of_drive_and_effort_holds(tmp_path, most, effort):
    drive = Drive(0.0, 0.2, 30.0, 2.0, most)
    scene = changed(arm(), "Shoulder", RX, drive=drive, passive=Passive(effort=effort))
    root, result = exported(scene, tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_XDrive"]["forceLimit"]) == min(most, effort)
    assert told(result) == []


def test_a_motor_keeps_within_the_effort(tmp_path):
    drive = Drive(0.0, 0.5, max_force=40.0, motor=True)
    scene = changed(arm(), "Shoulder", RX, drive=drive, passive=Passive(effort=12.0))
    root, _ = exported(scene, tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_XDrive"]["forceLimit"]) == 12.0


@pytest.mark.parametrize(
    "passive",
    [Passive(damping=20.0, effort=12.0, speed=1.5), Passive(stiffness=50.0, effort=12.0, speed=1.5)],
    ids=["damper", "spring"],
)
def test_an_effort_does_not_hold_the_joint_s_own_spring_or_damper(tmp_path, passive):
    """Those are the mechanism's and no motor's: with the effort as the drive's bound the arm would sink."""
    scene = changed(arm(), "Shoulder", RX, passive=passive)
    root, result = exported(scene, tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_XDrive"]["forceLimit"]) == pytest.approx(UNLIMITED)
    assert "largest effort of joint Shoulder" in [f for f, c, _ in told(result) if c == "JOINT_EFFORT_DROPPED"]
    assert by_scene(scene, tmp_path)["Upper"] == links(scene, tmp_path)["Upper"]
    both = changed(arm(), "Shoulder", RX, passive=passive, drive=Drive(0.0, 0.0, 5.0, 1.0))
    root, result = exported(both, tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_XDrive"]["forceLimit"]) == 12.0
    assert by_scene(both, tmp_path)["Upper"] == links(both, tmp_path)["Upper"]
    assert [f for f, c, _ in told(result) if c == "JOINT_EFFORT_SHARED"] == ["largest effort of joint Shoulder"]


def test_a_speed_of_zero_stops_no_joint(tmp_path):
    scene = changed(arm(), "Rail", TX, passive=Passive(effort=3.0, speed=0.0))
    assert "maxJointVelocity" not in links(scene, tmp_path)["Fore"]
    _, result = exported(scene, tmp_path)
    assert [(f, c) for f, c, _ in told(result)] == [("largest speed of joint Rail", "JOINT_EFFORT_DROPPED")]


@pytest.mark.parametrize("speeds", [(2.0, 2.0, 2.0), (2.0, 3.0, 2.0)], ids=["one speed", "several"])
def test_each_axis_of_a_ball_has_its_own_effort(tmp_path, speeds):
    scene = arm()
    hand = scene.add_part("Hand", BOX, translation=(0.9, 0.1, 0.2), mass=mass(0.5))
    fore = next(i for i, n in enumerate(scene.nodes) if n.name == "Fore")
    scene.add_joint("spherical", fore, hand, point=(0.75, 0.1, 0.2), name="Wrist")
    for freedom, effort, speed in zip((RX, RY, RZ), (5.0, 6.0, 7.0), speeds):
        scene = changed(scene, "Wrist", freedom, passive=Passive(effort=effort, speed=speed))
    own = links(scene, tmp_path)["Hand"]
    assert own == by_scene(scene, tmp_path)["Hand"]
    assert [own[f"{axis}Drive"]["forceLimit"] for axis in "xyz"] == [5.0, 6.0, 7.0]
    assert own.get("maxJointVelocity") == (2.0 if len(set(speeds)) == 1 else None)
    _, result = exported(scene, tmp_path)
    lost = [f for f, c, _ in told(result) if c == "JOINT_EFFORT_DROPPED"]
    assert len(lost) == (0 if len(set(speeds)) == 1 else 3)


@pytest.mark.parametrize("unity", ["2021", "2022", "6"])
def test_a_urdf_s_effort_and_damping_are_the_prefab_s(tmp_path, unity):
    inertial = '<inertial><mass value="1"/><inertia ixx=".1" iyy=".1" izz=".1" ixy="0" ixz="0" iyz="0"/></inertial>'
    (tmp_path / "a.urdf").write_text(
        f'<robot name="R"><link name="base"/><link name="l">{inertial}</link>'
        '<joint name="j" type="revolute"><parent link="base"/><child link="l"/><axis xyz="0 1 0"/>'
        '<limit lower="-1" upper="1.5" effort="12" velocity="1.5"/><dynamics damping="0.7" friction="0.2"/></joint></robot>'
    )
    options = kinefab.ExportOptions(writing={**ARTICULATED, "unity": unity})
    kinefab.export(tmp_path / "a.urdf", tmp_path / "a.prefab", options)
    text = (tmp_path / "a.prefab").read_text("ascii")
    assert "    damping: 0.7\n    forceLimit: 12\n" in text and "  m_JointFriction: 0.2\n" in text
