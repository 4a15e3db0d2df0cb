"""One block driven through the values of some of its coordinates, one straight piece after the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

import numpy as np

from ...spatial import Array
from ..equations.system import State
from .branching import crossings
from .coordinates import DrivenBlock
from .walk import Poses, Walk
from .way import Way, walked

STRAIGHT = 1e-9
"""Difference between steps, as a share of the step, up to which they are one straight way."""


class Run:
    """One block through the values of some of its coordinates.  goals: (frames, driven), metres and radians."""

    def __init__(self, block: DrivenBlock, driven: list[int], goals: Array):
        self.block, self.driven, self.goals = block, driven, goals
        self.walk = Walk(block.measured, block.independent(driven))
        self.before = block.measured.read(block.measured.start, block.measured.turns)[0]
        self.gap = 0.0
        self._poses: list[Poses] = []
        self._values: list[Array] = []
        self._legs: list[_Leg] = []

    def go(self, first: int, last: int) -> Way:
        """Walk from frame ``first`` (-1: where it stands now) straight to frame ``last`` and keep the frames after it."""
        start, target = self.walk.values, self.walk.values.copy()
        target[: len(self.driven)] = self.goals[last]
        way = walked(self.block, self.walk, target, shares(first, last), self.before)
        new = way.poses.at > 0.0 if first >= 0 else way.poses.at == 1.0
        self._poses.append(way.poses.taken(new))
        self._values.append(way.values[new])
        if len(way.values):
            self.before = way.values[-1]
        self.gap = max(self.gap, way.residual)
        self._legs.append(_Leg(first, last, start, target, way.knots))
        return way

    def poses(self, frames: int) -> tuple[Array, Array]:
        """Rotations, shape (frames, n + 1, 3, 3), and shifts, (frames, n + 1, 3), metres, of the block's bodies as in
        ``State``."""
        rotation, shift = (
            np.concatenate([getattr(poses, name) for poses in self._poses])[:frames]
            for name in ("rotation", "shift")
        )
        return rotation, shift

    def column(self, i: int, frames: int) -> Array:
        """The i-th driven coordinate's values so far, shape (frames,), metres and radians."""
        return np.concatenate(self._values)[:frames, i]

    def crossings(self) -> list[tuple[int, Array]]:
        """Where another motion crosses this one: how many frames lie up to there, and all held values, metres and radians."""
        legs = self._legs
        if len(self.block.measured.bodies) < 2:  # a body by itself has no loop
            return []

        def leg_at(place: float) -> tuple[_Leg, float]:
            number = min(int(place), len(legs) - 1)
            return legs[number], place - number

        def pose(place: float) -> State | None:
            leg, share = leg_at(place)
            return self.walk.single(leg.knots, share, leg.start, leg.target)

        found: list[tuple[int, Array]] = []
        for place in crossings(self.block.measured.system, _end_to_end([leg.knots for leg in legs]), pose):
            leg, share = leg_at(place)
            frames = leg.first + int(np.sum(shares(leg.first, leg.last) <= share))
            found.append((frames, leg.start + share * (leg.target - leg.start)))
        return found


@dataclass(frozen=True, slots=True, eq=False)
class _Leg:
    """One straight piece from frame ``first`` to frame ``last``, as far as it was walked.

    start, target: of the held values, metres and radians.
    """

    first: int
    last: int
    start: Array
    target: Array
    knots: Poses


def _end_to_end(legs: list[Poses]) -> Poses:
    """The knots of pieces one after the other, ``at`` counting pieces; where one begins the one before has ended."""
    moved = [replace(knots, at=knots.at + i) for i, knots in enumerate(legs)]
    kept = [knots if i == 0 else knots.taken(knots.at > i) for i, knots in enumerate(moved)]
    return Poses(*(np.concatenate([getattr(k, f.name) for k in kept]) for f in fields(Poses)))


def shares(first: int, last: int) -> Array:
    """Of a straight way between two frames, where the frames are; of the way to the first one, its end."""
    return np.array([0.0, 1.0]) if first < 0 else np.linspace(0.0, 1.0, last - first + 1)


def straight(goals: Array) -> Iterator[tuple[int, int]]:
    """The pieces of a path that can be walked straight: the way to its first frame (-1, 0), then (first, last)."""
    yield -1, 0
    first = 0
    steps = np.diff(goals, axis=0)
    for i in range(1, len(goals)):
        bends = i < len(steps) and not np.allclose(steps[i], steps[i - 1], rtol=STRAIGHT, atol=1e-12)
        if bends or i == len(goals) - 1:
            yield first, i
            first = i
