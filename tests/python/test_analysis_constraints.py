"""The constraint library: rows, rank and Jacobian of every pairing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from derivatives import check_derivative
from hypothesis import given, settings
from kinefab.analysis import analyse
from kinefab.analysis.equations.scene_equations import equations_of
from kinefab.analysis.freedom.rank import factored
from kinefab.analysis.freedom.twists import twist_space
from kinefab.diagnostics import Report
from kinefab.model import Constraint, Feature, JointKind, Node, Scene, Side
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from kinefab.spatial import Pose, frame_from_axes, rotation_about
from mechanism_cases import table
from strategies import random_pose, seeds

R = 0.13


def geometry(kind, frame: Pose, radius=0.0, half_angle=0.0):
    """A feature in the world: z of ``frame`` is its direction."""
    bare = kind in (F.POINT, F.SPHERE)
    return (
        kind,
        frame.translation,
        None if bare else frame.rotation[:, 2],
        frame.rotation[:, 0] if kind is F.FRAME else None,
        radius,
        half_angle,
    )


def shifted(frame: Pose, x=0.0, y=0.0, z=0.0, turn=None, about=2) -> Pose:
    """``frame`` moved along its own axes, then turned about one of them."""
    axis = np.eye(3)[about]
    local = Pose(np.eye(3) if turn is None else rotation_about(axis, turn), np.array([x, y, z]))
    return frame @ local


def z_towards(frame: Pose, direction) -> Pose:
    """A frame at the same place whose z is a direction given in ``frame``."""
    axes = frame_from_axes(frame.rotation @ np.asarray(direction, dtype=float))
    return Pose(np.column_stack([axes[:, 1], axes[:, 2], axes[:, 0]]), frame.translation)


def case(elements, relation, rng):
    """(kind, geometry of a, geometry of b, constraint fields) that satisfies a row of the table."""
    f = random_pose(rng)
    spin = rng.uniform(0.5, 2.5)
    slid = shifted(f, z=0.37, turn=spin)
    in_plane = shifted(f, x=0.4, y=-0.23, turn=spin)
    lying = z_towards(in_plane, (math.cos(0.8), math.sin(0.8), 0.0))
    tilted = z_towards(shifted(f, 0.3, 0.2, -0.4), (math.sin(0.6), 0.0, math.cos(0.6)))
    pair = tuple(F(e) if e != "body" else F.FRAME for e in elements)
    free = {
        "parallel": (C.PARALLEL, f, shifted(f, 0.3, 0.2, 0.5, spin), {}),
        "perpendicular": (
            C.PERPENDICULAR,
            f,
            z_towards(shifted(f, 0.3, 0.2, 0.5), (math.cos(1.1), math.sin(1.1), 0.0)),
            {},
        ),
        "angle": (C.ANGLE, f, tilted, {"value": 0.6}),
    }
    by_pair = {
        (("point", "point"), "coincident"): (
            C.COINCIDENT,
            f,
            Pose(random_pose(rng).rotation, f.translation),
            {},
        ),
        (("point", "point"), "distance"): (C.DISTANCE, f, shifted(f, 0.3), {"value": 0.3}),
        (("line", "point"), "coincident"): (C.COINCIDENT, f, slid, {}),
        (("line", "point"), "distance"): (C.DISTANCE, f, shifted(f, x=0.3, z=0.2), {"value": 0.3}),
        (("plane", "point"), "coincident"): (C.COINCIDENT, f, in_plane, {}),
        (("plane", "point"), "distance"): (C.DISTANCE, f, shifted(f, 0.2, 0.1, -0.3), {"value": 0.3}),
        (("line", "line"), "coincident"): (C.COINCIDENT, f, slid, {}),
        (("line", "line"), "intersect"): (
            C.DISTANCE,
            f,
            z_towards(shifted(f, z=0.3), (0.6, 0.0, 0.8)),
            {"value": 0.0, "reading": {"line_line_distance": "skew"}},
        ),
        (("line", "line"), "distance (skew)"): (
            C.DISTANCE,
            f,
            z_towards(shifted(f, y=0.3, z=0.2), (0.6, 0.0, 0.8)),
            {"value": 0.3},
        ),
        (("line", "line"), "distance (parallel)"): (
            C.DISTANCE,
            f,
            shifted(f, 0.3, 0.0, 0.2, spin),
            {"value": 0.3},
        ),
        (("plane", "line"), "coincident"): (C.COINCIDENT, f, lying, {}),
        (("plane", "line"), "parallel"): (
            C.PARALLEL,
            f,
            z_towards(shifted(f, 0, 0, 0.4), (0.6, 0.8, 0.0)),
            {},
        ),
        (("plane", "line"), "angle"): (C.ANGLE, f, tilted, {"value": math.pi / 2 - 0.6}),
        (("plane", "line"), "perpendicular"): (C.PERPENDICULAR, f, shifted(f, 0.1, 0.2, 0.3, spin), {}),
        (("plane", "line"), "distance"): (
            C.DISTANCE,
            f,
            z_towards(shifted(f, 0, 0, 0.3), (0.6, 0.8, 0.0)),
            {"value": 0.3},
        ),
        (("plane", "plane"), "mate/flush (coincident)"): (C.COINCIDENT, f, in_plane, {}),
        (("plane", "plane"), "distance"): (C.DISTANCE, f, shifted(in_plane, z=0.3), {"value": 0.3}),
        (("plane", "sphere"), "tangent"): (C.TANGENT, f, shifted(f, 0.2, 0.1, R), {}),
        (("sphere", "sphere"), "tangent"): (C.TANGENT, f, shifted(f, 2 * R), {}),
        (("sphere", "sphere"), "concentric"): (C.CONCENTRIC, f, f, {}),
        (("cylinder", "sphere"), "tangent"): (C.TANGENT, f, shifted(f, 2 * R, 0.0, 0.4), {}),
        (("cylinder", "sphere"), "concentric"): (C.CONCENTRIC, f, slid, {}),
        (("plane", "cylinder"), "tangent"): (
            C.TANGENT,
            f,
            z_towards(shifted(f, 0.2, 0.1, R), (0.6, 0.8, 0.0)),
            {},
        ),
        (("cylinder", "cylinder"), "tangent (parallel)"): (
            C.TANGENT,
            f,
            shifted(f, 2 * R, 0.0, 0.4, spin),
            {},
        ),
        (("cylinder", "cylinder"), "tangent (skew)"): (
            C.TANGENT,
            f,
            z_towards(shifted(f, 0.0, 2 * R, 0.4), (0.6, 0.0, 0.8)),
            {},
        ),
        (("plane", "cone"), "tangent"): (C.TANGENT, f, z_towards(f, (math.cos(0.4), 0.0, math.sin(0.4))), {}),
        (("plane", "circle"), "tangent (edge)"): (
            C.TANGENT,
            f,
            z_towards(shifted(f, 0.1, 0.2, R * math.sin(0.7)), (math.sin(0.7), 0.0, math.cos(0.7))),
            {},
        ),
        (("cylinder", "cylinder"), "concentric"): (C.CONCENTRIC, f, slid, {}),
        (("circle", "circle"), "concentric"): (C.CONCENTRIC, f, slid, {}),
        (("circle", "circle"), "insert"): (C.INSERT, f, shifted(f, turn=spin), {}),
        (("circle", "circle"), "insert + lock rotation"): (
            C.INSERT,
            f,
            shifted(f, turn=spin),
            {"lock_rotation": True},
        ),
        (("body", "body"), "lock/rigid/fastened"): (C.LOCK, f, f, {}),
        (("body", "body"), "lock orientation"): (
            C.LOCK_ORIENTATION,
            f,
            Pose(f.rotation, f.translation + 0.3),
            {},
        ),
        (("body", "body"), "slider"): (C.SLIDER, f, shifted(f, z=0.3), {}),
        (("body", "body"), "pin-slot"): (C.PIN_SLOT, f, shifted(f, x=0.3, turn=spin), {}),
        (("body", "body"), "universal"): (C.UNIVERSAL, f, z_towards(f, (0.6, 0.8, 0.0)), {}),
        (("body", "body"), "screw"): (C.SCREW, f, f, {"value": 0.05}),
    }
    kind, a, b, fields = by_pair.get((tuple(elements), relation)) or free[relation.split()[0]]
    sized = [
        geometry(k, p, R if k in (F.SPHERE, F.CYLINDER, F.CIRCLE) else 0.0, 0.4 if k is F.CONE else 0.0)
        for k, p in zip(pair, (a, b))
    ]
    return kind, *sized, fields


def scene_with(kind, a, b, fields, rng=None, third=None) -> Scene:
    """Two parts at random poses with one constraint whose geometry is given in the world."""
    rng = rng or np.random.default_rng(3)
    poses = [random_pose(rng), random_pose(rng)]
    nodes = [Node("a", "a", pose=poses[0], grounded=True), Node("b", "b", pose=poses[1])]

    def feature(node, g):
        shape, p, z, x, radius, half_angle = g
        inverse = poses[node].inverse()
        turn = lambda v: None if v is None else inverse.direction(v)  # noqa: E731
        return Feature(node, shape, inverse.point(p), turn(z), turn(x), radius, half_angle)

    features = [feature(0, a), feature(1, b)] + ([feature(0, third)] if third else [])
    return Scene(nodes=nodes, constraints=[Constraint("c", kind, tuple(features), **fields)])


ROWS = table("constraint_rows")


@pytest.mark.parametrize("row", ROWS, ids=[f"{r['elemA']}-{r['elemB']}-{r['relation']}" for r in ROWS])
def test_pairing_has_the_rows_and_the_rest_of_the_table(row):
    """Rows, freedoms left and their rotational and translational parts, at three random places."""
    for seed in range(3):
        rng = np.random.default_rng(seed)
        scene = scene_with(*case((row["elemA"], row["elemB"]), row["relation"], rng), rng)
        report = Report()
        equations = equations_of(scene, report)
        system = equations.system
        system.length[:] = 0.5
        residual, _, block = system.linearise(system.start())
        assert np.abs(residual).max() < 1e-12 and not report.diagnostics
        assert system.rows == int(row["rows"])
        stacked = np.zeros((system.rows, 6))
        np.add.at(stacked, system.row, block)
        rank, _, vt = factored(stacked)
        assert (rank, 6 - rank) == (int(row["dof_removed"]), int(row["dof_left"]))
        space = twist_space(vt[rank:].T, np.zeros(3), 0.5, np.eye(3))
        assert (space.r, space.t) == (int(row["r"]), int(row["t"]))


@settings(max_examples=40, deadline=None)
@given(seeds)
def test_jacobian_is_the_derivative_of_the_residual(seed):
    """Every kind's analytic Jacobian agrees with central differences away from where it is satisfied."""
    rng = np.random.default_rng(seed)
    row = ROWS[int(rng.integers(len(ROWS)))]
    scene = scene_with(*case((row["elemA"], row["elemB"]), row["relation"], rng), rng)
    check_derivative(scene, rng)


