"""Reads a mesh file of any format that trimesh knows; OBJ by its own pre-pass."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path
from typing import Any, cast

import numpy as np

from ..diagnostics import Report
from ..extras import install
from ..model import MeshKey, Surface
from ..spatial import Array
from .looks.gltf import GltfFile
from .looks.gltf_document import gltf_document
from .looks.passed_over import colors_of_stl, tell_3mf, tell_collada
from .looks.visuals import Look, look_of
from .pieces import MeshFile, Piece, placed
from .references import (
    FolderResolver,
    UnsafeReference,
    demand_honest_archive,
    heads_of_3mf,
    metres_of_3mf,
)
from .whole.stl import demand_whole_stl
from .wavefront.reader import ObjError, read_obj

FORMATS = (".obj", ".stl", ".ply", ".glb", ".gltf", ".dae", ".3mf", ".off")
ARCHIVES = (".3mf",)
GLTF = (".glb", ".gltf")
COLLADA = (".dae", ".zae")
UNMOVED = np.eye(4)
_STEP, _MESH = (
    "Open it in its own program and export STEP or STL.",
    "Open it in its own program and export glTF or OBJ.",
)
_ADVICE = {
    **dict.fromkeys(
        (".step", ".stp", ".iges", ".igs", ".wrl", ".vrml"), f"Install OpenCASCADE: {install('cad')}; or export STL or OBJ instead."
    ),
    **dict.fromkeys((".3ds", ".fbx", ".x3d"), f"Install assimp: {install('meshes')}; or export glTF or OBJ instead."),
    **dict.fromkeys(
        (".sldprt", ".sldasm", ".ipt", ".iam", ".prt", ".asm", ".catpart", ".catproduct", ".par", ".psm", ".f3d", ".smt",
         ".sat", ".sab", ".x_t", ".x_b", ".jt", ".3dm", ".fcstd", ".brep", ".brp", ".dwg", ".dxf"), _STEP,
    ),
    **dict.fromkeys((".blend", ".max", ".ma", ".mb", ".c4d", ".skp", ".lwo", ".3dxml", ".u3d", ".abc"), _MESH),
    **dict.fromkeys((".usd", ".usda", ".usdc", ".usdz"), "Export glTF or OBJ instead; USD is not read as a mesh."),
}  # fmt: skip

Reader = Callable[[Path, Report, str], MeshFile | None]
"""Reads a mesh file, or adds an error to the report; the text is the place that names the file."""


def read_mesh_file(path: Path, report: Report, where: str) -> MeshFile | None:
    """The file's pieces, or None with an error in the report.  where: the place that names the file."""
    suffix = path.suffix.lower()
    if suffix not in FORMATS:
        advice = _ADVICE.get(suffix, f"Give one of: {', '.join(FORMATS)}.")
        report.add("GEOMETRY_FORMAT_UNKNOWN", where, path=path.name, advice=advice)
        return None
    try:
        if path.exists() and not path.is_file():
            raise UnsafeReference("it is no regular file")
        if path.stat().st_size == 0:
            report.add("GEOMETRY_EMPTY", where, path=path.name)
            return None
        if suffix == ".stl":
            demand_whole_stl(path)
        found = read_obj(path, report) if suffix == ".obj" else _read_scene(path, report, where)
    except ObjError as error:
        report.add("GEOMETRY_UNREADABLE", where, path=path.name, detail=error)
        return None
    except MemoryError:
        raise
    except ImportError as error:  # a format whose parser is a package of its own
        report.add(
            "GEOMETRY_FORMAT_UNKNOWN",
            where,
            path=path.name,
            advice=f"Install it ({error}), or export OBJ or glTF.",
        )
        return None
    except Exception as error:  # trimesh's parsers raise whatever the damaged bytes lead to
        report.add("GEOMETRY_UNREADABLE", where, path=path.name, detail=_brief(error))
        return None
    if not any(len(piece.faces) for piece in found.pieces):
        report.add("GEOMETRY_EMPTY", where, path=path.name)
        return None
    return found


_PLY_LENGTH = "PLY is unexpected length"
"""What trimesh says of a binary file that is cut short, and of a whole one with triangles beside quadrangles."""


def _brief(error: Exception) -> str:
    if isinstance(error, UnsafeReference):
        return str(error)
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    said = " ".join(str(error).split())[:200]
    if said.startswith(_PLY_LENGTH):
        return "it is cut short, or its faces have different numbers of corners: triangulate them"
    return said or type(error).__name__


