"""Wrong data gives a diagnostic that names the constraint, never a wrong joint in silence."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.diagnostics import Severity
from kinefab.model import Constraint, Feature, Joint, JointKind, Node, NodeKind, Scene, Sense, freedoms_of
from kinefab.model import ConstraintKind as C
from kinefab.model import FeatureKind as F
from kinefab.spatial import Pose
from mechanism_cases import scene

X, Y, Z = np.eye(3)


def two_parts(*constraints) -> Scene:
    nodes = [
        Node("base", "base", grounded=True),
        Node("part", "part", pose=Pose(np.eye(3), np.array([0.1, 0.2, 0.3]))),
    ]
    return Scene(nodes=nodes, constraints=list(constraints))


def on(node, kind, world, direction=None, **more) -> Feature:
    """A feature given in the world on one of the two parts."""
    return Feature(
        node,
        kind,
        np.asarray(world, dtype=float) - (np.array([0.1, 0.2, 0.3]) if node == 1 else 0.0),
        direction,
        **more,
    )


def planes(id, kind, normal_a, normal_b, **more) -> Constraint:
    return Constraint(
        id, kind, (on(0, F.PLANE, (0, 0, 0), normal_a), on(1, F.PLANE, (0, 0, 0), normal_b)), **more
    )


def codes(found) -> list[str]:
    return [d.code for d in found.report.diagnostics]


def test_contradictory_distances_are_named():
    """Two distances between the same planes cannot both hold."""
    near, far = planes("near", C.DISTANCE, Z, Z, value=0.1), planes("far", C.DISTANCE, Z, Z, value=0.2)
    found = analyse(two_parts(near, far))
    (error,) = found.report.of(Severity.ERROR)
    assert error.code == "CONSTRAINTS_CONTRADICT" and "near" in error.message and "far" in error.message
    assert sorted(found.contradictory) == ["far", "near"]


def test_parallel_planes_asked_to_be_perpendicular_are_named():
    """Planes that one constraint makes parallel and another perpendicular contradict each other."""
    found = analyse(two_parts(planes("flush", C.COINCIDENT, Z, Z), planes("square", C.PERPENDICULAR, Z, Z)))
    assert "CONSTRAINTS_CONTRADICT" in codes(found)
    assert "square" in found.contradictory


def test_a_single_unsatisfied_constraint_is_a_gap():
    """Planes that stand parallel and are only asked to be perpendicular have a gap of 90 degrees."""
    found = analyse(two_parts(planes("square", C.PERPENDICULAR, Z, Z)))
    (gap,) = found.gaps
    assert gap.constraint == "square" and gap.degrees == pytest.approx(90.0)


@pytest.mark.parametrize("degrees", [10.0, 80.0, 170.0])
def test_an_angle_asked_of_axes_that_stand_parallel_is_a_gap(degrees):
    """There its rate vanishes, so that no step of the solver leads off; the pose beside it closes."""
    axes = (on(0, F.LINE, (0, 0, 0), Z), on(1, F.LINE, (0.1, 0.2, 0.3), Z))
    tilt = Constraint("tilt", C.ANGLE, axes, value=np.radians(degrees))
    found = analyse(two_parts(tilt))
    assert found.report.of(Severity.ERROR) == [] and found.contradictory == []
    (gap,) = found.gaps
    assert gap.constraint == "tilt" and gap.degrees == pytest.approx(degrees)
    assert sum(island.mobility for island in found.islands) == 5
    turned = found.scene(solved=True).nodes[1].pose.rotation
    assert np.degrees(np.arccos(turned[2, 2])) == pytest.approx(degrees, abs=1e-6)


def test_axis_of_no_length_is_an_error():
    """A line without a direction is refused by name; the rest is still analysed."""
    bad = Constraint("bad", C.PARALLEL, (on(0, F.LINE, (0, 0, 0), Z), on(1, F.LINE, (0, 0, 0), 0.0 * Z)))
    found = analyse(two_parts(bad, planes("mate", C.COINCIDENT, Z, Z)))
    assert codes(found) == ["CONSTRAINT_AXIS_ZERO"] and "bad" in found.report.diagnostics[0].message
    assert [j.kind for j in found.joints] == [JointKind.PLANAR]


def test_number_that_is_not_finite_is_an_error():
    """NaN in a feature or a value never reaches a joint."""
    bad = planes("bad", C.DISTANCE, Z, Z, value=float("nan"))
    assert codes(analyse(two_parts(bad))) == ["CONSTRAINT_NOT_FINITE"]


def test_part_constrained_to_itself_is_an_error():
    """Both sides on one part say nothing about motion."""
    bad = Constraint("bad", C.COINCIDENT, (on(1, F.POINT, (0, 0, 0)), on(1, F.POINT, (0, 0, 1))))
    assert codes(analyse(two_parts(bad))) == ["CONSTRAINT_WITH_ITSELF"]


def test_missing_part_is_an_error():
    """A constraint on a part that is not there is refused by name."""
    bad = Constraint("bad", C.COINCIDENT, (on(0, F.POINT, (0, 0, 0)), Feature(7, F.POINT, np.zeros(3))))
    assert codes(analyse(two_parts(bad))) == ["CONSTRAINT_NODE_MISSING"]


def test_missing_side_is_an_error():
    """A constraint with one side only is refused by name."""
    bad = Constraint("bad", C.COINCIDENT, (on(0, F.POINT, (0, 0, 0)),))
    assert codes(analyse(two_parts(bad))) == ["CONSTRAINT_FEATURES_MISSING"]


@pytest.mark.parametrize("kind", [k for k in C if k not in (C.ANGLE, C.SYMMETRY)])
def test_a_third_side_that_a_kind_has_no_use_for_changes_nothing(kind):
    """Such as what is left of a gear's carrier when its kind was changed."""
    sides = on(0, F.LINE, (0, 0, 0), Z), on(1, F.LINE, (0, 0, 0), Z)
    two = Constraint("c", kind, sides, value=0.5)
    three = replace(two, features=(*sides, on(0, F.PLANE, (0, 0, 0), Z)))
    assert analyse(two_parts(three)).mobility == analyse(two_parts(two)).mobility


