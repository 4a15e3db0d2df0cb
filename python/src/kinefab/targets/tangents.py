"""Tangents where a normal map wants them and the source gives none (Lengyel, "Computing Tangent Space Basis Vectors")."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..unity.scene import Mesh, MeshFilter, MeshRenderer, UnityScene

Reals = NDArray[np.floating[Any]]


def normal_mapped(scene: UnityScene) -> set[int]:
    """Meshes that show a normal map."""
    found: set[int] = set()
    for entry in scene.gameObjects:
        shown_materials = [
            scene.materials[m] for c in entry.components if isinstance(c, MeshRenderer) for m in c.materials
        ]
        if any(material.normalTexture is not None for material in shown_materials):
            found |= {c.mesh for c in entry.components if isinstance(c, MeshFilter)}
    return found


def with_tangents(mesh: Mesh) -> Mesh:
    """The mesh with tangents along the first texture coordinates; as it is where it has them, or nothing to make them of."""
    if mesh.tangents is not None or mesh.normals is None or not mesh.uvs:
        return mesh
    return replace(mesh, tangents=tangents_along(mesh.vertices, mesh.normals, mesh.uvs[0], mesh.triangles))


def tangents_along(
    vertices: Reals, normals: Reals, uv: Reals, triangles: NDArray[Any]
) -> NDArray[np.float32]:
    """Along the first texture coordinate, with the sense of the second in the fourth number, shape (n, 4), float32.

    normals: shape (n, 3), unit.  uv: shape (n, 2), v upwards.
    """
    a, b, c = (triangles[:, i].astype(np.int64) for i in range(3))
    p, uv = vertices.astype(np.float64), uv.astype(np.float64)
    e, f = p[b] - p[a], p[c] - p[a]
    s, t = uv[b] - uv[a], uv[c] - uv[a]
    area = s[:, 0] * t[:, 1] - t[:, 0] * s[:, 1]
    sense = np.sign(area)[:, None]
    along_u = (e * t[:, 1:] - f * s[:, 1:]) * sense
    along_v = (f * s[:, :1] - e * t[:, :1]) * sense
    us, vs = np.zeros_like(p), np.zeros_like(p)
    for corner in (a, b, c):
        np.add.at(us, corner, along_u)
        np.add.at(vs, corner, along_v)
    normals = normals.astype(np.float64)
    flat = us - normals * np.einsum("ij,ij->i", normals, us)[:, None]
    length = np.linalg.norm(flat, axis=1)
    lost = length <= 1e-12 * max(1.0, float(length.max(initial=0.0)))
    flat[lost] = _across(normals[lost])
    flat /= np.linalg.norm(flat, axis=1, keepdims=True)
    right = np.einsum("ij,ij->i", np.cross(normals, flat), vs) >= 0.0
    return np.column_stack([flat, np.where(right, 1.0, -1.0)]).astype(np.float32)


def _across(normals: np.ndarray) -> np.ndarray:
    """Some direction at right angles to each normal, shape (n, 3): where the texture coordinates say nothing."""
    axis = np.eye(3)[np.abs(normals).argmin(axis=1)] if len(normals) else np.zeros((0, 3))
    found = np.cross(normals, axis)
    found[np.linalg.norm(found, axis=1) == 0.0] = (1.0, 0.0, 0.0)
    return found
