"""The pixels that triangles cover, and how near each is there."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...spatial import Array, IntArray

MOST = 2_000_000
"""Pixels tried at a time, of the boxes around the triangles."""
FAR = 1e9
"""Columns; beyond every picture."""


@dataclass(frozen=True, slots=True, eq=False)
class Fragments:
    """pixel: row times width plus column.  depth: nearer is larger.  triangle: its number.  weight: (n, 3), barycentric."""

    pixel: IntArray
    depth: Array
    triangle: IntArray
    weight: Array


def fragments(flat: Array, depth: Array, width: int, height: int) -> Iterator[Fragments]:
    """What triangles cover of a picture, some triangles at a time.

    flat: corners in pixels, shape (n, 3, 2), y downwards.  depth: of the corners, shape (n, 3).
    """
    low = np.ceil(flat.min(axis=1) - 0.5).astype(np.int64)
    high = np.floor(flat.max(axis=1) - 0.5).astype(np.int64)
    low, high = np.maximum(low, 0), np.minimum(high, [width - 1, height - 1])
    size = np.maximum(high - low + 1, 0)
    area = size[:, 0] * size[:, 1]
    edge_u, edge_v = flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]
    twice = edge_u[:, 0] * edge_v[:, 1] - edge_u[:, 1] * edge_v[:, 0]
    some = np.flatnonzero((area > 0) & (np.abs(twice) > 1e-9))
    ends = np.searchsorted(np.cumsum(area[some]), np.arange(MOST, int(area[some].sum()) + MOST, MOST))
    for chosen in np.split(some, np.unique(ends)):
        if not len(chosen):
            continue
        row = np.repeat(chosen, size[chosen, 1])
        height_of = low[row, 1] + _counted(size[chosen, 1])
        left, right = _ends(flat[row], height_of + 0.5, twice[row])
        left, right = np.maximum(left, low[row, 0]), np.minimum(right, high[row, 0])
        long = np.maximum(right - left + 1, 0)
        of, x, y = np.repeat(row, long), np.repeat(left, long) + _counted(long), np.repeat(height_of, long)
        away_x, away_y = x + 0.5 - flat[of, 0, 0], y + 0.5 - flat[of, 0, 1]
        b = (away_x * edge_v[of, 1] - away_y * edge_v[of, 0]) / twice[of]
        c = (edge_u[of, 0] * away_y - edge_u[of, 1] * away_x) / twice[of]
        inside = (b >= -1e-9) & (c >= -1e-9) & (b + c <= 1.0 + 1e-9)
        of, b, c = of[inside], b[inside], c[inside]
        weight = np.stack([1.0 - b - c, b, c], axis=1)
        near = np.einsum("ni,ni->n", weight, depth[of])
        yield Fragments(y[inside] * width + x[inside], near, of, weight)


def _counted(lengths: IntArray) -> IntArray:
    """0, 1, 2 ... for each of the lengths, one after the other."""
    return np.arange(int(lengths.sum())) - np.repeat(np.cumsum(lengths) - lengths, lengths)


def _ends(flat: Array, y: Array, twice: Array) -> tuple[IntArray, IntArray]:
    """The first and the last column in which a triangle can cover a pixel of a line, one more to each side than it does.

    A long thin triangle that lies aslant covers one in thirty of the pixels of the box around it.  flat: (n, 3, 2), of each
    line its triangle.  y: of the line.  twice: its area, doubled, with its sign; of one that is next to nothing, and by a
    side that runs along the line, no column is left out, since rounding decides there.
    """
    first, last = np.full(len(y), -FAR), np.full(len(y), FAR)
    for i in range(3):
        start, along = flat[:, i], flat[:, (i + 1) % 3] - flat[:, i]
        decides = (np.abs(along[:, 1]) > 1e-6) & (np.abs(twice) > 1e-3)
        rise = np.where(decides, along[:, 1], 1.0)
        crossed = start[:, 0] + (y - start[:, 1]) * along[:, 0] / rise
        inward = rise * twice < 0.0
        first = np.where(decides & inward, np.maximum(first, crossed), first)
        last = np.where(decides & ~inward, np.minimum(last, crossed), last)
    first, last = np.clip(first, -FAR, FAR), np.clip(last, -FAR, FAR)
    return np.floor(first - 0.5).astype(np.int64) - 1, np.ceil(last - 0.5).astype(np.int64) + 1


def nearest_last(flat: Array, depth: Array, width: int, height: int, same: float) -> IntArray:
    """The triangles that are seen, in an order of drawing in which the one seen at a pixel comes after all others there.

    Where triangles overlap in a circle, the farther comes first.  same: depths so near count as one.
    """
    pixel, near, of = [np.zeros(0, np.int64)], [np.zeros(0)], [np.zeros(0, np.int64)]
    for found in fragments(flat, depth, width, height):
        pixel.append(found.pixel)
        near.append(found.depth)
        of.append(found.triangle)
    pixels, depths, triangles = np.concatenate(pixel), np.concatenate(near), np.concatenate(of)
    order = np.lexsort((depths, pixels))
    pixels, depths, triangles = pixels[order], depths[order], triangles[order]
    last = (
        np.flatnonzero(np.append(pixels[1:] != pixels[:-1], True)) if len(pixels) else np.zeros(0, np.int64)
    )
    top = last[np.searchsorted(last, np.arange(len(pixels)))] if len(pixels) else last
    seen = np.unique(triangles[last])
    behind = (depths < depths[top] - same) & (triangles != triangles[top])
    pairs = np.unique(np.stack([triangles[behind], triangles[top[behind]]], axis=1), axis=0)
    pairs = pairs[np.isin(pairs[:, 0], seen)]
    return _sorted(seen, pairs, depth.mean(axis=1))


def _sorted(seen: IntArray, pairs: IntArray, depth: Array) -> IntArray:
    """Each pair's first before its second, else the farther first."""
    from heapq import heapify, heappop, heappush

    after: dict[int, list[int]] = {}
    waits = dict.fromkeys(seen.tolist(), 0)
    for first, second in pairs.tolist():
        after.setdefault(first, []).append(second)
        waits[second] += 1
    by_depth = sorted(waits, key=lambda t: depth[t])
    ready = [(float(depth[t]), t) for t in by_depth if not waits[t]]
    heapify(ready)
    done: list[int] = []
    left = iter(by_depth)
    while len(done) < len(waits):
        if not ready:  # a circle
            stuck = next(t for t in left if waits[t] > 0)
            waits[stuck] = 0
            heappush(ready, (float(depth[stuck]), stuck))
        t = heappop(ready)[1]
        done.append(t)
        waits[t] = -1
        for other in after.get(t, ()):
            if waits[other] > 0:
                waits[other] -= 1
                if not waits[other]:
                    heappush(ready, (float(depth[other]), other))
    return np.array(done, dtype=np.int64)
