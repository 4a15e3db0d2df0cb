"""The rows of a closing joint that are exported hold the mechanism wherever it goes, not only where it was exported."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from kinefab.analysis import AnalysisOptions, Closures, analyse
from kinefab.analysis.equations.rows import Rows
from kinefab.analysis.equations.scene_equations import joint_rows, joint_sides
from kinefab.analysis.equations.solve import Solver
from kinefab.analysis.freedom.first_order import block_freedoms
from kinefab.model import Motion, Scene
from kinefab.spatial import Pose
from mechanism_cases import MINIMAL, all_ids, scene

STEP = 0.1
STEPS = 35
FEW_STEPS = 5
LARGE = 50
"""Bodies from which a mechanism is followed for a few steps only."""
SEEDS = 2
ON_ROWS = 1e-10
SINGULAR = 0.05
"""Share of the smallest singular value at the exported pose below which all rows together are about to give way."""
HELD = 0.1
"""Share of that of all rows which the exported rows must have."""


def locked(found) -> list[int]:
    return [sum(f.motion is Motion.LOCKED for f in j.freedoms) for j in found.joints]


def rows_of(found, like):
    """The equations of the found joints, between the nodes of ``like`` (one node for each rigid group), at its pose."""
    source = like.scene().with_poses([*like.poses, *(n.pose for n in like.nodes)])
    body = [int(b) for b in like.assembly.body]
    body += range(max(body) + 1, max(body) + 1 + len(like.nodes))
    rows = Rows()
    for i, joint in enumerate(found.joints):
        rows.owner = i
        a, b = (replace(s, body=body[s.body]) for s in joint_sides(joint, source))
        joint_rows(rows, joint, a, b)
    return rows.system(max(body) + 1)


def smallest(system, state, rank=None):
    """The rank of the rows over the bodies' twists, and the last singular value that counts."""
    _, at_a, at_b = system.linearise(state)
    jacobian = np.zeros((system.rows, system.bodies, 6))
    np.add.at(jacobian, (system.row, system.body_a), at_a)
    np.add.at(jacobian, (system.row, system.body_b), at_b)
    s = np.linalg.svd(jacobian[:, 1:].reshape(system.rows, -1), compute_uv=False)
    rank = int(np.sum(s > 1e-7 * s[0])) if rank is None else rank
    return rank, float(s[rank - 1]) if rank <= len(s) else 0.0


def poses(system, seed, steps):
    """Poses along a motion in a random direction, both ways."""
    solver = Solver(system)
    for sign in (1.0, -1.0):
        state, wanted = system.start(), {}
        for _ in range(steps):
            moved = state
            for part, freedom in enumerate(block_freedoms(solver, state)):
                if not freedom.mobility:
                    continue
                if part not in wanted:
                    draw = np.random.default_rng((seed, part)).standard_normal(freedom.mobility)
                    wanted[part] = sign * freedom.basis @ draw
                along = freedom.basis @ (freedom.basis.T @ wanted[part])
                wanted[part] = along / np.abs(along).max()
                moved = system.moved(moved, freedom.bodies, STEP * wanted[part].reshape(-1, 6))
            state, left = solver.project(moved)
            if left.max(initial=0.0) > ON_ROWS:
                break
            yield state


@pytest.mark.parametrize("id", [i for i in all_ids() if i[0] == "M"])
def test_the_exported_rows_hold_along_the_motion(id):
    """At poses along every mechanism's motion the rows that are exported leave no more freedoms than all rows do,
    nor nearly so, but where all rows themselves are about to leave more."""
    few, all_ = (analyse(scene(id), AnalysisOptions(closures=c)) for c in (Closures.MINIMAL, Closures.EXACT))
    if locked(few) == locked(all_):
        return
    kept, whole = rows_of(few, all_), rows_of(all_, all_)
    for system in (kept, whole):
        system.length[:] = all_.assembly.equations.length
        system.row_length[:] = all_.assembly.equations.length
    rank, least = smallest(whole, whole.start())
    assert smallest(kept, kept.start()) == (rank, pytest.approx(least, rel=1.0 - HELD))
    seen = 0
    for seed in range(SEEDS if all_.mobility > 1 else 1):
        for n, state in enumerate(poses(whole, seed, STEPS if whole.bodies < LARGE else FEW_STEPS)):
            here = smallest(whole, state, rank)[1]
            if here > SINGULAR * least:
                own = replace(state, angle=kept.start().angle)
                assert smallest(kept, own, rank)[1] > HELD * here, (id, seed, n)
                seen += 1
    assert seen >= 10


def test_mechanisms_that_are_alike_keep_the_same_rows():
    """Bricard loops side by side: each closes as it does alone."""
    one = scene("M13")
    nodes, constraints = [one.nodes[0]], []
    for copy in range(3):
        by = Pose(np.eye(3), np.array([3.0, 1.0, -2.0]) * copy)
        for node in one.nodes[1:]:
            nodes.append(replace(node, id=f"{node.id}{copy}", name=f"{node.name}{copy}", pose=by @ node.pose))
        for constraint in one.constraints:
            sides = tuple(
                replace(f, node=f.node + copy * (len(one.nodes) - 1))
                if f.node
                else replace(f, point=by.point(f.point), direction=by.direction(f.direction))
                for f in constraint.features
            )
            constraints.append(replace(constraint, id=f"{constraint.id}{copy}", features=sides))
    found = analyse(Scene(nodes=nodes, constraints=constraints), MINIMAL)
    alone, together = (
        [j.freedoms for j in f.joints if f.findings[j.id].closure] for f in (analyse(one, MINIMAL), found)
    )
    assert together == 3 * alone and len(alone) == 1
