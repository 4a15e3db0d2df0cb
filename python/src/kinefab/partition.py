"""Numbers joined step by step to sets."""

from __future__ import annotations

import numpy as np

from .spatial import IntArray


class Partition:
    """Disjoint sets of 0..count-1, each known by its lowest, so that nothing depends on the order of joining."""

    def __init__(self, count: int):
        self._leader = list(range(count))

    def copy(self) -> Partition:
        """The same sets, to go on apart."""
        same = Partition(0)
        same._leader = [*self._leader]
        return same

    def find(self, i: int) -> int:
        """The lowest of the set that i is in."""
        leader = self._leader
        while leader[i] != i:
            leader[i] = leader[leader[i]]
            i = leader[i]
        return i

    def join(self, i: int, j: int) -> bool:
        """Make one set of two; False where they were one already."""
        i, j = self.find(i), self.find(j)
        self._leader[max(i, j)] = min(i, j)
        return i != j

    def labels(self) -> IntArray:
        """Shape (count,): 0, 1, ... in order of each set's lowest."""
        roots = np.array([self.find(i) for i in range(len(self._leader))])
        return np.unique(roots, return_inverse=True)[1].reshape(-1)
