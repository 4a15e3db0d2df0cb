"""Limits, drives, motors, readings and misfits of exported components, by a second reading of Unity."""

from __future__ import annotations

import math
from dataclasses import replace

import kinefab
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from joint_cases import DRIVEN, GROUNDING, KINDS, NAMES, Case, between, relative, turned
from kinefab.diagnostics import Report
from kinefab.model import FREE, UNLOCKED, Drive, Freedom, JointKind, Motion, Node, Passive, SphericalDrive
from kinefab.rigid import rigid_groups
from kinefab.spatial import Pose, rotation_exp
from kinefab.unity.joints.mapping import map_joint
from unity_semantics import matrix, rotation_vector, turn

seeds = st.integers(0, 2**32 - 1)


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("zero", [0.0, 25.0, 79.0])
def test_hinge_reads_the_cad_angle_from_the_exported_pose(grounding, zero):
    """HingeJoint.angle is q - q0, and the limits -10..80 are shifted by q0."""
    case = Case(7, JointKind.REVOLUTE, turned(zero), grounding, rx=between(-10, 80))
    assert case.component["type"] == "HingeJoint"
    assert case.component["limits"]["min"] == pytest.approx(-10 - zero, abs=1e-9)
    assert case.component["limits"]["max"] == pytest.approx(80 - zero, abs=1e-9)
    for q, beyond in ((-10, 0), (0, 0), (33, 0), (80, 0), (-11, 1), (82, 2)):
        own, connected = case.unity_poses(*case.poses_at(turned(q)))
        assert case.live.hinge_angle(own, connected) == pytest.approx(q - zero, abs=1e-9)
        assert case.live.violation(own, connected) == pytest.approx(math.radians(beyond), abs=1e-9)


def test_range_beyond_half_a_turn_is_met_by_the_right_whole_turn():
    """A range of 200..300 degrees around a pose at 250, which the frames show as -110, becomes -50..50."""
    case = Case(7, JointKind.REVOLUTE, turned(250), rx=between(200, 300))
    assert case.component["limits"]["min"] == pytest.approx(-50)
    assert case.component["limits"]["max"] == pytest.approx(50)
    assert "extendedLimits" not in case.component


def test_hinge_limits_past_half_a_turn_are_extended_and_past_a_turn_reported():
    """-270..90 degrees needs extendedLimits; -700..700 cannot be counted and is left out with a report."""
    case = Case(7, JointKind.REVOLUTE, rx=between(-270, 90))
    assert case.component["extendedLimits"] is True and case.component["limits"]["min"] == pytest.approx(
        -270 + 0
    )
    case = Case(7, JointKind.REVOLUTE, rx=between(-700, 700))
    assert "useLimits" not in case.component and case.component["exact"] is False
    assert [o.code for o in case.report.outcomes] == ["JOINT_LIMIT_BEYOND_TURN"]


@pytest.mark.parametrize(
    ("low", "high", "speed", "extended"),
    [
        (-180, 180, math.inf, True),
        (-180, 180, 0.0, True),  # a speed of zero in a file says nothing about what pushes the part
        (-180, 0, 1.0, True),
        (0, 175, 3.0, True),  # turns 6.9 degrees in two steps of 0.02 s
        (-170, 170, 3.0, False),
        (-170, 170, math.inf, True),
        (-90, 160, math.inf, False),
    ],
)
def test_a_hinge_that_may_wrap_beyond_its_stop_is_extended(low, high, speed, extended):
    """Without extendedLimits the angle jumps from 180 to -180, and the stop pushes the wrong way; nothing is lost by them."""
    freedom = replace(between(low, high), passive=Passive(speed=speed))
    case = Case(7, JointKind.REVOLUTE, rx=freedom)
    assert case.component.get("extendedLimits", False) is extended
    assert case.component["limits"] == pytest.approx({"min": low, "max": high}, abs=1e-9)


def test_a_fast_motor_makes_the_limits_of_its_hinge_extended():
    """720 degrees a second are 28.8 in two steps; 100 are 4."""
    for speed, extended in ((720, True), (100, False)):
        drive = Drive(target_velocity=math.radians(speed), damping=1.0, motor=True)
        freedom = replace(between(-155, 155), drive=drive)
        case = Case(7, JointKind.REVOLUTE, rx=freedom)
        assert case.component.get("extendedLimits", False) is extended


