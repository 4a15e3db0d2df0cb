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
AT_ONCE = 1 << 18
"""Numbers that are looked at together: as far as the processor's cache goes."""


def extents(points: Array) -> tuple[Array, Array]:
    """Lowest and highest of points along ``DIRECTIONS``, each of shape (13,).  points: shape (n, 3)."""
    heights = DIRECTIONS @ points.T
    return heights.min(axis=1), heights.max(axis=1)


def placed_extents(
    points: Array, linear: Array, translations: Array, directions: Array = DIRECTIONS
) -> tuple[Array, Array]:
    """Lowest and highest of one cloud of points in several places, each of shape (k, directions).

    points: shape (n, 3).  linear: shape (k, 3, 3).  translations: shape (k, 3).
    """
    rows = np.ascontiguousarray(points.T)
    low, high = (np.empty((len(linear), len(directions))) for _ in range(2))
    together = max(1, AT_ONCE // (len(directions) * max(1, len(points))))
    for start in range(0, len(linear), together):
        part = slice(start, start + together)
        heights = (directions @ linear[part]) @ rows
        low[part], high[part] = heights.min(axis=2), heights.max(axis=2)
    along = translations @ directions.T
    return low + along, high + along


def close_pairs(low: Array, high: Array) -> IntArray:
    """Pairs of shapes whose extents overlap along every direction, the lower number first, in order; shape (k, 2).

    low, high: shape (n, directions).
    """
    order = np.argsort(low[:, 0], kind="stable")  # a sweep along the first direction
    low, high = low[order].T, high[order].T
    stops: IntArray = np.asarray(np.searchsorted(low[0], high[0], side="right"), dtype=np.int64)
    follow = np.maximum(stops - np.arange(len(order)) - 1, 0)  # those that begin before a shape ends
    ends = np.cumsum(follow)
    found: list[IntArray] = [np.zeros((0, 2), dtype=np.int64)]
    done = 0
    while done < len(order):
        before = int(ends[done - 1]) if done else 0
        stop = max(done + 1, int(np.searchsorted(ends, before + AT_ONCE, side="right")))
        own = np.arange(done, stop)
        first = np.repeat(own, follow[own])
        second = first + 1 + np.arange(len(first)) - np.repeat(ends[own] - follow[own] - before, follow[own])
        for lowest, highest in zip(low[1:], high[1:]):
            near = (lowest[second] <= highest[first]) & (highest[second] >= lowest[first])
            first, second = first[near], second[near]
        hits = order[np.column_stack([first, second])]
        found.append(np.sort(hits, axis=1))
        done = stop
    pairs = np.concatenate(found)
    return pairs[np.lexsort(pairs.T[::-1])]
