"""The poses of a block with one freedom: a curve.

It is followed along its own tangent (pseudo-arclength), which passes dead points without noticing; there the
rate of some joint coordinate changes sign, and the place is found by bisection on the step.  Driving the
joint itself would stall there: s_min falls as the square root of the distance.
"""

from __future__ import annotations

import math

import numpy as np

from ...spatial import Array, BoolArray
from ..equations.system import State
from ..freedom.first_order import block_freedoms
from .measured import Measured

STEP = 0.05
"""Length of a step along the curve: the fastest body's radians, or fractions of the length."""
SMALLEST = 1e-4
MOST_STEPS = 4000
WORK_IN_ALL = 2.5e5
"""Steps tried times the bodies of the block, both ways together, after which the search stops where it has come: about a
minute."""
STRAIGHT = 0.95
"""Cosine between tangents of neighbouring poses; below it the step was too long."""
FAR = 20.0
"""A slide that has gone this many lengths has no end."""
TURNS = 3.0
"""So has a hinge after this many turns without the mechanism coming round."""
OVERLAP = 3
"""Steps walked past the starting pose, so that no turning point is missed at the seam."""


class _Lost(Exception):
    """The curve could not be followed between two of its poses."""


class Curve:
    """The poses of one block with one freedom, followed from the exported one both ways.

    zero: the coordinates at the exported pose, metres and radians: they count from the source's zero, which may lie anywhere.
    low, high: the ends that were come to.  steps: tried so far.
    """

    def __init__(self, block: Measured):
        self.block = block
        self.turns = block.turns
        self.zero = block.read(block.start, block.turns)[0]
        self.low, self.high = self.zero.copy(), self.zero.copy()
        self.steps = 0
        self.most = int(WORK_IN_ALL / len(block.bodies))

    @property
    def stopped(self) -> bool:
        """Whether the search has come to an end before it was done."""
        return self.steps >= self.most

    def ranges(self) -> tuple[Array, Array] | None:
        """Lower and upper ends of the block's coordinates, metres and radians from each joint's zero (not from the
        exported pose); infinite where there is none.

        None where the curve could not be followed to an end, or is ``stopped``: what was seen may not be all of it.
        """
        try:
            return self._ranges()
        except _Lost:
            return None

    def _ranges(self) -> tuple[Array, Array] | None:
        low, high = self.low, self.high
        endless = np.zeros(len(low), dtype=bool)
        for sign in (1.0, -1.0):
            came_round = self._follow(sign, low, high, endless)
            if came_round is None:
                return None
            if came_round:
                break
        return np.where(endless, -np.inf, low), np.where(endless, np.inf, high)

    def _tangent(self, state: State, towards: Array) -> Array:
        """Unit velocity along the curve, the way that ``towards`` goes.

        Where branches cross there are more velocities; the one nearest to the old is kept.
        """
        basis = block_freedoms(self.block.solver, state)[0].basis
        along = basis @ (basis.T @ towards)
        return along / np.abs(along).max()

    def _coordinates(self, state: State, tangent: Array) -> tuple[Array, Array]:
        """Joint coordinates and their rates along the tangent."""
        value, rates = self.block.read(state, self.turns)
        return value, rates @ tangent

    def _follow(self, sign: float, low: Array, high: Array, endless: BoolArray) -> bool | None:
        """Extend the ranges along one way of the curve; whether it came back to where it began, None if lost."""
        basis = block_freedoms(self.block.solver, self.block.start)[0].basis
        if basis.shape[1] > 1:  # branches cross here: which of them is followed would be a matter of rounding
            return None
        state, tangent = self.block.start, sign * basis[:, 0] / np.abs(basis[:, 0]).max()
        self.turns = self.block.turns
        q, rate = self._coordinates(state, tangent)
        step, travelled, overlap = STEP, 0.0, 0
        for _ in range(MOST_STEPS):
            if self.stopped:
                return None
            self.steps += 1
            there = self.block.moved(state, step * tangent)
            ahead = None if there is None else self._tangent(there, tangent)
            if (
                there is None
                or ahead is None
                or ahead @ tangent < STRAIGHT * np.linalg.norm(ahead) * np.linalg.norm(tangent)
            ):
                step *= 0.5
                if step < SMALLEST:
                    return None
                continue
            new_q, new_rate = self._coordinates(there, ahead)
            stop = self._first_limit(state, tangent, step, new_q)
            for i in np.flatnonzero(rate * new_rate < 0.0):
                at = self._turning_point(state, tangent, step, int(i))
                low[i], high[i] = min(low[i], at), max(high[i], at)
            if stop is not None:
                low[:], high[:] = np.minimum(low, stop), np.maximum(high, stop)
                return False
            low[:], high[:] = np.minimum(low, new_q), np.maximum(high, new_q)
            self.turns = self.block.passed(there, self.turns)
            travelled += step
            state, tangent, q, rate = there, ahead, new_q, new_rate
            step = min(STEP, 1.5 * step)
            if self._gone(q):
                endless |= (q <= low) | (q >= high)
                return False
            overlap += travelled > 3.0 * STEP and self._back(state) or overlap > 0
            if overlap > OVERLAP:
                endless |= self.block.rotary & (np.round((q - self.zero) / math.tau) != 0.0)
                return True
        return None

    def _between(self, state: State, twist: Array) -> State:
        """A pose on the way to the next one.  Raises ``_Lost`` where the mechanism cannot be brought back to its curve."""
        there = self.block.moved(state, twist)
        if there is None:
            raise _Lost
        return there

    def _gone(self, q: Array) -> bool:
        """Whether a coordinate has gone so far that it will not come back."""
        reach = np.where(self.block.rotary, TURNS * math.tau, FAR * self.block.length)
        return bool((np.abs(q - self.zero) >= reach).any())

    def _back(self, state: State) -> bool:
        """Whether every body is where it began, within a step."""
        start, bodies = self.block.start, self.block.bodies
        turn = np.abs(state.rotation[bodies] - start.rotation[bodies]).max()
        shift = np.abs((state.shift - start.shift)[bodies] / self.block.system.length[bodies, None]).max()
        return max(turn, shift) < STEP

    def _turning_point(self, state: State, tangent: Array, step: float, i: int) -> float:
        """The coordinate where its rate vanishes between two poses."""
        from scipy.optimize import brentq  # late: it takes a tenth of a second

        def rate(s: float) -> float:
            there = self._between(state, s * tangent)
            return float(self._coordinates(there, self._tangent(there, tangent))[1][i])

        s = brentq(rate, 0.0, step, xtol=1e-13, rtol=1e-14)
        there = self._between(state, s * tangent)
        return float(self._coordinates(there, tangent)[0][i])

    def _first_limit(self, state: State, tangent: Array, step: float, new_q: Array) -> Array | None:
        """Coordinates where the first joint meets a limit of the source's, or None when none does."""
        from scipy.optimize import brentq  # late: it takes a tenth of a second

        hits: list[float] = []
        lower, upper = self.block.lower, self.block.upper
        for i in np.flatnonzero((new_q > upper) | (new_q < lower)).tolist():
            bound = float(upper[i] if new_q[i] > upper[i] else lower[i])

            def beyond(s: float, i: int = i, bound: float = bound) -> float:
                there = self._between(state, s * tangent)
                return float(self._coordinates(there, tangent)[0][i]) - bound

            start = beyond(0.0)
            hits.append(brentq(beyond, 0.0, step, xtol=1e-13) if start * beyond(step) < 0.0 else 0.0)
        if not hits:
            return None
        there = self._between(state, min(hits) * tangent)
        return self._coordinates(there, tangent)[0]
