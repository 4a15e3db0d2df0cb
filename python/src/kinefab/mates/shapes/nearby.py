"""Which parts come near each other: a grid of boxes, so that cost grows with the parts and not with their pairs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence
from itertools import product

import numpy as np

from ...spatial import Array

MOST_CELLS = 64
"""A part that would fill more cells than this is compared with all others instead."""


def near_pairs(lows: Array, highs: Array, margins: Sequence[float] | Array) -> list[tuple[int, int]]:
    """Pairs (i, j), i < j, sorted, of boxes that come closer than the smaller of their margins, metres.

    lows, highs: shape (n, 3).  Time is near-linear in n where few boxes are much larger than the others.
    """
    count = len(lows)
    if count < 2:
        return []
    margin = np.asarray(margins, dtype=np.float64)[:, None]
    low, high = lows - margin, highs + margin
    cell = max(float(np.median(np.max(high - low, axis=1))), 1e-9)
    first, last = np.floor(low / cell).astype(np.int64), np.floor(high / cell).astype(np.int64)
    cells = np.prod(last - first + 1, axis=1)
    wide = np.flatnonzero(cells > MOST_CELLS)
    found: set[tuple[int, int]] = set()
    grid: defaultdict[tuple[int, ...], list[int]] = defaultdict(list)
    is_wide = np.zeros(count, dtype=bool)
    is_wide[wide] = True
    for i in np.flatnonzero(~is_wide).tolist():
        ranges = [range(int(a), int(b) + 1) for a, b in zip(first[i], last[i])]
        for key in product(*ranges):
            grid[key].append(i)
    for members in grid.values():
        index = np.array(members)
        for k, i in enumerate(members[:-1]):
            others = index[k + 1 :]
            touching = _meet(lows, highs, i, others, margin)
            found.update((i, int(j)) for j in others[touching])
    everyone = np.arange(count)
    for i in wide.tolist():
        others = everyone[everyone != i]
        touching = _meet(lows, highs, i, others, margin)
        found.update((min(i, int(j)), max(i, int(j))) for j in others[touching])
    return sorted(found)


def _meet(lows: Array, highs: Array, i: int, others: np.ndarray, margin: Array) -> np.ndarray:
    gap = np.minimum(margin[others], margin[i])
    return np.all((lows[others] <= highs[i] + gap) & (highs[others] >= lows[i] - gap), axis=1)
