"""A mesh file through assimp; runs in the guarded process (``sources.guard``), nothing else imports it."""

# assimp_py is a binding of C++ that need not be installed.
# pyright: reportMissingImports=false, reportMissingModuleSource=false, reportMissingTypeStubs=false
# pyright: reportUnknownVariableType=false, reportUnknownMemberType=false, reportUnknownArgumentType=false
# pyright: reportAttributeAccessIssue=false, reportUnknownParameterType=false

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import assimp_py
import numpy as np

from ...color import linear

MOST_LEVELS = 200
TRIANGLES = 3


def meshes(path: str) -> Iterator[tuple[Any, ...]]:
    """(name, vertices, triangles, matrix, material, color) of every placed mesh.  Raises RuntimeError for what assimp refuses."""
    flags = assimp_py.Process_Triangulate | assimp_py.Process_SortByPType
    suffix = path[path.rfind(".") :].lower()
    if suffix == ".fbx":
        flags |= assimp_py.Process_GlobalScale  # the unit that the file states
    scene = assimp_py.import_file(path, flags)
    root = scene.root_node
    # Of 3DS assimp turns the whole by its root node: the file's own axes are asked for.
    start = np.eye(4) if suffix == ".3ds" else np.array(root.transformation, dtype=np.float64)
    nodes = [(root, start, 0)]
    while nodes:
        node, matrix, level = nodes.pop()
        for number in node.mesh_indices:
            mesh = scene.meshes[number]
            if mesh.num_faces == 0 or mesh.num_indices != TRIANGLES * mesh.num_faces:
                continue  # points and lines
            vertices = np.array(mesh.vertices, dtype=np.float64).reshape(-1, 3)
            triangles = np.array(mesh.indices, dtype=np.int64).reshape(-1, 3)
            if len(triangles) and not 0 <= triangles.min() <= triangles.max() < len(vertices):
                raise RuntimeError("a face names a corner that is not there")
            yield node.name or mesh.name, vertices, triangles, matrix[:3], *_look(scene, mesh.material_index)
        if level < MOST_LEVELS:
            below = [
                (c, matrix @ np.array(c.transformation, dtype=np.float64), level + 1) for c in node.children
            ]
            nodes += reversed(below)


def _look(scene: Any, index: int) -> tuple[str, tuple[float, ...] | None]:
    """Name and colour of a material; none where the file states none and assimp makes one up."""
    if not 0 <= index < len(scene.materials):
        return "", None
    material = scene.materials[index]
    name, color = str(material.get("NAME", "")), material.get("COLOR_DIFFUSE")
    if color is None or name == "DefaultMaterial":
        return name, None
    return name, (*(linear(float(c)) for c in color[:3]), float(material.get("OPACITY", 1.0)))