@settings(max_examples=15, deadline=None)
@given(seeds)
def test_coupled_rows_have_the_right_derivative_too(seed):
    """Gear, rack and symmetry rows hold several atoms; their sum's Jacobian agrees with differences."""
    rng = np.random.default_rng(seed)
    f = random_pose(rng)
    other = shifted(f, 0.3, 0.1, 0.2)
    kind = [C.GEAR, C.RACK, C.LINEAR, C.SYMMETRY][int(rng.integers(4))]
    if kind is C.SYMMETRY:
        mirrored = f.point(np.array([0.3, 0.1, -0.2]))
        scene = scene_with(
            kind,
            geometry(F.POINT, shifted(f, 0.3, 0.1, 0.2)),
            geometry(F.POINT, Pose(f.rotation, mirrored)),
            {},
            rng,
            geometry(F.PLANE, f),
        )
    else:
        scene = scene_with(kind, geometry(F.LINE, f), geometry(F.LINE, other), {"value": -0.4}, rng)
    check_derivative(scene, rng)


def test_one_vendors_distance_of_lines_is_three_rows_and_anothers_one():
    """The reading of a line-line distance decides between skew and parallel lines."""
    rng = np.random.default_rng(5)
    f = random_pose(rng)
    lines = geometry(F.LINE, f), geometry(F.LINE, shifted(f, 0.3))
    rows = {}
    for reading in ("parallel", "skew"):
        fields = {"value": 0.3, "reading": {"line_line_distance": reading}}
        rows[reading] = equations_of(scene_with(C.DISTANCE, *lines, fields), Report()).system.rows
    assert rows == {"parallel": 3, "skew": 1}


