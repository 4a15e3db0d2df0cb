"""Meshes that are a box, a ball or a capsule, for which engines have colliders of their own.

A mesh is one only where its skin is closed, every vertex lies on the shape and every facet is one of it: then no hole,
cut corner or hollow is left out.  Cost: proportional to the mesh, most of it spared where a look at a part of it says no.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from ..model import Collider, ColliderKind, Mesh
from ..spatial import Array, IntArray, Pose
from .closure import joined_vertices
from .mass import solid_volume

FIT = 1e-4
"""How far a vertex may be off, as a share of the shape's smallest extent."""
ROUNDING = 1e-6
"""Of the largest extent: what coordinates of 32 bits may be off anyway."""
SAG = 0.04
"""How far the middle of a facet of a round shape may lie below it, as a share of the radius: 16 sides."""
UNEVEN = 4.0
"""How much further than most facets of its shape one may lie below: more is cut off."""
UNSEEN = 3.0
"""Tolerances that a facet may lie deep whatever it is like."""
MOST_CORNERS = 4
"""Of a facet of a round shape, flat as a whole; one of more that lies deeper than most is a face that somebody cut."""
FLAT = 4e-7
"""Of the largest coordinate, which may have 32 bits: how far a triangle's corner may lie off its neighbour's plane where both are one
facet."""
SAMPLE = 2000
"""Vertices or triangles that are looked at first."""
STEPS = 12


def recognised(mesh: Mesh) -> Collider | None:
    """The box, ball or capsule that the mesh is, in the mesh's own frame, within ``FIT``; None for any other."""
    vertices, faces = np.asarray(mesh.vertices, dtype=np.float64), mesh.faces
    if len(faces) < 12 or not np.isfinite(vertices).all():
        return None
    return _box(vertices, faces) or _ball(vertices, faces) or _capsule(vertices, faces)


def _some(rows: Array) -> Array:
    """``SAMPLE`` of the rows at most, the same every time and in no rhythm of the mesh."""
    return rows if len(rows) <= SAMPLE else rows[np.random.default_rng(0).integers(0, len(rows), SAMPLE)]


def _normals(vertices: Array, faces: IntArray) -> tuple[Array, Array]:
    """Unit normals and areas of the triangles that have one."""
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    double = np.linalg.norm(across, axis=1)
    has = double > 1e-12 * double.max(initial=0.0)
    return across[has] / double[has, None], 0.5 * double[has]


def _tolerance(smallest: float, largest: float) -> float:
    """Metres; infinite precision is asked of no thin plate."""
    return max(FIT * smallest, ROUNDING * largest)


def _box(vertices: Array, faces: IntArray) -> Collider | None:
    if _right_angles(*_normals(vertices, _some(faces))) is None or (axes := _right_angles(*_normals(vertices, faces))) is None:
        return None
    along = vertices @ axes
    low, high = along.min(axis=0), along.max(axis=0)
    size = high - low
    tolerance = _tolerance(float(size.min()), float(size.max()))
    if size.min() <= 100.0 * tolerance:
        return None
    on_low, on_high = (np.abs(along - end) <= tolerance for end in (low, high))
    # Each triangle lies in one of the six faces, all three corners in the same.
    if not (on_low[faces].all(axis=1) | on_high[faces].all(axis=1)).any(axis=1).all():
        return None
    if not _is_one_skin(vertices, faces) or abs(solid_volume(vertices, faces) / size.prod() - 1.0) > 10.0 * tolerance / size.min():
        return None
    extents = (float(size[0]), float(size[1]), float(size[2]))
    return Collider(ColliderKind.BOX, Pose(axes, axes @ (0.5 * (low + high))), size=extents)


def _right_angles(normals: Array, areas: Array) -> Array | None:
    """Three directions at right angles along which all normals lie, as columns of a rotation as near to the mesh's own axes
    as can be; None where the normals have others."""
    if not len(areas):
        return None
    first = _mean_direction(normals, areas, normals[areas.argmax()])
    across = np.abs(normals @ first) < 0.5
    if not across.any():
        return None
    second = _mean_direction(normals[across], areas[across], normals[across][areas[across].argmax()])
    second = second - (second @ first) * first
    second /= np.linalg.norm(second)
    axes = np.column_stack([first, second, np.cross(first, second)])
    if areas[np.abs(normals @ axes).max(axis=1) > 1.0 - 1e-3].sum() < 0.999 * areas.sum():
        return None
    order: list[int] = []
    for row in range(3):
        order.append(max((i for i in range(3) if i not in order), key=lambda i: abs(axes[row, i])))
    axes = axes[:, order]
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    if np.abs(axes - np.eye(3)).max() < ROUNDING:
        return np.eye(3)
    if np.linalg.det(axes) < 0.0:
        axes[:, 2] = -axes[:, 2]
    return axes


