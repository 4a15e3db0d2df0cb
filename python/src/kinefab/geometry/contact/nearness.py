"""Which shapes come near each other, by their extents along a few directions."""

from __future__ import annotations

import numpy as np

from ...spatial import Array, IntArray

DIRECTIONS: Array = np.array(
    [
        *((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        *((1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)),
        *((1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)),
    ],
    dtype=np.float64,
)
"""Across a cube's faces, edges and corners, shape (13, 3): shapes apart along one of them do not touch."""


def extents(points: Array) -> tuple[Array, Array]:
    """Lowest and highest of points along ``DIRECTIONS``, each of shape (13,).  points: shape (n, 3)."""
    heights = DIRECTIONS @ points.T
    return heights.min(axis=1), heights.max(axis=1)


def close_pairs(low: Array, high: Array) -> IntArray:
    """Pairs of shapes whose extents overlap along every direction, the lower number first, in order; shape (k, 2).

    low, high: shape (n, directions).
    """
    order = np.argsort(low[:, 0], kind="stable")  # a sweep along the first direction
    stops: IntArray = np.asarray(np.searchsorted(low[order, 0], high[order, 0], side="right"), dtype=np.int64)
    swept_low, swept_high = low[order], high[order]
    found: list[IntArray] = []
    for k, stop in enumerate(stops.tolist()):
        if stop < k + 2:
            continue
        others = slice(k + 1, stop)
        before = swept_low[others, 1:] > swept_high[k, 1:]
        behind = swept_high[others, 1:] < swept_low[k, 1:]
        near = ~(before | behind).any(axis=1)
        hits = order[others][near]
        if len(hits):
            found.append(np.column_stack([np.minimum(order[k], hits), np.maximum(order[k], hits)]))
    if not found:
        return np.zeros((0, 2), dtype=np.int64)
    pairs = np.concatenate(found)
    return pairs[np.lexsort(pairs.T[::-1])]
