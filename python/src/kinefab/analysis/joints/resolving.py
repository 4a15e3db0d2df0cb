"""What stands for a pair whose twists at the closed pose are those of no joint.

Its finite motions may be a joint's where the pose is singular; each of its constraints may be one by itself, or two
with a body between; else a joint that comes near them is measured by how far it misses.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from ...spatial import IntArray, cross
from ..assembly.assemble import Assembly
from ..equations.solve import Solver
from ..equations.system import System
from ..freedom.finite import EXACT, Candidate, chain_misfit, misfits
from ..freedom.first_order import block_freedoms
from ..freedom.motion import finite_freedoms
from ..freedom.twists import NAMED, snapped, twist_space
from ..pairs.middle import middle_body
from ..pairs.relations import Relation, find_joints, pairs_of, relations_of

MISSED_SAMPLES = 1000
"""Motions among which the largest misfit of an approximated joint is looked for: the few that tell whether a joint fits
find half of it."""

Stand = Relation | tuple[Candidate, Candidate]
"""What stands for some rows of a pair: a relation with its joint, or the joints to a middle body and on from it."""


def find_by_finite_motions(assembly: Assembly, relation: Relation) -> None:
    """At a singular pose the twists promise too much: classify what really moves."""
    if len(relation.rows) == relation.rank:
        return
    label = np.zeros(assembly.system.bodies, dtype=np.int64)
    label[relation.second] = 1
    alone = assembly.system.select(relation.rows).relabel(label)
    solver = Solver.fitted(alone, relation.length)
    start = alone.start()
    part = int(assembly.solver.row_part[relation.rows[0]])
    block, relative = assembly.freedoms[part], assembly.relative
    if len(block.bodies) == 1 and len(block.rows) == len(relation.rows):
        # the pair is a block: it was searched, whichever of the two is its root
        body, finite = int(block.bodies[0]), assembly.finite[part]
        center, length = relative.center[body], relative.length[body]
    else:
        finite = finite_freedoms(solver, block_freedoms(solver, start), start)[0]
        center, length = alone.center[1], alone.length[1]
    if not finite.singular:
        return
    relation.finite = finite.mobility
    arm = (relation.origin - center) / relation.length
    v = finite.tangent[:3] * length / relation.length + cross(finite.tangent[3:].T, arm).T
    basis = np.linalg.qr(np.concatenate([v, finite.tangent[3:]]))[0]
    space = twist_space(basis, relation.origin, relation.length, alone.axes, NAMED)
    named = relation.geometry
    directions = np.concatenate([named.first, named.second])
    relation.space = snapped(space, named.points, directions, relation.length)
    local = replace(relation, first=0, second=1, rows=np.arange(alone.rows))
    find_joints(alone, [local], alone.residual(start))
    relation.joint, relation.misfit, relation.tried = local.joint, local.misfit, local.tried


def joints_of_each(assembly: Assembly, relation: Relation) -> list[tuple[Stand, list[str]]] | None:
    """A joint, or two with a middle body, for each of the pair's constraints that says something new, and
    the names of those that it stands for; None where there is no such joint.

    A relation that is stated twice must not become two rods side by side: they would make a loop of their own.
    """
    system, statements = assembly.system, assembly.equations.statements
    found: list[tuple[int, Stand, IntArray, str]] = []
    for owner in relation.owners:
        rows = relation.rows[system.owner[relation.rows] == owner]
        single = _single(system, rows) if len(relation.owners) > 1 else relation
        stand = single if single.joint is not None else middle_body(system, rows, relation)
        if stand is None:
            return None
        found.append((single.rank, stand, rows, statements[owner].id))
    stands: list[tuple[Stand, list[str]]] = []
    for _, stand, rows, name in sorted(found, key=lambda f: -f[0]):
        by = next((names for earlier, names in stands if _implied(system, rows, earlier, relation)), None)
        if by is None:
            stands.append((stand, [name]))
        else:
            by.append(name)
    return stands


def _single(system: System, rows: IntArray) -> Relation:
    """The relation that some of a pair's rows make by themselves."""
    some = system.select(rows)
    pairs = pairs_of(some)
    relation = relations_of(some, pairs, some.start())[0]
    find_joints(some, [relation], some.residual(some.start()))
    return replace(relation, rows=np.sort(rows))


def _implied(system: System, rows: IntArray, stand: Stand, relation: Relation) -> bool:
    """Whether all motions that two joints with a middle body allow keep these rows too."""
    if isinstance(stand, Relation):
        return False
    return chain_misfit(system.select(rows), relation.second, *stand, relation.length) <= EXACT


def missed(system: System, relation: Relation, joint: Candidate) -> tuple[float, float]:
    """By how much a joint violates the relation's rows as it moves: metres, radians (or cosines)."""
    second = np.array([relation.second])
    worst: list[float] = []
    for lengths in (True, False):
        some = system.select(relation.rows[system.is_length[relation.rows] == lengths])
        one = np.zeros(len(some.kind), dtype=np.int64)
        length = np.array([relation.length])
        worst.append(float(misfits(some, second, one, [joint], length, MISSED_SAMPLES)[0]))
    return worst[0] * relation.length, worst[1]
