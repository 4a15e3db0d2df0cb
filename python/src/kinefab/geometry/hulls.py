"""Convex hulls for collision, small enough for Unity."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cache, lru_cache
from importlib import import_module
from importlib.util import find_spec
from typing import Any

import numpy as np

from ..diagnostics import Report
from ..model import Mesh, Scene
from ..spatial import Array, BoolArray, IntArray, bounds, cross

UNITY_TRIANGLES = 255
"""Most triangles of a convex MeshCollider."""
UNITY_VERTICES = 128
"""So many vertices have at most 252 triangles: a hull of n points has 2 n - 4 (Euler)."""
DIRECTIONS = 24
"""Directions whose extreme vertices a simplified hull starts from."""
EXACT = 400
"""Vertices up to which all are handed to qhull, whose time grows with them; of more, the extreme ones along ..."""
MANY_DIRECTIONS = 128
COARSE = 0.02
"""Share of the size that the hull of those may lie inside, where it has most of the vertices that Unity takes."""
INSIDE = 1e-7
"""Share of the size by which a vertex that counts as inside may stand out, as ``welded`` has it."""
BLOCK = 65_536
"""Heights, of vertices along directions, that are worked out together: few enough that BLAS starts no threads for them, which would
cost more than they bring, and that the next step finds them in the processor's cache."""

Hull = tuple[Array, IntArray]

_KEY: Array = np.array([1.0, math.sqrt(2.0), math.sqrt(3.0)])
"""Along it few points of a mesh are at one height."""


def collision_hulls(scene: Scene, bodies: Iterable[tuple[int, str]], report: Report) -> dict[int, Mesh]:
    """The hull of each mesh named in ``bodies``: pairs of a mesh and what to call its body in the report.

    Flat meshes have none and are missing from the answer.
    """
    hulls: dict[int, Mesh] = {}
    seen: set[int] = set()
    for index, body in bodies:
        if index in seen:
            continue
        seen.add(index)
        mesh = scene.meshes[index]
        hull, before, deviation = _small_hull(_places(mesh))
        if hull is None:
            report.add("HULL_FLAT", body=body)
            continue
        if before:
            after = len(hull[1])
            report.add("HULL_SIMPLIFIED", body=body, before=before, after=after, deviation=f"{deviation:.3g}")
        hulls[index] = Mesh(f"{mesh.name} hull", *hull, origin=mesh.origin and f"{mesh.origin} hull")
    return hulls


def _places(mesh: Mesh) -> Array:
    """A mesh's vertices without those that repeat an earlier one for another normal or image: the hull is then that of the mesh
    without normals, and takes less time."""
    points = mesh.vertices
    if mesh.normals is None and not mesh.uvs:
        return points
    x, y, z = np.ascontiguousarray(points.T)  # by hand, as what BLAS makes of equal rows may differ
    order = np.argsort(x * _KEY[0] + y * _KEY[1] + z * _KEY[2], kind="stable")
    ordered = points[order]
    fresh = np.ones(len(points), dtype=bool)
    fresh[order[1:]] = (ordered[1:] != ordered[:-1]).any(axis=1)
    return points[fresh]


def hull_of_points(points: Array, fast: bool = False) -> Hull | None:
    """Convex hull of points, shape (n, 3): vertices and outward wound faces; None for a flat cloud.

    Of many points by Manifold where it can: qhull takes the square of what stands on one face, minutes for a fine cylinder.
    fast: of few points too, where flat faces may be cut into other triangles.
    """
    if len(points) < 4 or not _is_solid(points):
        return None
    if fast:
        low, high = bounds(points)
        enclosing = _enclosing(points, np.arange(len(points)), float((high - low).max()), fast=True)
        return None if enclosing is None else enclosing[0]
    found = _wrapped_fast(points) if len(points) > EXACT else None
    found = _wrapped(points) if found is None else found
    return None if found is None else found[0]