@pytest.mark.parametrize(("low", "high", "speed", "told"), [(-180, 180, 1.0, "180"), (-179, 5, 1.0, "179"), (-170, 170, 3.0, "")])
def test_a_stop_that_a_configurable_joint_may_pass_is_told(low, high, speed, told):
    """It has no extendedLimits, and turns past its stop as a hinge without them does; a link of an articulation does not."""
    drive = Drive(stiffness=10.0, damping=1.0, max_force=5.0)
    freedom = replace(between(low, high), passive=Passive(speed=speed), drive=drive)
    case = Case(7, JointKind.REVOLUTE, rx=freedom)
    assert case.component["type"] == "ConfigurableJoint"
    found = [d.message for d in case.report.diagnostics if d.code == "JOINT_STOP_WRAPS"]
    assert len(found) == (1 if told else 0) and all(f"at {told} degrees" in message for message in found)


def test_a_link_holds_a_stop_at_half_a_turn(tmp_path):
    scene = kinefab.Scene()
    base, arm = scene.add_part("Base", grounded=True), scene.add_part("Arm")
    drive = kinefab.Drive(stiffness=10.0, damping=1.0, max_force=5.0)
    scene.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 0, 1), limits=(-180, 180), drive=drive)
    for physics, told in (("rigidbody", True), ("articulation", False)):
        options = kinefab.ExportOptions(writing={"physics": physics})
        result = kinefab.export(scene, tmp_path / "a.kinefab", options)
        assert ("JOINT_STOP_WRAPS" in {d.code for d in result.report.diagnostics}) is told


@pytest.mark.parametrize(
    ("stop", "speed", "extended"), [("3.141592653589793", 3, True), ("2.97", 3, False), ("2.97", 7, True)]
)
def test_a_robots_speed_decides_whether_its_hinge_is_extended(tmp_path, stop, speed, extended):
    """From the file to the scene; 2.97 rad are 170.2 degrees. An older editor has no such field, and the report tells it."""
    link = '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    source = tmp_path / "arm.urdf"
    source.write_text(
        f'<robot name="Arm"><link name="base">{link}</link><link name="tip">{link}</link>'
        '<joint name="turn" type="revolute"><parent link="base"/><child link="tip"/><axis xyz="0 0 1"/>'
        f'<limit lower="-{stop}" upper="{stop}" effort="10" velocity="{speed}"/></joint></robot>'
    )
    scene = kinefab.export(source, tmp_path / "arm.kinefab")
    assert ('"extendedLimits": true' in scene.path.read_text()) is extended
    assert [o.outcome.value for o in scene.report.outcomes if o.feature == "joint turn"] == ["kept"]
    (tmp_path / "old").mkdir()
    options = kinefab.ExportOptions(writing={"unity": "2021"})
    old = kinefab.export(source, tmp_path / "old" / "arm.prefab", options)
    told = [o for o in old.report.outcomes if "extendedLimits" in o.feature + o.message]
    assert bool(told) is extended


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("lead", [0.004, -0.004])
def test_a_screw_of_many_turns_ends_where_its_slide_does(grounding, lead):
    """-720..1800 degrees, of which Unity counts half a turn, are -2 and 5 leads of travel, of either thread."""

    def at(degrees: float) -> np.ndarray:
        return np.array([lead * degrees / 360.0, 0, 0, math.radians(degrees), 0, 0])

    case = Case(
        7, JointKind.SCREW, at(90), grounding, lead=lead, rx=replace(between(-720, 1800), at=at(90)[3])
    )
    assert (case.component["xMotion"], case.component["angularXMotion"]) == ("Limited", "Free")
    assert [(o.outcome.value, o.code) for o in case.report.outcomes] == [("kept", "")]
    for degrees, beyond in ((-720, 0), (0, 0), (1800, 0), (-810, 0.001), (1980, 0.002)):
        assert case.violation_at(at(degrees)) == pytest.approx(beyond, abs=1e-9)


