"""Mobility, redundancy and freedoms of every mechanism of the table."""

from __future__ import annotations

from dataclasses import replace

import kinefab
import numpy as np
import pytest
from kinefab.analysis import analyse
from kinefab.analysis.equations.solve import Solver, cautious_step, minimum_norm
from kinefab.analysis.findings.summary import scene_entry
from kinefab.analysis.freedom.branches import held_there
from kinefab.analysis.freedom.motion import walked
from kinefab.analysis.freedom.probes import floor_of, left_of, left_of_each, trial
from kinefab.model import ConstraintKind
from linkages import elbow_of, flat_ladder
from mechanism_cases import analysed, scene, table

EXPECTED = table("mobility")


@pytest.mark.parametrize("row", EXPECTED, ids=[r["id"] for r in EXPECTED])
def test_rows_rank_and_mobility_are_those_of_the_table(row):
    """Rows, rank, redundancy, first-order and finite mobility agree with the independent computation."""
    found = analysed(row["id"])
    bodies = (
        len(
            [
                g
                for g, grounded in zip(found.assembly.stated.members, found.assembly.stated.grounded)
                if not grounded
            ]
        )
        + 1
    )
    assert (bodies, found.rows, found.rank, found.first_order, found.redundant, found.mobility) == tuple(
        int(row[key]) for key in ("bodies", "rows", "rank", "first_order", "redundant", "finite")
    )


LISTED = [r for r in EXPECTED if r["freedoms"]]


@pytest.mark.parametrize("row", LISTED, ids=[r["id"] for r in LISTED])
def test_each_part_has_the_freedoms_of_the_table(row):
    """Every part that the table names keeps that many freedoms against ground (legs by their first part)."""
    found = analysed(row["id"])
    left = {found.source.nodes[f.node].name: f.dof for f in found.freedoms}
    for entry in row["freedoms"].split():
        name, dof = entry.split("=")
        parts = [
            n
            for n in left
            if n == name or n.startswith(name) and n[len(name) :].strip("_abxy0123456789") == ""
        ]
        assert parts and all(left[n] == int(dof) for n in parts), (name, left)


def test_leg_spins_are_idle_freedoms():
    """Each leg between two balls has one freedom that moves nothing else (M15), each Delta rod too (M19)."""
    assert [i.count for i in analysed("M15").idle] == [1] * 6
    assert [i.count for i in analysed("M19").idle] == [1] * 6
    assert analysed("M14").idle == []


def test_idle_freedoms_of_a_single_loop_are_those_of_bodies_that_turn_as_one():
    """M28: the rod of an RSSR spins.  M42: the ram spins as a whole, and its middle stage slides.  In the order of
    the source's parts."""
    for id, expected in (("M28", [{"rod"}]), ("M42", [{"tube", "middle", "piston"}, {"middle"}])):
        found = analysed(id)
        assert [i.count for i in found.idle] == [1] * len(expected)
        assert [{found.source.nodes[n].name for n in i.nodes} for i in found.idle] == expected


@pytest.mark.parametrize("order", ["abcd", "bcda", "cdab", "dabc"])
def test_a_floating_loop_has_the_same_idle_freedoms_from_every_root(order):
    """Two plates turn against the other two about one axis; what hangs on the first holds it, and what hangs on the third by the same
    axis holds nothing."""
    scene = kinefab.Scene()
    plates = {name: scene.add_part(name, mass=1.0, translation=(0.2 * ord(name), 0.1, 0.3)) for name in order}
    held, near, far = (scene.add_part(name, mass=1.0) for name in ("held", "near", "far"))
    scene.add_hinge(plates["a"], plates["b"], point=(0, 0, 0), axis=(0, 0, 1))
    scene.add_ball(plates["b"], plates["c"], point=(0.5, 0, 0.1))
    scene.add_hinge(plates["c"], plates["d"], point=(0, 0, 0.4), axis=(0, 0, 1))
    scene.add_ball(plates["d"], plates["a"], point=(0.3, 0.6, 0.2))
    scene.add_hinge(plates["a"], held, point=(1, 1, 0), axis=(1, 0, 0))
    for part in (near, far):
        scene.add_hinge(plates["c"], part, point=(0, 0, 0), axis=(0, 0, 1))
    assert sum(idle.count for idle in analyse(scene).idle) == 1


def test_a_leg_that_only_seems_to_buckle_is_not_idle():
    """M45: four velocities, no motion, so none that moves nothing else."""
    assert analysed("M45").idle == []


