"""Constraints that bound a distance or an angle instead of stating it, at poses on either side and beyond half a turn."""

from __future__ import annotations

import math

import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.diagnostics import Outcome
from kinefab.model import RX, TX, Constraint, ConstraintKind, Feature, FeatureKind, Motion, Node, Scene
from kinefab.spatial import rotation_about

X, Y, Z = np.eye(3)
O = np.zeros(3)


def parts(*constraints) -> Scene:
    nodes = [Node("base", "base", grounded=True), Node("arm", "arm")]
    return Scene(nodes=nodes, constraints=list(constraints))


def at(node: int, kind: FeatureKind, direction=None, point=O) -> Feature:
    """The parts stand unturned in one place, so features are given in the world."""
    return Feature(node, kind, np.asarray(point, dtype=float), direction)


def hinge() -> Constraint:
    sides = at(0, FeatureKind.CIRCLE, Z), at(1, FeatureKind.CIRCLE, Z)
    return Constraint("hinge", ConstraintKind.INSERT, sides)


def slide() -> tuple[Constraint, Constraint]:
    return tuple(
        Constraint(f"flush {n}", ConstraintKind.COINCIDENT, (at(0, FeatureKind.PLANE, n), at(1, FeatureKind.PLANE, n)))
        for n in (X, Y)
    )  # fmt: skip


def turned(degrees: float) -> np.ndarray:
    return rotation_about(Z, math.radians(degrees)) @ X


def limits(scene: Scene, freedom: int) -> tuple[float, float]:
    """Of the arm against the base along or about +Z, from the exported pose."""
    found = analyse(scene)
    (joint,) = found.joints
    own, frame = joint.freedoms[freedom], found.source.pose(joint.a) @ joint.frame_a
    assert own.motion is Motion.LIMITED and "bound" in joint.because
    turn = 1.0 if (joint.b == 1) == (frame.rotation[2, 0] > 0.0) else -1.0
    low, high = sorted((turn * own.lower, turn * own.upper))
    return low, high


@pytest.mark.parametrize(
    ("normal", "reading", "lower", "upper"),
    [
        (Z, {}, 0.1, 0.4),
        (-Z, {}, 0.1, 0.4),  # the same distance, counted from the other face
        (Z, {"offset": "along_normal"}, 0.1, 0.4),
        (-Z, {"offset": "along_normal"}, -0.4, -0.1),
    ],
)
@pytest.mark.parametrize("other", [FeatureKind.PLANE, FeatureKind.POINT])
def test_a_bounded_distance_has_the_sign_of_the_exported_pose(normal, reading, lower, upper, other):
    """The arm stands 0.15 along +Z and may stand between 0.1 and 0.4, however the face below it is turned."""
    sides = (
        at(0, FeatureKind.PLANE, normal),
        at(1, other, Z if other is FeatureKind.PLANE else None, 0.15 * Z),
    )
    bound = Constraint("bound", ConstraintKind.DISTANCE, sides, lower=lower, upper=upper, reading=reading)
    assert limits(parts(*slide(), bound), TX) == pytest.approx((-0.05, 0.25))


def test_two_bounds_of_one_motion_leave_what_both_allow_and_one_that_leaves_nothing_is_told():
    """Of the arm 0.15 along +Z; a range whose ends were exchanged made a scene that the C# reader refuses."""
    sides = at(0, FeatureKind.PLANE, Z), at(1, FeatureKind.PLANE, Z, 0.15 * Z)

    def bounds(*ranges):
        named = [f"bound {i}" if i else "bound" for i in range(len(ranges))]
        kind = ConstraintKind.DISTANCE
        return parts(
            *slide(), *(Constraint(n, kind, sides, lower=a, upper=b) for n, (a, b) in zip(named, ranges))
        )

    assert limits(bounds((0.1, 0.4), (-0.2, 0.3)), TX) == pytest.approx((-0.05, 0.15))
    apart = bounds((0.1, 0.2), (0.3, 0.4))
    assert limits(apart, TX) == pytest.approx((-0.05, 0.05))
    (told,) = (o for o in analyse(apart).report.outcomes if o.feature == "constraint bound 1")
    assert (told.code, told.outcome) == ("CONSTRAINT_RANGE_EXCLUDED", Outcome.DROPPED)


