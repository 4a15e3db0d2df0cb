"""One block driven through the values of some of its coordinates, one straight piece after the other."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...spatial import Array
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

    def go(self, first: int, last: int) -> Way:
        """Walk from frame ``first`` (-1: where it stands now) straight to frame ``last`` and keep the frames after it."""
        target = self.walk.values.copy()
        target[: len(self.driven)] = self.goals[last]
        way = walked(self.block, self.walk, target, shares(first, last), self.before)
        new = way.poses.at > 0.0 if first >= 0 else way.poses.at == 1.0
        self._poses.append(way.poses.taken(new))
        self._values.append(way.values[new])
        if len(way.values):
            self.before = way.values[-1]
        self.gap = max(self.gap, way.residual)
        return way

    def poses(self, frames: int) -> tuple[Array, Array]:
        rotation, shift = (
            np.concatenate([getattr(poses, name) for poses in self._poses])[:frames]
            for name in ("rotation", "shift")
        )
        return rotation, shift

    def column(self, i: int, frames: int) -> Array:
        return np.concatenate(self._values)[:frames, i]


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
