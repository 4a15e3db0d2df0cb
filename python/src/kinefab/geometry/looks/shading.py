"""Normals of meshes whose source states none: smooth across edges up to an angle, hard across sharper ones."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ...model import Mesh, Scene
from ...spatial import Array, IntArray
from ..closure import joined_across

UP = np.array([0.0, 1.0, 0.0])
"""Normal of a vertex that no face with an area uses."""
TOGETHER = 25_000
"""Triangles of meshes that are shaded in one go, as far as the processor's cache goes."""
NOTHING = 1e-12
"""What a normal has less of along an axis is rounding, which each processor's arc cosine does in its own way."""
FLAT = 1e-30
"""Twice the area of a triangle, as a share of the square of the mesh's size, below which it has no direction."""


def with_normals(scene: Scene, angle: float | None) -> Scene:
    """The scene with normals on every mesh that a body shows.  angle: as ``shaded`` has it; None leaves all as they are."""
    if angle is None:
        return scene
    shown = {body.mesh for node in scene.nodes for body in node.bodies}
    meshes = list(scene.meshes)
    wanted = [i for i, mesh in enumerate(meshes) if i in shown and _is_plain(mesh)]
    for batch in _batches(wanted, [len(meshes[i].faces) for i in wanted]):
        for i, mesh in zip(batch, _shaded([meshes[i] for i in batch], angle)):
            meshes[i] = mesh
    return replace(scene, meshes=meshes)


def _batches(numbers: list[int], sizes: list[int]) -> Iterator[list[int]]:
    """The numbers in runs whose sizes together are about ``TOGETHER``."""
    batch: list[int] = []
    total = 0
    for number, size in zip(numbers, sizes):
        batch.append(number)
        total += size
        if total >= TOGETHER:
            yield batch
            batch, total = [], 0
    if batch:
        yield batch


def shaded(mesh: Mesh, angle: float) -> Mesh:
    """The mesh with normals; itself where it has some.

    angle: degrees between two faces up to which the edge between them is smooth.
    A vertex where faces of several smooth surfaces meet is repeated for each, with its uvs and colours; the order of the
    faces stays.  A normal is the mean of its faces', each weighted by its angle at the vertex (Thuermer and Wuethrich 1998),
    which does not depend on how flat faces were cut into triangles.
    """
    return _shaded([mesh], angle)[0] if _is_plain(mesh) else mesh


def _is_plain(mesh: Mesh) -> bool:
    return mesh.normals is None and len(mesh.faces) > 0


def _shaded(meshes: list[Mesh], angle: float) -> list[Mesh]:
    """``shaded``, of meshes without normals, in one go: most are so small that calling numpy for each costs more than its work."""
    starts = np.cumsum([0, *(len(mesh.vertices) for mesh in meshes)])
    ends = np.cumsum([len(mesh.faces) for mesh in meshes])
    places, lengths = joined_across([mesh.vertices for mesh in meshes])
    vertices = np.concatenate([mesh.vertices for mesh in meshes])
    faces = np.concatenate([mesh.faces + start for mesh, start in zip(meshes, starts)])
    sizes = np.repeat(lengths, np.diff(ends, prepend=0))
    normals, faces, origin = _split(vertices, faces, places, sizes, math.radians(angle))
    # What was repeated stands at the end, in the order of the vertices that it repeats.
    added = np.searchsorted(origin[starts[-1] :], starts) + starts[-1]
    found: list[Mesh] = []
    for k, mesh in enumerate(meshes):
        low, high = int(starts[k]), int(starts[k + 1])
        own = faces[ends[k] - len(mesh.faces) : ends[k]] - low
        if added[k + 1] > added[k]:
            own[own >= high - low] -= int(added[k]) - high
        repeated = origin[added[k] : added[k + 1]] - low

        found.append(
            replace(
                mesh,
                vertices=_grown(mesh.vertices, repeated),
                faces=own,
                normals=np.concatenate([normals[low:high], normals[added[k] : added[k + 1]]]),
                uvs=tuple(_grown(uv, repeated) for uv in mesh.uvs),
                colors=None if mesh.colors is None else _grown(mesh.colors, repeated),
            )
        )
    return found