def test_a_screw_of_less_than_half_a_turn_keeps_its_turn_and_one_of_two_ranges_the_narrower():
    case = Case(7, JointKind.SCREW, lead=0.004, rx=between(-10, 80))
    assert (case.component["xMotion"], case.component["angularXMotion"]) == ("Free", "Limited")
    slide = Freedom(Motion.LIMITED, -0.5, 0.003)
    case = Case(7, JointKind.SCREW, lead=0.004, rx=between(-720, 1800), tx=slide)
    assert case.component["linearLimit"]["limit"] == pytest.approx(0.5 * (0.003 + 0.008))


@given(seed=seeds, zero=st.floats(-20, 90), grounding=st.sampled_from(GROUNDING))
@settings(max_examples=30, deadline=None)
def test_configurable_twist_limits_hold_where_the_cad_says(seed, zero, grounding):
    """A cylindrical joint limited to -10..80 degrees and free to slide stops at these angles."""
    q0 = np.array([0.1, 0, 0, math.radians(zero), 0, 0])
    limits = between(-10, 80)
    case = Case(seed, JointKind.CYLINDRICAL, q0, grounding, rx=limits)
    for q, beyond in ((-10, 0), (80, 0), (-12.5, 2.5), (83, 3)):
        violation = case.violation_at([0.2, 0, 0, math.radians(q), 0, 0])
        assert violation == pytest.approx(math.radians(beyond), abs=1e-9)


