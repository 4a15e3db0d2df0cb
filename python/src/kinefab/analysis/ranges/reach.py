"""How far one coordinate of a mechanism with several freedoms can go, the others moving as they must.

The coordinate is followed uphill: of all motions of the mechanism the one that raises it with the least change
of everything else, along the limits of other joints where it meets them.  Where nothing raises it any more it
is at a top.  A top may be a mere saddle, or the lower of two, so the search leaves it in random directions and
climbs again, and starts a second time from the other end of the range; the widest range counts.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...spatial import Array
from ..equations.system import State
from ..freedom.first_order import block_freedoms
from .measured import Measured

STEP = 0.3
"""Length of a step: the fastest body's radians, or fractions of the length."""
SMALLEST = 1e-9
LEVEL = 1e-7
"""Slope below which a coordinate is at a top: rise of the coordinate for each unit of motion."""
NEARLY_LEVEL = 1e-5
"""Slope at which a top that rounding keeps from being climbed further is known to 1e-10."""
SETTLED = 1e-13
"""Rise for a step, radians or fractions of the length, that counts as none."""
MOST_STEPS = 400
KICK = 0.3
KICKS = 3
"""Times a top is left at random, and the size of it, in the terms of STEP."""
HIGHER = 1e-7
"""Rise above a top that makes it none."""
MOST_TOPS = 12
FAR = 10.0
"""A slide that has gone this many lengths has no end."""
ON_LIMIT = 1e-7


STEPS_IN_ALL = 5_000
"""Steps tried in the search of one mechanism, all its coordinates together; then it stops where it has come."""
WORK_IN_ALL = 4e9
"""Steps times the cube of the mechanism's unknowns (6 a part), likewise: about ten seconds."""


@dataclass(slots=True)
class _Pose:
    """state, turns: see ``Measured``.  q: the coordinates there.  lost: the way up ended where it should not."""

    state: State
    turns: Array
    q: Array
    lost: bool = False