@pytest.mark.parametrize(
    ("here", "lower", "upper", "axis", "reading", "expected"),
    [
        (30, 10, 80, None, {}, (-20, 50)),
        (-30, 10, 80, None, {}, (-50, 20)),  # the program shows 30 degrees
        (-30, -80, -10, None, {}, (-50, 20)),
        (200, 170, 260, Z, {}, (-30, 60)),  # beyond half a turn, where the pose reads -160
        (200, 170, 260, None, {"angle": "directed"}, (-30, 60)),
        (160, 100, 260, -Z, {}, (-60, 100)),  # about -Z it reads -160, or 200
        (-30, 300, 350, Z, {}, (-30, 20)),
        (10, -720, 720, Z, {}, (-730, 710)),
    ],
)
def test_a_bounded_angle_is_met_at_the_turn_and_on_the_side_of_its_range(
    here, lower, upper, axis, reading, expected
):
    """The arm's line stands ``here`` degrees from the base's; limits are counted from there about +Z."""
    sides = [at(0, FeatureKind.LINE, X), at(1, FeatureKind.LINE, turned(here))]
    if axis is not None:
        sides.append(at(0, FeatureKind.LINE, axis))
    ends = math.radians(lower), math.radians(upper)
    bound = Constraint(
        "bound", ConstraintKind.ANGLE, tuple(sides), lower=ends[0], upper=ends[1], reading=reading
    )
    found = np.degrees(limits(parts(hinge(), bound), RX))
    assert found == pytest.approx(expected)


@pytest.mark.parametrize("here", [20, 160])
def test_a_bounded_angle_between_a_plane_and_a_line_bounds_the_tilt_and_fixes_nothing(here):
    """The line leaves the plane by 20 degrees and may by 5 to 60, leaning to either side."""
    sides = at(0, FeatureKind.PLANE, Y), at(1, FeatureKind.LINE, turned(here))
    ends = math.radians(5), math.radians(60)
    bound = Constraint("bound", ConstraintKind.ANGLE, sides, lower=ends[0], upper=ends[1])
    scene = parts(hinge(), bound)
    assert analyse(scene).mobility == 1
    expected = (-15, 40) if here < 90 else (-40, 15)
    assert np.degrees(limits(scene, RX)) == pytest.approx(expected)


@pytest.mark.parametrize(
    ("kind", "sides", "mobility", "outcome"),
    [
        (ConstraintKind.DISTANCE, (at(0, FeatureKind.POINT), at(1, FeatureKind.POINT, None, X)), 6, "dropped"),
        (ConstraintKind.DISTANCE, (at(0, FeatureKind.LINE, Z), at(1, FeatureKind.POINT, None, X)), 6, "dropped"),
        (ConstraintKind.ANGLE, (at(0, FeatureKind.PLANE, Z), at(1, FeatureKind.LINE, X + Z)), 6, "dropped"),
        (ConstraintKind.PARALLEL, (at(0, FeatureKind.LINE, Z), at(1, FeatureKind.LINE, Z)), 4, "approximated"),
    ],
)  # fmt: skip
def test_bounds_of_what_no_joint_counts_are_told(kind, sides, mobility, outcome):
    """They remove nothing; the constraint's own rows stay where it has some."""
    found = analyse(parts(Constraint("bound", kind, sides, lower=0.1, upper=0.4)))
    assert found.mobility == mobility
    assert [d.code for d in found.report.diagnostics if d.code.startswith("CONSTRAINT")] == [
        "CONSTRAINT_RANGE_DROPPED"
    ]
    assert [o.outcome for o in found.report.outcomes if o.feature == "constraint bound"] == [Outcome(outcome)]