@given(seed=seeds, q0=st.floats(-0.3, 0.5), grounding=st.sampled_from(GROUNDING))
@settings(max_examples=30, deadline=None)
def test_asymmetric_slide_stops_at_both_ends(seed, q0, grounding):
    """A slide from -0.010 to 0.080 m stops there, whatever its place at export."""
    case = Case(seed, JointKind.PRISMATIC, np.full(6, q0), grounding, tx=Freedom(Motion.LIMITED, -0.01, 0.08))
    assert case.component["linearLimit"]["limit"] == pytest.approx(0.045)
    for q, beyond in ((-0.01, 0), (0.08, 0), (0.03, 0), (-0.012, 0.002), (0.1, 0.02)):
        assert case.violation_at([q, 0, 0, 0, 0, 0]) == pytest.approx(beyond, abs=1e-12)


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("lower, upper, furthest", [(-math.inf, 0.3, -99.7), (-0.2, math.inf, 99.8)])
def test_slide_with_one_end_stops_there_and_a_hundred_metres_from_it(grounding, lower, upper, furthest):
    """Unity's linear limit has two ends; the one that CAD does not have is far from the one that it has."""
    slide = Freedom(Motion.LIMITED, lower, upper)
    case = Case(17, JointKind.PRISMATIC, np.full(6, 0.1), grounding, tx=slide)
    end, out = (upper, 1.0) if math.isinf(lower) else (lower, -1.0)
    for q, beyond in ((end, 0), (end + 0.02 * out, 0.02), (furthest, 0), (furthest - 0.5 * out, 0.5)):
        assert case.violation_at([q, 0, 0, 0, 0, 0]) == pytest.approx(beyond, abs=1e-9)
    assert [o.code for o in case.report.outcomes] == ["JOINT_LIMIT_ONE_SIDED"]


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("kind, freedom", DRIVEN)
def test_drive_target_is_where_the_cad_coordinate_meets_it(kind, freedom, grounding):
    """At q = target, c equals targetPosition or targetRotation, with one freedom driven from its own zero."""
    target = 0.35
    driven = Freedom(Motion.FREE, drive=Drive(target=target, stiffness=50.0, damping=2.0, max_force=9.0))
    case = Case(11, kind, np.zeros(6), grounding, **{NAMES[freedom]: driven})
    q = np.zeros(6)
    q[freedom] = target
    r, d = case.live.c(*case.unity_poses(*case.poses_at(q)))
    assert np.allclose(d, case.component["targetPosition"], atol=1e-12)
    assert np.allclose(r, matrix(case.component["targetRotation"]), atol=1e-12)
    drives = [key for key in case.component if key.endswith("Drive")]
    assert len(drives) == 1
    assert case.component[drives[0]] == {"positionSpring": 50.0, "positionDamper": 2.0, "maximumForce": 9.0}


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("kind, freedom", DRIVEN)
def test_target_speed_drives_the_cad_coordinate_forwards(kind, freedom, grounding):
    """Along the CAD motion, Unity's relative velocity equals targetVelocity or targetAngularVelocity."""
    speed, step = 0.8, 1e-6
    driven = Freedom(Motion.FREE, drive=Drive(target_velocity=speed, damping=3.0))
    case = Case(5, kind, np.zeros(6), grounding, **{NAMES[freedom]: driven})
    later = np.zeros(6)
    later[freedom] = speed * step
    case.rng = np.random.default_rng(1)  # the same pose of a for both
    start = case.live.c(*case.unity_poses(*case.poses_at(np.zeros(6))))
    case.rng = np.random.default_rng(1)
    r, d = case.live.c(*case.unity_poses(*case.poses_at(later)))
    linear = (d - start[1]) / step
    turning = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (2.0 * step)
    # PhysX drives actor0 against actor1 in rotation (w0 - w1), so against c's own sense.
    assert np.allclose(linear, case.component["targetVelocity"], atol=1e-5)
    assert np.allclose(-turning, case.component["targetAngularVelocity"], atol=1e-5)


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize(
    "kind, q0, free",
    [
        (JointKind.SPHERICAL, [0, 0, 0, 0.5, -0.3, 0.4], {}),
        (JointKind.UNIVERSAL, [0, 0, 0, 0.5, 0, 0.3], {}),
        (JointKind.GENERAL, [0, 0, 0, 0, 0.5, 0.3], {"ry": FREE, "rz": FREE}),  # its axes are renamed
    ],
)
def test_slerp_drive_turns_to_its_target_and_at_its_speed(kind, q0, free, grounding):
    """Where b stands in a as the target says, c equals targetRotation; turning as asked, targetAngularVelocity."""
    target, spin, step = rotation_exp(np.array([0.4, -0.7, 0.3])), np.array([0.1, 0.7, -0.4]), 1e-6
    drive = SphericalDrive(target, spin, 400.0, 60.0)
    case = Case(59, kind, np.array(q0), grounding, slerp=drive, **free)
    assert case.component["rotationDriveMode"] == "Slerp"
    r, _ = case.live.c(*case.unity_poses(*case.poses_apart(Pose(target))))
    assert np.allclose(r, matrix(case.component["targetRotation"]), atol=1e-12)
    start = relative(case.rotations, case.q0)
    r, _ = case.live.c(*case.unity_poses(*case.poses_apart(Pose(rotation_exp(spin * step)) @ start)))
    turning = np.array([r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]]) / (2.0 * step)
    assert np.allclose(-turning, case.component["targetAngularVelocity"], atol=1e-5)


@pytest.mark.parametrize("grounding", GROUNDING)
def test_hinge_motor_and_spring_keep_the_cad_sense(grounding):
    """A motor of +0.5 rad/s is +28.65 deg/s; a spring's target is shifted by q0."""
    motor = Freedom(Motion.FREE, drive=Drive(target_velocity=0.5, max_force=3.0, motor=True))
    case = Case(3, JointKind.REVOLUTE, grounding=grounding, rx=motor)
    assert case.component["motor"] == {"targetVelocity": pytest.approx(math.degrees(0.5)), "force": 3.0}
    spring = Freedom(Motion.FREE, drive=Drive(target=1.0, stiffness=4.0, damping=0.2))
    case = Case(3, JointKind.REVOLUTE, np.full(6, 0.3), grounding, rx=spring)
    expected = {"spring": 4.0, "damper": 0.2, "targetPosition": pytest.approx(math.degrees(0.7))}
    assert case.component["spring"] == expected


