"""What ``--physics articulation`` tells and what it writes are one: nothing told lost that is there, nothing lost untold."""

from __future__ import annotations

from dataclasses import replace
from math import radians

import kinefab
import numpy as np
import pytest
from kinefab import model
from kinefab.model import RX, TX, Drive, Dynamics, Passive, SphericalDrive
from kinefab.spatial import rotation_exp
from test_prefab_articulation import BOX, arm, exported, link, mass, nodes_of


def changed(scene: kinefab.Scene, name: str, freedom: int | None = None, /, **fields) -> kinefab.Scene:
    """With a joint, or one of its freedoms, that states something else."""
    (index,) = [i for i, j in enumerate(scene.joints) if j.name == name]
    joint = scene.joints[index]
    if freedom is not None:
        freedoms = list(joint.freedoms)
        freedoms[freedom] = replace(freedoms[freedom], **fields)
        fields = {"freedoms": tuple(freedoms)}
    scene.joints[index] = replace(joint, **fields)
    return scene


def told(result: kinefab.ExportResult) -> list[tuple[str, str, str]]:
    found = [o for o in result.report.outcomes if o.outcome.value != "kept"]
    return [(o.feature, o.code, o.message) for o in found]


def test_friction_that_is_written_is_not_told_as_lost(tmp_path):
    scene = changed(arm(), "Shoulder", RX, passive=Passive(friction=0.75, armature=0.01))
    root, result = exported(scene, tmp_path)
    assert float(link(nodes_of(root)["Upper"])["m_JointFriction"]) == 0.75
    codes = [code for feature, code, _ in told(result) if feature.endswith(" of joint Shoulder")]
    assert sorted(codes) == ["JOINT_ARMATURE_DROPPED", "JOINT_FRICTION_COEFFICIENT"]
    assert "JOINT_FRICTION_DROPPED" not in {d.code for d in result.report.diagnostics}
    (tmp_path / "plain").mkdir()
    plain = kinefab.export(scene, tmp_path / "plain" / "Arm.prefab")  # with Rigidbodies it is lost
    assert [c for f, c, _ in told(plain) if f.endswith(" of joint Shoulder")] == [
        "JOINT_FRICTION_DROPPED",
        "JOINT_ARMATURE_DROPPED",
    ]


def test_friction_of_what_closes_a_loop_is_lost_and_told(tmp_path):
    """A four-bar: three links have their friction, the fourth joint is on a helper and no link's."""
    scene = kinefab.Scene()
    parts = [
        scene.add_part(name, BOX, grounded=name == "Base") for name in ("Base", "Crank", "Rod", "Rocker")
    ]
    points = ((0, 0, 0), (0.1, 0.2, 0), (0.5, 0.3, 0), (0.4, 0, 0))
    for k, point in enumerate(points):
        scene.add_hinge(parts[k], parts[(k + 1) % 4], point=point, axis=(0, 0, 1), name=f"Pin {k}")
        scene = changed(scene, f"Pin {k}", RX, passive=Passive(friction=0.1 * (k + 1)))
    root, result = exported(scene, tmp_path)
    (closing,) = [o.feature for o in result.report.outcomes if o.code == "ARTICULATION_LOOP_HELPER"]
    lost = [f for f, c, _ in told(result) if c == "JOINT_FRICTION_DROPPED"]
    kept = [f for f, c, _ in told(result) if c == "JOINT_FRICTION_COEFFICIENT"]
    assert lost == [f"friction of {closing}"]
    assert sorted([*lost, *kept]) == [f"friction of joint Pin {k}" for k in range(4)]
    links = [n for n in nodes_of(root).values() if any(c["type"] == "ArticulationBody" for c in n.components)]
    written = sorted(float(link(n)["m_JointFriction"]) for n in links if float(link(n)["m_JointFriction"]))
    assert written == pytest.approx([0.1 * (k + 1) for k in range(4) if f"joint Pin {k}" != closing])


@pytest.mark.parametrize(
    "name, freedom, fields, word",
    [
        ("Shoulder", RX, {"restitution": 0.5}, "bounciness"),
        ("Rail", TX, {"stiffness": 200.0, "damping": 3.0}, "spring"),
        ("Rail", TX, {"restitution": 0.5}, "bounciness"),
        ("Shoulder", None, {"collide": True}, "enableCollision"),
    ],
)
def test_what_a_link_has_no_field_for_is_told(tmp_path, name, freedom, fields, word):
    _, result = exported(changed(arm(), name, freedom, **fields), tmp_path)
    found = [
        message
        for f, code, message in told(result)
        if f.endswith(f" of joint {name}") and code == "TARGET_FIELD_DROPPED"
    ]
    assert len(found) == 1 and word in found[0] and "an articulation" in found[0]


@pytest.mark.parametrize("name, freedom", [("Shoulder", RX), ("Rail", TX)])
def test_a_drive_of_accelerations_stays_one(tmp_path, name, freedom):
    drive = Drive(0.0, radians(5), 12.0, 0.5, 7.0, acceleration=True)
    scene = changed(arm(), name, freedom, drive=drive)
    root, result = exported(scene, tmp_path)
    part = {"Shoulder": "Upper", "Rail": "Fore"}[name]
    own = link(nodes_of(root)[part])["m_XDrive"]
    assert own["driveType"] == "1" and float(own["stiffness"]) == 12.0
    assert told(result) == []
    old, result = exported(scene, tmp_path, writing={"unity": "2021"})
    assert "driveType" not in link(nodes_of(old)[part])["m_XDrive"]
    lost = {(f, c) for f, c, _ in told(result)}
    assert (f"useAcceleration of link {part}", "TARGET_FIELD_DROPPED") in lost
    assert {(f"centre of mass and inertia of {n}", "TARGET_MASS_DROPPED") for n in ("Upper", "Fore")} <= lost


