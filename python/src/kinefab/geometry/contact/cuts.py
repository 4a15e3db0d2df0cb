"""Cuts a solid until its parts are nearly convex: a ring into sectors, all else by planes in Manifold's exact Booleans.

The part with the most air in its hull is cut by the plane, of a few, that leaves the least air in the hulls of its halves.
Where none helps at once (half a ring fills its hull no better than the ring), it is cut by the first plane whose halves gain
much by one cut more, else by the one whose halves gain the most.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np

from ...spatial import Array, IntArray, cross
from .crossings import crossings
from .sectors import Ring, ring_sectors

AIR = 0.04
"""Of all hulls together, as a share of the solid: enough."""
HELPS = 0.05
"""Share of a part's air that a cut takes away at once, below which the next cut is looked at too."""
GOOD = 0.5
"""Share of a part's air that goes by a cut through its middle or along an inner edge, from which on no other is tried."""
ENOUGH = 0.2
"""Share of a part's air that goes by two cuts, from which on no other first cut is looked for."""
SAME = 1e-6
"""Relative difference of volumes that is rounding."""
ALONG = (0.3, 0.7)
"""Where a part is cut across the solid's own axes beside its middles, as shares of its extent."""
MOST_REFLEX = 3
"""Planes of faces at inner edges that are tried: along them a stepped or slotted part falls into exact pieces."""
EDGE = 0.02
"""Share of a part's extent at either side in which no such plane cuts."""
COARSER = 0.003
"""How far a solid is made simpler first, as a share of its size; not where a thin wall is lost by it."""
LOST = 0.01
"""Share of the volume: a wall."""
NOTHING = 1e-9
"""A volume below this share of the cube of the size is rounding."""

_Plane = tuple[Array, float]
"""Unit normal and distance from the origin."""


@dataclass(frozen=True, slots=True, eq=False)
class _Part:
    """points: shape (n, 3).  faces: shape (m, 3).  edges: pairs of points, each once, shape (2, k).  filled: volume of the hull.
    air: of that, what is not solid."""

    solid: Any
    points: Array
    faces: IntArray
    edges: IntArray
    filled: float
    air: float


def nearly_convex_parts(vertices: Array, faces: IntArray, most: int) -> list[Array]:
    """The vertices of each part of a closed, welded mesh, shape (n, 3); none where its skin is no manifold.

    vertices: scaled so that the largest extent is 1.  most: parts, unless the mesh falls into more by itself.
    """
    library: Any = import_module("manifold3d")  # it states no types
    whole = library.Manifold(library.Mesh64(np.ascontiguousarray(vertices), faces.astype(np.uint64)))
    if whole.status() != library.Error.NoError or whole.volume() <= NOTHING:
        return []
    simpler = whole.simplify(COARSER)
    if abs(simpler.volume() - whole.volume()) < LOST * whole.volume():
        whole = simpler
    parts = _apart([whole], library)
    if len(parts) == 1 and (sectors := _sectors(parts[0], AIR * whole.volume(), library)):
        return sectors
    reflex = _reflex_planes(vertices, faces)
    while len(parts) < most and sum(part.air for part in parts) > AIR * whole.volume():
        worst = max(parts, key=lambda part: part.air)
        halves = _cut(worst, reflex, library)
        if len(halves) < 2:
            break
        k = parts.index(worst)
        parts[k : k + 1] = halves
    return [part.points for part in parts]


def _sectors(part: _Part, enough: float, library: Any) -> list[Array]:
    """The points of each sector where the part is a ring that is best cut so; else none."""
    ring = Ring(part.points, part.faces, part.edges, part.filled - part.air)
    axes = [*np.eye(3), *_principal(part.points)]
    return ring_sectors(ring, axes, enough, lambda points: _filled(points, library))


def _cut(part: _Part, reflex: list[_Plane], library: Any) -> list[_Part]:
    """The halves of a part, by the best plane found."""
    filled, best = _best(part, _distinct([*_middles(part.points), *_within(part.points, reflex)]), library)
    if part.filled - filled < GOOD * part.air:
        further, other = _best(part, _across(part.points, np.eye(3), ALONG), library)
        if further < filled * (1.0 - SAME):
            filled, best = further, other
    halves = _apart(part.solid.split_by_plane(*best), library)
    if part.filled - filled > HELPS * part.air:
        return halves
    for plane in _middles(part.points):
        pieces = _apart(part.solid.split_by_plane(*plane), library)
        after = sum(min(piece.filled, _best(piece, _middles(piece.points), library)[0]) for piece in pieces)
        if after < filled * (1.0 - SAME):
            filled, halves = after, pieces
        if part.filled - filled > ENOUGH * part.air:
            break
    return halves


