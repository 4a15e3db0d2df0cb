"""Mobility, redundancy and freedoms of every mechanism of the table."""

from __future__ import annotations

import kinefab
import pytest
from kinefab.analysis import analyse
from linkages import flat_ladder
from mechanism_cases import analysed, table

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


def test_a_leg_that_only_seems_to_buckle_is_not_idle():
    """M45: four velocities, no motion, so none that moves nothing else."""
    assert analysed("M45").idle == []


def test_what_stands_between_coupled_joints_is_not_idle():
    """An arm whose elbow is driven from the base by a belt, a tool hanging on it: its shoulder carries elbow and tool,
    and no freedom moves nothing else.  The motor's shaft that also slides has that one."""
    scene = kinefab.Scene()
    base = scene.add_part("Base", grounded=True)
    arm, fore, tool, motor = (scene.add_part(name) for name in ("Arm", "Fore", "Tool", "Motor"))
    scene.add_hinge(base, arm, point=(0, 0, 0), axis=(0, 1, 0), name="Shoulder")
    elbow = scene.add_hinge(arm, fore, point=(0.5, 0, 0), axis=(0, 1, 0), name="Elbow")
    scene.add_hinge(fore, tool, point=(1, 0, 0), axis=(0, 1, 0), name="Wrist")
    shaft = scene.add_joint("cylindrical", base, motor, point=(0, 0, 0.2), axis=(0, 1, 0), name="Shaft")
    scene.add_coupling((shaft, "rx"), elbow, ratio=0.5)
    found = analyse(scene)
    assert found.mobility == 4
    assert [([found.source.nodes[n].name for n in i.nodes], i.count) for i in found.idle] == [(["Motor"], 1)]


@pytest.mark.parametrize(
    ("id", "loops"), [("M01", 1), ("M06", 2), ("M09", 1), ("M14", 5), ("M19", 5), ("M32", 2), ("M40", 40)]
)
def test_loops_are_joints_minus_moving_bodies(id, loops):
    """One closing joint for each independent loop."""
    found = analysed(id)
    assert sum(f.closure for f in found.findings.values()) == loops
    assert sum(i.loops for i in found.islands) == loops


@pytest.mark.parametrize(("rods", "loose"), [(1, 0), (8, 0), (30, 0), (100, 0), (1, 3), (4, 4), (30, 5)])
def test_a_flat_ladder_of_any_length_has_one_motion(rods, loose):
    """Flat, every crank of a ladder of parallelograms seems to turn by itself: rods + 1 freedoms, of which one is a
    motion.  An arch of bars from its last tip to the ground adds its own, three less than hinges and bars count."""
    found = analyse(flat_ladder(rods, loose))
    arch = max(0, loose - 2)
    assert (found.first_order, found.mobility) == (rods + 1 + arch, 1 + arch)
