"""Plane faces laid on each other: the corners of what they have in common, from their triangles."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...spatial import Array, cross, perpendicular

MOST = 12
"""Corners of an overlap that are kept."""
EDGE = 1e-6
"""Share of the larger outline by which a point may be outside and still counts as on it."""


def inside(corners: Array, normal: Array, points: Array) -> np.ndarray:
    """Which points, in the plane of the triangles (n, 3, 3), lie in one of them; shape (k,)."""
    flat = _axes(normal)
    return _inside(corners @ flat.T, points @ flat.T)


def _axes(normal: Array) -> Array:
    x = perpendicular(normal)
    return np.array([x, cross(normal, x)])


def _inside(triangles: Array, points: Array) -> np.ndarray:
    """In two dimensions: triangles (n, 3, 2) of either sense, points (k, 2)."""
    if not len(points) or not len(triangles):
        return np.zeros(len(points), dtype=bool)
    size = float(np.ptp(triangles.reshape(-1, 2), axis=0).max())
    a, b, c = (triangles[:, i] for i in range(3))
    turn = np.sign((b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0]))
    within = np.ones((len(points), len(triangles)), dtype=bool)
    for p, q in ((a, b), (b, c), (c, a)):
        edge = q - p
        length = np.maximum(np.linalg.norm(edge, axis=1), 1e-300)
        offset = points[:, None] - p[None]
        distance = turn * (edge[:, 0] * offset[..., 1] - edge[:, 1] * offset[..., 0]) / length
        within &= distance >= -EDGE * size
    return within.any(axis=1)


def common(first: Outline, second: Outline, normal: Array) -> tuple[Array, float]:
    """Corners of the overlap of two plane faces, seen along the normal, and the area of its hull, m^2.

    The corners, shape (k, 3), lie in the second face's plane; none where the faces only touch along an edge or not at
    all.  They are those of the overlap's convex hull.
    """
    axes = _axes(normal)
    (a, edges_a), (b, edges_b) = first.near(second), second.near(first)
    a, b, edges_a, edges_b = a @ axes.T, b @ axes.T, edges_a @ axes.T, edges_b @ axes.T
    pa, pb = _corners(a), _corners(b)
    found = [pa[_inside(b, pa)], pb[_inside(a, pb)], _crossings(edges_a, edges_b)]
    points = np.concatenate(found)
    if len(points) < 3:
        return np.zeros((0, 3)), 0.0
    hull = hull_of(points)
    area = _area(hull)
    size = float(np.ptp(points, axis=0).max())
    if area <= 1e-5 * size * size or len(hull) < 3:
        return np.zeros((0, 3)), 0.0
    height = float(second.triangles[0, 0] @ normal)
    hull = _farthest(hull)
    return hull @ axes + height * normal, area


@dataclass(frozen=True, eq=False)
class Outline:
    """A plane face: its triangles (n, 3, 3) and its edges (k, 2, 3)."""

    triangles: Array
    edges: Array

    @cached_property
    def _boxes(self) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        return _box(self.triangles), _box(self.edges)

    @cached_property
    def box(self) -> tuple[Array, Array]:
        """Lower and upper corner of the whole."""
        corners = self.triangles.reshape(-1, 3)
        return corners.min(axis=0), corners.max(axis=0)

    def near(self, other: Outline) -> tuple[Array, Array]:
        """The triangles and edges whose boxes meet the other's box, widened by what the two may be apart."""
        low, high = other.box
        margin = float((high - low).max())  # more than flats that face each other are apart
        triangles, edges = self._boxes
        return (
            self.triangles[_meeting(triangles, low - margin, high + margin)],
            self.edges[_meeting(edges, low - margin, high + margin)],
        )


def _box(pieces: Array) -> tuple[Array, Array]:
    """Lower and upper corners, shape (3, n) each."""
    return np.ascontiguousarray(pieces.min(axis=1).T), np.ascontiguousarray(pieces.max(axis=1).T)


def _meeting(boxes: tuple[Array, Array], low: Array, high: Array) -> np.ndarray:
    lows, highs = boxes
    found = np.flatnonzero((lows[0] <= high[0]) & (highs[0] >= low[0]))
    for axis in (1, 2):
        found = found[(lows[axis, found] <= high[axis]) & (highs[axis, found] >= low[axis])]
    return found


def outline_of(triangles: Array) -> Outline:
    """The outline of a plane face: edges that belong to one triangle only."""
    size = float(np.ptp(triangles.reshape(-1, 3), axis=0).max())
    _, first, index = np.unique(
        (triangles.reshape(-1, 3) / max(size, 1e-300)).round(9),
        axis=0,
        return_index=True,
        return_inverse=True,
    )
    points = triangles.reshape(-1, 3)[first]
    corners = index.reshape(-1, 3)
    edges = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]), axis=1)
    single, counts = np.unique(edges, axis=0, return_counts=True)
    return Outline(triangles, points[single[counts == 1]])


def _farthest(hull: Array) -> Array:
    """Of many corners those that reach farthest in some directions: a ring needs no more to lie firmly."""
    if len(hull) <= MOST:
        return hull
    angles = 2.0 * math.pi * np.arange(MOST) / MOST
    reach = hull @ np.array([np.cos(angles), np.sin(angles)])
    return hull[np.unique(np.argmax(reach, axis=0))]


def _corners(triangles: Array) -> Array:
    return np.unique(triangles.reshape(-1, 2).round(12), axis=0)


def _crossings(a: Array, b: Array) -> Array:
    """Points where segments (n, 2, 2) of the one cross segments of the other."""
    if not len(a) or not len(b):
        return np.zeros((0, 2))
    p, r = a[:, None, 0], (a[:, 1] - a[:, 0])[:, None]
    q, s = b[None, :, 0], (b[:, 1] - b[:, 0])[None]
    turn = r[..., 0] * s[..., 1] - r[..., 1] * s[..., 0]
    offset = q - p
    with np.errstate(divide="ignore", invalid="ignore"):
        t = (offset[..., 0] * s[..., 1] - offset[..., 1] * s[..., 0]) / turn
        u = (offset[..., 0] * r[..., 1] - offset[..., 1] * r[..., 0]) / turn
    meet = (np.abs(turn) > 1e-14) & (t >= 0.0) & (t <= 1.0) & (u >= 0.0) & (u <= 1.0)
    i, j = np.nonzero(meet)
    return a[i, 0] + t[i, j][:, None] * (a[i, 1] - a[i, 0])


def hull_of(points: Array) -> Array:
    """Corners of the convex hull of points in the plane, counter-clockwise (Andrew's monotone chain)."""
    ordered = sorted({(float(x), float(y)) for x, y in points.round(12)})
    if len(ordered) < 3:
        return np.array(ordered).reshape(-1, 2)

    def chain(sequence: list[tuple[float, float]]) -> list[tuple[float, float]]:
        kept: list[tuple[float, float]] = []
        for p in sequence:
            while len(kept) > 1 and _turn(kept[-2], kept[-1], p) <= 0.0:
                kept.pop()
            kept.append(p)
        return kept[:-1]

    return np.array(chain(ordered) + chain(ordered[::-1])).reshape(-1, 2)


def _turn(a: tuple[float, float], b: tuple[float, float], c: tuple[float, float]) -> float:
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


def _area(hull: Array) -> float:
    x, y = hull[:, 0], hull[:, 1]
    return 0.5 * abs(float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1))))