def within_unity(hull: Hull) -> tuple[Hull, float]:
    """A hull through as many of another's vertices as Unity takes, and how far it lies inside, in metres; itself and 0
    where it is small enough."""
    if len(hull[1]) <= UNITY_TRIANGLES:
        return hull, 0.0
    smaller, deviation = _through_extremes(hull[0], DIRECTIONS, 0.0)
    return (hull, 0.0) if smaller is None else (smaller, deviation)


def _small_hull(points: Array) -> tuple[Hull | None, str, float]:
    """A hull that Unity takes, how many triangles it would have had ("" where it is the whole hull), how far inside it lies."""
    if len(points) > EXACT:
        hull, deviation = _through_extremes(points, MANY_DIRECTIONS, COARSE, fast=True)
        if hull is not None:
            return hull, f"more than {len(hull[1])}" if deviation > 0.0 else "", deviation
    whole = hull_of_points(points)
    if whole is None:
        return None, "", 0.0
    hull, deviation = within_unity(whole)
    return hull, "" if hull is whole else str(len(whole[1])), deviation


def _through_extremes(
    points: Array, directions: int, coarse: float, fast: bool = False
) -> tuple[Hull | None, float]:
    """A hull through at most ``UNITY_VERTICES`` of the points, and how far the others stand out of it, 0 where none does.

    It starts from the extreme points along ``directions`` and takes those that stand out the farthest; with more than half of
    the vertices that Unity takes, it ends when it lies no more than ``coarse`` of the size inside.  fast: by Manifold where it can.
    None where the extreme points are flat.
    """
    low, high = bounds(points)
    size = float((high - low).max())
    taken = _marked(points, directions)
    if not _is_solid(points[taken]):  # of a flat cone all of them are on its rim
        if not _is_solid(points):
            return None, 0.0
        taken = _marked(_evened(points), directions)
    while (found := _enclosing(points, chosen := np.flatnonzero(taken), size, fast)) is not None:
        hull, planes, outside = found
        fresh = np.flatnonzero(outside > INSIDE * size)
        deviation = float(outside.max()) if len(fresh) else 0.0
        room = UNITY_VERTICES - len(chosen)
        if len(fresh) > room:
            if 2 * len(chosen) > UNITY_VERTICES and deviation <= coarse * size:
                return hull, deviation
            fresh = _farthest(points, planes, chosen)[: min(room, len(chosen))]
        if not len(fresh):
            return hull, deviation
        taken[fresh] = True
    return None, 0.0


def _marked(points: Array, directions: int) -> BoolArray:
    """Which points are extreme along directions: a row of flags, as numpy's ``unique`` of a hundred numbers takes ten times as long."""
    taken = np.zeros(len(points), dtype=bool)
    taken[_extreme(points, _directions(directions))[0]] = True
    return taken


def _enclosing(points: Array, chosen: IntArray, size: float, fast: bool) -> tuple[Hull, Array, Array] | None:
    """The hull of the chosen points, the planes of its faces, and how far every point stands out of it."""
    if fast and (found := _wrapped_fast(points[chosen])) is not None:
        outside = _standing_out(points, found[1])
        if outside[chosen].max() <= 0.5 * INSIDE * size:
            return *found, outside
    found = _wrapped(points[chosen])
    return None if found is None else (*found, _standing_out(points, found[1]))


def _farthest(points: Array, planes: Array, taken: IntArray) -> list[int]:
    """For each plane the point that stands out of it the most, each once, the farthest first, without those taken."""
    highest, height = _extreme(points, planes[:, :3])
    order = np.argsort(-(height + planes[:, 3]), kind="stable")
    known = set(taken.tolist())
    return [v for v in dict.fromkeys(highest[order].tolist()) if v not in known]


def _standing_out(points: Array, planes: Array) -> Array:
    """How far each point is outside the hull of these planes, shape (n,), negative inside."""
    rows = np.ones((4, len(points)))  # with a row of ones, so that the product adds the offset
    rows[:3] = points.T
    outside, step = np.empty(len(points)), BLOCK // len(planes) + 1
    for start in range(0, len(points), step):
        (planes @ rows[:, start : start + step]).max(axis=0, out=outside[start : start + step])
    return outside