@pytest.mark.parametrize("axis", ["ry", "rz"])
def test_single_rotation_about_another_axis_keeps_its_asymmetric_limits(axis):
    """A general joint that turns about Y or Z only is renamed to X, where Unity has a low and a high limit."""
    limits = between(-10, 80)
    slide = Freedom(Motion.FREE)
    case = Case(9, JointKind.GENERAL, tx=slide, **{axis: limits})
    index = NAMES.index(axis)
    for q, beyond in ((-10, 0), (80, 0), (-13, 3), (84, 4)):
        values = np.zeros(6)
        values[0], values[index] = 0.3, math.radians(q)
        assert case.violation_at(values) == pytest.approx(math.radians(beyond), abs=1e-9)
    assert [o.outcome.value for o in case.report.outcomes] == ["kept"]


@pytest.mark.parametrize("grounding", GROUNDING)
def test_limited_pin_in_slot_stops_at_the_ends_of_the_slot(grounding):
    """The slot turns with a, so its ends hold at every angle of the pin."""
    case = Case(13, JointKind.PIN_SLOT, np.full(6, 0.2), grounding, ty=Freedom(Motion.LIMITED, -0.05, 0.2))
    for angle in (-1.0, 0.4, 2.0):
        for q, beyond in ((-0.05, 0), (0.2, 0), (-0.06, 0.01), (0.25, 0.05)):
            assert case.violation_at([0, q, 0, angle, 0, 0]) == pytest.approx(beyond, abs=1e-12)


def test_cone_of_a_ball_joint_is_measured_from_a():
    """Swing limits of 30 and 50 degrees hold about a's axes, for a joint exported at its zero."""
    for grounding in GROUNDING:
        case = Case(17, JointKind.SPHERICAL, grounding=grounding, ry=between(-30, 30), rz=between(-50, 50))
        assert case.violation_at([0, 0, 0, 1.0, math.radians(30), 0]) < 1e-9
        assert case.violation_at([0, 0, 0, 1.0, 0, math.radians(50)]) < 1e-9
        assert case.violation_at([0, 0, 0, 1.0, math.radians(36), 0]) == pytest.approx(0.2, abs=1e-9)


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("low, high", [(-70, 20), (-20, 70)])
def test_swing_with_uneven_ends_gets_as_far_as_the_further_one(low, high, grounding):
    """Unity has one angle for both sides: what CAD allows stays allowed."""
    case = Case(19, JointKind.UNIVERSAL, grounding=grounding, rz=between(low, high))
    assert [o.code for o in case.report.outcomes] == ["JOINT_LIMIT_ASYMMETRIC"]
    for degrees, beyond in ((-70, 0), (70, 0), (-73, 3), (74, 4)):
        values = [0, 0, 0, 0.4, 0, math.radians(degrees)]
        assert case.violation_at(values) == pytest.approx(math.radians(beyond), abs=1e-9)


@pytest.mark.parametrize("half, motion", [(179, "Limited"), (200, "Free")])
def test_swing_beyond_half_a_turn_is_free_and_told(half, motion):
    """The cone ends there, and 200 degrees in its field would be another range."""
    case = Case(19, JointKind.UNIVERSAL, rz=between(-half, half))
    assert case.component.get("angularZMotion", "Free") == motion
    told = [o.code for o in case.report.outcomes]
    assert told == (["JOINT_LIMIT_BEYOND_TURN"] if motion == "Free" else [""])
    assert ("angularZLimit" in case.component) == (motion == "Limited")


