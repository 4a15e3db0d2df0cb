"""Normals of meshes whose source states none: smooth across edges up to an angle, hard across sharper ones."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...model import Mesh, Scene
from ...spatial import Array, IntArray
from ..closure import joined_vertices

UP = np.array([0.0, 1.0, 0.0])
"""Normal of a vertex that no face with an area uses."""
FLAT = 1e-30
"""Twice the area of a triangle, as a share of the square of the mesh's size, below which it has no direction."""


def with_normals(scene: Scene, angle: float | None) -> Scene:
    """The scene with normals on every mesh that a body shows.  angle: as ``shaded`` has it; None leaves all as they are."""
    if angle is None:
        return scene
    shown = {body.mesh for node in scene.nodes for body in node.bodies}
    meshes = [shaded(mesh, angle) if i in shown else mesh for i, mesh in enumerate(scene.meshes)]
    return replace(scene, meshes=meshes)


def shaded(mesh: Mesh, angle: float) -> Mesh:
    """The mesh with normals; itself where it has some.

    angle: degrees between two faces up to which the edge between them is smooth.
    A vertex where faces of several smooth surfaces meet is repeated for each, with its uvs and colours; the order of the
    faces stays.  A normal is the mean of its faces', each weighted by its angle at the vertex (Thuermer and Wuethrich 1998),
    which does not depend on how flat faces were cut into triangles.
    """
    if mesh.normals is not None or not len(mesh.faces):
        return mesh
    places = joined_vertices(mesh.vertices)
    across = _face_normals(mesh)
    weights = _corner_angles(mesh)
    count = int(places.max()) + 1
    mean = _summed([places[mesh.faces[:, c]] for c in range(3)], across, weights, count)
    creased = _creased(mesh, places, across, mean, angle)
    corners = mesh.faces
    normals = mean[places]
    if not creased.any():
        return replace(mesh, normals=_unit(normals))
    # Only corners at vertices where some faces differ by more are told apart by the edges between them.
    face, corner = np.nonzero(creased[places[corners]])
    groups = _smooth_groups(mesh, places, across, face, corner, math.cos(math.radians(angle)))
    at = corners[face, corner]
    own = np.zeros((int(groups.max()) + 1, 3))
    for axis in range(3):
        own[:, axis] = np.bincount(groups, weights[face, corner] * across[face, axis], minlength=len(own))
    # A vertex's first surface keeps its number, each further one is a new vertex at the end.
    pairs, number = np.unique(at.astype(np.int64) * len(own) + groups, return_inverse=True)
    vertex, group = pairs // len(own), pairs % len(own)
    fresh = np.r_[False, vertex[1:] == vertex[:-1]]
    index = np.where(fresh, len(mesh.vertices) + np.cumsum(fresh) - 1, vertex)
    faces = corners.copy()
    faces[face, corner] = index[np.reshape(number, -1)]
    origin = np.r_[np.arange(len(mesh.vertices)), vertex[fresh]]
    normals = np.vstack([normals, np.zeros((int(fresh.sum()), 3))])
    flat = (
        np.einsum("ij,ij->i", own, own)[group] <= 0.0
    )  # a face without area takes what its neighbours have together
    normals[index] = np.where(flat[:, None], mean[places[vertex]], own[group])
    return replace(
        mesh,
        vertices=mesh.vertices[origin],
        faces=faces,
        normals=_unit(normals),
        uvs=tuple(uv[origin] for uv in mesh.uvs),
        colors=None if mesh.colors is None else mesh.colors[origin],
    )


def _face_normals(mesh: Mesh) -> Array:
    """Unit normals of the faces, shape (m, 3), zero where a face has no area."""
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    length = np.sqrt(np.einsum("ij,ij->i", across, across))
    size = float(np.ptp(mesh.vertices, axis=0).max())
    solid = length > FLAT * size * size
    across[solid] /= length[solid, None]
    across[~solid] = 0.0
    return across


def _corner_angles(mesh: Mesh) -> Array:
    """Of each face at each of its corners, radians, shape (m, 3)."""
    found = np.empty(mesh.faces.shape)
    for c in range(3):
        at = mesh.vertices[mesh.faces[:, c]]
        u, v = mesh.vertices[mesh.faces[:, c - 2]] - at, mesh.vertices[mesh.faces[:, c - 1]] - at
        dot = np.einsum("ij,ij->i", u, v)
        size = np.sqrt(np.einsum("ij,ij->i", u, u) * np.einsum("ij,ij->i", v, v))
        cosine = np.divide(dot, size, out=np.ones_like(dot), where=size > 0.0)
        found[:, c] = np.arccos(np.clip(cosine, -1.0, 1.0))
    return found


def _summed(corners: list[IntArray], across: Array, weights: Array, count: int) -> Array:
    total = np.zeros((count, 3))
    for c, numbers in enumerate(corners):
        for axis in range(3):
            total[:, axis] += np.bincount(numbers, weights[:, c] * across[:, axis], minlength=count)
    return total


def _creased(mesh: Mesh, places: IntArray, across: Array, mean: Array, angle: float) -> Array:
    """Which places have a face further than half the angle from the mean: at all others every edge is smooth."""
    length = np.sqrt(np.einsum("ij,ij->i", mean, mean))
    direction = np.divide(mean, length[:, None], out=np.zeros_like(mean), where=length[:, None] > 0.0)
    found = np.zeros(len(mean), dtype=bool)
    least = math.cos(math.radians(0.5 * angle)) - 1e-12
    solid = across.any(axis=1)
    for c in range(3):
        at = places[mesh.faces[:, c]]
        found[at[solid & (np.einsum("ij,ij->i", direction[at], across) < least)]] = True
    return found


def _smooth_groups(
    mesh: Mesh, places: IntArray, across: Array, face: IntArray, corner: IntArray, cosine: float
) -> IntArray:
    """A number for each corner: corners at one place are alike when smooth edges lead from face to face between them.

    face, corner: the corners asked for, all of a place or none.  An edge of two faces that run through it one way and the
    other is smooth when their normals differ by no more than the angle; any other edge is hard.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.csgraph import connected_components

    numbers = places[mesh.faces]
    count = int(numbers.max()) + 1
    number = np.arange(len(face))
    here = numbers[face, corner]
    ahead, behind = numbers[face, (corner + 1) % 3], numbers[face, (corner + 2) % 3]
    # Round a place each edge leaves one face as its next corner and enters another as its last.
    leaving, entering = here * count + ahead, here * count + behind
    left, left_at, left_count = np.unique(leaving, return_index=True, return_counts=True)
    slot = np.minimum(np.searchsorted(left, entering), len(left) - 1)
    _, back, entered_count = np.unique(entering, return_inverse=True, return_counts=True)
    single = (left[slot] == entering) & (left_count[slot] == 1) & (entered_count[np.reshape(back, -1)] == 1)
    other = left_at[slot]
    alike = np.einsum("ij,ij->i", across[face], across[face[other]]) >= cosine - 1e-9
    smooth = single & alike
    links = coo_matrix(
        (np.ones(int(smooth.sum()), dtype=np.int8), (number[smooth], other[smooth])), (len(face), len(face))
    )
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.int64)


def _unit(normals: Array) -> Array:
    length = np.sqrt(np.einsum("ij,ij->i", normals, normals))
    normals[length <= 0.0] = UP
    normals[length > 0.0] /= length[length > 0.0, None]
    return normals
