"""Tangents of meshes that show a normal map."""

from __future__ import annotations

from dataclasses import replace

from ....unity.scene import Mesh
from ...tangents import tangents_along


def with_tangents(mesh: Mesh) -> Mesh:
    """The mesh with tangents along the first texture coordinates; as it is where it has them, or nothing to make them of."""
    if mesh.tangents is not None or mesh.normals is None or not mesh.uvs:
        return mesh
    return replace(mesh, tangents=tangents_along(mesh.vertices, mesh.normals, mesh.uvs[0], mesh.triangles))
