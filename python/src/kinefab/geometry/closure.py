"""Is a mesh the closed skin of a solid?"""

from __future__ import annotations

import numpy as np

from ..spatial import Array, IntArray


def welded(vertices: Array, faces: IntArray, tolerance: float = 1e-7) -> IntArray:
    """``faces`` with vertices at the same place given the same number, shape (m, 3).

    CAD programs repeat a vertex for each surface that meets there.
    tolerance: what counts as the same place, as a share of the mesh's size.
    """
    return joined_vertices(vertices, tolerance)[faces]


def joined_vertices(vertices: Array, tolerance: float = 1e-7) -> IntArray:
    """For each vertex the number of its place, shape (n,); tolerance: as ``welded`` has it."""
    low = vertices.min(axis=0)
    size = float((vertices.max(axis=0) - low).max())
    if not size > 0.0:
        return np.zeros(len(vertices), dtype=np.int64)
    cells = np.rint((vertices - low) / (size * tolerance)).astype(np.int64)
    span = (
        int(cells.max()) + 1
    )  # below 2^24 by default, so two of them fit one 64-bit key, and sorting keys is cheap
    _, columns = np.unique(cells[:, 0] * span + cells[:, 1], return_inverse=True)
    _, numbers = np.unique(np.reshape(columns, -1) * span + cells[:, 2], return_inverse=True)
    return np.reshape(numbers, -1)


def is_skin(vertices: Array, faces: IntArray) -> bool:
    """Whether a mesh is closed once vertices at the same place are one."""
    return is_closed(faces) or is_closed(welded(vertices, faces))  # closed before is closed after


def is_closed(faces: IntArray) -> bool:
    """Whether every edge is used by as many faces one way as the other.

    faces: welded, shape (m, 3).  Then volume and moments do not depend on the origin.
    """
    count = int(faces.max()) + 1
    start, end = faces.T, faces[:, [1, 2, 0]].T
    forward, backward = (start * count + end).reshape(-1), (end * count + start).reshape(-1)
    if (improper := start == end).any():
        proper = ~improper.reshape(-1)
        forward, backward = forward[proper], backward[proper]
    return bool(np.array_equal(np.sort(forward), np.sort(backward)))
