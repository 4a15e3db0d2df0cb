"""Where the way of a mechanism meets another one: poses at which its rows lose rank.

There (a folded parallelogram, a kite laid flat) the loops hold one direction of motion less than elsewhere, and two or more
motions cross.  A walk goes straight through, on the branch that it came by; a built mechanism may take the other.
A dead point of what drives is none of them: there the rows keep their rank (Müller, A.: Local kinematic analysis of
closed-loop linkages, Mechanism and Machine Theory 2018, section 3).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.linalg import qr

from ...spatial import Array
from ..equations.solve import Solver
from ..equations.system import State, System
from .walk import Poses

RANK = 1e-7
"""Pivots up to this share of the largest are those of repeated rows."""
MEETS = 1e-5
"""Share of its usual size that the last pivot falls below where two ways meet."""
DIP = 0.6
"""Share of a neighbour's that the last pivot falls below on its way to zero: it goes down to it evenly."""
PLACE = 1e-8
"""How exactly a crossing is looked for, as a share of the way."""


def crossings(system: System, knots: Poses, at: Callable[[float], State | None]) -> list[float]:
    """The shares of a walked way, ends included, at which another motion crosses it.

    system: the block's own rows, without those that hold a coordinate.  knots: the poses that were walked through, near
    enough to each other that the rows turn little in between.  at: the pose at a share, None where none was found.
    """
    solver = Solver(system)
    pivots = [_pivots(solver, knots.state(i)) for i in range(len(knots.at))]
    rank = max(int(np.sum(p > RANK * p[0])) if len(p) else 0 for p in pivots)
    if not rank:
        return []
    last = np.array([p[rank - 1] for p in pivots])
    usual = float(last.max())

    def size(share: float) -> float:
        state = at(share)
        return usual if state is None else float(_pivots(solver, state)[rank - 1])

    found: list[float] = []
    for i, here in enumerate(last):
        around = [last[j] for j in (i - 1, i + 1) if 0 <= j < len(last)]
        if here > min(around, default=np.inf):
            continue
        if here < MEETS * usual:
            found.append(float(knots.at[i]))
        elif len(around) == 2 and here < DIP * max(around):
            place, least = _least(size, float(knots.at[i - 1]), float(knots.at[i + 1]))
            if least < MEETS * usual:
                found.append(place)
    return found


def _least(size: Callable[[float], float], low: float, high: float) -> tuple[float, float]:
    from scipy.optimize import minimize_scalar  # late: it takes a tenth of a second

    found = minimize_scalar(
        size, bounds=(low, high), method="bounded", options={"xatol": PLACE * (high - low)}
    )
    return float(found.x), float(found.fun)


def _pivots(solver: Solver, state: State) -> Array:
    """Of the rows' Jacobian at a pose, sizes of the pivots of its factorisation with column pivoting, descending."""
    _, block_a, block_b = solver.system.linearise(state)
    found = [
        np.abs(np.diag(qr(jacobian, mode="r", pivoting=True, check_finite=False)[0]))
        for group in solver.groups
        for jacobian in solver.jacobians(group, block_a, block_b)
    ]
    return np.sort(np.concatenate(found))[::-1] if found else np.zeros(0)
