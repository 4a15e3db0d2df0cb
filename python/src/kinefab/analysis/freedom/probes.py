"""Trial steps: what is left of a velocity after a step along it and back onto the rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...spatial import Array, IntArray
from ..equations.solve import DENSE, Solver
from ..equations.system import State, repeated_state
from .first_order import BlockFreedom

STEP = 1e-3
"""Size of a trial step, radians or fractions of the length."""
SHORTEST_WAY = 1e-2
"""Way along which rows that do not quite repeat each other may come apart by what they are off by."""
FURTHEST = 0.2
"""Size of the largest."""
STILL = 1e-6
"""Share of a direction up to which nothing turns in it."""
WHOLE = 0.9
"""Share above which nothing is in doubt: a motion keeps all of itself, but for its curvature."""
HIDDEN = 1e-6
"""Way up to which nothing is left: an obstructed velocity keeps the root of the closing error, some 1e-7, whatever the step."""
ROUNDS = 3
"""Times that what is left of directions is tried again."""
OPEN = 1e4
"""Times the error asked for beyond which a pose that was to be closed got stuck: it is none of the mechanism's."""
SQUARE = 1e-2
"""Share of a trial step whose square is no more open than that: it hides no more of what is obstructed."""
TELLING = 0.125
"""Share of a step whose fourth power is no less open than the poses there, so that the step tells: what the fourth power of the
way obstructs keeps the fourth root of the closing error, 1e-3 to 1e-2 where rows that nearly repeat each other hold up the closing."""


def random_direction(basis: Array, draw: np.random.Generator) -> Array:
    direction: Array = basis @ draw.standard_normal((basis.shape[1],))
    return direction / np.abs(direction).max()


def floor_of(solver: Solver, state: State) -> Array:
    """A pose that cannot be closed further is asked for no more than it has, and none for more than rows repeat each other to."""
    return np.maximum(1e-14, 2.0 * solver.worst(solver.system.residual(state))) + SHORTEST_WAY * solver.cut


def _most_open(floor: Array, step: float) -> Array:
    """Residual of each part beyond which a trial step did not come back onto the rows."""
    return np.maximum(OPEN * floor, min((SQUARE * step) ** 2, (TELLING * step) ** 4))


def trial(
    solver: Solver,
    first_order: Mapping[int, BlockFreedom],
    start: State,
    directions: dict[int, Array],
    step: float = STEP,
    floor: Array | None = None,
    *,
    keep: bool = False,
    furthest: float = FURTHEST,
) -> tuple[dict[int, Array], Array, State]:
    """Displacements (6 n of each part), over their way, after a step along each direction and back onto the rows; the residual
    of each part there; and the pose.  What did not come back onto them has kept nothing, unless told to ``keep``.

    floor: see ``floor_of``, where it is known.  furthest: that a step goes beside a steep rack, see ``_way``."""
    bodies = np.concatenate([first_order[p].bodies for p in directions])
    ways = {part: _way(d, step, furthest) for part, d in directions.items()}
    twists = np.concatenate([ways[part] * d.reshape(-1, 6) for part, d in directions.items()])
    active = np.zeros(solver.parts, dtype=bool)
    active[list(directions)] = True
    state = solver.system.moved(start, bodies, twists)
    floor = floor_of(solver, start) if floor is None else floor
    state, left = solver.project(state, active, floor)
    stuck = left > _most_open(floor, step)
    moved = _displacement(solver, bodies, start, state)
    ends: list[int] = np.cumsum([6 * len(first_order[p].bodies) for p in directions]).tolist()
    own = zip(directions, [0, *ends], ends)
    return {part: moved[at:end] / ways[part] * (keep or not stuck[part]) for part, at, end in own}, left, state


def _way(direction: Array, step: float, furthest: float) -> float:
    """How far a trial step goes along a direction whose largest entry is 1: until what turns has gone ``step``, or to ``furthest``.

    Beside the slide of a steep rack a turn is little, and what its fourth power obstructs a rounding."""
    turn = float(np.abs(direction.reshape(-1, 6)[:, 3:]).max())
    return max(step, min(step / turn, furthest)) if turn > STILL else step


