"""Follows a block from pose to pose while some of its coordinates are moved.

The way is walked in knots, each predicted by the polynomial through the last ones, so that the branch is kept, and
brought back onto the rows; where no further knot is found however near, the mechanism is at a dead point.  Poses
asked for in between are predicted from the knots around them and solved all at once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...spatial import Array, BoolArray
from ..equations.solve import Solver
from ..equations.system import State, System, joined, repeated
from ..ranges.measured import Measured

STEP = 0.3
"""Longest step between knots: a held coordinate's radians, or fractions of the length."""
FIRST_STEP = 0.05
SMALLEST = 1e-10
"""Shortest one: what stops the way within it is a dead point."""
REACHED = 1e-11
"""Scaled residual of a pose that is one of the mechanism's."""
FLOOR = 20.0
"""Times the residual that the closed pose itself is left with, where that is larger."""
ASTRAY = 0.1
"""A pose this far from where it was predicted, radians or fractions of the length, may be another branch's."""
STRAY_SHARE = 0.5
"""Likewise where it is that much of the step itself."""
SURE = 0.02
"""A prediction this near lets the next step be longer."""
ITERATIONS = 16
DEGREE = 3
"""Of the polynomials that poses are predicted by."""


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """A block's bodies at several places of the way, ``at`` (from 0 to 1, ascending).

    rotation: (poses, n + 1, 3, 3) and shift: (poses, n + 1, 3), metres, as in ``State``.  angle: (poses, atoms).
    """

    at: Array
    rotation: Array
    shift: Array
    angle: Array

    def predicted(self, at: Array) -> Poses:
        """The poses at other places, by the polynomial through the nearest ones."""
        count = min(DEGREE + 1, len(self.at))
        first = np.searchsorted(self.at, at) - (count + 1) // 2
        near = np.clip(first, 0, len(self.at) - count)[:, None] + np.arange(count)
        weight = _lagrange(self.at[near], at)
        rotation, shift, angle = (
            np.einsum("fk,fk...->f...", weight, values[near])
            for values in (self.rotation, self.shift, self.angle)
        )
        return Poses(at, _orthonormal(rotation), shift, angle)

    def state(self, i: int) -> State:
        return State(self.rotation[i], self.shift[i], self.angle[i])

    def taken(self, which: BoolArray) -> Poses:
        """Some of the poses (a mask)."""
        return Poses(self.at[which], self.rotation[which], self.shift[which], self.angle[which])

    def merged(self, other: Poses) -> Poses:
        """The poses of both, in order of place."""
        order = np.argsort(np.concatenate([self.at, other.at]), kind="stable")
        pairs = ((getattr(self, f), getattr(other, f)) for f in ("at", "rotation", "shift", "angle"))
        return Poses(*(np.concatenate(pair)[order] for pair in pairs))

    @staticmethod
    def of(at: Sequence[float], states: Sequence[State]) -> Poses:
        columns = zip(*((s.rotation, s.shift, s.angle) for s in states))
        return Poses(np.array(at), *(np.array(column) for column in columns))


def _lagrange(knots: Array, at: Array) -> Array:
    """Weights of the values at ``knots``, shape (n, k), for the polynomial's values ``at``, shape (n,)."""
    weight = np.ones(knots.shape)
    for i in range(knots.shape[1]):
        for j in range(knots.shape[1]):
            if i != j:
                weight[:, i] *= (at - knots[:, j]) / (knots[:, i] - knots[:, j])
    return weight


def _orthonormal(rotation: Array) -> Array:
    """The rotations nearest to matrices that nearly are ones (Newton's iteration for the polar factor)."""
    for _ in range(4):
        rotation = rotation @ (1.5 * np.eye(3) - 0.5 * np.swapaxes(rotation, -1, -2) @ rotation)
    return rotation


