"""Rotations and poses, held against scipy's, which shares no code with them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kinefab.spatial import (
    Pose,
    cross,
    frame_from_axes,
    matrices_from_quaternions,
    matrix_from_quaternion,
    perpendicular,
    quaternion_from_matrix,
    quaternions_from_matrices,
    rotation_about,
    rotation_exp,
    rotation_log,
    skew,
)
from scipy.spatial.transform import Rotation

# Near the half turns about each axis another entry of the quaternion is the largest; beyond them w is negative.
TURNS = [
    *(3.1 * axis + 0.02 * np.array([0.3, -0.5, 0.7]) for axis in np.vstack([np.eye(3), -np.eye(3)])),
    *(
        3.3 * axis / np.linalg.norm(axis)
        for axis in np.array([[1.0, 0.2, -0.3], [-0.2, 1.0, 0.4], [0.3, 0.1, -1.0]])
    ),
    *np.random.default_rng(5).normal(size=(12, 3)),
    np.zeros(3),
]


@pytest.mark.parametrize("turn", TURNS)
def test_a_rotation_is_scipys_in_every_form(turn):
    theirs = Rotation.from_rotvec(turn)
    matrix, quaternion = theirs.as_matrix(), theirs.as_quat()
    quaternion *= math.copysign(1.0, quaternion[3])
    assert np.allclose(rotation_exp(turn), matrix)
    assert np.allclose(quaternion_from_matrix(matrix), quaternion)
    assert np.allclose(matrix_from_quaternion(-2.5 * quaternion), matrix)
    assert np.allclose(rotation_log(matrix), theirs.as_rotvec())
    if turn.any():
        size = float(np.linalg.norm(turn))
        assert np.allclose(rotation_about(turn / size, size), matrix)


def test_stacks_are_what_each_is_alone():
    theirs = Rotation.from_rotvec(np.array(TURNS))
    matrices, quaternions = theirs.as_matrix(), theirs.as_quat()
    quaternions *= np.where(quaternions[:, 3:] < 0.0, -1.0, 1.0)
    assert np.allclose(quaternions_from_matrices(matrices), quaternions)
    two_deep = quaternions_from_matrices(matrices[:20].reshape(4, 5, 3, 3))
    assert np.allclose(two_deep.reshape(20, 4), quaternions[:20])
    assert np.allclose(matrices_from_quaternions(3.0 * quaternions), matrices)


def test_poses_follow_each_other_as_matrices_do():
    poses = [Pose(rotation_exp(np.array(turn)), np.array(at)) for turn, at in (
        ((0.3, -1.1, 0.7), (5.0, -2.0, 0.5)), ((-1.4, 0.2, 0.9), (0.3, 0.7, -4.0)),
    )]  # fmt: skip
    whole = []
    for pose in poses:
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = pose.rotation, pose.translation
        whole.append(m)
    both, product = poses[0] @ poses[1], whole[0] @ whole[1]
    assert np.allclose(both.rotation, product[:3, :3]) and np.allclose(both.translation, product[:3, 3])
    back = poses[0].inverse() @ poses[0]
    assert np.allclose(back.rotation, np.eye(3)) and np.allclose(back.translation, 0.0)
    points = np.array([[1.0, 2.0, -3.0], [0.2, -0.4, 0.8]])
    assert np.allclose(poses[0].point(points), (np.column_stack([points, [1, 1]]) @ whole[0].T)[:, :3])
    assert np.allclose(poses[0].direction(points[0]), whole[0][:3, :3] @ points[0])


def test_products_are_numpys():
    a, b = np.random.default_rng(6).normal(size=(2, 4, 3))
    assert np.allclose(cross(a, b), np.cross(a, b)) and np.allclose(cross(a[0], b[0]), np.cross(a[0], b[0]))
    assert np.allclose(skew(a) @ b[..., None], np.cross(a, b)[..., None])


def test_a_frame_has_its_first_axis_and_leans_to_the_second():
    """Whatever their lengths; where the second is along the first, or none, it is across it all the same."""
    first, second = np.array([3.0, -1.0, 2.0]), np.array([0.4, 2.0, -0.3])
    frame = frame_from_axes(first, second)
    assert np.allclose(frame.T @ frame, np.eye(3)) and np.linalg.det(frame) > 0.0
    assert np.allclose(np.cross(frame[:, 0], first), 0.0) and frame[:, 0] @ first > 0.0
    assert frame[:, 1] @ second > 0.0 and frame[:, 2] @ second == pytest.approx(0.0, abs=1e-12)
    assert np.allclose(frame_from_axes(1e-6 * first, 1e-12 * second), frame)
    for alike in (None, -7.0 * first, first / 3.0):  # no whole part of it: what is left across is rounding
        frame = frame_from_axes(first, alike)
        assert np.allclose(frame.T @ frame, np.eye(3)) and np.linalg.det(frame) > 0.0
        assert np.array_equal(frame[:, 1], perpendicular(frame[:, 0]))
    with pytest.raises(ValueError, match="zero length"):
        frame_from_axes(np.zeros(3))