@pytest.mark.parametrize("closures", list(Closures))
def test_a_rod_between_points_that_others_hold_together_is_a_contradiction(closures):
    """It has no direction, from which no body can be made that stands for it."""
    sides = [(on(0, F.POINT, at), on(1, F.POINT, at)) for at in ((0, 0, 0), *np.eye(3))]
    constraints = [Constraint(f"c{i}", C.COINCIDENT, both) for i, both in enumerate(sides[1:])]
    constraints.append(Constraint("rod", C.DISTANCE, sides[0], value=0.5))
    found = analyse(two_parts(*constraints), AnalysisOptions(closures))
    assert "CONSTRAINTS_CONTRADICT" in codes(found)


def test_unknown_pairing_and_unknown_kind_are_dropped_with_a_warning():
    """What has no equations is reported dropped, and removes nothing."""
    point_angle = Constraint("angle", C.ANGLE, (on(0, F.POINT, (0, 0, 0)), on(1, F.POINT, (0, 0, 0))))
    path = Constraint(
        "path", C.OTHER, (on(0, F.BODY, (0, 0, 0)), on(1, F.BODY, (0, 0, 0))), raw_kind="PathMate"
    )
    found = analyse(two_parts(point_angle, path))
    assert sorted(codes(found)) == ["CONSTRAINT_NOT_INTERPRETED", "CONSTRAINT_PAIRING_UNKNOWN"]
    assert found.mobility == 6 and found.joints == []


def test_directions_the_wrong_way_round_are_a_gap_of_half_a_turn():
    """Aligned normals that stand opposed satisfy every row; the sense does not."""
    found = analyse(two_parts(replace(planes("mate", C.COINCIDENT, Z, -Z), sense=Sense.ALIGNED)))
    (gap,) = found.gaps
    assert gap.degrees == pytest.approx(180.0)


def test_ten_thousand_constraints_between_one_pair_make_one_joint():
    """Repeating a mate ten thousand times is slow for nobody and counted as redundant."""
    many = [replace(planes("mate", C.COINCIDENT, Z, Z), id=f"mate:{i}") for i in range(10_000)]
    begin = time.perf_counter()
    found = analyse(two_parts(*many))
    assert time.perf_counter() - begin < 60.0
    assert (found.rows, found.rank) == (30_000, 3)
    assert [j.kind for j in found.joints] == [JointKind.PLANAR]
    assert "CONSTRAINTS_MANY" in codes(found)


def test_a_joint_and_the_constraints_that_make_it_count_once():
    """A bundle with an explicit hinge and its insert has five rows, one joint, no redundancy."""
    source = scene("P03")
    at = np.array([0.1, -0.2, 0.3])
    axes = np.column_stack([Z, X, Y])
    hinge = Joint(
        "hinge",
        JointKind.REVOLUTE,
        0,
        1,
        Pose(axes, at),
        source.nodes[1].pose.inverse() @ Pose(axes, at),
        freedoms_of(JointKind.REVOLUTE),
    )
    found = analyse(replace(source, joints=[hinge]))
    assert (found.rows, found.redundant, found.mobility) == (5, 0, 1)
    assert [j.id for j in found.joints] == ["hinge"] and found.joints[0].because == ("insert:1",)


def test_a_joint_that_its_constraints_contradict_in_freedoms_is_reported():
    """A cylindrical joint beside an insert: the constraints remove more, both count, a warning says so."""
    source = scene("P03")
    at = np.array([0.1, -0.2, 0.3])
    axes = np.column_stack([Z, X, Y])
    joint = Joint(
        "tube",
        JointKind.CYLINDRICAL,
        0,
        1,
        Pose(axes, at),
        source.nodes[1].pose.inverse() @ Pose(axes, at),
        freedoms_of(JointKind.CYLINDRICAL),
    )
    found = analyse(replace(source, joints=[joint]))
    assert codes(found) == ["JOINT_CONSTRAINTS_DISAGREE"]
    assert [(j.id, j.kind) for j in found.joints] == [("tube", JointKind.REVOLUTE)] and found.mobility == 1


def test_an_empty_scene_has_no_mobility():
    """Nothing in, nothing out, no traceback."""
    found = analyse(Scene())
    assert (found.mobility, found.joints, found.islands) == (0, [], [])


def test_a_part_without_constraints_keeps_six_freedoms():
    """A loose part floats."""
    found = analyse(two_parts())
    assert found.mobility == 6
    assert [(len(f.translations), len(f.rotations)) for f in found.freedoms] == [(0, 0), (3, 3)]


def test_a_flexible_assembly_in_another_adds_no_freedoms():
    """Nested assemblies that may move in themselves are no bodies: the hinge below them is all that moves."""
    source = scene("P03")
    above = [
        Node("top", "top", NodeKind.ASSEMBLY, flexible=True),
        Node("sub", "sub", NodeKind.ASSEMBLY, parent=0, flexible=True),
    ]
    below = [replace(n, parent=1) for n in source.nodes]
    moved = [
        replace(c, features=tuple(replace(f, node=f.node + 2) for f in c.features))
        for c in source.constraints
    ]
    found = analyse(Scene(nodes=above + below, constraints=moved))
    assert (found.mobility, found.rank, [j.kind for j in found.joints]) == (1, 5, [JointKind.REVOLUTE])
