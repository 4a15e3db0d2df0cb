"""Branches of motions that cross at a pose: whether directions belong to one branch, and which have the largest."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...spatial import Array, BoolArray
from ..equations.solve import Solver
from ..equations.system import State
from .first_order import BlockFreedom, freedoms_of
from .probes import WHOLE, left_of, random_direction

MIXTURES = 3
"""Of motions: by chance one in eight lies so near a single branch that it keeps all but a tenth of itself."""
NARROWER = 10.0
"""Times that the gap between kept and repeated rows may be narrower at another pose, as what closing left is another one there."""
NOISY_GAP = 1e10
"""A narrower gap between kept and repeated rows is none of rounding: the rows repeat each other as exactly as the CAD program
solved them, and without a motion that uses the difference the mechanism would be locked."""


def held_there(solver: Solver, here: Mapping[int, BlockFreedom], there: State, parts: BoolArray) -> list[int]:
    """Parts, of a mask, whose rows hold more at another pose than at the one before.

    What all velocities of a pose move through has as many velocities everywhere.  Where two branches cross, a direction that
    happens to lie near one of them keeps all but a little of itself, but the rows that repeat others where both meet do not
    on either one: they turn with the way."""
    found = freedoms_of(solver, there, parts)
    return [
        p
        for p, f in found.items()
        if f.rank > here[p].rank or NARROWER * f.gap < min(here[p].gap, NOISY_GAP)
    ]


def largest_branch(
    solver: Solver, part: int, freedom: BlockFreedom, state: State, ways: Array, step: float, floor: Array
) -> Array:
    """Of directions, shape (6 n, m), that are motions each, those that one branch has: the most found whose mixtures are motions too.
    Steps along mixtures lead back to where branches cross."""
    count, largest = ways.shape[1], list[int]()
    for first in range(count):
        branch = [first]
        for k in range(1, count):
            more = [*branch, (first + k) % count]
            if mixtures_move(solver, part, freedom, state, ways[:, more], step, floor):
                branch = more
        largest = branch if len(branch) > len(largest) else largest
    return ways[:, largest]


def mixtures_move(
    solver: Solver,
    part: int,
    freedom: BlockFreedom,
    state: State,
    ways: Array,
    step: float,
    floor: Array,
) -> bool:
    """Whether mixtures of directions, shape (6 n, m), are motions as these are.  Where branches of motions cross, the directions of
    all survive, and of a mixture only what one branch has of it; a mixture that happens to lie near one branch leads to a pose
    that has not all of the directions."""
    draw, active = np.random.default_rng(19), np.arange(solver.parts) == part
    count = ways.shape[1]
    for _ in range(MIXTURES if count > 1 else 0):
        way = random_direction(ways, draw)
        way /= np.linalg.norm(way)
        left, _, poses = left_of(solver, part, freedom, state, way, step, floor)
        if np.linalg.norm(left - way) > 1.0 - WHOLE:
            return False
        for there in poses:
            if freedom.mobility == count:
                if held_there(solver, {part: freedom}, there, active):
                    return False
            elif freedoms_of(solver, there, active)[part].mobility < count:
                return False
    return True
