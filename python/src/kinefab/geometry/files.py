"""Reads a mesh file of any format that trimesh knows; OBJ by its own pre-pass."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..diagnostics import Report
from ..model import Material, MeshKey
from .obj import ObjError, read_obj
from .pieces import MeshFile, Piece

FORMATS = (".obj", ".stl", ".ply", ".glb", ".gltf", ".dae", ".3mf", ".off")
STEP_FORMATS = (".step", ".stp")
_ADVICE = {
    ".iges": "Export STEP or OBJ instead.",
    ".igs": "Export STEP or OBJ instead.",
    ".usd": "Export glTF or OBJ instead; USD is not read.",
    ".fbx": "Export OBJ or glTF instead; FBX is a closed format.",
}


def read_mesh_file(path: Path, report: Report, where: str) -> MeshFile | None:
    """The file's pieces, or None with an error in the report.  where: the place that names the file."""
    suffix = path.suffix.lower()
    known = FORMATS + (STEP_FORMATS if _reads_step() else ())
    if suffix not in known:
        advice = _ADVICE.get(suffix, f"Give one of: {', '.join(known)}.")
        if suffix in STEP_FORMATS:
            advice = "Install the STEP reader: pip install kinefab[step]; or export OBJ."
        report.add("GEOMETRY_FORMAT_UNKNOWN", where, path=path.name, advice=advice)
        return None
    try:
        if path.stat().st_size == 0:
            report.add("GEOMETRY_EMPTY", where, path=path.name)
            return None
        found = read_obj(path, report) if suffix == ".obj" else _read_scene(path)
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


def _reads_step() -> bool:
    from importlib.util import find_spec

    return find_spec("cascadio") is not None


def _brief(error: Exception) -> str:
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return " ".join(str(error).split())[:200] or type(error).__name__


def _read_scene(path: Path) -> MeshFile:
    """Every placed mesh of a trimesh scene as a piece, named by its node, the nodes above and its geometry."""
    import trimesh

    if hasattr(trimesh, "load_scene"):
        scene = trimesh.load_scene(str(path), process=False)
    else:
        scene = trimesh.load(str(path), force="scene", process=False)
    parents = scene.graph.transforms.parents
    pieces: list[Piece] = []
    materials: dict[str, Material] = {}
    by_node: dict[str, list[tuple[int, ...]]] = {}
    by_ancestor: dict[str, list[int]] = {}
    by_geometry: dict[str, list[tuple[int, ...]]] = {}
    for node in scene.graph.nodes_geometry:
        transform, name = scene.graph[node]
        mesh = scene.geometry[name]
        if len(getattr(mesh, "faces", ())) == 0:
            continue
        number = len(pieces)
        pieces.append(_placed(mesh, np.asarray(transform), materials))
        by_node.setdefault(str(node), []).append((number,))
        by_geometry.setdefault(str(name), []).append((number,))
        above = parents.get(node)
        while above is not None and above != scene.graph.base_frame:
            by_ancestor.setdefault(str(above), []).append(number)
            above = parents.get(above)
    objects = dict(by_node)
    for name, numbers in by_ancestor.items():  # a node whose mesh was split by material
        objects.setdefault(name, [tuple(numbers)])
    for name, occurrences in by_geometry.items():
        objects.setdefault(name, occurrences)
    return MeshFile(path, pieces, {MeshKey.OBJECT: objects, MeshKey.GROUP: by_geometry}, materials)


def _placed(mesh, transform: np.ndarray, materials: dict[str, Material]) -> Piece:
    """One trimesh mesh at its place in the scene."""
    vertices = np.asarray(mesh.vertices, dtype=np.float64)
    faces = np.asarray(mesh.faces, dtype=np.int64)
    # Normals from the file lie in trimesh's cache; asking for them outright would compute missing ones, and
    # asking the cache itself would hash the whole mesh.
    normals = np.asarray(mesh.vertex_normals) if "vertex_normals" in mesh._cache.cache else None
    uv = getattr(mesh.visual, "uv", None)
    piece = Piece(vertices, faces, normals, uv, (len(faces),), (_named_material(mesh, materials),))
    return piece if np.array_equal(transform, np.eye(4)) else transformed(piece, transform)


def transformed(piece: Piece, matrix: np.ndarray) -> Piece:
    """A piece through an affine map, shape (4, 4); where that mirrors, the winding is turned too."""
    linear = matrix[:3, :3]
    vertices = piece.vertices @ linear.T + matrix[:3, 3]
    mirrored = np.linalg.det(linear) < 0.0
    normals = piece.normals
    if normals is not None:
        normals = normals @ np.linalg.inv(linear)  # normals go by the inverse transpose
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    faces = piece.faces[:, ::-1] if mirrored else piece.faces
    return Piece(vertices, faces, normals, piece.uv, piece.face_counts, piece.materials)


def _named_material(mesh, materials: dict[str, Material]) -> str:
    """The name of a mesh's material, noted with its colour, roughness and metalness; "" for none."""
    material = getattr(mesh.visual, "material", None)
    name = getattr(material, "name", None)
    if not name:
        return ""
    if name not in materials:
        main = np.asarray(material.main_color, dtype=np.float64) / 255.0
        rough, metal = getattr(material, "roughnessFactor", None), getattr(material, "metallicFactor", None)
        materials[name] = Material(
            str(name),
            tuple(float(c) for c in main),
            0.0 if metal is None else float(metal),
            0.5 if rough is None else 1.0 - float(rough),
        )
    return str(name)
