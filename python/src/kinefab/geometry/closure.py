"""Is a mesh the closed skin of a solid?"""

from __future__ import annotations

import numpy as np

from ..spatial import Array


def welded(vertices: Array, faces: np.ndarray, tolerance: float = 1e-7) -> np.ndarray:
    """``faces`` with vertices at the same place given the same number, shape (m, 3).

    CAD programs repeat a vertex for each surface that meets there.
    tolerance: what counts as the same place, as a share of the mesh's size.
    """
    low = vertices.min(axis=0)
    size = float((vertices.max(axis=0) - low).max())
    if not size > 0.0:
        return np.zeros_like(faces)
    cells = np.rint((vertices - low) / (size * tolerance)).astype(np.int64)
    span = int(round(1.0 / tolerance)) + 2  # below 2^21, so three of them fit one 64-bit key
    keys = (cells[:, 0] * span + cells[:, 1]) * span + cells[:, 2] if span < 1 << 21 else None
    if keys is None:
        _, numbers = np.unique(cells, axis=0, return_inverse=True)
    else:
        _, numbers = np.unique(keys, return_inverse=True)
    return numbers.reshape(-1)[faces]


def is_closed(faces: np.ndarray) -> bool:
    """Whether every edge is used by as many faces one way as the other.

    faces: welded, shape (m, 3).  Then volume and moments do not depend on the origin.
    """
    count = int(faces.max()) + 1
    start, end = faces, np.roll(faces, -1, axis=1)
    proper = start != end
    forward, backward = (start * count + end)[proper], (end * count + start)[proper]
    return bool(np.array_equal(np.sort(forward, axis=None), np.sort(backward, axis=None)))