class Walk:
    """A block whose coordinates ``held`` (their places among the block's) are moved from value to value.

    values: where they stand, metres and radians.  state: the block's pose there.
    smallest: see ``SMALLEST``; the place of a dead point is known that exactly.
    """

    def __init__(self, block: Measured, held: Sequence[int], smallest: float = SMALLEST):
        self.smallest = smallest
        self.block = block
        self.held = np.array(held, dtype=np.int64)
        order = np.argsort(self.held)
        rows = block.probe.select(self.held[order])
        self._column = order
        """For each of the held rows the place of its coordinate among ``held``."""
        rows.row_length = np.where(rows.is_length, block.length, 1.0)
        self.system: System = joined(block.system, rows)
        self._first = len(block.system.kind)
        self.solver = Solver(self.system)
        own = np.isin(block.probe.row, self.held)
        angle = np.concatenate([block.start.angle, block.turns[own]])
        self.state = State(block.start.rotation, block.start.shift, angle)
        self.values: Array = block.read(block.start, block.turns)[0][self.held]
        floor = float(np.abs(block.system.residual(block.start)).max(initial=0.0))
        self.reached = max(REACHED, FLOOR * floor)

    def towards(self, target: Array) -> tuple[Poses, bool]:
        """Walk to these values; the knots on the way (``at`` is the share of it), and whether the end was reached.

        The walk stands at the last knot then.
        """
        start, target = self.values, np.asarray(target, dtype=float)
        unit = np.where(self.block.rotary[self.held], 1.0, self.block.length)
        way = float(np.abs((target - start) / unit).max(initial=0.0))
        at, states = [0.0], [self.state]
        if way == 0.0:
            return Poses.of(at, states), True
        step, longest = min(FIRST_STEP / way, 1.0), STEP / way
        while at[-1] < 1.0:
            goal = min(at[-1] + step, 1.0)
            if 1.0 - goal < 1e-3 * step:
                goal = 1.0
            recent = Poses.of(at[-DEGREE - 1 :], states[-DEGREE - 1 :])
            guess = recent.predicted(np.array([goal])).state(0)
            found = self._solved(guess, start + goal * (target - start))
            stray = np.inf if found is None else self._distance(guess, found)
            if found is None or not self._on_the_branch(stray, self._distance(states[-1], found), len(at)):
                step = 0.5 * (goal - at[-1])
                if step * way < self.smallest:
                    break
                continue
            step = min(longest, (goal - at[-1]) * (2.0 if stray < SURE else 1.0))
            at.append(goal)
            states.append(found)
        self.state, self.values = states[-1], start + at[-1] * (target - start)
        return Poses.of(at, states), at[-1] == 1.0

    def _on_the_branch(self, stray: float, moved: float, knots: int) -> bool:
        return stray < ASTRAY and (knots < 3 or stray < STRAY_SHARE * moved + 1e-4)

    def _solved(self, guess: State, values: Array) -> State | None:
        self.system.d[self._first :] = values[self._column]
        state, left = self.solver.project(guess, None, 0.1 * self.reached, ITERATIONS)
        if not left.max(initial=0.0) < self.reached:
            return None
        self.system.remember(state)
        return state

    def _distance(self, one: State, other: State) -> float:
        bodies = self.block.bodies
        turn = np.abs(one.rotation[bodies] - other.rotation[bodies]).max(initial=0.0)
        shift = (one.shift - other.shift)[bodies] / self.system.length[bodies, None]
        return float(max(turn, np.abs(shift).max(initial=0.0)))

    def between(self, knots: Poses, at: Array, start: Array, target: Array) -> Poses:
        """The poses at some shares of a way that was walked from ``start`` towards ``target``, shape (poses,)."""
        guess = knots.predicted(at)
        count, n = len(at), self.system.bodies - 1
        many = repeated(self.system, count)
        values = start + at[:, None] * (target - start)
        held = np.arange(len(self.system.kind)) >= self._first
        many.d[np.tile(held, count)] = values[:, self._column].ravel()
        state, left = Solver(many).project(_stacked(guess), None, 0.1 * self.reached, ITERATIONS)
        many.remember(state)
        rotation, shift = (
            np.concatenate(
                [values[:1][None].repeat(count, 0), values[1:].reshape(count, n, *values.shape[1:])], 1
            )
            for values in (state.rotation, state.shift)
        )
        poses = Poses(at, rotation, shift, state.angle.reshape(count, -1))
        for i in np.flatnonzero(left >= self.reached):  # a pose that needs a nearer start than its neighbours
            self._again(poses, knots, int(i), values[i])
        return poses

    def _again(self, poses: Poses, knots: Poses, i: int, values: Array) -> None:
        near = knots.state(int(np.argmin(np.abs(knots.at - poses.at[i]))))
        found = self._solved(near, values)
        if found is not None:
            poses.rotation[i], poses.shift[i], poses.angle[i] = found.rotation, found.shift, found.angle

    def misfit(self, poses: Poses) -> float:
        """The largest residual of the block's own rows at some poses, radians or fractions of the length."""
        own = repeated(self.block.system, len(poses.at))
        state = _stacked(poses)
        state.angle = poses.angle[:, : self._first].ravel()
        return float(np.abs(own.residual(state)).max(initial=0.0))

    def single(self, knots: Poses, at: float, start: Array, target: Array) -> State | None:
        """The pose at one share of a walked way."""
        guess = knots.predicted(np.array([at])).state(0)
        return self._solved(guess, start + at * (target - start))


def _stacked(poses: Poses) -> State:
    """The poses as one state of a repeated system: ground once, then the bodies of each."""
    ground = poses.rotation[:1, 0], poses.shift[:1, 0]
    rotation, shift = (
        np.concatenate([first, values[:, 1:].reshape(-1, *values.shape[2:])])
        for first, values in zip(ground, (poses.rotation, poses.shift))
    )
    return State(rotation, shift, poses.angle.ravel())


def coordinates_at(block: Measured, poses: Poses) -> Array:
    """All coordinates of a block at the poses of a way that began at its start, shape (poses, k); angles unwrapped."""
    probe = repeated(block.probe, len(poses.at))
    state = _stacked(poses)
    state.angle = np.zeros(len(probe.kind))
    value = probe.residual(state).reshape(len(poses.at), -1)
    return np.where(block.rotary, np.unwrap(value, axis=0), value)
