"""Names, order, sides, place and unit change nothing; small noise no class; large noise is reported."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.model import Constraint, ConstraintKind, Feature, FeatureKind, Node, Scene
from kinefab.spatial import Pose, rotation_exp
from mechanism_cases import MINIMAL, all_ids, analysed, scene
from restated import as_given, placed, shaken, shuffled, told, turned_round
from strategies import random_pose, seeds

SAME = 1e-6
"""Of frames, as a fraction of the assembly's length: singular poses are found to the root of a rounding."""
UNITS = (1.0, 1e-3, 1e-2, 0.0254, 1e3)


def restated(source: Scene, seed: int):
    """The scene under other names, in another order, with sides exchanged, elsewhere and in another unit."""
    rng = np.random.default_rng(seed)
    scale = float(rng.choice(UNITS))
    it = shuffled(turned_round(as_given(source)), rng)
    return placed(it, random_pose(rng, 3.0 * scale), scale)


@cache
def told_of(id: str):
    return told(analysed(id), as_given(scene(id)))


def assert_same(expected, found, length):
    assert found[0] == expected[0]
    for a, b in zip(expected[1], found[1]):
        assert np.abs(np.subtract(a, b)).max(initial=0.0) < SAME * max(1.0, length)


@pytest.mark.parametrize("id", all_ids())
def test_nothing_but_names_and_units_changes(id):
    """Every pair and mechanism: each joint joins the same parts, is of the same kind, closes a loop or not, and has
    the same frame in the parts; each part moves in the same directions; the findings are the same."""
    seed = int(id[1:]) + (100 if id[0] == "M" else 0)
    it = restated(scene(id), seed)
    assert_same(told_of(id), told(analyse(it.scene, MINIMAL), it), analysed(id).assembly.equations.length)


@settings(max_examples=25, deadline=None)
@given(st.sampled_from(all_ids()), seeds)
def test_nothing_but_names_and_units_changes_at_random(id, seed):
    """The same, for further orders, poses and units."""
    it = restated(scene(id), seed)
    assert_same(told_of(id), told(analyse(it.scene, MINIMAL), it), analysed(id).assembly.equations.length)


@pytest.mark.parametrize("id", ["M01", "M06", "M09", "M14", "M19", "M21", "M23", "M36", "M40"])
def test_explicit_joints_are_ordered_by_place_too(id):
    """The same mechanism stated by joints instead of constraints, those that close loops among them."""
    joints = analyse(scene(id), AnalysisOptions(closures=Closures.EXACT)).joints
    source = replace(scene(id), constraints=[], joints=joints)
    expected = told(analyse(source, MINIMAL), as_given(source))
    for seed in range(2):
        it = restated(source, seed)
        assert_same(expected, told(analyse(it.scene, MINIMAL), it), analysed(id).assembly.equations.length)


@pytest.mark.parametrize("id", ["P03", "P20", "P30", "M01", "M06", "M09", "M12", "M14", "M19", "M27", "M36"])
def test_the_root_of_a_floating_island_is_chosen_by_place(id):
    """With nothing grounded, the part from which freedoms are counted and joints grow does not depend on the order."""
    source = scene(id)
    source = replace(source, nodes=[replace(n, grounded=False) for n in source.nodes])
    expected = told(analyse(source, MINIMAL), as_given(source))
    for seed in range(3):
        it = restated(source, seed)
        assert_same(expected, told(analyse(it.scene, MINIMAL), it), analysed(id).assembly.equations.length)