def _grown(values: Array, repeated: IntArray) -> Array:
    return np.concatenate([values, values[repeated]]) if len(repeated) else values


def _split(
    vertices: Array, faces: IntArray, places: IntArray, sizes: Array, angle: float
) -> tuple[Array, IntArray, IntArray]:
    """Normals, faces, and of which vertex each is a copy: the vertices first, then those repeated.

    places: of each vertex its place.  sizes: of each face its mesh's.  angle: radians.
    Within, the three coordinates of many points stand in three rows, shape (3, ...): numpy is twice as fast on long rows.
    """
    by_corner = np.ascontiguousarray(faces.T)
    corners = np.take(np.ascontiguousarray(vertices.T), by_corner, axis=1)  # by axis, corner and face
    edges = [corners[:, c - 2] - corners[:, c] for c in range(3)]  # from each corner to the next
    across = _face_normals(edges, sizes)
    weights = _corner_angles(edges)
    count = int(places.max()) + 1
    numbers = places[by_corner]
    mean = _summed(numbers, across, weights, count)
    creased = _creased(numbers, across, mean, angle)
    normals = mean.T[places]
    origin = np.arange(len(vertices))
    if not creased.any():
        return _unit(normals), faces, origin
    # Only corners at vertices where some faces differ by more are told apart by the edges between them.
    face, corner = np.nonzero(creased[numbers].T)
    groups = _smooth_groups(numbers, across, face, corner, math.cos(angle))
    at = faces[face, corner]
    weight = weights[corner, face]
    own = np.column_stack([np.bincount(groups, weight * row[face]) for row in across])
    # A vertex's first surface keeps its number, each further one is a new vertex at the end.
    pairs, number = np.unique(at.astype(np.int64) * len(own) + groups, return_inverse=True)
    vertex, group = pairs // len(own), pairs % len(own)
    fresh = np.r_[False, vertex[1:] == vertex[:-1]]
    index = np.where(fresh, len(vertices) + np.cumsum(fresh) - 1, vertex)
    faces = faces.copy()
    faces[face, corner] = index[np.reshape(number, -1)]
    normals = np.vstack([normals, np.zeros((int(fresh.sum()), 3))])
    # A face without area takes what its neighbours have together.
    flat = np.einsum("ij,ij->i", own, own)[group] <= 0.0
    normals[index] = np.where(flat[:, None], mean.T[places[vertex]], own[group])
    return _unit(normals), faces, np.r_[origin, vertex[fresh]]


def _dot(x: Array, y: Array) -> Array:
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


def _face_normals(edges: list[Array], sizes: Array) -> Array:
    """Unit normals of the faces, shape (3, m), zero where a face has no area.  edges: see ``_split``."""
    (a, b, c), (d, e, f) = edges[0], -edges[2]
    across = np.stack([b * f - c * e, c * d - a * f, a * e - b * d])
    length = np.sqrt(_dot(across, across))
    solid = length > FLAT * sizes * sizes
    return across / np.where(solid, length, np.inf)


def _corner_angles(edges: list[Array]) -> Array:
    """At each corner of each face, radians, shape (3, m)."""
    found = np.empty((3, edges[0].shape[1]))
    squares = [_dot(edge, edge) for edge in edges]
    for c in range(3):
        dot = -_dot(edges[c], edges[c - 1])
        size = np.sqrt(squares[c] * squares[c - 1])
        found[c] = np.divide(dot, size, out=np.ones_like(dot), where=size > 0.0)
    return np.arccos(np.clip(found, -1.0, 1.0, out=found), out=found)


def _summed(numbers: IntArray, across: Array, weights: Array, count: int) -> Array:
    """Of each place the normals of its faces together, each by its weight, shape (3, count)."""
    total = np.zeros((3, count))
    for at, weight in zip(numbers, weights):
        for axis in range(3):
            total[axis] += np.bincount(at, weight * across[axis], minlength=count)
    return total


