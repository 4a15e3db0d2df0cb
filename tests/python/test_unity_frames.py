"""The one mirror: right by kind of quantity, its own inverse, and in step with composition."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kinefab.spatial import Pose, matrix_from_quaternion, rotation_about, rotation_exp
from kinefab.unity import frames

M = np.diag([-1.0, 1.0, 1.0])
seeds = st.integers(0, 2**32 - 1)
few = settings(max_examples=40, deadline=None)


def random_pose(rng) -> Pose:
    return Pose(matrix_from_quaternion(rng.normal(size=4)), rng.normal(size=3))


@pytest.mark.parametrize("name, shape", [("point", (3,)), ("direction", (5, 3)), ("axial", (3,)), ("quaternion", (2, 4)),
                                         ("rotation", (3, 3)), ("inertia", (3, 3)), ("angle", ()), ("lead", ())])  # fmt: skip
def test_mirror_twice_changes_nothing(name, shape):
    """Every kind of quantity comes back as it was."""
    value = np.random.default_rng(4).normal(size=shape)
    mirror = getattr(frames, name)
    assert np.array_equal(mirror(mirror(value)), value)


def test_winding_twice_changes_nothing():
    """Triangles come back as they were."""
    faces = np.array([[0, 1, 2], [2, 3, 7]])
    assert np.array_equal(frames.winding(frames.winding(faces)), faces)


@given(seeds)
@few
def test_mirror_commutes_with_composition(seed):
    """The mirror of a product of poses is the product of the mirrored poses; so with points in them."""
    rng = np.random.default_rng(seed)
    a, b, p = random_pose(rng), random_pose(rng), rng.normal(size=3)
    one, two = frames.pose(a @ b), frames.pose(a) @ frames.pose(b)
    assert np.allclose(one.rotation, two.rotation, atol=1e-14)
    assert np.allclose(one.translation, two.translation, atol=1e-14)
    assert np.allclose(frames.point(a.point(p)), frames.pose(a).point(frames.point(p)), atol=1e-14)


@given(seeds)
@few
def test_quaternion_and_matrix_mirror_alike(seed):
    """The mirrored quaternion stands for M R M."""
    q = np.random.default_rng(seed).normal(size=4)
    expected = M @ matrix_from_quaternion(q) @ M
    assert np.allclose(matrix_from_quaternion(frames.quaternion(q)), expected, atol=1e-14)


@given(seeds, st.floats(-3, 3))
@few
def test_axis_and_angle_mirror_in_two_equal_ways(seed, angle):
    """A rotation is (M a, -q) as well as (-M a, q)."""
    axis = np.random.default_rng(seed).normal(size=3)
    axis /= np.linalg.norm(axis)
    expected = frames.rotation(rotation_about(axis, angle))
    polar = rotation_about(frames.direction(axis), float(frames.angle(angle)))
    assert np.allclose(polar, expected, atol=1e-13)
    assert np.allclose(rotation_about(frames.axial(axis), angle), expected, atol=1e-13)


@given(seeds)
@few
def test_velocity_of_a_turning_point_stays_consistent(seed):
    """v = w x r holds after the mirror with the component formula of the cross product."""
    rng = np.random.default_rng(seed)
    w, r = rng.normal(size=3), rng.normal(size=3)
    assert np.allclose(
        frames.direction(np.cross(w, r)), np.cross(frames.axial(w), frames.point(r)), atol=1e-14
    )


@given(seeds)
@few
def test_inertia_of_mirrored_point_masses(seed):
    """The inertia of mirrored points is the mirrored inertia."""
    points = np.random.default_rng(seed).normal(size=(7, 3))
    of = lambda p: np.eye(3) * (p * p).sum() - p.T @ p  # noqa: E731
    assert np.allclose(frames.inertia(of(points)), of(frames.point(points)), atol=1e-12)


def test_outward_normals_stay_outward():
    """With mirrored corners and turned winding, the normal by Unity's left-hand rule is the mirrored normal."""
    corners = np.array([[0.0, 0, 0], [2, 0, 0.5], [0, 3, 1]])
    normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
    a, b, c = frames.point(corners)[frames.winding(np.array([[0, 1, 2]]))[0]]
    assert np.allclose(np.cross(b - a, c - a), frames.direction(normal))


def test_screw_lead_turns_its_sign():
    """Advancing lead/2pi per radian along M a while turning the other way about it is a lead of -lead."""
    axis, lead, angle = np.array([0.6, 0.0, 0.8]), 0.003, 0.7
    advance = frames.direction(axis * lead * angle / (2 * np.pi))
    turn = float(frames.angle(angle))
    assert np.allclose(
        advance, frames.direction(axis) * float(frames.lead(lead)) * turn / (2 * np.pi), atol=1e-16
    )


def test_joint_basis_is_what_unity_builds():
    """X and Y are mirrored directions, Z their component cross product, so the basis is a rotation."""
    r = rotation_exp(np.array([0.3, -1.1, 0.4]))
    basis = frames.joint_basis(r)
    assert np.allclose(basis[:, 0], M @ r[:, 0]) and np.allclose(basis[:, 1], M @ r[:, 1])
    assert np.linalg.det(basis) == pytest.approx(1.0)


@pytest.mark.parametrize("axis", range(3))
def test_joint_coordinates_read_on_unitys_axes(axis):
    """A turn and a slide about and along a CAD axis are, mirrored, those by sign * q about and along Unity's."""
    r = rotation_exp(np.array([0.3, -1.1, 0.4]))
    basis, q = frames.joint_basis(r)[:, axis], 0.7
    for b_in_a, seen in ((True, q), (False, -q)):
        senses = frames.Senses.of(b_in_a)
        turn, slide = frames.rotation(rotation_about(r[:, axis], seen)), frames.direction(r[:, axis] * seen)
        assert np.allclose(rotation_about(basis, senses.angular[axis] * q), turn, atol=1e-14)
        assert np.allclose(basis * senses.linear[axis] * q, slide, atol=1e-14)