def test_one_drive_about_all_rotations_is_told(tmp_path):
    scene = arm()
    hand = scene.add_part("Hand", BOX, translation=(0.9, 0.1, 0.2), mass=mass(0.5))
    fore = next(i for i, n in enumerate(scene.nodes) if n.name == "Fore")
    scene.add_joint("spherical", fore, hand, point=(0.75, 0.1, 0.2), name="Wrist")
    given = SphericalDrive(np.eye(3), np.zeros(3), 9.0, 0.5, 4.0)
    scene = changed(scene, "Wrist", slerp=given)
    _, result = exported(scene, tmp_path)
    assert [(f, c) for f, c, _ in told(result)] == [("joint Wrist", "TARGET_FEATURE_APPROXIMATED")]
    scene = changed(scene, "Wrist", slerp=replace(given, target=rotation_exp(np.array([0.1, 0.2, 0.3]))))
    with pytest.raises(kinefab.KinefabError):
        exported(scene, tmp_path)


def test_a_clip_of_a_link_and_a_greatest_spin_are_told(tmp_path):
    """No Transform moves a link; what else the clip moves it moves still, and it does not play by itself."""
    scene = arm()
    lamp = scene.add_part("Lamp", BOX, translation=(2, 1, 0))
    upper = next(i for i, n in enumerate(scene.nodes) if n.name == "Upper")
    scene.nodes[lamp] = replace(scene.nodes[lamp], dynamics=Dynamics(kinematic=True))
    scene.nodes[upper] = replace(scene.nodes[upper], dynamics=Dynamics(max_angular_velocity=30.0))
    moved = np.array([[0.3, 0.1, 0.2], [0.4, 0.1, 0.2]])
    tracks = (model.Track(upper, moved), model.Track(lamp, moved + 1.0))
    scene.animations.append(model.AnimationClip("Wave", np.array([0.0, 1.0]), tracks))
    root, result = exported(scene, tmp_path)
    lost = {(f, c) for f, c, _ in told(result)}
    assert ("clip Wave of Upper", "TARGET_FIELD_DROPPED") in lost
    assert ("maxAngularVelocity of Rigidbody of Upper", "TARGET_FIELD_DROPPED") in lost
    clip = (tmp_path / "Arm" / "Animations" / "Wave.anim").read_text()
    assert "path: Lamp" in clip and "Upper" not in clip


def test_what_came_with_2022_is_told_for_2021(tmp_path):
    scene = kinefab.Scene()
    base = scene.add_part("Base", BOX, grounded=True)
    disc = scene.add_part("Disc", BOX, translation=(0.3, 0, 0), mass=mass(1.0))
    scene.add_hinge(base, disc, point=(0.3, 0, 0), axis=(0, 0, 1), limits=(-10, 300), name="Turn")
    scene = changed(scene, "Turn", RX, drive=Drive(0.5, 0.0, 20.0, 1.0, acceleration=True))
    lost: dict[str, list[str]] = {}
    for unity in ("2021", "2022"):
        (tmp_path / unity).mkdir()
        options = kinefab.ExportOptions(writing={"unity": unity})
        result = kinefab.export(scene, tmp_path / unity / "A.prefab", options)
        lost[unity] = [
            message for f, c, message in told(result) if f.endswith(" of joint Turn") and c == "TARGET_FIELD_DROPPED"
        ]
        text = (tmp_path / unity / "A.prefab").read_text()
        assert ("useAcceleration: 1" in text or "m_UseAcceleration: 1" in text) is (unity == "2022")
    assert lost["2022"] == [] and lost["2021"] and any("useAcceleration" in m for m in lost["2021"])


@pytest.mark.parametrize("hinges, many", [(63, False), (64, True)])
def test_more_links_than_physx_counts_are_told(tmp_path, hinges, many):
    """Links of one articulation: each hinge's, and the base's.  A second, small one is not counted with them."""
    scene = kinefab.Scene()
    above = scene.add_part("Base", None, grounded=True)
    for k in range(hinges):
        part = scene.add_part(f"P{k}", None, translation=(0.1 * k, 0, 0), mass=mass(1.0))
        scene.add_hinge(above, part, point=(0.1 * k, 0, 0), axis=(0, k % 2, 1), name=f"H{k}")
        above = part
    free = [scene.add_part(name, None, translation=(0, 1, 0), mass=mass(1.0)) for name in ("Left", "Right")]
    scene.add_hinge(*free, point=(0, 1, 0), axis=(0, 0, 1), name="Apart")
    _, result = exported(scene, tmp_path, writing={"unity": "2022"})
    found = [d.message for d in result.report.diagnostics if d.code == "ARTICULATION_LINKS_MANY"]
    assert len(found) == many and all(f" has {hinges + 1} links" in message for message in found)
