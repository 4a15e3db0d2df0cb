"""Loads the triangles that the bodies of a scene refer to, and lets equal bodies share one mesh."""

from __future__ import annotations

import zlib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Callable

import numpy as np

from ..diagnostics import Report
from ..model import Body, Material, Mesh, MeshReference, Scene
from ..spatial import Array
from .files import read_mesh_file, transformed
from .matching import Wanted, match_bodies
from .pieces import MeshFile, Piece, joined

SAME_SHAPE = 1e-5
"""Two meshes are one when no vertex differs by more than this share of their size: what is left of printed
coordinates after the way back into the part's frame."""

FARTHEST = 1e15
"""Metres: no vertex comes near it; beyond, volumes overflow and Unity's float32 has no number for it."""

_Place = tuple[int, int]
"""(index of a node, index of one of its bodies)"""


class MeshFiles:
    """Mesh files as they are asked for, each read once."""

    def __init__(self, report: Report):
        self._report = report
        self._files: dict[Path, MeshFile | None] = {}

    def get(self, path: Path, where: str) -> MeshFile | None:
        """The file, or None with an error in the report.  where: the place that names it."""
        if path not in self._files:
            self._files[path] = read_mesh_file(path, self._report, where)
        return self._files[path]

    def vertices(self, reference: MeshReference) -> Array:
        """The vertices that a reference means, in its node's frame, shape (n, 3); none where it is not found.

        What is wrong with the reference is reported when the scene's geometry is loaded, not here.
        """
        file = self.get(reference.path, reference.where)
        if file is None:
            return np.zeros((0, 3))
        (numbers,) = match_bodies(file, [Wanted(reference.key or "", reference)], Report())
        if not numbers:
            return np.zeros((0, 3))
        return transformed(joined([file.pieces[n] for n in numbers]), reference.to_node).vertices


def load_geometry(
    scene: Scene, files: MeshFiles, report: Report, progress: Callable[[str, float], None]
) -> Scene:
    """The scene with the mesh of every ``Body.reference`` loaded, in its node's frame, metres.

    Errors (missing files, bodies that are not in them) are in the report; such bodies stay without a mesh.
    """
    places: dict[Path, list[_Place]] = {}
    for i, node in enumerate(scene.nodes):
        for k, body in enumerate(node.bodies):
            if body.reference is not None and body.mesh is None:
                places.setdefault(body.reference.path, []).append((i, k))
    if not places:
        return scene
    loading = _Loading(scene, report)
    for done, (path, bodies) in enumerate(places.items()):
        progress("geometry", done / len(places))
        wanted = [
            Wanted(f"{scene.nodes[i].id}/{scene.nodes[i].bodies[k].name}", scene.nodes[i].bodies[k].reference)
            for i, k in bodies
        ]
        file = files.get(path, wanted[0].reference.where)
        if file is None:
            continue
        matches = match_bodies(file, wanted, report)
        for k, (place, body, numbers) in enumerate(zip(bodies, wanted, matches)):
            if numbers:
                loading.place(place, body, file, numbers)
            progress("geometry", (done + (k + 1) / len(bodies)) / len(places))
    progress("geometry", 1.0)
    return loading.finish()


@dataclass(frozen=True, slots=True)
class _Known:
    """A mesh that others may turn out to equal.  first: its first vertex.  tolerance: metres."""

    mesh: int
    first: list[float]
    tolerance: float


