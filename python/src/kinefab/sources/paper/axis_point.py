"""Where an axis of known direction lies: the cylinder that two parts' vertices share along that direction.

Seen along the axis a bore and its pin are two concentric circles of vertices.  Neighbouring vertices of a
circle give its centre; centres that many vertices agree on are fitted, and one that both parts have is the
axis.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from ...spatial import Array, perpendicular

MIN_VERTICES = 8
"""Fewest vertices, seen along the axis, that are called a circle; a square's corners lie on one too."""
MAX_GAP = math.radians(100.0)
"""Widest gap between neighbours on a circle: a fillet or an arc is no bore."""
ROUGH, FINE = 2e-2, 2e-3
"""Distance from the circle, in radii: of a first guess from three neighbours, and after the fit."""
MAX_VERTICES = 3000
"""Largest number of distinct vertices looked at, for the search compares each with each."""


@dataclass(frozen=True, slots=True, eq=False)
class Circle:
    """center: shape (2,), across the axis.  along: mean position of its vertices along the axis."""

    center: Array
    radius: float
    along: float


def common_axis_point(first: Array, second: Array, direction: Array) -> Array | None:
    """A point on the one cylinder axis that both vertex sets have along ``direction``.

    first, second: vertices in one frame, shape (n, 3).  direction: unit vector, shape (3,).  The point lies
    at the height of the second set's circle.  None when there is no such axis, or more than one.
    """
    side = perpendicular(direction)
    axes = np.column_stack([side, np.cross(direction, side), direction])
    ours, theirs = circles(first @ axes), circles(second @ axes)
    shared: list[Circle] = []
    for circle in theirs:
        near = [
            o for o in ours if np.linalg.norm(o.center - circle.center) <= FINE * min(o.radius, circle.radius)
        ]
        if near and not any(np.linalg.norm(s.center - circle.center) <= FINE * s.radius for s in shared):
            shared.append(circle)
    if len(shared) != 1:
        return None
    return axes @ np.array([*shared[0].center, shared[0].along])


def circles(vertices: Array) -> list[Circle]:
    """The circles that vertices form when seen along z; shape (n, 3)."""
    size = np.ptp(vertices[:, :2], axis=0).max(initial=0.0) if len(vertices) else 0.0
    if size == 0.0:
        return []
    _, kept = np.unique(np.round(vertices[:, :2] / (1e-5 * size)), axis=0, return_index=True)
    points = vertices[np.sort(kept), :2]
    if not MIN_VERTICES <= len(points) <= MAX_VERTICES:
        return []
    centers, radii = _circles_of_neighbours(points)
    found: list[Circle] = []
    explained = np.zeros(len(points), dtype=bool)
    for index, (center, radius) in enumerate(zip(centers, radii)):
        if explained[index] or not 0.0 < radius < size:
            continue
        on = _on_circle(points, center, radius, ROUGH)
        if on.sum() < MIN_VERTICES:
            continue
        center, radius = _fit(points[on])
        on = _on_circle(points, center, radius, FINE)
        if on.sum() < MIN_VERTICES or _widest_gap(points[on] - center) > MAX_GAP:
            continue
        explained |= on
        found.append(
            Circle(
                center, radius, float(vertices[_on_circle(vertices[:, :2], center, radius, FINE), 2].mean())
            )
        )
    return found


def _on_circle(points: Array, center: Array, radius: float, tolerance: float) -> np.ndarray:
    return np.abs(np.linalg.norm(points - center, axis=1) - radius) <= tolerance * radius


def _circles_of_neighbours(points: Array) -> tuple[Array, Array]:
    """Centre and radius of the circle through each point and its two nearest neighbours; nan on a line."""
    squared = np.sum((points[:, None, :] - points[None, :, :]) ** 2, axis=2)
    np.fill_diagonal(squared, np.inf)
    nearest = np.argpartition(squared, 1, axis=1)[:, :2]
    u, v = points[nearest[:, 0]] - points, points[nearest[:, 1]] - points
    cross = 2.0 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0])
    uu, vv = np.sum(u * u, axis=1), np.sum(v * v, axis=1)
    cross = np.where(np.abs(cross) > 1e-9 * np.sqrt(uu * vv), cross, np.nan)
    offset = np.column_stack([v[:, 1] * uu - u[:, 1] * vv, u[:, 0] * vv - v[:, 0] * uu]) / cross[:, None]
    return points + offset, np.linalg.norm(offset, axis=1)


def _fit(points: Array) -> tuple[Array, float]:
    """Least-squares circle (Kasa 1976): x^2 + y^2 = 2 c.p + r^2 - c.c is linear in c and the rest."""
    origin = points.mean(axis=0)
    local = points - origin
    squares: Array = np.einsum("ni,ni->n", local, local)
    solution = np.linalg.lstsq(np.column_stack([2.0 * local, np.ones(len(local))]), squares, rcond=None)[0]
    return solution[:2] + origin, math.sqrt(max(0.0, solution[2] + solution[:2] @ solution[:2]))


def _widest_gap(around: Array) -> float:
    angles = np.sort(np.arctan2(around[:, 1], around[:, 0]))
    return float(np.diff(angles, append=angles[0] + 2.0 * math.pi).max())
