"""Names, order, sides, place and unit change nothing; small noise no class; large noise is reported."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mechanism_cases import all_ids, analysed, scene
from strategies import random_pose, seeds

from kinefab.analysis import analyse
from kinefab.model import Constraint, ConstraintKind, Feature, Scene
from kinefab.spatial import Pose, rotation_exp

IDS = st.sampled_from([id for id in all_ids() if id not in ("M40", "M17")])
SENSITIVE = (ConstraintKind.PIN_SLOT, ConstraintKind.GEAR, ConstraintKind.RACK, ConstraintKind.LINEAR)
"""Constraints whose two sides play different roles."""


def summary(found) -> tuple:
    """What must not change: the counts, and each part's freedoms and each joint's kind."""
    names = Counter(j.kind.value for j in found.joints if not j.closure)
    freedoms = sorted((len(f.translations), len(f.rotations)) for f in found.freedoms)
    return (
        found.mobility,
        found.first_order,
        found.rows,
        found.rank,
        len(found.joints),
        sum(j.closure for j in found.joints),
        freedoms,
        sorted(names.items()),
    )


def transformed(source: Scene, by: Pose, scale: float = 1.0) -> Scene:
    """Everything moved by a pose and measured in another unit."""

    def feature(f: Feature) -> Feature:
        return replace(f, point=f.point * scale, radius=f.radius * scale)

    def constraint(c: Constraint) -> Constraint:
        length = c.kind in (
            ConstraintKind.DISTANCE,
            ConstraintKind.SCREW,
            ConstraintKind.RACK,
            ConstraintKind.INSERT,
        )
        return replace(
            c, features=tuple(map(feature, c.features)), value=c.value * (scale if length else 1.0)
        )

    nodes = [replace(n, pose=by @ Pose(n.pose.rotation, n.pose.translation * scale)) for n in source.nodes]
    return replace(source, nodes=nodes, constraints=[constraint(c) for c in source.constraints])


def reordered(source: Scene, rng) -> Scene:
    """Parts and constraints in another order and under other names."""
    order = rng.permutation(len(source.nodes))
    number = {int(old): new for new, old in enumerate(order)}
    nodes = [replace(source.nodes[i], id=f"n{k}", name=f"n{k}") for k, i in enumerate(order)]
    constraints = [
        replace(c, id=f"c{k}", features=tuple(replace(f, node=number[f.node]) for f in c.features))
        for k, c in enumerate(source.constraints)
    ]
    return replace(
        source, nodes=nodes, constraints=[constraints[i] for i in rng.permutation(len(constraints))]
    )


def swapped(source: Scene) -> Scene:
    """The two sides of each constraint exchanged, where they mean the same."""

    def turn(c: Constraint) -> Constraint:
        if c.kind in SENSITIVE:
            return c
        return replace(c, features=(c.features[1], c.features[0], *c.features[2:]))

    return replace(source, constraints=[turn(c) for c in source.constraints])


def shaken(source: Scene, size: float, rng) -> Scene:
    """Every pose but ground's with an error of ``size`` (metres, radians)."""
    nodes = [
        n
        if n.grounded
        else replace(
            n,
            pose=Pose(
                rotation_exp(size * rng.uniform(-1, 1, 3)) @ n.pose.rotation,
                n.pose.translation + size * rng.uniform(-1, 1, 3),
            ),
        )
        for n in source.nodes
    ]
    return replace(source, nodes=nodes)


@settings(max_examples=25, deadline=None)
@given(IDS, seeds, st.sampled_from([1.0, 1e-3, 1e-2, 0.0254, 1e3]))
def test_place_and_unit_change_nothing(id, seed, scale):
    """The same assembly anywhere and in any unit has the same freedoms and joints."""
    placed = random_pose(np.random.default_rng(seed), 3.0 * scale)
    assert summary(analyse(transformed(scene(id), placed, scale))) == summary(analysed(id))


@settings(max_examples=20, deadline=None)
@given(IDS, seeds)
def test_names_and_order_change_nothing(id, seed):
    """Renaming and re-ordering parts and constraints leaves the counts, freedoms and kinds of joints."""
    found, expected = analyse(reordered(scene(id), np.random.default_rng(seed))), analysed(id)
    assert summary(found)[:7] == summary(expected)[:7]
    assert Counter(j.kind for j in found.joints if not j.closure).total() == len(
        [j for j in expected.joints if not j.closure]
    )


