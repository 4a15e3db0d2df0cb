"""Is a mesh the closed skin of a solid?"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..spatial import Array, IntArray

MOST_SHORT = 46_340
"""Vertices of which two numbers fit one 32-bit key: twice as many of them are sorted in the same time."""


def welded(vertices: Array, faces: IntArray, tolerance: float = 1e-7) -> IntArray:
    """``faces`` with vertices at the same place given the same number, shape (m, 3).

    CAD programs repeat a vertex for each surface that meets there.
    tolerance: what counts as the same place, as a share of the mesh's size.
    """
    return joined_vertices(vertices, tolerance)[faces]


def joined_vertices(vertices: Array, tolerance: float = 1e-7) -> IntArray:
    """For each vertex the number of its place, shape (n,); tolerance: as ``welded`` has it."""
    return joined_across([vertices], tolerance)[0]


def joined_across(meshes: Sequence[Array], tolerance: float = 1e-7) -> tuple[IntArray, Array]:
    """``joined_vertices`` of several meshes, their vertices behind each other and their places counted through; and each mesh's
    size, shape (k,).

    meshes: the vertices of each, at least one.
    """
    counts = [len(vertices) for vertices in meshes]
    starts = np.cumsum([0, *counts[:-1]])
    rows = np.ascontiguousarray((meshes[0] if len(meshes) == 1 else np.concatenate(meshes)).T)
    low = np.minimum.reduceat(rows, starts, axis=1)
    sizes = (np.maximum.reduceat(rows, starts, axis=1) - low).max(axis=0)
    owner = np.repeat(np.arange(len(meshes)), counts)
    cell = np.where(sizes > 0.0, sizes * tolerance, np.inf)
    rows -= low[:, owner]
    rows /= cell[owner]
    cells = np.rint(rows, out=rows).astype(np.int64)
    span = int(cells.max()) + 1
    # Below 2^24 by default, so two of them and a mesh's number fit one 64-bit key, and sorting keys is cheap.
    _, columns = np.unique((owner * span + cells[0]) * span + cells[1], return_inverse=True)
    _, numbers = np.unique(np.reshape(columns, -1) * span + cells[2], return_inverse=True)
    return np.reshape(numbers, -1), sizes


def is_skin(vertices: Array, faces: IntArray) -> bool:
    """Whether a mesh is closed once vertices at the same place are one."""
    return is_closed(faces) or is_closed(welded(vertices, faces))  # closed before is closed after


def is_closed(faces: IntArray) -> bool:
    """Whether every edge is used by as many faces one way as the other.

    faces: welded, shape (m, 3).  Then volume and moments do not depend on the origin.
    """
    count = int(faces.max()) + 1
    start = np.ascontiguousarray(faces.T, dtype=np.int32 if count <= MOST_SHORT else np.int64)
    end = start[[1, 2, 0]]
    forward, backward = (start * count + end).reshape(-1), (end * count + start).reshape(-1)
    forward.sort()  # an edge within a place is in both
    backward.sort()
    return bool(np.array_equal(forward, backward))