@pytest.mark.parametrize("grounding", GROUNDING)
def test_drive_targets_count_from_the_middle_of_the_range_and_from_the_exported_angle(grounding):
    """A limited slide's target is measured from its middle, a turn's from q0: at the target, c meets both."""
    slide = Freedom(Motion.LIMITED, -0.01, 0.08, Drive(target=0.06, stiffness=5.0))
    turning = Freedom(Motion.FREE, drive=Drive(target=0.9, stiffness=5.0))
    case = Case(23, JointKind.CYLINDRICAL, np.full(6, 0.05), grounding, tx=slide, rx=turning)
    r, d = case.live.c(*case.unity_poses(*case.poses_at([0.06, 0, 0, 0.9, 0, 0])))
    assert np.allclose(d, case.component["targetPosition"], atol=1e-12)
    assert np.allclose(r, matrix(case.component["targetRotation"]), atol=1e-12)


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("kind, freedom", [(kind, i) for kind in KINDS for i in UNLOCKED[kind]])
def test_coordinate_of_a_coupling_reads_the_own_bodys_motion(kind, freedom, grounding):
    """sign * (q - zero) is how far the own body moves against the connected one, by the left-hand rule."""
    case = Case(29, kind, np.zeros(6), grounding)
    q = np.zeros(6)
    q[freedom] = 0.3
    start = case.unity_poses(*case.poses_at(np.zeros(6)))
    reading = case.mapped.coordinates[freedom]
    expected = reading.sign * (0.3 - reading.zero)
    if case.component["type"] == "HingeJoint":
        angle = case.live.hinge_angle(*case.unity_poses(*case.poses_at(q)))
        assert reading.name == "angle" and math.radians(angle) == pytest.approx(expected, abs=1e-12)
        return
    own_against_connected = 1.0 if case.component.get("swapBodies") else -1.0
    r, d = case.live.c(*case.unity_poses(*case.poses_at(q)))
    d = own_against_connected * (d - case.live.c(*start)[1])
    turning = own_against_connected * rotation_vector(r)
    found = dict(zip(("x", "y", "z", "angularX", "angularY", "angularZ"), [*d, *turning]))
    assert found.pop(reading.name) == pytest.approx(expected, abs=1e-12)
    assert max(map(abs, found.values())) < 1e-12


def test_limits_and_readings_of_a_joint_exported_away_from_zero_start_at_zero():
    """The reading's zero is the coordinate at export, so a coupling starts from what is met there."""
    case = Case(31, JointKind.CYLINDRICAL, np.array([0.2, 0, 0, 0.4, 0, 0]))
    assert case.mapped.coordinates[0].zero == pytest.approx(0.2)
    assert case.mapped.coordinates[3].zero == pytest.approx(0.4)


@pytest.mark.parametrize("kind", [kind for kind in KINDS if len([i for i in UNLOCKED[kind] if i > 2]) < 3])
def test_tilted_pose_is_a_gap_in_degrees(kind):
    """Two degrees about a locked axis are reported as two degrees, and the component as not exact."""
    case = Case(37, kind)
    locked = next(i for i in (4, 5, 3) if i not in UNLOCKED[kind])
    tilt = Pose(turn(locked - 3, math.radians(2)), np.zeros(3))
    joint = case.joint
    moved = case.scene.nodes[0].pose @ joint.frame_a @ tilt @ joint.frame_b.inverse()
    case.scene.nodes[1] = Node("B", "B", pose=moved)
    report = Report()
    mapped = map_joint(joint, case.scene, rigid_groups(case.scene), lambda node: node, report)
    (finding,) = report.diagnostics
    assert finding.code == "JOINT_POSE_GAP" and " 2 degrees" in finding.message
    assert mapped.component.exact is False


def test_range_of_one_value_is_a_lock_at_that_value():
    """A slide limited to 0.2..0.2 is a fixed joint, and its pose at 0.2 has no gap."""
    held = Freedom(Motion.LIMITED, 0.2, 0.2)
    case = Case(41, JointKind.PRISMATIC, np.full(6, 0.2), tx=held)
    assert case.component["type"] == "FixedJoint" and case.report.diagnostics == []
    case = Case(41, JointKind.CYLINDRICAL, np.full(6, 0.2), tx=held)
    assert case.component["type"] == "HingeJoint" and case.report.diagnostics == []
    assert case.violation_at([0.2, 0, 0, 1.0, 0, 0]) < 1e-12


def test_turns_of_one_value_are_locks_at_these_values():
    """Held at 20, 10 and 30 degrees about X, Y and Z it is a fixed joint; with X free a hinge that turns from there."""
    held = {"rx": between(20, 20), "ry": between(10, 10), "rz": between(30, 30)}
    stands = np.array([0, 0, 0, *np.radians([20, 10, 30])])
    case = Case(67, JointKind.SPHERICAL, stands, **held)
    assert case.component["type"] == "FixedJoint" and case.report.diagnostics == []
    case = Case(67, JointKind.SPHERICAL, stands, **held | {"rx": between(-10, 80)})
    assert case.component["type"] == "HingeJoint" and case.report.diagnostics == []
    for degrees, beyond in ((-10, 0), (80, 0), (83, 3)):
        q = [0, 0, 0, *np.radians([degrees, 10, 30])]
        assert case.violation_at(q) == pytest.approx(math.radians(beyond), abs=1e-9)