def test_what_stands_between_coupled_joints_is_not_idle():
    """An arm whose elbow is driven from the base by a belt, a tool hanging on it: its shoulder carries elbow and tool,
    and no freedom moves nothing else.  The motor's shaft that also slides is a chain's end: a coupling closes no loop."""
    arms = kinefab.Scene()
    base = arms.add_part("Base", grounded=True)
    arm, fore, tool, motor = (arms.add_part(name) for name in ("Arm", "Fore", "Tool", "Motor"))
    arms.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 1, 0), name="Shoulder")
    elbow = arms.add_hinge(arm, fore, point=(0.5, 0, 0), axis=(0, 1, 0), name="Elbow")
    arms.add_hinge(fore, tool, point=(1, 0, 0), axis=(0, 1, 0), name="Wrist")
    shaft = arms.add_joint("cylindrical", base, motor, point=(0, 0, 0.2), axis=(0, 1, 0), name="Shaft")
    arms.add_coupling((shaft, "rx"), elbow, ratio=0.5)
    found = analyse(arms)
    assert found.mobility == 4
    assert found.idle == []


def without(id: str, *constraints: str):
    """The analysis of a mechanism without some of its constraints."""
    source = scene(id)
    return analyse(replace(source, constraints=[c for c in source.constraints if c.id not in constraints]))


def changed(id: str, constraint: str, **changes):
    """The analysis of a mechanism with one constraint changed."""
    source = scene(id)
    constraints = [replace(c, **changes) if c.id == constraint else c for c in source.constraints]
    return analyse(replace(source, constraints=constraints))


def test_idle_freedoms_are_those_of_the_bodies_that_are_exported():
    """P29 without its third rod: the ball where two rods meet turns by itself.  M18 without one: what the platform can
    do while the arms stand still moves the rods that stand for the distances."""
    found = without("P29", "distance:3")
    assert [([found.source.nodes[n].name for n in i.nodes], i.count) for i in found.idle] == [(["B"], 3)]
    assert without("M18", "distance:3").idle == []


def test_two_bars_about_one_axis_move_in_a_linkage_that_cannot_else():
    """The flat double four-bar with one corner welded: a triangle without height stands still, and the bars behind
    it, of which one ends where the other begins, turn as one.  All other velocities take that motion back with them."""
    found = changed("M39", "insert:4", lock_rotation=True)
    assert (found.first_order, found.mobility) == (2, 1)


def test_a_pose_that_could_not_be_closed_is_not_walked_to(monkeypatch):
    """M45 after random steps is sometimes a pose that misses its constraints by 1e-5 and comes no nearer; from there
    it had three motions."""
    assembly = analysed("M45").assembly
    solver = Solver(assembly.solver.alone(0))
    first, start = replace(assembly.freedoms[0], bodies=np.arange(1, 8)), solver.system.start()
    monkeypatch.setattr(Solver, "project", lambda self, state, *rest: (state, np.full(self.parts, 1e-5)))
    there = walked(solver, 0, first, start)
    assert np.array_equal(there.rotation, start.rotation) and np.array_equal(there.shift, start.shift)


def test_steps_taken_at_once_leave_what_they_leave_one_by_one():
    """Of a flat ladder, whose velocities are obstructed but for one, and of a mechanism that only moves."""
    for scene_of in (flat_ladder(2), analysed("M06").source):
        assembly = analyse(scene_of).assembly
        solver = Solver(assembly.solver.alone(0), cautious=True)
        start, first = solver.system.start(), assembly.freedoms[0]
        freedom = replace(first, bodies=np.arange(1, solver.system.bodies))
        for keep in (True, False):
            asked = solver, 0, freedom, start
            ways, floor = freedom.basis.T, floor_of(solver, start)
            left, open_ = left_of_each(*asked, ways, 1e-2, floor, keep=keep)
            single = [left_of(*asked, way, 1e-2, floor, keep=keep) for way in ways]
            assert np.abs(left - [one for one, *_ in single]).max() < 1e-5
            assert open_ == pytest.approx(max(residual for _, residual, _ in single), rel=1.0, abs=1e-13)


def test_where_branches_cross_the_rows_hold_more_on_either_one():
    """A parallelogram that lies flat turns on, or folds: its pose has two velocities, those of either motion one."""
    solver, start, first = crossing()
    here, every = {0: first}, np.ones(1, dtype=bool)
    assert first.mobility == 2 and not held_there(solver, here, start, every)
    for way in first.basis.T:
        state = trial(solver, here, start, {0: way / np.abs(way).max()}, 1e-2)[2]
        assert held_there(solver, here, state, every) == [0]


def crossing():
    assembly = analyse(flat_ladder(1)).assembly
    solver = Solver(assembly.solver.alone(0), cautious=True)
    bodies = np.arange(1, solver.system.bodies)
    return solver, solver.system.start(), replace(assembly.freedoms[0], bodies=bodies)


