"""Polygons to triangles: fans where a polygon is convex, ears where it is not."""

from __future__ import annotations

import numpy as np

from ....spatial import Array, cross

FLAT = 1e-12


def triangles(points: Array, counts: np.ndarray, corners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Triangles as numbers of corners, shape (m, 3), and the polygon of each, shape (m,), in the polygons' order.

    points: shape (n, 3).  counts: corners of each polygon, shape (f,).  corners: points of all polygons, one after
    another.  Polygons of less than three corners have none.
    """
    if len(counts) and (counts == 3).all():
        return np.arange(len(corners)).reshape(-1, 3), np.arange(len(counts))
    starts = np.cumsum(counts) - counts
    pieces: list[np.ndarray] = []
    owners: list[np.ndarray] = []
    for count in np.flatnonzero(np.bincount(counts)):  # counts add up to the corners, so none is large
        if count < 3:
            continue
        which = np.flatnonzero(counts == count)
        first = starts[which]
        if count == 3:
            pieces.append(first[:, None] + np.arange(3))
            owners.append(which)
            continue
        turn = np.zeros(len(which), dtype=np.int64)
        concave = _concave(points[corners[first[:, None] + np.arange(count)]])
        if count == 4:
            # The fan from a reflex corner lies inside; at most one corner of a plain quad is reflex.
            turn = np.where(concave.any(axis=1), concave.argmax(axis=1), 0)
            clipped = np.zeros(len(which), dtype=bool)
        else:
            clipped = concave.any(axis=1)
        order = (turn[:, None] + np.arange(count)) % count
        fan = np.stack(
            [np.column_stack([np.zeros(count - 2, int), np.arange(1, count - 1), np.arange(2, count)])]
        )[0]
        whole = ~clipped
        pieces.append((first[whole][:, None, None] + order[whole][:, fan]).reshape(-1, 3))
        owners.append(np.repeat(which[whole], count - 2))
        for polygon in which[clipped]:
            start = starts[polygon]
            ears = _ears(points[corners[start : start + count]])
            pieces.append(start + np.array(ears, dtype=np.int64))
            owners.append(np.full(len(ears), polygon))
    if not pieces:
        return np.zeros((0, 3), dtype=np.int64), np.zeros(0, dtype=np.int64)
    found, owner = np.concatenate(pieces), np.concatenate(owners)
    if len(pieces) > 1:
        order = np.argsort(owner, kind="stable")
        found, owner = found[order], owner[order]
    return found, owner


def _concave(polygons: Array) -> np.ndarray:
    """Which corners are reflex; shape (k, n, 3) to (k, n)."""
    forward = np.roll(polygons, -1, axis=1) - polygons
    turns = cross(np.roll(forward, 1, axis=1), forward)
    normal = cross(polygons, np.roll(polygons, -1, axis=1)).sum(axis=1)  # Newell's
    along = np.einsum("kni,ki->kn", turns, normal)
    return along < -FLAT * np.abs(along).max(axis=1, keepdims=True)


def _ears(polygon: Array) -> list[list[int]]:
    """Triangles of one simple polygon, shape (n, 3), in the plane that fits it best."""
    normal = cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0)
    drop = int(np.argmax(np.abs(normal)))
    flat = np.delete(polygon, drop, axis=1)
    if (normal[drop] < 0.0) != (drop == 1):
        flat = flat[:, ::-1]
    left = list(range(len(polygon)))
    found: list[list[int]] = []
    while len(left) > 3:
        for k in range(len(left)):
            a, b, c = left[k - 1], left[k], left[(k + 1) % len(left)]
            if _area(flat[a], flat[b], flat[c]) > 0.0 and not any(
                _inside(flat[p], flat[a], flat[b], flat[c]) for p in left if p not in (a, b, c)
            ):
                break
        else:
            k = 0  # not simple: any triangle is as good
        found.append([left[k - 1], left[k], left[(k + 1) % len(left)]])
        del left[k]
    return [*found, left]


def _area(a: Array, b: Array, c: Array) -> float:
    return float((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))


def _inside(p: Array, a: Array, b: Array, c: Array) -> bool:
    return _area(a, b, p) >= 0.0 and _area(b, c, p) >= 0.0 and _area(c, a, p) >= 0.0