def _mean_direction(normals: Array, areas: Array, about: Array) -> Array:
    """Of the normals along a direction or against it."""
    along = normals @ about
    near = np.abs(along) > 1.0 - 1e-3
    mean = (np.sign(along[near]) * areas[near]) @ normals[near]
    return mean / np.linalg.norm(mean)


@dataclass(frozen=True, slots=True, eq=False)
class _Round:
    """All points ``radius`` from a segment: its middle, its direction and half its length, 0 of a ball's."""

    centre: Array
    axis: Array
    half: float
    radius: float

    def nearest(self, points: Array) -> Array:
        """Of the segment, to each point."""
        t = np.clip((points - self.centre) @ self.axis, -self.half, self.half)
        return self.centre + t[:, None] * self.axis

    def volume(self) -> float:
        return math.pi * self.radius**2 * (4.0 / 3.0 * self.radius + 2.0 * self.half)


def _ball(vertices: Array, faces: IntArray) -> Collider | None:
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    spread = float(np.ptp(vertices, axis=0).max())
    if spread <= 0.0:
        return None
    at = (_some(vertices) - middle) / spread
    rows = np.column_stack([2.0 * at, np.ones(len(at))])
    solved, *_ = np.linalg.lstsq(rows, np.einsum("ij,ij->i", at, at), rcond=None)
    squared = float(solved[3] + solved[:3] @ solved[:3])
    if squared <= 0.0:
        return None
    shape = _Round(middle + spread * solved[:3], np.array([0.0, 0.0, 1.0]), 0.0, spread * math.sqrt(squared))
    if not _is_all_of(shape, vertices, faces):
        return None
    return Collider(ColliderKind.SPHERE, Pose(translation=shape.centre), radius=shape.radius)


def _capsule(vertices: Array, faces: IntArray) -> Collider | None:
    shape = _fitted_capsule(vertices, faces)
    if shape is None or not _is_all_of(shape, vertices, faces):
        return None
    axis = shape.axis
    if np.abs(axis - (own := np.eye(3)[np.abs(axis).argmax()])).max() < ROUNDING:
        axis = own
    other = np.eye(3)[np.abs(axis).argmin()]
    x = np.cross(other, axis)
    x /= np.linalg.norm(x)
    rotation = np.column_stack([x, np.cross(axis, x), axis])
    pose = Pose(rotation, shape.centre)
    return Collider(ColliderKind.CAPSULE, pose, radius=shape.radius, length=2.0 * shape.half)