def test_soft_limit_and_strong_spring_need_a_configurable_joint():
    """What a HingeJoint lacks (soft limits, a spring's largest torque or speed) goes to a ConfigurableJoint."""
    soft = Freedom(Motion.LIMITED, -0.2, 1.4, stiffness=30.0, damping=2.0)
    case = Case(43, JointKind.REVOLUTE, rx=soft)
    assert case.component["angularXLimitSpring"] == {"spring": 30.0, "damper": 2.0}
    assert case.violation_at([0, 0, 0, 1.4, 0, 0]) < 1e-12
    weak = Freedom(Motion.FREE, drive=Drive(target=0.5, stiffness=4.0, max_force=2.0))
    case = Case(43, JointKind.REVOLUTE, rx=weak)
    assert case.component["angularXDrive"]["maximumForce"] == 2.0
    turning = Freedom(Motion.FREE, drive=Drive(target_velocity=0.5, damping=3.0))
    case = Case(43, JointKind.REVOLUTE, rx=turning)
    assert case.component["angularXDrive"]["positionDamper"] == 3.0
    assert abs(case.component["targetAngularVelocity"][0]) == 0.5


@pytest.mark.parametrize(
    "kind, limited, ends",
    [
        (JointKind.REVOLUTE, {"rx": 0.3}, {"limits": 0.3}),
        (JointKind.CYLINDRICAL, {"rx": 0.3}, {"lowAngularXLimit": 0.3, "highAngularXLimit": 0.3}),
        (JointKind.PRISMATIC, {"tx": 0.3}, {"linearLimit": 0.3}),
        (JointKind.SPHERICAL, {"ry": 0.1, "rz": 0.3}, {"angularYLimit": 0.3, "angularZLimit": 0.3}),
    ],
)
def test_bounce_of_a_limit_is_that_of_each_of_its_ends(kind, limited, ends):
    """The cone has one for both swings, the larger."""
    freedoms = {
        name: Freedom(Motion.LIMITED, -0.2, 0.2, restitution=bounce) for name, bounce in limited.items()
    }
    component = Case(53, kind, **freedoms).component
    assert {key: component[key]["bounciness"] for key in ends} == ends


@pytest.mark.parametrize("ry, rz", [(5.0, 2.0), (2.0, 5.0)])
def test_swings_share_the_stronger_drive(ry, rz):
    """Unity has one for both, and a drive that is too weak moves nothing."""
    drives = {
        name: Freedom(Motion.FREE, drive=Drive(stiffness=k, damping=0.1 * k, max_force=3.0 * k))
        for name, k in (("ry", ry), ("rz", rz))
    }
    case = Case(61, JointKind.SPHERICAL, **drives)
    assert [o.code for o in case.report.outcomes] == ["JOINT_DRIVE_SHARED"]
    wanted = {"positionSpring": 5.0, "positionDamper": 0.5, "maximumForce": 15.0}
    assert case.component["angularYZDrive"] == wanted and "angularXDrive" not in case.component


@pytest.mark.parametrize("grounding", GROUNDING)
def test_cross_joint_limits_hold_from_any_exported_pose(grounding):
    """A universal joint exported bent: -10..80 degrees about b's axis and +-20 about a's, counted from its bend."""
    rz = math.degrees(0.3)
    q0 = np.array([0, 0, 0, 0.5, 0, 0.3])
    case = Case(47, JointKind.UNIVERSAL, q0, grounding, rx=between(-10, 80), rz=between(rz - 20, rz + 20))
    assert [o.outcome.value for o in case.report.outcomes] == ["kept"]
    for x, z, beyond in ((-10, rz, 0), (80, rz - 20, 0), (83, rz, 3), (0, rz + 24, 4), (-12, rz + 5, 2)):
        values = [0, 0, 0, math.radians(x), 0, math.radians(z)]
        assert case.violation_at(values) == pytest.approx(math.radians(beyond), abs=1e-9)