class _Loading:
    """The scene's meshes, materials and bodies while files are being read."""

    def __init__(self, scene: Scene, report: Report):
        self._scene, self._report = scene, report
        self._meshes, self._materials = list(scene.meshes), list(scene.materials)
        self._bodies = [list(node.bodies) for node in scene.nodes]
        self._by_origin: dict[tuple, tuple[int, Piece]] = {}
        self._by_shape: dict[tuple, list[_Known]] = {}
        self._first_of: dict[tuple[str, int], tuple[int, str]] = {}

    def place(self, place: _Place, wanted: Wanted, file: MeshFile, numbers: tuple[int, ...]) -> None:
        """Give a body the mesh of these pieces."""
        i, k = place
        body = self._bodies[i][k]
        matrix = np.asarray(wanted.reference.to_node, dtype=np.float64)
        origin = (file.path, numbers, matrix.tobytes())  # parts with a file of their own repeat this exactly
        if origin not in self._by_origin:
            with np.errstate(over="ignore", invalid="ignore"):  # checked right below
                piece = transformed(joined([file.pieces[n] for n in numbers]), matrix)
            if not (np.abs(piece.vertices) <= FARTHEST).all():
                self._report.add("GEOMETRY_NOT_FINITE", wanted.reference.where, body=wanted.label)
                return
            self._by_origin[origin] = (self._share(body.name, piece), piece)
        mesh, piece = self._by_origin[origin]
        materials = self._body_materials(body, piece, file)
        self._bodies[i][k] = replace(body, mesh=mesh, materials=materials, reference=None)
        self._compare_with_definition(place, wanted, mesh)

    def finish(self) -> Scene:
        nodes = [
            replace(node, bodies=tuple(bodies)) if bodies else node
            for node, bodies in zip(self._scene.nodes, self._bodies)
        ]
        return replace(self._scene, nodes=nodes, meshes=self._meshes, materials=self._materials)

    def _share(self, name: str, piece: Piece) -> int:
        """The index of a mesh of this shape: one that is there already, or a new one."""
        faces = np.ascontiguousarray(piece.faces)
        key = (len(piece.vertices), piece.face_counts, piece.uv is None, zlib.crc32(faces))
        alike = self._by_shape.setdefault(key, [])
        first = piece.vertices[0].tolist()
        for known in alike:
            if all(
                abs(x - y) <= known.tolerance for x, y in zip(first, known.first)
            ):  # tells most apart at once
                mesh = self._meshes[known.mesh]
                if _deviation(mesh.vertices, piece.vertices) <= known.tolerance and (
                    piece.uv is None or np.allclose(mesh.uv, piece.uv, atol=SAME_SHAPE)
                ):
                    return known.mesh
        self._meshes.append(Mesh(name, piece.vertices, faces, piece.normals, piece.uv, piece.face_counts))
        tolerance = SAME_SHAPE * float(np.ptp(piece.vertices, axis=0).max())
        alike.append(_Known(len(self._meshes) - 1, first, tolerance))
        return len(self._meshes) - 1

    def _compare_with_definition(self, place: _Place, wanted: Wanted, mesh: int) -> None:
        """Occurrences of one definition look alike in the part's frame, unless a pose or unit is wrong."""
        i, k = place
        node = self._scene.nodes[i]
        if node.definition is None:
            return
        first, first_id = self._first_of.setdefault((node.definition, k), (mesh, node.id))
        if first == mesh:
            return
        a, b = self._meshes[first].vertices, self._meshes[mesh].vertices
        deviation = f"{_deviation(a, b):.3g}" if a.shape == b.shape else "an unknown number of"
        self._report.add(
            "BODY_SHAPE_DIFFERS",
            wanted.reference.where,
            node=node.id,
            first=first_id,
            definition=node.definition,
            deviation=deviation,
        )

    def _body_materials(self, body: Body, piece: Piece, file: MeshFile) -> tuple[int, ...]:
        """One material for each submesh: the source's where it names as many, else the file's."""
        count = max(1, len(piece.face_counts))
        if len(body.materials) == count:
            return body.materials
        if count == 1 and not body.materials and not any(piece.materials):
            return ()
        names = piece.materials or ("",) * count
        return tuple(self._material(name, file, body) for name in names)

    def _material(self, name: str, file: MeshFile, body: Body) -> int:
        """The index of the scene's material of that name, added from the file where it is new."""
        if not name and body.materials:
            return body.materials[0]
        for index, material in enumerate(self._materials):
            if material.name in (name, name.replace("_", " ")):
                return index
        self._materials.append(file.materials.get(name, Material(name or "Default")))
        return len(self._materials) - 1


def _deviation(a: np.ndarray, b: np.ndarray) -> float:
    return float(np.abs(a - b).max())