def _fitted_capsule(vertices: Array, faces: IntArray) -> _Round | None:
    """By Gauss and Newton, from the axis along which the skin is spread most."""
    a, b, c = (vertices[_some(faces)[:, i]] for i in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    if areas.sum() <= 0.0:
        return None
    middles = (a + b + c) / 3.0
    centre = areas @ middles / areas.sum()
    spread = (areas[:, None] * (middles - centre)).T @ (middles - centre)
    axis = np.linalg.eigh(spread)[1][:, 2]
    axis = axis * (1.0 if axis[np.abs(axis).argmax()] > 0.0 else -1.0)
    used = _some(vertices)
    along = (used - centre) @ axis
    radius = float(np.linalg.norm(used - centre - along[:, None] * axis, axis=1).max())
    half = 0.5 * float(np.ptp(along)) - radius
    if half <= 0.05 * radius or radius <= 0.0:
        return None
    shape = _Round(centre + 0.5 * (along.max() + along.min()) * axis, axis, half, radius)
    for _ in range(STEPS):
        across = np.linalg.svd(shape.axis[None, :])[2][1:]
        nearest = shape.nearest(used)
        out = used - nearest
        distance = np.linalg.norm(out, axis=1)
        if distance.min() <= 0.0:
            return None
        out /= distance[:, None]
        t = (nearest - shape.centre) @ shape.axis
        end = np.where(np.abs(t) >= shape.half, np.sign(t), 0.0)
        rows = np.column_stack(
            [out, t * (out @ across[0]), t * (out @ across[1]), end * (out @ shape.axis), np.ones(len(used))]
        )
        step, *_ = np.linalg.lstsq(rows, distance - shape.radius, rcond=None)
        axis = shape.axis + step[3] * across[0] + step[4] * across[1]
        shape = _Round(
            shape.centre + step[:3], axis / np.linalg.norm(axis), shape.half + float(step[5]), shape.radius + float(step[6])
        )
        if not 0.0 < shape.half < np.inf or not 0.0 < shape.radius < np.inf:
            return None
        if np.abs(step).max() < 1e-12 * shape.radius:
            break
    return shape


def _is_all_of(shape: _Round, vertices: Array, faces: IntArray) -> bool:
    """Whether the mesh is the whole skin of a round shape, in facets as small as one is cut into."""
    tolerance = _tolerance(2.0 * shape.radius, 2.0 * (shape.radius + shape.half))
    off = np.linalg.norm(vertices - shape.nearest(vertices), axis=1) - shape.radius
    if np.abs(off).max() > tolerance or not _is_one_skin(vertices, faces):
        return False
    if not _is_finely_cut(shape, vertices, faces, tolerance):
        return False
    share = solid_volume(vertices, faces) / shape.volume()
    return 1.0 - 3.0 * SAG < share <= 1.0 + 3.0 * FIT


def _is_finely_cut(shape: _Round, vertices: Array, faces: IntArray, tolerance: float) -> bool:
    """Whether no facet lies as deep below the shape as where something is cut off."""
    normals, _ = _normals(vertices, faces)
    if len(normals) < len(faces):
        faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
        normals, _ = _normals(vertices, faces)
    if len(normals) < len(faces):
        return False
    sag = _below(shape, vertices[faces[:, 0]], normals)
    if sag.min() < -tolerance or sag.max() > SAG * shape.radius:
        return False
    if sag.max() <= UNSEEN * tolerance:
        return True
    if (facets := _flat_facets(vertices, faces)) is None:
        return False
    normals, points, corners = facets
    sag = _below(shape, points, normals)
    usual = float(np.median(sag))
    return bool(sag.max() <= UNEVEN * usual + tolerance) and not bool(
        (sag[corners > MOST_CORNERS] > max(usual, UNSEEN * tolerance)).any()
    )


def _below(shape: _Round, points: Array, normals: Array) -> Array:
    """How far planes lie below a round shape, metres, along their normals from the segment's end that is furthest that way."""
    ends = shape.half * np.abs(normals @ shape.axis)
    return shape.radius + ends - np.einsum("ij,ij->i", points - shape.centre, normals)


def _is_one_skin(vertices: Array, faces: IntArray) -> bool:
    """Whether each edge has two triangles, one each way, and all hang together as a ball's skin does."""
    places = joined_vertices(vertices)[faces]
    kept = places[(places != np.roll(places, 1, axis=1)).all(axis=1)]
    if not len(kept):
        return False
    count = int(kept.max()) + 1
    start, end = kept.T.astype(np.int64).reshape(-1), np.roll(kept, -1, axis=1).T.astype(np.int64).reshape(-1)
    forward, backward = np.sort(start * count + end), np.sort(end * count + start)
    if not (np.array_equal(forward, backward) and (np.diff(forward) > 0).all()):
        return False
    used = np.zeros(count, dtype=bool)
    used[start] = True
    places_used = int(used.sum())
    graph = coo_matrix((np.ones(len(start), dtype=np.int8), (start, end)), shape=(count, count))
    parts = connected_components(graph, directed=False, return_labels=False) - (count - places_used)
    return places_used - len(forward) // 2 + len(kept) == 2 and parts == 1


def _flat_facets(vertices: Array, faces: IntArray) -> tuple[Array, Array, IntArray] | None:
    """Triangles that lie in one plane with a neighbour taken together: normals, a point of each, and how many corners they have.
    None where a triangle has no normal."""
    places = joined_vertices(vertices)[faces]
    kept = (places != np.roll(places, 1, axis=1)).all(axis=1)
    places, faces = places[kept], faces[kept]
    a, b, c = (vertices[faces[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    length = np.linalg.norm(across, axis=1)
    if length.min() <= 0.0:
        return None
    normals = across / length[:, None]
    count = int(places.max()) + 1
    start, end = places.reshape(-1), np.roll(places, -1, axis=1).reshape(-1)
    owner = np.repeat(np.arange(len(places)), 3)
    key, back = start.astype(np.int64) * count + end, end.astype(np.int64) * count + start
    order = np.argsort(key)
    twin = owner[order][np.searchsorted(key[order], back)]
    opposite = a[twin] + b[twin] + c[twin] - vertices[faces.reshape(-1)] - np.roll(vertices[faces], -1, axis=1).reshape(-1, 3)
    flat = np.abs(np.einsum("ij,ij->i", opposite - a[owner], normals[owner])) < FLAT * float(np.abs(a).max())
    graph = coo_matrix((np.ones(int(flat.sum())), (owner[flat], twin[flat])), shape=(len(places),) * 2)
    group = connected_components(graph, directed=False)[1]
    # A corner is where the outline of a facet turns.
    outer = ~flat
    own, at, to = group[owner[outer]], start[outer], end[outer]
    order = np.lexsort((at, own))
    by_start = own[order].astype(np.int64) * count + at[order]
    following = np.searchsorted(by_start, own.astype(np.int64) * count + to)
    if (following >= len(by_start)).any() or len(np.unique(by_start)) != len(by_start):
        return None
    where = np.zeros((count, 3))
    where[places.reshape(-1)] = vertices[faces.reshape(-1)]
    along = where[to] - where[at]
    along /= np.linalg.norm(along, axis=1)[:, None]
    bends = np.linalg.norm(np.cross(along, along[order][following]), axis=1) > 1e-3
    corners = np.bincount(own, weights=bends, minlength=int(group.max()) + 1)
    heads = np.unique(group, return_index=True)[1]
    return normals[heads], a[heads], corners.astype(np.int64)
