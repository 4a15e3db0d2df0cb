"""Symmetry that only two bodies have a part in, as a width mate states it: a joint of the pair."""

from __future__ import annotations

import numpy as np
import pytest
from exported_components import components
from hypothesis import given, settings
from kinefab.analysis import analyse
from kinefab.model import Constraint, Feature, Node, Scene
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from kinefab.spatial import Pose
from strategies import random_direction, random_pose, seeds
from test_analysis_components import worst_violation


def width(rng, sides, feature, grounded):
    """A slot centred on a tab, or a part mirrored in a plane of the other or of itself, at any pose.

    sides: parts of the two sides and of the plane; part 3 is fixed to part 2.  grounded: parts on the ground.
    """
    nodes = [Node("base", "base", grounded=True)]
    nodes += [Node(n, n, pose=random_pose(rng), grounded=i in grounded) for i, n in enumerate("abc", 1)]
    middle, (normal, *_) = rng.uniform(-1, 1, 3), np.linalg.qr(rng.normal(size=(3, 3)))[0].T
    aside, along = 0.3 * normal, np.cross(normal, random_direction(rng)) if feature is F.LINE else normal

    def on(node, kind, at, direction=None):
        inwards = nodes[node].pose.inverse()
        return Feature(
            node, kind, inwards.point(at), None if direction is None else inwards.direction(direction)
        )

    direction = None if feature is F.POINT else along / np.linalg.norm(along)
    points = (middle + aside, middle - aside)
    named = (on(node, feature, at, direction) for node, at in zip(sides, points))
    fixed = Constraint("fixed", C.LOCK, (Feature(2, F.BODY, np.zeros(3)), Feature(3, F.BODY, np.zeros(3))))
    mate = Constraint("width", C.SYMMETRY, (*named, on(sides[2], F.PLANE, middle, normal)))
    return Scene(nodes=nodes, constraints=[mate, fixed])


@pytest.mark.parametrize("grounded", [(), (1,), (2,)])
@pytest.mark.parametrize(
    ("sides", "feature", "kind"),
    [
        ((2, 2, 1), F.PLANE, "planar"),
        *(((2, 1, plane), F.PLANE, "planar") for plane in (1, 2)),
        *(((2, 1, plane), F.LINE, "cylindrical") for plane in (1, 2)),
        *(((2, 1, plane), F.POINT, "spherical") for plane in (1, 2)),
        ((2, 1, 3), F.PLANE, "planar"),
        ((3, 2, 1), F.PLANE, "planar"),
    ],
)
@settings(max_examples=3, deadline=None)
@given(seeds)
def test_a_symmetry_of_two_bodies_is_a_joint(sides, feature, kind, grounded, seed):
    """A width mate, and a plane that moves as one with a side, by the source's word or by a lock: one joint, exactly."""
    rng = np.random.default_rng(seed)
    found = analyse(width(rng, sides, feature, grounded))
    (joint,) = (j for j in found.joints if "width" in j.because)
    assert joint.kind.value == kind and found.couplings == [] and found.gaps == []
    assert {o.outcome.value for o in found.report.outcomes} == {"kept"}
    assert found.mobility == len(joint.unlocked) + 6 * (not grounded)
    if grounded:
        moved, parts = components(found)
        assert worst_violation(found, parts, moved, rng) < 1e-9


def test_a_symmetry_between_grounded_parts_is_one_with_the_ground():
    """Plane and one side on two grounded parts: the other side's part slides on the plane of both."""
    x = np.eye(3)[0]
    nodes = [Node("tab", "tab", grounded=True), Node("wall", "wall", grounded=True), Node("slot", "slot")]
    features = (Feature(n, F.PLANE, at * x, x) for n, at in ((1, 0.3), (2, -0.3), (0, 0.0)))
    found = analyse(Scene(nodes=nodes, constraints=[Constraint("width", C.SYMMETRY, tuple(features))]))
    (joint,) = found.joints
    assert (joint.kind.value, joint.because, found.mobility) == ("planar", ("width",), 3)


def test_a_symmetry_within_one_part_is_with_itself():
    x = np.eye(3)[0]
    features = (Feature(1, F.PLANE, at * x, x) for at in (0.3, -0.3, 0.0))
    nodes = [Node("base", "base", grounded=True), Node("a", "a")]
    found = analyse(Scene(nodes=nodes, constraints=[Constraint("width", C.SYMMETRY, tuple(features))]))
    assert [o.code for o in found.report.outcomes] == ["CONSTRAINT_WITH_ITSELF"]


@pytest.mark.parametrize("hung", [0, 35])
@pytest.mark.parametrize("seed", range(3))
def test_a_row_whose_parts_cancel_holds_nothing(seed, hung):
    """Two faces of grounded parts in one plane and a part's mid-plane square to them: of the three rows of their symmetry one
    is left.  That of the distances comes to nothing but a rounding, which was taken for a row.  hung: parts of a chain from
    there to the ground, pinned at points, so that the block is a large one."""
    rng = np.random.default_rng(seed)
    nodes = [Node(str(i), str(i), pose=random_pose(rng), grounded=i == 0) for i in range(2 + hung)]
    face, normal, along = np.linalg.qr(rng.normal(size=(3, 3)))[0].T

    def on(node, kind, at, direction=None):
        inwards = Pose() if node is None else nodes[node].pose.inverse()
        return Feature(
            node, kind, inwards.point(at), None if direction is None else inwards.direction(direction)
        )

    first, second = (rng.uniform(-1, 1) * normal + rng.uniform(-1, 1) * along for _ in range(2))
    sides = on(None, F.PLANE, first, face), on(0, F.PLANE, second, face)
    constraints = [Constraint("mate", C.SYMMETRY, (*sides, on(1, F.PLANE, rng.uniform(-1, 1, 3), normal)))]
    for i in range(1, 2 + hung if hung else 1):
        at = rng.uniform(-1, 1, 3)
        pin = on(i, F.POINT, at), on(i + 1 if i < 1 + hung else None, F.POINT, at)
        constraints.append(Constraint(f"pin {i}", C.COINCIDENT, pin))
    found = analyse(Scene(nodes=nodes, constraints=constraints))
    expected = 6 * (1 + hung) - 1 - 3 * (len(constraints) - 1)
    assert (found.mobility, found.first_order) == (expected, expected)