def ring_of_bars(count: int, grounded: bool) -> Scene:
    """Bars hinged end to end in a ring, all alike and alike seen from each other; on a plate, or floating."""
    nodes = (
        [Node("plate", "plate", pose=Pose(np.eye(3), np.array([0.0, 0.0, -0.2])), grounded=True)]
        if grounded
        else []
    )
    first = len(nodes)
    corner = [rotation_exp(np.array([0.0, 0.0, 2 * np.pi * k / count])) for k in range(count)]
    for k in range(count):
        nodes.append(Node(f"bar{k}", f"bar{k}", pose=Pose(corner[k], corner[k] @ [1.0, 0.0, 0.0])))
    constraints = []

    def hinge(a: int, b: int, at) -> None:
        sides = (
            Feature(
                n,
                FeatureKind.CIRCLE,
                nodes[n].pose.inverse().point(at),
                np.array([0.0, 0.0, 1.0]),
                radius=0.1,
            )
            for n in (a, b)
        )
        constraints.append(Constraint(f"insert:{a}-{b}", ConstraintKind.INSERT, tuple(sides)))

    for k in range(count):
        hinge(
            first + k,
            first + (k + 1) % count,
            corner[k] @ rotation_exp(np.array([0, 0, np.pi / count])) @ [1.2, 0, 0],
        )
    if grounded:
        hinge(0, first, nodes[first].pose.translation)
    return Scene(nodes=nodes, constraints=constraints)


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_parts_exactly_alike_are_told_apart_by_where_they_stand_on_the_ground(seed):
    """Six bars, alike and alike placed, one of them hinged to a plate: which hinge closes the ring is settled."""
    source = ring_of_bars(6, grounded=True)
    it = restated(source, seed)
    assert_same(told(analyse(source, MINIMAL), as_given(source)), told(analyse(it.scene, MINIMAL), it), 1.5)


@settings(max_examples=10, deadline=None)
@given(seeds)
def test_a_floating_ring_is_the_same_up_to_its_own_symmetry(seed):
    """Six bars that nothing holds, each seeing the others alike: no rule could tell which hinge is to close the ring,
    since a turn by 60 degrees changes nothing but names.  Compared with the names of that turn left out."""
    source = ring_of_bars(6, grounded=False)
    it = restated(source, seed)

    def nameless(found) -> Counter:
        return Counter(
            (len(j.because), j.kind, found.findings[j.id].closure, j.freedoms) for j in found.joints
        )

    expected, found = analyse(source, MINIMAL), analyse(it.scene, MINIMAL)
    assert nameless(expected) == nameless(found) and sum(f.closure for f in found.findings.values()) == 1
    assert (expected.mobility, expected.rank) == (found.mobility, found.rank)


def summary(found) -> tuple:
    """What must not change: the counts, and each part's freedoms and each joint's kind."""
    names = Counter(j.kind.value for j in found.joints if not found.findings[j.id].closure)
    freedoms = sorted((len(f.translations), len(f.rotations)) for f in found.freedoms)
    return (
        found.mobility,
        found.first_order,
        found.rows,
        found.rank,
        len(found.joints),
        sum(f.closure for f in found.findings.values()),
        freedoms,
        sorted(names.items()),
    )


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
    found = analyse(shaken(scene(id), 1e-6 * analysed(id).assembly.equations.length, rng), MINIMAL)
    assert summary(found) == summary(analysed(id))
    assert found.gaps == [] and found.contradictory == []


@pytest.mark.parametrize("id", ["P03", "P09", "P21", "M01", "M09", "M14"])
def test_noise_of_a_hundredth_is_reported_in_metres_and_degrees(id):
    """A pose that misses its constraints by 1e-2 is named, constraint by constraint, with the gap."""
    rng = np.random.default_rng(2)
    found = analyse(shaken(scene(id), 1e-2, rng), MINIMAL)
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

    assert analyse(bent(1e-2), MINIMAL).contradictory
    fine = analyse(bent(1e-6), MINIMAL)
    assert fine.contradictory == [] and [j.kind.value for j in fine.joints] == ["revolute"]


def test_solving_moves_parts_to_the_nearest_closed_pose():
    """A shaken four-bar is closed again within the size of the shake."""
    rng = np.random.default_rng(4)
    found = analyse(shaken(scene("M01"), 1e-3, rng), MINIMAL)
    solved = found.scene(solved=True)
    again = analyse(replace(solved, joints=[], couplings=[]), MINIMAL)
    assert again.worst_gap[0] < 1e-12 and again.worst_gap[1] < 1e-9
    for before, after in zip(found.source.nodes, solved.nodes):
        assert np.linalg.norm(before.pose.translation - after.pose.translation) < 5e-3