def _read_scene(path: Path, report: Report, where: str) -> MeshFile:
    """Every placed mesh of a trimesh scene as a piece, named by its node, the nodes above and its geometry."""
    resolver = FolderResolver(path.parent)
    suffix = path.suffix.lower()
    gltf = suffix in GLTF
    document = GltfFile(path, gltf_document(path), resolver.get, report, where) if gltf else None
    scene = _trimesh_scene(path, resolver)
    parents = scene.graph.transforms.parents
    pieces: list[Piece] = []
    surfaces: dict[str, Surface] = {}
    own: dict[str, Piece] = {}
    by_node: dict[str, list[tuple[int, ...]]] = {}
    by_ancestor: dict[str, list[int]] = {}
    by_geometry: dict[str, list[tuple[int, ...]]] = {}
    if suffix in COLLADA:
        tell_collada(path, report, where)
    primitives = {} if document is None else document.primitives(list(scene.geometry))
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        mesh = scene.geometry[name]
        if len(getattr(mesh, "faces", ())) == 0:
            continue
        number = len(pieces)
        if name not in own:
            if suffix == ".stl":
                _paint_stl(mesh, path)
            look, vertices = look_of(mesh, gltf, suffix in COLLADA), None
            if document is not None and name in primitives:
                look = document.completed(look, primitives[name])
                vertices = document.places(primitives[name])
            own[name] = _piece(mesh, look, surfaces, vertices)
        matrix = np.asarray(transform)
        pieces.append(own[name] if (matrix == UNMOVED).all() else transformed(own[name], matrix))
        by_node.setdefault(str(node), []).append((number,))
        by_geometry.setdefault(str(name), []).append((number,))
        above, passed = parents.get(node), {node}
        while above is not None and above != scene.graph.base_frame:
            if above in passed:
                raise UnsafeReference("its nodes stand in a circle, each under the next")
            passed.add(above)
            by_ancestor.setdefault(str(above), []).append(number)
            above = parents.get(above)
    objects = dict(by_node)
    for name, numbers in by_ancestor.items():  # a node whose mesh was split by material
        objects.setdefault(name, [tuple(numbers)])
    for name, occurrences in by_geometry.items():
        objects.setdefault(name, occurrences)
    _tell_images(path, resolver.failed, report, where)
    metres = None
    if suffix in ARCHIVES:
        metres = metres_of_3mf(heads := heads_of_3mf(path))
        tell_3mf(heads, path, report, where)
    return MeshFile(path, pieces, {MeshKey.OBJECT: objects, MeshKey.GROUP: by_geometry}, surfaces, metres)


def _tell_images(path: Path, failed: Mapping[str, str], report: Report, where: str) -> None:
    """failed: what could not be read beside the file, and why; of buffers the whole file would have failed."""
    told = [(f"texture {name}", name, detail) for name, detail in failed.items()]
    if path.suffix.lower() in GLTF and find_spec("PIL") is None and b'"images"' in path.read_bytes():
        told.append((f"textures of {path.name}", "of it", "reading images needs the Python package pillow"))
    for feature, file, detail in told:
        report.dropped(feature, "TEXTURE_UNREADABLE", where, file=file, path=path.name, detail=detail)


_UNHEARD = logging.NullHandler()


def _trimesh_scene(path: Path, resolver: FolderResolver) -> Any:
    """The file as trimesh reads it; its classes state no types."""
    import trimesh

    # What it could not load is a finding of ours; without a handler its tracebacks would go to stderr.
    logging.getLogger("trimesh").addHandler(_UNHEARD)

    library = cast(Any, trimesh)
    if path.suffix.lower() in ARCHIVES:
        demand_honest_archive(path)
    if hasattr(library, "load_scene"):
        return library.load_scene(str(path), process=False, resolver=resolver)
    return library.load(str(path), force="scene", process=False, resolver=resolver)


def _piece(mesh: Any, look: Look, surfaces: dict[str, Surface], vertices: Array | None) -> Piece:
    """One trimesh mesh in its own frame, its surfaces noted.  vertices: instead of those that trimesh has, shape (n, 3)."""
    if vertices is None:
        vertices = np.asarray(mesh.vertices, dtype=np.float64)
    faces = np.asarray(mesh.faces, dtype=np.int64)
    # Normals from the file lie in trimesh's cache; asking for them outright would compute missing ones, and
    # asking the cache itself would hash the whole mesh.
    normals = np.asarray(mesh.vertex_normals) if "vertex_normals" in mesh._cache.cache else None
    if look.corners is not None:
        vertices, normals = vertices[look.corners], None if normals is None else normals[look.corners]
        faces = np.arange(len(look.corners)).reshape(-1, 3)
    if look.order is not None:
        faces = faces[look.order]
    names = tuple("" if s is None else noted(s, surfaces) for s in look.surfaces)
    return Piece(vertices, faces, normals, look.uv, look.face_counts, names, look.colors)


def _paint_stl(mesh: Any, path: Path) -> None:
    """Give a mesh the colours that its triangles have in the file."""
    marks = mesh.face_attributes.get("stl")
    if marks is None or not len(marks):
        return
    with path.open("rb") as stream:
        colors = colors_of_stl(np.asarray(marks).reshape(-1).astype(np.int64), stream.read(80))
    if colors is not None and len(colors) == len(mesh.faces):
        mesh.visual.face_colors = colors.astype(np.uint8)


def transformed(piece: Piece, matrix: Array) -> Piece:
    """A piece through an affine map, shape (4, 4); where that mirrors, the winding is turned too."""
    return placed(piece, matrix[:3, :3], matrix[:3, 3])


def noted(surface: Surface, surfaces: dict[str, Surface]) -> str:
    """The name that a surface is listed by: its own, with a number where another of that name looks different."""
    name, count = surface.name, 1
    while surfaces.setdefault(name, replace(surface, name=name)) != replace(surface, name=name):
        count += 1
        name = f"{surface.name}:{count}"
    return name