def _best(part: _Part, planes: list[_Plane], library: Any) -> tuple[float, _Plane]:
    """The least volume of the hulls of both halves together, and by which plane; of equal ones the first."""
    least, found = np.inf, planes[0]
    for normal, offset in planes:
        height = part.points @ normal - offset
        above = height >= 0.0
        section = crossings(part.points, part.edges, height)
        filled, enough = 0.0, least * (1.0 - SAME)
        for side in (above, ~above):
            half = np.concatenate([part.points[side], section])
            filled += _filled(half, library)
            if filled >= enough:
                break
        else:
            least, found = filled, (normal, offset)
    return float(least), found


def _within(points: Array, planes: list[_Plane]) -> list[_Plane]:
    """Those of the planes that cut well inside the points."""
    found: list[_Plane] = []
    for normal, offset in planes:
        height = points @ normal
        margin = EDGE * float(np.ptp(height))
        if height.min() + margin < offset < height.max() - margin:
            found.append((normal, offset))
    return found


def _middles(points: Array) -> list[_Plane]:
    """Planes through the middle, across the frame's axes and those along which the points spread, the widest first."""
    return _distinct([*_across(points, np.eye(3), (0.5,)), *_across(points, _principal(points), (0.5,))])


def _principal(points: Array) -> Array:
    """Unit vectors along which the points spread, the widest first, shape (3, 3)."""
    centred = points - points.mean(axis=0)
    return np.linalg.eigh(centred.T @ centred)[1].T[::-1]


def _filled(points: Array, library: Any) -> float:
    """Volume of the hull."""
    return float(library.Manifold.hull_points(points).volume())


def _distinct(planes: list[_Plane]) -> list[_Plane]:
    """The planes, each once: a part that lies along the frame's axes spreads along them too."""
    found: list[_Plane] = []
    for normal, offset in planes:
        for other, distance in found:
            along = float(normal @ other)
            if abs(along) > 1.0 - SAME * SAME and abs(offset - distance * math.copysign(1.0, along)) < SAME:
                break
        else:
            found.append((normal, offset))
    return found


def _across(points: Array, axes: Array, shares: tuple[float, ...]) -> list[_Plane]:
    heights = points @ axes.T
    low, extent = heights.min(axis=0), np.ptp(heights, axis=0)
    return [(axis, float(low[k] + share * extent[k])) for k, axis in enumerate(axes) for share in shares]


def _reflex_planes(vertices: Array, faces: IntArray) -> list[_Plane]:
    """Planes of faces that meet a neighbour at an inner edge, those with the longest and steepest edges first."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    normals = cross(b - a, c - a)
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    start, end = faces.reshape(-1), np.roll(faces, -1, axis=1).reshape(-1)
    opposite = np.roll(faces, -2, axis=1).reshape(-1)
    owner = np.repeat(np.arange(len(faces)), 3)
    key, twin = start * len(vertices) + end, end * len(vertices) + start
    order = np.argsort(key)
    other = order[np.minimum(np.searchsorted(key[order], twin), len(order) - 1)]
    rises = np.einsum("ij,ij->i", vertices[opposite[other]] - vertices[start], normals[owner])
    inner = (key[other] == twin) & (rises > 1e-3)
    if not inner.any():
        return []
    weight = (np.linalg.norm(vertices[end] - vertices[start], axis=1) * rises)[inner]
    normal = normals[owner[inner]]
    offset = np.einsum("ij,ij->i", normal, vertices[start[inner]])
    rounded = np.column_stack([normal, offset]).round(4) + 0.0
    leading = np.take_along_axis(rounded, (rounded[:, :3] != 0.0).argmax(axis=1)[:, None], axis=1)
    _, first, group = np.unique(rounded * np.sign(leading), axis=0, return_index=True, return_inverse=True)
    total = np.bincount(np.reshape(group, -1), weight)
    chosen = first[np.argsort(-total.round(9), kind="stable")[:MOST_REFLEX]]
    return [(normal[k], float(offset[k])) for k in chosen]


def _apart(solids: Iterable[Any], library: Any) -> list[_Part]:
    """The connected pieces of solids, without what is only rounding."""
    found: list[_Part] = []
    pieces = (piece for solid in solids if not solid.is_empty() for piece in solid.decompose())
    for piece in pieces:
        if (volume := float(piece.volume())) <= NOTHING:
            continue
        mesh = piece.to_mesh64()
        points = np.ascontiguousarray(mesh.vert_properties[:, :3], dtype=np.float64)
        corners = np.asarray(mesh.tri_verts, dtype=np.int64)
        start, end = corners.reshape(-1), np.roll(corners, -1, axis=1).reshape(-1)
        filled = _filled(points, library)
        once = start < end  # each edge is there both ways
        edges = np.stack([start[once], end[once]])
        found.append(_Part(piece, points, corners, edges, filled, filled - volume))
    return found
