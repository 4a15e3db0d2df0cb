from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """vertices, normals: shape (n, 3).  uvs: one array of shape (n, 2) a set, v upwards.  tangents: shape (n, 4), w the
    sense of the bitangent.  colors: linear RGBA, shape (n, 4).  triangles: shape (m, 3), clockwise from outside (Unity's
    front).  submeshes: number of triangles of each, in order."""

    name: str
    vertices: Floats
    triangles: NDArray[np.integer]
    normals: Floats | None = None
    uvs: tuple[Floats, ...] = ()
    tangents: Floats | None = None
    colors: Floats | None = None
    submeshes: tuple[int, ...] = ()