def _creased(numbers: IntArray, across: Array, mean: Array, angle: float) -> Array:
    """Which places have a face further than half the angle from the mean: at all others every edge is smooth."""
    length = np.sqrt(_dot(mean, mean))
    direction = np.divide(mean, length, out=np.zeros_like(mean), where=length > 0.0)
    found = np.zeros(mean.shape[1], dtype=bool)
    least = math.cos(0.5 * angle) - 1e-12
    solid = across.any(axis=0)
    for at in numbers:
        found[at[solid & (_dot(np.take(direction, at, axis=1), across) < least)]] = True
    return found


def _smooth_groups(
    numbers: IntArray, across: Array, face: IntArray, corner: IntArray, cosine: float
) -> IntArray:
    """A number for each corner: corners at one place are alike when smooth edges lead from face to face between them.

    numbers: places of the faces' corners, shape (3, m).  face, corner: the corners asked for, by face, all of a place or none.  An
    edge of two faces that run through it one way and the other is smooth when their normals differ by no more than the angle;
    any other edge is hard.
    """
    count = numbers.shape[1]
    asked = np.full(3 * count, -1)  # by corner, then face
    asked[corner * count + face] = np.arange(len(face))
    following = np.roll(asked, -count)
    # Edges by the corner that they leave: those that end or start at a corner asked for.
    edges = np.flatnonzero((asked >= 0) | (following >= 0))
    own = edges % count
    one, other = _twins(numbers.reshape(-1)[edges], np.roll(numbers.reshape(-1), -count)[edges])
    smooth = _dot(np.take(across, own[one], axis=1), np.take(across, own[other], axis=1)) >= cosine - 1e-9
    one, other = one[smooth], other[smooth]
    # Round a place each edge leaves one face as its next corner and enters another as its last.
    ahead = np.arange(len(face))
    behind = ahead.copy()
    for edge, twin in ((one, other), (other, one)):
        leaves, enters = asked[edges[edge]], following[edges[twin]]
        there = leaves >= 0
        leaves, enters = leaves[there], enters[there]
        ahead[leaves], behind[enters] = enters, leaves
    lowest = np.minimum(_lowest_along(ahead), _lowest_along(behind))
    return (np.cumsum(lowest == np.arange(len(face))) - 1)[lowest]


def _lowest_along(following: IntArray) -> IntArray:
    """Of each number the lowest that is met by going on from it.  following: of each the next, itself at an end."""
    lowest = np.arange(len(following))
    while True:  # twice as far each time
        lower = np.minimum(lowest, lowest[following])
        if np.array_equal(lower, lowest):
            return lowest
        lowest, following = lower, following[following]


def _twins(start: IntArray, end: IntArray) -> tuple[IntArray, IntArray]:
    """Pairs of edges that run between two places one way and the other, with no third; an edge within a place, if it is the only
    one there, is its own twin.  start, end: places."""
    low, high = np.minimum(start, end), np.maximum(start, end)
    keys = low * (int(high.max(initial=0)) + 1) + high
    order = np.argsort(keys)
    ordered = keys[order]
    first = np.flatnonzero(np.r_[True, ordered[1:] != ordered[:-1]][: len(keys)])
    count = np.diff(np.r_[first, len(keys)])
    pairs, single = first[count == 2], order[first[count == 1]]
    one, other = order[pairs], order[pairs + 1]
    opposite = (start[one] == end[other]) & (start[one] != end[one])
    single = single[start[single] == end[single]]
    return np.r_[one[opposite], single], np.r_[other[opposite], single]


def _unit(normals: Array) -> Array:
    length = np.sqrt(np.einsum("ij,ij->i", normals, normals))
    normals /= np.where(length > 0.0, length, 1.0)[:, None]
    normals[np.abs(normals) < NOTHING] = 0.0
    normals[length <= 0.0] = UP
    return normals