class Reach:
    """The search in one block."""

    def __init__(self, block: Measured):
        self.block = block
        self.unit = np.where(block.rotary, 1.0, block.length)
        self.start = _Pose(block.start, block.turns, block.read(block.start, block.turns)[0])
        self.seen = 0.0, 0.0  # ends that were come to last
        self.draw = np.random.default_rng(29)
        self.steps = 0
        self.most = int(min(STEPS_IN_ALL, WORK_IN_ALL / (6.0 * len(block.bodies)) ** 3))

    @property
    def stopped(self) -> bool:
        """Whether the search has come to an end before it was done."""
        return self.steps >= self.most

    def range_of(self, i: int) -> tuple[float, float] | None:
        """Lower and upper end of coordinate i, metres or radians; infinite where it has none.

        None where the search was lost at a singular pose, or is ``stopped``: what it saw may not be all there is.
        """
        top, bottom = (self._highest(i, sign, self.start) for sign in (1.0, -1.0))
        if not self._gone(top.q[i], i):
            top = self._higher(i, 1.0, top, self._highest(i, 1.0, bottom))
        if not self._gone(bottom.q[i], i):
            bottom = self._higher(i, -1.0, bottom, self._highest(i, -1.0, top))
        low, high = float(bottom.q[i]), float(top.q[i])
        if self.block.rotary[i] and high - low >= math.tau:
            return -math.inf, math.inf
        self.seen = low, high
        if top.lost or bottom.lost or self.stopped:
            return None
        return -math.inf if self._gone(low, i) else low, math.inf if self._gone(high, i) else high

    def _gone(self, q: float, i: int) -> bool:
        """Whether a coordinate has gone so far that no end is to be expected: a whole turn, or FAR lengths."""
        return abs(q - self.start.q[i]) >= (math.tau if self.block.rotary[i] else FAR * self.block.length)

    def _highest(self, i: int, sign: float, start: _Pose) -> _Pose:
        """The highest top (for sign -1: the deepest bottom) found from a pose."""
        best = self._climbed(i, sign, start)
        kicks = tops = 0
        while kicks < KICKS and tops < MOST_TOPS and not self._gone(best.q[i], i):
            kicks, tops = kicks + 1, tops + 1
            kicked = self._kicked(best)
            if kicked is not None:
                last, best = best, self._higher(i, sign, best, self._climbed(i, sign, kicked))
                kicks = kicks if best is last else 0
        return best

    def _higher(self, i: int, sign: float, one: _Pose, other: _Pose) -> _Pose:
        """The other top where it is clearly higher, or as high and not lost."""
        rise = sign * (other.q[i] - one.q[i]) / self.unit[i]
        return other if rise > HIGHER or (one.lost and not other.lost and rise > -HIGHER) else one

    def _kicked(self, pose: _Pose) -> _Pose | None:
        """A pose a random way off, within the limits."""
        basis = block_freedoms(self.block.solver, pose.state)[0].basis
        for _ in range(KICKS):
            twist: Array = basis @ self.draw.standard_normal((basis.shape[1],))
            there = self._stepped(pose, {}, KICK * twist / np.abs(twist).max())
            if there is not None and not self._beyond(there.q):
                return there
        return None

    def _climbed(self, i: int, sign: float, pose: _Pose) -> _Pose:
        """Follow coordinate i up to where nothing raises it."""
        trust, last = math.inf, None
        for _ in range(MOST_STEPS):
            if self._gone(pose.q[i], i):
                return pose
            twist, held = self._uphill(pose, i, sign)
            slope = float(np.linalg.norm(twist))
            if slope < LEVEL:
                return pose
            # Barzilai and Borwein's step, from the last one and what it did to the slope.
            if last is not None:
                step, change = last[0], last[1] - twist
                bend = float(step @ change)
                trust = float(step @ step) / bend if bend > 0.0 else math.inf
            length = min(trust, STEP / np.abs(twist).max())
            there, length = self._raised(pose, i, sign, twist, held, length)
            rise = sign * (there.q[i] - pose.q[i])
            last, pose = (length * twist, twist), there
            if rise < SETTLED * self.unit[i]:
                return replace(pose, lost=slope > NEARLY_LEVEL)
        return replace(pose, lost=True)

    def _raised(
        self, pose: _Pose, i: int, sign: float, twist: Array, held: dict[int, float], length: float
    ) -> tuple[_Pose, float]:
        """The pose after a step that raises the coordinate, and the step's length; the same pose if none does."""
        while length * np.abs(twist).max() > SMALLEST:
            there = self._stepped(pose, held, length * twist)
            met = {} if there is None else self._beyond(there.q)
            if met:
                there = self._stepped(pose, held | met, length * twist)
                met = {} if there is None else self._beyond(there.q)
            if there is not None and not met and sign * (there.q[i] - pose.q[i]) > 0.0:
                return there, length
            length *= 0.3
        return pose, 0.0

    def _uphill(self, pose: _Pose, i: int, sign: float) -> tuple[Array, dict[int, float]]:
        """The steepest motion of the block (scaled twists, 6 n) that passes no limit, its length the slope, and the
        limits that it keeps to, by coordinate."""
        from scipy.optimize import nnls  # late: it takes a tenth of a second

        basis = block_freedoms(self.block.solver, pose.state)[0].basis
        rates = self.block.read(pose.state, pose.turns)[1] @ basis / self.unit[:, None]
        steepest = sign * rates[i]
        at = self._beyond(pose.q, -ON_LIMIT)
        if not at:
            return basis @ steepest, {}
        walls = np.array([rates[j] if end == self.block.upper[j] else -rates[j] for j, end in at.items()])
        push = nnls(walls.T, steepest)[0]
        held = {j: end for (j, end), strength in zip(at.items(), push) if strength > 0.0}
        return basis @ (steepest - walls.T @ push), held

    def _beyond(self, q: Array, by: float = 0.5 * ON_LIMIT) -> dict[int, float]:
        """The limits, by coordinate, that a pose is beyond by so much."""
        low, high = self.block.lower - by * self.unit, self.block.upper + by * self.unit
        found = {int(j): float(self.block.lower[j]) for j in np.flatnonzero(q < low)}
        return found | {int(j): float(self.block.upper[j]) for j in np.flatnonzero(q > high)}

    def _stepped(self, pose: _Pose, held: dict[int, float], twist: Array) -> _Pose | None:
        """A step, back on the rows and with the coordinates ``held`` at these values; None too when ``stopped``."""
        if self.stopped:
            return None
        self.steps += 1
        block = self.block
        if held:
            at = np.array(sorted(held))
            state = block.held(at, np.array([held[j] for j in at])).moved(pose.state, pose.turns, twist)
        else:
            state = block.moved(pose.state, twist)
        if state is None:
            return None
        turns = block.passed(state, pose.turns)
        return _Pose(state, turns, block.read(state, turns)[0])
