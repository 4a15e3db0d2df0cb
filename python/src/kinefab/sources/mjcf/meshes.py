"""Meshes and heightfields as MuJoCo has compiled them, in the frame of the geom that shows them."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...model import Mesh
from ...spatial import Array, IntArray


def compiled_mesh(model: Any, index: int) -> Mesh:
    """Vertices in MuJoCo's frame of the mesh, which its geoms are placed by; one for each corner that differs."""
    name = str(model.mesh(index).name) or f"mesh{index}"
    first, count = int(model.mesh_vertadr[index]), int(model.mesh_vertnum[index])
    vertices = np.array(model.mesh_vert[first : first + count], dtype=np.float64)
    start, faces = int(model.mesh_faceadr[index]), int(model.mesh_facenum[index])
    span = slice(start, start + faces)
    corners = [np.array(model.mesh_face[span], dtype=np.int64).ravel()]
    normals = _rows(model.mesh_normal, model.mesh_normaladr, model.mesh_normalnum, index)
    if len(normals):
        corners.append(np.array(model.mesh_facenormal[span], dtype=np.int64).ravel())
    uvs = _rows(model.mesh_texcoord, model.mesh_texcoordadr, model.mesh_texcoordnum, index)
    if len(uvs):
        corners.append(np.array(model.mesh_facetexcoord[span], dtype=np.int64).ravel())
    unique, inverse = _alike(corners)
    found_normals: Array | None = None
    if len(normals):
        found_normals = normals[unique[:, 1]]
        sizes = np.linalg.norm(found_normals, axis=1)
        found_normals = (
            found_normals / np.where(sizes > 0.0, sizes, 1.0)[:, None] if (sizes > 0.0).all() else None
        )
    found_uvs: tuple[Array, ...] = ()
    if len(uvs):
        chosen = uvs[unique[:, -1]]
        found_uvs = (np.column_stack([chosen[:, 0], 1.0 - chosen[:, 1]]),)  # MuJoCo counts v downwards
    indices: IntArray = np.asarray(inverse, dtype=np.int64).reshape(-1, 3)
    return Mesh(name, vertices[unique[:, 0]], indices, found_normals, found_uvs)


def _alike(columns: list[IntArray]) -> tuple[IntArray, IntArray]:
    """The different rows of some columns in their order, and which of them each row is; np.unique takes ten times as long."""
    rows = np.column_stack(columns)
    order = np.lexsort(columns[::-1])
    sorted_ = rows[order]
    first = np.ones(len(rows), dtype=bool)
    first[1:] = (sorted_[1:] != sorted_[:-1]).any(axis=1)
    number = np.empty(len(rows), dtype=np.int64)
    number[order] = np.cumsum(first) - 1
    return sorted_[first], number


def _rows(values: Any, starts: Any, counts: Any, index: int) -> Array:
    start, count = int(starts[index]), int(counts[index])
    return np.array(values[start : start + count], dtype=np.float64) if start >= 0 else np.zeros((0, 3))


def heightfield(model: Any, index: int) -> Mesh:
    """The surface: MuJoCo's first row lies at -Y, its first column at -X."""
    name = str(model.hfield(index).name) or f"hfield{index}"
    rows, columns = int(model.hfield_nrow[index]), int(model.hfield_ncol[index])
    start = int(model.hfield_adr[index])
    heights = np.array(model.hfield_data[start : start + rows * columns], dtype=np.float64)
    width, length, top, _ = (float(v) for v in model.hfield_size[index])
    x, y = np.meshgrid(np.linspace(-width, width, columns), np.linspace(-length, length, rows))
    vertices = np.column_stack([x.ravel(), y.ravel(), top * heights])
    uv = np.column_stack([0.5 * (x.ravel() / width + 1.0), 0.5 * (y.ravel() / length + 1.0)])
    a = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)[None, :]).ravel()
    quads = np.stack([a, a + 1, a + columns + 1, a, a + columns + 1, a + columns], axis=1)
    return Mesh(name, vertices, quads.reshape(-1, 3).astype(np.int64), None, (uv,))