def joined(found, names) -> list:
    """Every joint as what it joins (the old names of all parts of both bodies), its kind and whether it closes."""
    parts = range(len(found.source.nodes))

    def body(node) -> tuple:
        if node is None or node >= len(parts):
            return ("ground",) if node is None else ("middle",)
        return tuple(sorted(names[i] for i in parts if found.groups.together(i, node)))

    return sorted((sorted((body(j.a), body(j.b))), j.kind.value, j.closure) for j in found.joints)


@settings(max_examples=30, deadline=None)
@given(IDS.filter(lambda id: id != "M19"), seeds)
def test_the_same_joint_closes_the_loop_in_any_order(id, seed):
    """Names and order decide no joint, its kind or its place in the tree (but M19's, whose arms are alike)."""
    source = scene(id)
    expected = joined(analysed(id), [n.id for n in source.nodes])
    order = np.random.default_rng(seed).permutation(len(source.nodes))  # as ``reordered`` draws it
    found = analyse(reordered(source, np.random.default_rng(seed)))
    assert joined(found, [source.nodes[i].id for i in order]) == expected


@settings(max_examples=20, deadline=None)
@given(IDS)
def test_swapped_sides_change_nothing(id):
    """A constraint says the same whichever side it names first."""
    assert summary(analyse(swapped(scene(id)))) == summary(analysed(id))


@settings(max_examples=20, deadline=None)
@given(
    st.sampled_from(
        [f"P{i:02d}" for i in range(1, 31)] + ["M01", "M04", "M09", "M11", "M12", "M14", "M21", "M32"]
    ),
    seeds,
)
def test_noise_of_a_millionth_changes_no_class(id, seed):
    """Poses rounded to 1e-6 give the same classes, and no gap is worth reporting."""
    rng = np.random.default_rng(seed)
    found = analyse(shaken(scene(id), 1e-6 * analysed(id).assembly.equations.length, rng))
    assert summary(found) == summary(analysed(id))
    assert found.gaps == [] and found.contradictory == []


@pytest.mark.parametrize("id", ["P03", "P09", "P21", "M01", "M09", "M14"])
def test_noise_of_a_hundredth_is_reported_in_metres_and_degrees(id):
    """A pose that misses its constraints by 1e-2 is named, constraint by constraint, with the gap."""
    rng = np.random.default_rng(2)
    found = analyse(shaken(scene(id), 1e-2, rng))
    assert found.gaps and all(0.0 < gap.metres < 0.2 or 0.01 < gap.degrees < 3.0 for gap in found.gaps)
    reported = [d for d in found.report.diagnostics if d.code == "CONSTRAINT_GAP"]
    assert len(reported) == len(found.gaps)


def test_misaligned_geometry_is_contradictory_not_absorbed():
    """Two hinges whose axes differ by 1e-2 in the part itself cannot both hold; by 1e-6 they can."""
    source = scene("P09")

    def bent(angle):
        second = source.constraints[1]
        a, b = second.features
        tilted = replace(b, direction=rotation_exp(np.array([angle, 0, 0])) @ b.direction)
        return replace(source, constraints=[source.constraints[0], replace(second, features=(a, tilted))])

    assert analyse(bent(1e-2)).contradictory
    fine = analyse(bent(1e-6))
    assert fine.contradictory == [] and [j.kind.value for j in fine.joints] == ["revolute"]


def test_solving_moves_parts_to_the_nearest_closed_pose():
    """A shaken four-bar is closed again within the size of the shake."""
    rng = np.random.default_rng(4)
    found = analyse(shaken(scene("M01"), 1e-3, rng))
    solved = found.scene(solved=True)
    again = analyse(replace(solved, joints=[], couplings=[]))
    assert again.worst_gap[0] < 1e-12 and again.worst_gap[1] < 1e-9
    for before, after in zip(found.source.nodes, solved.nodes):
        assert np.linalg.norm(before.pose.translation - after.pose.translation) < 5e-3
