"""What contacts leave free between two bodies: with everything that touches kept, and with only what holds both ways.

A normal at a point is a row of a matrix on twists (translation, rotation * length), taken about a centre.  Rows that
cannot be left on their free side, since others push back, hold both ways: found by a linear programme.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...spatial import Array, BoolArray
from ..touching.contact import Contact

RANK = 1e-5
"""Singular values below this share of the largest are none: normals are unit, lengths scaled."""
CLOSED = 1e-4
"""How far a row may be left, of 1, and still counts as held."""
FARTHEST = 20.0
"""How far a twist may go in search of what it leaves; rounding in the geometry comes to a 1e-8th of that."""
HELD = 1e-5
"""How much of a unit row the others may miss to hold it."""


@dataclass(frozen=True, slots=True, eq=False)
class Scale:
    """center: WORLD, shape (3,).  length: metres."""

    center: Array
    length: float

    def rows(self, points: Array, normals: Array) -> Array:
        """What holds points along normals, shape (n, 3) each, WORLD: rows over the six of a twist about the centre,
        turns times the length, shape (n, 6)."""
        return np.hstack([normals, np.cross(points - self.center, normals) / self.length])


@dataclass(frozen=True, slots=True, eq=False)
class Freedom:
    """kept: twists with all that touches kept, shape (6, k), orthonormal.  held: those that only two-sided holds
    leave; kept is within it.  closed: for each contact whether its normals hold both ways."""

    kept: Array
    held: Array
    closed: tuple[bool, ...]


def null_space(rows: Array) -> Array:
    """Orthonormal basis of the twists that rows (n, 6) leave, shape (6, k)."""
    if not len(rows):
        return np.eye(rows.shape[1] if rows.ndim == 2 else 6)
    if len(rows) > rows.shape[1]:
        rows = np.linalg.qr(rows)[1]  # the same null space, and no square matrix of the number of rows
    _, values, right = np.linalg.svd(rows)
    rank = int(np.sum(values > RANK * max(float(values[0]), RANK)))
    return right[rank:].T


def freedom_of(contacts: Sequence[Contact], flips: Sequence[bool], scale: Scale) -> Freedom:
    """flips: for each contact whether its first part is on the second body."""
    both = [scale.rows(c.points, c.normals) for c in contacts if c.two_sided]
    base = null_space(np.concatenate(both) if both else np.zeros((0, 6)))
    single = [(i, c) for i, c in enumerate(contacts) if not c.two_sided and len(c.points)]
    closed = [c.two_sided for c in contacts]
    if not single or not base.shape[1]:
        for i, _ in single:
            closed[i] = True
        return Freedom(base, base, tuple(closed))
    blocks = [scale.rows(c.points, -c.normals if flips[i] else c.normals) @ base for i, c in single]
    owner = np.concatenate([np.full(len(block), k) for k, block in enumerate(blocks)])
    rows = np.concatenate(blocks)
    active = np.linalg.norm(rows, axis=1) > RANK
    holds = held_both_ways(rows)
    held = base @ null_space(rows[holds]) if holds.any() else base
    touching = np.array([single[int(k)][1].touching for k in owner])
    pressed = holds | (touching & active)
    kept = base @ null_space(rows[pressed]) if pressed.any() else base
    for k, (i, _) in enumerate(single):
        mine = owner == k
        closed[i] = bool(np.all(holds[mine] | ~active[mine]) and mine.any())
    return Freedom(kept, held, tuple(closed))


def held_both_ways(rows: Array) -> BoolArray:
    """Which rows (n, k), each of what can be left on one side alone, hold both ways since others push back, shape (n,)."""
    active = np.linalg.norm(rows, axis=1) > RANK
    left = np.ones(len(rows))
    if active.any():
        left[active] = _left(rows[active])
    return left <= CLOSED


def _left(rows: Array) -> Array:
    """How far each row can be left on its free side, at most 1, while none is crossed: max sum s, rows v >= s."""
    unit = rows / np.linalg.norm(rows, axis=1)[:, None]
    rounded, index = np.unique(unit.round(9), axis=0, return_inverse=True)
    count, size = rounded.shape
    if size == 1:  # along one freedom: held where there are both signs
        both = rounded.min() < 0.0 < rounded.max()
        return np.zeros(len(rows)) if both else np.ones(len(rows))
    from scipy.optimize import linprog  # late: it takes a tenth of a second

    found = linprog(
        np.concatenate([np.zeros(size), -np.ones(count)]),
        A_ub=np.hstack([-rounded, np.eye(count)]),
        b_ub=np.zeros(count),
        bounds=[(-FARTHEST, FARTHEST)] * size + [(0.0, 1.0)] * count,
        method="highs",
    )
    solution: Array | None = found.x if found.status == 0 else None
    values = _apart(rounded) if solution is None else solution[size:]
    return values[index.reshape(-1)]


def _apart(rows: Array) -> Array:
    """As ``_left``, row by row, where the programme fails: a row is held where the others add up to its opposite."""
    from scipy.optimize import nnls  # late, as above

    return np.array([float(nnls(rows.T, -row)[1] > HELD) for row in rows])
