"""Cuts a ring into equal sectors about its axis.

A washer, a race or a bushing is hollow only because it goes around: where its section is nearly convex, no other cuts leave
less air in as many pieces.  It takes no Boolean: the hull of a sector rests on the vertices in it and on the points where
edges cross its two half planes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from ...spatial import Array, IntArray, bounds, cross, perpendicular
from .crossings import crossings

FEW, SOME, MANY = 8, 12, 16
"""Sectors, of which the fewest are taken that leave little air."""
ROUND = 0.1
"""Of their mean volume: what the hulls of the many may differ by.  Those of a frame of four or six sides differ by more."""
CONVEX = 0.1
"""Air that a section leaves in its own hull, as a share of the solid, up to which only going around makes the ring hollow."""


@dataclass(frozen=True, slots=True, eq=False)
class Ring:
    """What may be one: a closed mesh in one piece.

    points: shape (n, 3).  faces: shape (m, 3).  edges: pairs of points, each once, shape (2, k).  volume: the solid's.
    """

    points: Array
    faces: IntArray
    edges: IntArray
    volume: float


def ring_sectors(
    ring: Ring, axes: Iterable[Array], enough: float, filled: Callable[[Array], float]
) -> list[Array]:
    """The points of each sector, shape (n, 3); none of what is no round ring, or one whose section is far from convex.

    axes: unit vectors, any of which may be the ring's.  enough: air in all hulls together at which no more sectors are made.
    filled: volume of the hull of points.
    """
    for axis in axes:
        flat = _seen_along(axis, ring.points)
        if not _covers_origin(flat[ring.faces]) and (found := _about(flat, ring, enough, filled)):
            return found
    return []


def _about(flat: Array, ring: Ring, enough: float, filled: Callable[[Array], float]) -> list[Array]:
    """Those about an axis.  flat: the points seen along it, from where it passes, shape (n, 2)."""

    def cut(count: int) -> tuple[list[Array], Array]:
        sectors = _cut(flat, ring, count)
        return sectors, np.array([filled(sector) for sector in sectors])

    many, hulls = cut(MANY)
    if not many or np.ptp(hulls) > ROUND * hulls.mean():
        return []
    few, larger = cut(FEW)
    air, more = float(hulls.sum()) - ring.volume, float(larger.sum()) - ring.volume
    if more <= enough:
        return few
    # What going around leaves falls with the square of their number, as an arc's sagitta does; the rest is the section's.
    if (air * MANY**2 - more * FEW**2) / (MANY**2 - FEW**2) > CONVEX * ring.volume:
        return []
    some, between = cut(SOME)
    return some if some and float(between.sum()) - ring.volume <= enough else many


def _seen_along(axis: Array, points: Array) -> Array:
    """The points in a plane across the axis, from the middle of their extents, shape (n, 2)."""
    second = perpendicular(axis)
    flat = points @ np.column_stack([cross(second, axis), second])
    low, high = bounds(flat)
    return flat - 0.5 * (low + high)


def _covers_origin(triangles: Array) -> bool:
    """Whether the origin is in any of the triangles, shape (m, 3, 2), or on an edge."""
    ahead = np.roll(triangles, -1, axis=1)
    side = triangles[..., 0] * ahead[..., 1] - triangles[..., 1] * ahead[..., 0]
    return bool(((side >= 0.0).all(axis=1) | (side <= 0.0).all(axis=1)).any())


def _cut(flat: Array, ring: Ring, count: int) -> list[Array]:
    """The points of an even number of sectors; none where a half plane between two meets nothing: the ring is open."""
    points, both = ring.points, np.hstack([ring.points, flat])
    turn = 2.0 * np.pi / count
    number = np.floor_divide(np.arctan2(flat[:, 1], flat[:, 0]), turn).astype(np.int64) % count
    borders: list[Array] = [points[:0]] * count
    for k in range(count // 2):
        along = np.array([np.cos(k * turn), np.sin(k * turn)])
        height = flat @ np.array([-along[1], along[0]])
        crossing = crossings(both, ring.edges, height)
        ahead = crossing[:, 3:] @ along > 0.0
        if ahead.all() or not ahead.any():
            return []
        borders[k], borders[k + count // 2] = crossing[ahead, :3], crossing[~ahead, :3]
    return [np.concatenate([points[number == k], borders[k], borders[(k + 1) % count]]) for k in range(count)]