def _displacement(solver: Solver, bodies: IntArray, start: State, end: State) -> Array:
    """Scaled twist that takes the bodies from one state to a near one, to second order, shape (6 n,)."""
    turn = end.rotation[bodies] @ np.swapaxes(start.rotation[bodies], 1, 2)
    w = 0.5 * np.stack(
        [turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], axis=1
    )
    v = (end.shift[bodies] - start.shift[bodies]) / solver.system.length[bodies, None]
    return np.concatenate([v, w], axis=1).ravel()


def kept_of(
    solver: Solver, part: int, freedom: BlockFreedom, state: State, step: float, floor: Array | None = None
) -> tuple[Array, Array, float]:
    """Orthonormal directions of what trial steps both ways leave of a basis, shape (6 n, m), the share left of each, and the largest
    residual where the steps ended.

    An obstructed velocity takes a motion back along with it, or does not come back onto the rows with it: what is left of
    directions that hold both is tried again by itself before it has kept nothing.
    """
    basis = freedom.basis
    floor = floor_of(solver, state) if floor is None else floor
    for last in (*(False for _ in range(1, ROUNDS)), True):
        left, open_ = left_of_each(solver, part, freedom, state, basis.T, step, floor, keep=not last)
        u, s, _ = np.linalg.svd(left.T, full_matrices=False)
        some = s > HIDDEN / step
        if not some.any() or (open_ <= _most_open(floor, step)[part] and not np.any(some & (s < WHOLE))):
            break
        basis = u[:, some]
    return u, s, open_


def left_of_each(
    solver: Solver,
    part: int,
    freedom: BlockFreedom,
    state: State,
    directions: Array,
    step: float,
    floor: Array,
    *,
    keep: bool,
) -> tuple[Array, float]:
    """As ``left_of`` of several directions, shape (m, 6 n): what is left of each, and the largest residual.  All steps of a small
    part are taken at once, each in a copy of its own."""
    if solver.parts > 1 or 6 * len(freedom.bodies) > DENSE:
        tried = [left_of(solver, part, freedom, state, way, step, floor, keep=keep) for way in directions]
        return np.array([left for left, *_ in tried]), max(residual for _, residual, _ in tried)
    ways = directions / np.abs(directions).max(axis=1)[:, None]
    copies, states = solver.copies(2 * len(ways)), repeated_state(state, 2 * len(ways))
    bodies = np.arange(len(states.rotation) - 1).reshape(2 * len(ways), -1) + 1
    parts: list[int] = copies.part[bodies[:, 0]].tolist()
    blocks = {p: replace(freedom, bodies=own[freedom.bodies - 1]) for p, own in zip(parts, bodies)}
    wanted = dict(zip(parts, [*ways, *-ways]))
    moved, residual, _ = trial(copies, blocks, states, wanted, step, np.full(copies.parts, floor[part]), keep=keep)
    there, back = np.split(np.array([moved[p] for p in parts]), 2)
    return 0.5 * (there - back) / np.linalg.norm(ways, axis=1)[:, None], float(residual.max())


def left_of(
    solver: Solver,
    part: int,
    freedom: BlockFreedom,
    state: State,
    direction: Array,
    step: float,
    floor: Array | None = None,
    *,
    keep: bool = False,
) -> tuple[Array, float, tuple[State, State]]:
    """What trial steps both ways leave of a direction, as a share of its length, shape (6 n,); the larger residual where they
    ended, see ``trial``; and the two poses."""
    direction = direction / np.abs(direction).max()
    there, back = (
        trial(solver, {part: freedom}, state, {part: way}, step, floor, keep=keep) for way in (direction, -direction)
    )
    left = 0.5 * (there[0][part] - back[0][part]) / np.linalg.norm(direction)
    return left, max(float(there[1][part]), float(back[1][part])), (there[2], back[2])