@pytest.mark.parametrize("radii", [(0.3, 0.2), (0.2, 0.3)])
@pytest.mark.parametrize(("side", "apart"), [(Side.OUTSIDE, 0.5), (Side.INSIDE, 0.1)])
def test_tangent_spheres_touch_from_the_stated_side(side, apart, radii):
    """Spheres of 0.3 and 0.2 touch outside at 0.5 and inside at 0.1, whichever is the larger."""
    f = Pose(np.eye(3), np.array([0.1, 0.2, 0.3]))
    scene = scene_with(
        C.TANGENT,
        geometry(F.SPHERE, f, radii[0]),
        geometry(F.SPHERE, shifted(f, apart), radii[1]),
        {"side": side},
    )
    found = analyse(scene)
    assert found.gaps == [] and found.mobility == 5


@pytest.mark.parametrize(("side", "height"), [(Side.OUTSIDE, 0.2), (Side.INSIDE, -0.2)])
def test_a_sphere_touches_a_plane_on_the_stated_side(side, height):
    """Outside is where the normal points."""
    f = random_pose(np.random.default_rng(7))
    there = Pose(f.rotation, f.point(np.array([0.3, -0.1, height])))
    scene = scene_with(C.TANGENT, geometry(F.PLANE, f), geometry(F.SPHERE, there, 0.2), {"side": side})
    system = equations_of(scene, Report()).system
    assert np.abs(system.residual(system.start())).max() < 1e-12