def test_rows_that_merging_repeats_are_redundant_in_the_file():
    """Two slides whose bodies keep one orientation, and a hinge that this holds: it is merged, and its body is then
    held twice.  The file says no fewer than its islands do."""
    found = changed("M29", "concentric:3", kind=ConstraintKind.LOCK_ORIENTATION)
    assert found.redundant == 0 and scene_entry(found)["redundant"] == 1


@pytest.mark.parametrize(
    ("id", "loops"), [("M01", 1), ("M06", 2), ("M09", 1), ("M14", 5), ("M19", 5), ("M32", 2), ("M40", 40)]
)
def test_loops_are_joints_minus_moving_bodies(id, loops):
    """One closing joint for each independent loop."""
    found = analysed(id)
    assert sum(f.closure for f in found.findings.values()) == loops
    assert sum(i.loops for i in found.islands) == loops


@pytest.mark.parametrize(("rods", "loose"), [(1, 0), (3, 0), (8, 0), (30, 0), (100, 0), (1, 3), (4, 4), (30, 5)])
def test_a_flat_ladder_of_any_length_has_one_motion(rods, loose):
    """Flat, every crank of a ladder of parallelograms seems to turn by itself: rods + 1 freedoms, of which one is a
    motion.  An arch of bars from its last tip to the ground adds its own, three less than hinges and bars count."""
    found = analyse(flat_ladder(rods, loose))
    arch = max(0, loose - 2)
    assert (found.first_order, found.mobility) == (rods + 1 + arch, 1 + arch)


@pytest.mark.parametrize("kinds", [("spherical", "universal"), ("universal", "spherical")])
@pytest.mark.parametrize("turn", [0.0, 180.0, 37.0])
def test_a_joint_that_turns_back_is_not_rigid(kinds, turn):
    """A four-bar without redundant rows, its crank along its frame: coupler and rocker have the same velocity there, and
    part with the square of the crank's step.  They were taken for one body, and nothing moved."""
    scene, up = kinefab.Scene(), (0, 0, 1)
    ground = scene.add_part("Frame", grounded=True)
    crank, coupler, rocker = (scene.add_part(name) for name in ("Crank", "Coupler", "Rocker"))
    tip = 0.1 * np.array([np.cos(np.radians(turn)), np.sin(np.radians(turn)), 0.0])
    corner = elbow_of(tip, 0.35, np.array([0.4, 0.0, 0.0]), 0.25)
    scene.add_hinge(ground, crank, point=(0, 0, 0), axis=up)
    scene.add_hinge(ground, rocker, point=(0.4, 0, 0), axis=up)
    scene.add_joint(kinds[0], crank, coupler, point=tip, axis=up)
    scene.add_joint(kinds[1], coupler, rocker, point=corner, axis=up)
    found = analyse(scene)
    assert (found.first_order, found.mobility, found.redundant) == (1, 1, 0)
    assert len(found.joints) == 4 and found.fixed == ()


def test_legs_that_only_spin_at_the_pose_move_all_the_same():
    """A platform on six legs whose universal joints' axes lie in one plane with their leg: each leg turns about itself,
    and its slide stands still to first order alone.  No row is redundant, so all six velocities are motions."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    top = scene.add_part("Top", translation=(0, 0.6, 0))
    for i in range(6):
        side = 1 if i % 2 else -1
        foot, tip = (
            np.array([radius * np.cos(angle), height, radius * np.sin(angle)])
            for radius, angle, height in (
                (0.45, np.radians(60 * i + 10 * side), 0.05),
                (0.25, np.radians(60 * i - 20 * side), 0.55),
            )
        )
        lower, upper = scene.add_part(f"Lower{i}"), scene.add_part(f"Upper{i}")
        across = np.cross((1, 0, 0), np.cross((1, 0, 0), tip - foot))
        scene.add_joint("universal", base, lower, point=foot, axis=(1, 0, 0), secondary=across)
        scene.add_slider(lower, upper, point=0.5 * (foot + tip), axis=tip - foot)
        scene.add_ball(upper, top, point=tip)
    found = analyse(scene)
    assert (found.first_order, found.mobility, found.redundant) == (6, 6, 0)
    assert len(found.joints) == 18


def test_a_cautious_step_does_not_take_back_what_an_obstructed_velocity_is_multiplied_with():
    """o o = 0 and o s = 0: every s is a solution beside o = 0, and steps that obey both rows halve s as often as o."""
    for first in ((0.01, 0.01), (0.002, 0.03), (0.01, 0.004)):
        left = {}
        for step in (minimum_norm, cautious_step):
            o, s = first
            for _ in range(60):
                jacobian, residual = np.array([[[2 * o, 0.0], [s, o]]]), np.array([[o * o, o * s]])
                o, s = np.array((o, s)) - step(jacobian, residual)[0]
            left[step] = abs(o), s
        assert left[cautious_step][0] < 1e-7
        assert left[cautious_step][1] > 0.5 * first[1]
