"""Poses along the motions of a system's independent parts, all parts at once.

Every part sets out both ways along one direction (of several, where it has several freedoms) and keeps to it as well
as its rows allow.  Directions are told from the bodies' own frames, so that neither names nor the place of the
assembly nor the basis of a null space decide anything.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...spatial import Array, BoolArray, IntArray
from ..equations.solve import DENSE, Solver
from ..equations.system import State
from .first_order import BlockFreedom, block_freedoms

STEP = 0.2
"""Radians, or fractions of the length, of the body that moves most in a step."""
STEPS = 16
"""Steps each way: together a turn of the fastest body."""
FEW_STEPS = 3
"""Those of a part with so many bodies that it is not solved densely."""
DIRECTIONS = 3
"""Directions in which a part with as many freedoms, or more, sets out."""
CLOSED = 1e-9
"""Scaled residual up to which a pose is one of the mechanism's; at the next one its part stops."""


def poses_along(solver: Solver, frames: Array) -> Iterator[tuple[State, BoolArray]]:
    """Poses, each with the parts that have come there, a mask over the solver's parts.

    frames: shape (bodies, 3, 3), WORLD axes that each body's part of a direction is told in.
    """
    start = solver.system.start()
    freedoms = block_freedoms(solver, start)
    first = [np.array([f.mobility > way for f in freedoms], dtype=bool) for way in range(DIRECTIONS)]
    for way, able in enumerate(first):
        for sign in (1.0, -1.0):
            if able.any():
                wanted = {int(p): sign * _direction(freedoms[p], frames, way) for p in np.flatnonzero(able)}
                yield from _walk(solver, start, freedoms, wanted)


def _direction(freedom: BlockFreedom, frames: Array, way: int) -> Array:
    draw = np.random.default_rng(41 + way).standard_normal((len(freedom.bodies), 2, 3))
    return np.einsum("nij,nkj->nki", frames[freedom.bodies], draw).reshape(-1)


def _walk(
    solver: Solver, state: State, freedoms: list[BlockFreedom], wanted: dict[int, Array]
) -> Iterator[tuple[State, BoolArray]]:
    for step in range(STEPS):
        bodies: list[IntArray] = []
        twists: list[Array] = []
        for part in sorted(wanted):
            freedom = freedoms[part]
            along = freedom.basis @ (freedom.basis.T @ wanted[part])
            size = np.linalg.norm(along.reshape(-1, 3), axis=1).max(initial=0.0)
            if not size > 0.0 or step >= FEW_STEPS and 6 * len(freedom.bodies) > DENSE:
                del wanted[part]
                continue
            wanted[part] = along / size
            bodies.append(freedom.bodies)
            twists.append(STEP * wanted[part].reshape(-1, 6))
        active = np.isin(np.arange(solver.parts), list(wanted))
        if not active.any():
            return
        moved = solver.system.moved(state, np.concatenate(bodies), np.concatenate(twists))
        there, left = solver.project(moved, active)
        here = active & (left < CLOSED)
        lost = np.isin(solver.part, np.flatnonzero(active & ~here))
        there.rotation[lost], there.shift[lost] = state.rotation[lost], state.shift[lost]
        solver.system.remember(there)
        state = there
        wanted = {part: along for part, along in wanted.items() if here[part]}
        yield state, here
        freedoms = block_freedoms(solver, state)