def _extreme(points: Array, directions: Array) -> tuple[IntArray, Array]:
    """For each direction the farthest point along it, and how far that is."""
    found, far = np.zeros(len(directions), dtype=np.int64), np.full(len(directions), -np.inf)
    step = BLOCK // len(directions) + 1
    for start in range(0, len(points), step):
        along = directions @ points[start : start + step].T
        best = along.argmax(axis=1)
        reach = along[np.arange(len(along)), best]
        farther = reach > far
        found[farther], far[farther] = start + best[farther], reach[farther]
    return found, far


def _wrapped(points: Array) -> tuple[Hull, Array] | None:
    """The hull, and the plane of each of its faces: outward unit normal and offset, shape (m, 4); None where qhull finds none."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        hull = ConvexHull(points)
    except QhullError:
        return None
    faces = hull.simplices.astype(np.int64)
    a, b, c = (points[faces[:, i]] for i in range(3))
    inward = np.einsum("ij,ij->i", cross(b - a, c - a), hull.equations[:, :3]) < 0.0
    faces[inward] = faces[inward][:, ::-1]
    used = np.zeros(len(points), dtype=bool)
    used[faces] = True
    numbers = np.cumsum(used) - 1
    return (points[used], numbers[faces]), hull.equations


def _wrapped_fast(points: Array) -> tuple[Hull, Array] | None:
    """``_wrapped`` by Manifold, in a third of the time; None where that is not installed or finds no hull.

    It is the same hull but for how flat faces of more than three vertices are cut into triangles, unless rounding decides where a
    narrow face looks or whether a point is a vertex: then some of the points stand out of the planes.
    """
    library = _manifold()
    if library is None:
        return None
    low, high = bounds(points)
    moved = points - 0.5 * (low + high)  # what it takes for rounding grows with the distance from the origin
    mesh = library.Manifold.hull_points(moved).to_mesh64()
    corners = np.asarray(mesh.vert_properties, dtype=np.float64)
    faces = np.asarray(mesh.tri_verts, dtype=np.int64)
    # It tells where the vertices are, not which of the points they were.
    key = moved @ _KEY
    order = np.argsort(key)
    number = order[np.minimum(np.searchsorted(key[order], corners @ _KEY), len(order) - 1)]
    if not len(faces) or not np.array_equal(moved[number], corners):
        return None
    vertices = points[number]
    at = np.take(np.ascontiguousarray(vertices.T), faces.T, axis=1)  # by axis, corner and face
    (a, b, c), (d, e, f) = at[:, 1] - at[:, 0], at[:, 2] - at[:, 0]
    normals = np.stack([b * f - c * e, c * d - a * f, a * e - b * d])
    length = np.sqrt((normals * normals).sum(axis=0))
    if not length.all():
        return None
    normals /= length
    return (vertices, faces), np.vstack([normals, -(normals * at[:, 0]).sum(axis=0)]).T


@cache
def _manifold() -> Any:
    """The library, which states no types, or None."""
    return import_module("manifold3d") if find_spec("manifold3d") is not None else None


def _is_solid(points: Array) -> bool:
    """Whether the points leave every plane by more than rounding."""
    rows = np.ascontiguousarray(points.T)
    centred = rows - rows.mean(axis=1)[:, None]
    spread = np.linalg.eigvalsh(centred @ centred.T)  # squares of lengths
    return bool(spread[0] > 1e-14 * spread[2])


def _evened(points: Array) -> Array:
    """Solid points stretched so that they spread as far along each axis."""
    centred = points - points.mean(axis=0)
    squares, axes = np.linalg.eigh(centred.T @ centred)
    return centred @ (axes / np.sqrt(squares))


@lru_cache(maxsize=2)
def _directions(count: int) -> Array:
    """Directions spread evenly over the sphere (Fibonacci lattice), shape (count, 3)."""
    i = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * i / count, math.pi * (1.0 + math.sqrt(5.0)) * i
    radius = np.sqrt(1.0 - z * z)
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), z])
