"""Each exported component allows what the CAD joint allows and no more, by a second reading of Unity."""

from __future__ import annotations

import numpy as np
import pytest
from joint_cases import GROUNDING, KINDS, NAMES, Case, random_pose
from kinefab.model import Freedom, JointKind, Motion
from kinefab.spatial import Pose
from unity_semantics import ANGULAR, LINEAR, compose, inverse, mirrored, turn


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("kind", KINDS)
def test_component_allows_every_motion_of_the_cad_joint(kind, grounding):
    """Ten poses that the joint allows, from a non-zero start, satisfy the component to rounding."""
    for seed in range(3):
        q0 = np.random.default_rng(seed).uniform(-0.6, 0.6, 6)
        case = Case(seed, kind, q0, grounding)
        for _ in range(10):
            assert case.violation_at(case.random_q()) < 1e-12


@pytest.mark.parametrize("grounding", GROUNDING)
@pytest.mark.parametrize("kind", KINDS)
def test_cad_joint_allows_every_motion_of_the_component(kind, grounding):
    """Poses that the component allows leave the CAD joint's locked rows at zero."""
    for seed in range(3):
        q0 = np.random.default_rng(seed).uniform(-0.6, 0.6, 6)
        case = Case(seed, kind, q0, grounding)
        live = case.live
        hinge = case.component["type"] == "HingeJoint"
        linear, angular = ([], [0]) if hinge else (live.unlocked(LINEAR), live.unlocked(ANGULAR))
        assert len(linear) + len(angular) == len(case.free)
        for _ in range(10):
            d, angles = np.zeros(3), np.zeros(3)
            d[linear] = case.rng.uniform(-0.4, 0.4, len(linear))
            angles[angular] = case.rng.uniform(-0.7, 0.7, len(angular))
            # Y locked: Rz Rx has b's X across a's Z; Z locked: Ry Rx; else any product will do.
            r = turn(2, angles[2]) @ turn(1, angles[1]) @ turn(0, angles[0])
            connected = mirrored(pair(random_pose(case.rng, 2.0)))
            if case.mapped.connected is None:
                connected = (np.eye(3), np.zeros(3))
            own = live.own_pose((r, d), connected)
            assert live.violation(own, connected) < 1e-12
            c = in_cad(case, own, connected)
            assert (
                max(abs(c[1][i]) for i in range(3) if i not in case.free) < 1e-12 if len(linear) < 3 else True
            )
            assert rotation_misfit(case.rotations, c[0]) < 1e-12


def pair(pose: Pose):
    return pose.rotation, pose.translation


def in_cad(case, own, connected):
    """b's joint frame in a's, from Unity poses of the component's bodies."""
    own, connected = mirrored(own), mirrored(connected)
    a, b = (own, connected) if case.mapped.owner == 0 else (connected, own)
    if case.mapped.connected is None:  # the other side is the world: put its node back where it stands
        world = pair(case.scene.pose(1 if case.mapped.owner == 0 else case.joint.a))
        a, b = (a, world) if case.mapped.owner == 0 else (world, b)
    frame_a = compose(a, pair(case.joint.frame_a))
    return compose(inverse(frame_a), compose(b, pair(case.joint.frame_b)))


def rotation_misfit(rotations, r) -> float:
    if rotations == ():
        return float(np.linalg.norm(r - np.eye(3)))
    if rotations == (0,):
        return float(np.linalg.norm(r[:, 0] - np.eye(3)[0]))
    return abs(r[2, 0]) if rotations == (0, 2) else 0.0


SETS = [[i for i in range(6) if bits >> i & 1] for bits in range(1, 63)]


def leaves_slides_uneven(unlocked) -> bool:
    """Whether two rotations are left and, of the slides across the axis fixed in a, just one."""
    rotations = [i - 3 for i in unlocked if i > 2]
    if len(rotations) != 2:
        return False
    fixed_in_a = 2 if rotations != [0, 1] else 1
    return len([i for i in range(3) if i != fixed_in_a and i in unlocked]) == 1


@pytest.mark.parametrize("unlocked", SETS)
def test_any_set_of_freedoms_is_carried_by_one_component(unlocked):
    """All 62 sets of plain freedoms: what the CAD joint allows, the component allows, freedom for freedom; where
    that cannot be away from the joint's zero, it is reported."""
    for seed, grounding in enumerate(GROUNDING):
        q0 = np.random.default_rng(seed).uniform(-0.6, 0.6, 6) * (
            0.0 if leaves_slides_uneven(unlocked) else 1.0
        )
        case = Case(
            seed, JointKind.GENERAL, q0, grounding, **{NAMES[i]: Freedom(Motion.FREE) for i in unlocked}
        )
        assert [o.outcome.value for o in case.report.outcomes] == ["kept"]
        for _ in range(5):
            assert case.violation_at(case.random_q()) < 1e-12
        if case.component["type"] == "ConfigurableJoint":
            assert len(case.live.unlocked(LINEAR)) + len(case.live.unlocked(ANGULAR)) == len(unlocked)


@pytest.mark.parametrize("unlocked", [s for s in SETS if leaves_slides_uneven(s)])
def test_slides_that_turn_with_the_exported_pose_are_reported(unlocked):
    """One slide across the axis fixed in a, exported away from zero, fits no component: JOINT_AXES_TURNED."""
    case = Case(3, JointKind.GENERAL, np.full(6, 0.3), **{NAMES[i]: Freedom(Motion.FREE) for i in unlocked})
    assert [o.code for o in case.report.outcomes] == ["JOINT_AXES_TURNED"]
    assert case.component["exact"] is False
