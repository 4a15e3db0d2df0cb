"""Symmetry about a plane on a third part."""

from __future__ import annotations

import numpy as np
from derivatives import check_derivative
from hypothesis import given, settings
from strategies import random_pose, seeds

from kinefab.analysis import analyse
from kinefab.analysis.equations import equations_of
from kinefab.diagnostics import Report
from kinefab.model import Constraint, ConstraintKind as C, Feature, FeatureKind as F, Node, Scene
from kinefab.spatial import Pose, rotation_about, rotation_exp


def mirrored_planes(first, second, tilt=0.0):
    """Three parts: a middle plane on the ground and one plane on each of two parts, symmetric but for ``tilt``."""
    middle = Pose(np.eye(3), np.array([0.1, 0.2, 0.3]))
    a = middle @ Pose(rotation_about(np.array([0.0, 1.0, 0.0]), 0.4), np.array([0.2, 0.1, 0.5]))
    flip = np.diag([1.0, 1.0, -1.0])
    normal = flip @ a.rotation[:, 2]
    point = middle.translation + flip @ (a.translation - middle.translation)
    nodes = [
        Node("base", "base", grounded=True),
        Node("a", "a", pose=first),
        Node("b", "b", pose=second),
    ]
    features = (
        Feature(
            1, F.PLANE, first.inverse().point(a.translation), first.inverse().direction(a.rotation[:, 2])
        ),
        Feature(2, F.PLANE, second.inverse().point(point), second.inverse().direction(normal)),
        Feature(0, F.PLANE, middle.translation, middle.rotation[:, 2]),
    )
    return Scene(nodes=nodes, constraints=[Constraint("mirror", C.SYMMETRY, features)])


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_symmetric_planes_are_three_equations_between_three_parts(seed):
    """Satisfied by a mirror image, with the right derivative away from it; nine freedoms of twelve stay."""
    rng = np.random.default_rng(seed)
    scene = mirrored_planes(random_pose(rng), random_pose(rng))
    found = analyse(scene)
    assert (found.rows, found.rank, found.mobility) == (3, 3, 9) and found.gaps == []
    assert [o.code for o in found.report.outcomes] == [
        "RELATION_DROPPED"
    ]  # no Unity joint joins three bodies
    check_derivative(scene, rng)


def mirrored_lines(first, second, slip=0.0):
    """As ``mirrored_planes`` with lines; b's is named by another of its points, the other way round."""
    middle = Pose(rotation_about(np.array([0.6, 0.0, 0.8]), 0.7), np.array([0.1, 0.2, 0.3]))
    normal = middle.rotation[:, 2]
    flip = np.eye(3) - 2.0 * np.outer(normal, normal)
    point, along = np.array([0.5, -0.3, 0.9]), np.array([2.0, 3.0, 6.0]) / 7.0
    image_along = -flip @ along
    aside = np.cross(image_along, normal)
    image = middle.translation + flip @ (point - middle.translation) + 0.8 * image_along + slip * aside
    nodes = [
        Node("base", "base", grounded=True),
        Node("a", "a", pose=first),
        Node("b", "b", pose=second),
    ]
    features = (
        Feature(1, F.LINE, first.inverse().point(point), first.inverse().direction(along)),
        Feature(2, F.LINE, second.inverse().point(image), second.inverse().direction(image_along)),
        Feature(0, F.PLANE, middle.translation, normal),
    )
    return Scene(nodes=nodes, constraints=[Constraint("mirror", C.SYMMETRY, features)])


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_symmetric_lines_are_four_equations_between_three_parts(seed):
    """Satisfied by a mirror image, with the right derivative away from it; eight freedoms of twelve stay."""
    rng = np.random.default_rng(seed)
    scene = mirrored_lines(random_pose(rng), random_pose(rng))
    found = analyse(scene)
    assert (found.rows, found.rank, found.mobility) == (4, 4, 8) and found.gaps == []
    assert [o.code for o in found.report.outcomes] == ["RELATION_DROPPED"]
    check_derivative(scene, rng)


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_symmetric_lines_hold_wherever_they_move(seed):
    """One line moved anywhere and slid along itself, the other to the image: nothing is violated."""
    rng = np.random.default_rng(seed)
    scene = mirrored_lines(random_pose(rng), random_pose(rng))
    a, b, plane = scene.constraints[0].features
    flip = np.eye(3) - 2.0 * np.outer(plane.direction, plane.direction)
    turn = rotation_exp(0.4 * rng.uniform(-1, 1, 3))
    shift = rng.uniform(-0.5, 0.5, 3)
    first, second = scene.nodes[1].pose, scene.nodes[2].pose
    moved_a = Pose(turn, shift) @ first
    at, along = moved_a.point(a.point), moved_a.direction(a.direction)
    goal = plane.point + flip @ (at - plane.point) + rng.uniform(-1, 1) * (flip @ along)
    rotation = flip @ turn @ flip @ second.rotation
    moved_b = Pose(rotation, goal - rotation @ b.point)
    system = equations_of(scene, Report()).system
    state = system.start()
    for body, old, new in ((2, first, moved_a), (3, second, moved_b)):
        step = new @ old.inverse()
        state.rotation[body] = step.rotation
        state.shift[body] = step.translation + step.rotation @ system.center[body] - system.center[body]
    assert np.abs(system.residual(state)).max() < 1e-12


def test_lines_that_miss_their_image_are_reported():
    """One line 0.05 m beside the mirror image of the other: both parts can move, so they are moved there."""
    at_rest = Pose(np.eye(3), np.zeros(3))
    found = analyse(mirrored_lines(at_rest, at_rest, slip=0.05))
    assert [gap.constraint for gap in found.gaps] == ["mirror"] and found.contradictory == []
    assert found.mobility == 8