@pytest.mark.parametrize("lead", [0.01, -0.004])
def test_a_screw_of_positive_lead_is_right_handed(lead):
    """Turned as the right hand's fingers about the axis it goes along it, as a joint's lead says it too."""
    f = random_pose(np.random.default_rng(8))
    scene = scene_with(C.SCREW, geometry(F.LINE, f), geometry(F.LINE, f), {"value": lead})
    (joint,) = analyse(scene).joints
    assert joint.kind is JointKind.SCREW and joint.lead == pytest.approx(lead)


def test_angle_zero_between_axes_needs_a_reference_or_a_common_axis():
    """An angle of zero about a common axis is one row; without an axis it is two, parallel directions."""
    f = Pose(np.eye(3), np.array([0.1, 0.2, 0.3]))
    x_axis = z_towards(f, (1, 0, 0))
    bare = scene_with(C.ANGLE, geometry(F.PLANE, x_axis), geometry(F.PLANE, x_axis), {"value": 0.0})
    assert equations_of(bare, Report()).system.rows == 2
    with_vector = scene_with(
        C.ANGLE,
        geometry(F.PLANE, x_axis),
        geometry(F.PLANE, x_axis),
        {"value": 0.0},
        third=geometry(F.LINE, f),
    )
    assert equations_of(with_vector, Report()).system.rows == 1
