"""Meshes that a script passes: trimesh's own objects, arrays, files."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np

from ..geometry.files import transformed
from ..geometry.looks.visuals import look_of
from ..geometry.pieces import Piece
from ..model import Mesh, MeshReference, Surface
from ..spatial import Array
from .arguments import LARGEST, shown

METRES = {"m": 1.0, "cm": 0.01, "mm": 0.001, "in": 0.0254, "ft": 0.3048}


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """One body: a mesh, or the file that it is to be loaded from.  surfaces: its looks, one for each submesh, or none."""

    name: str
    mesh: Mesh | None = None
    reference: MeshReference | None = None
    surfaces: tuple[Surface, ...] = ()


def shapes_of(name: str, given: Any, unit: Any) -> list[Shape]:
    """The bodies of what a script passes as a part's mesh; none of None.

    given: a trimesh.Trimesh or anything with ``vertices`` and ``faces``; a trimesh.Scene (a body for each of its
    geometries); the path of a mesh file.  unit: of its numbers.
    """
    if not isinstance(unit, str) or unit not in METRES:
        raise ValueError(f"the unit of {name}'s mesh is {shown(unit)}; pass one of: {', '.join(METRES)}")
    if given is None:
        return []
    size = METRES[unit]
    if isinstance(given, (str, os.PathLike)):
        path = Path(cast("str | os.PathLike[str]", given))
        if not _is_file(path):
            raise ValueError(f"the mesh of {name} is {shown(str(path))}, where there is no file")
        return [Shape(name, reference=MeshReference(path, np.diag([size, size, size, 1.0]), where=str(path)))]
    if hasattr(given, "geometry") and hasattr(given, "graph"):
        return _scene_shapes(name, given, size)
    if not (hasattr(given, "vertices") and hasattr(given, "faces")):
        raise TypeError(
            f"the mesh of {name} is {type(given).__name__} {shown(given)}; pass a trimesh.Trimesh or trimesh.Scene, anything"
            " with vertices and faces, or the path of a mesh file"
        )
    return [_shape(name, name, given, np.diag([size, size, size, 1.0]))]


def _is_file(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):  # longer than any name may be; a NUL in it, in older Pythons
        return False


def _scene_shapes(name: str, scene: Any, size: float) -> list[Shape]:
    found: list[Shape] = []
    for node in sorted(scene.graph.nodes_geometry):
        transform, geometry = scene.graph[node]
        mesh = scene.geometry[geometry]
        if hasattr(mesh, "faces"):
            matrix = np.diag([size, size, size, 1.0]) @ np.asarray(transform, dtype=np.float64)
            found.append(_shape(str(node), f"{name}/{node}", mesh, matrix))
    if not found:
        raise ValueError(f"the scene passed as the mesh of {name} has no triangles")
    return found


def _shape(body: str, name: str, given: Any, matrix: Array) -> Shape:
    """A mesh through an affine map, shape (4, 4), which may mirror it, with its looks.  name: for errors."""
    vertices, faces = (_numbers(name, given, what) for what in ("vertices", "faces"))
    if faces.ndim and not len(faces):
        raise ValueError(f"the mesh of {name} has no triangles")
    if vertices.shape[1:] != (3,) or faces.shape[1:] != (3,):
        raise ValueError(
            f"the mesh of {name} has shapes {vertices.shape}, {faces.shape}; pass triangles, (n, 3) and (m, 3)"
        )
    if not len(vertices) or not np.abs(vertices).max() <= LARGEST:
        raise ValueError(
            f"the mesh of {name} has a vertex that is not finite, beyond {LARGEST:g} m, or none at all"
        )
    if faces.dtype.kind == "f" and (faces != np.floor(faces)).any():
        raise ValueError(f"the faces of {name}'s mesh are no whole numbers; pass numbers of vertices, from 0")
    vertices, faces = vertices.astype(np.float64), faces.astype(np.int64)
    if (worst := faces.min()) < 0 or (worst := faces.max()) >= len(vertices):
        raise ValueError(f"the mesh of {name} names vertex {worst}; it has {len(vertices)}, counted from 0")
    look, normals = look_of(given), _stated_normals(given, len(vertices))
    if look.corners is not None:
        vertices, normals = vertices[look.corners], None if normals is None else normals[look.corners]
        faces = np.arange(len(look.corners)).reshape(-1, 3)
    piece = Piece(
        vertices,
        faces if look.order is None else faces[look.order],
        normals,
        look.uv,
        look.face_counts if len(look.face_counts) > 1 else (),
        colors=look.colors,
    )
    piece = transformed(piece, matrix)
    mesh = Mesh(
        body,
        piece.vertices,
        piece.faces,
        piece.normals,
        () if piece.uv is None else (piece.uv,),
        None,
        piece.colors,
        piece.face_counts,
    )
    return Shape(body, mesh, surfaces=tuple(s for s in look.surfaces if s is not None))


def _numbers(name: str, given: Any, what: str) -> Array:
    """The vertices or the faces of a mesh, as numbers of any shape."""
    values = getattr(given, what)
    try:
        array = np.asarray(values)
    except ValueError:  # lists of unequal length
        array = np.empty(0, dtype=object)
    if array.dtype.kind not in "iuf":
        raise ValueError(f"the {what} of {name}'s mesh are {shown(values)}; pass an array of numbers, (n, 3)")
    return array


def _stated_normals(given: Any, count: int) -> Array | None:
    """Normals of the vertices, unit, where whoever made the mesh gave them.

    trimesh keeps those that it was given where it keeps those that it once computed, smooth across every edge; the latter
    are told by being what it would compute.
    """
    cache = getattr(getattr(given, "_cache", None), "cache", None)
    if cache is not None and "vertex_normals" not in cache:
        return None
    normals = getattr(given, "vertex_normals", None)
    if normals is None or np.shape(normals) != (count, 3):
        return None
    normals = np.array(normals, dtype=np.float64)
    length = np.linalg.norm(normals, axis=1)
    if not (np.isfinite(length).all() and (length > 0.0).all()):
        return None
    if cache is not None:
        bare = type(given)(given.vertices, given.faces, process=False)
        if np.abs(np.asarray(bare.vertex_normals) - normals).max() < 1e-6:
            return None
    return normals / length[:, None]
