"""Loads the triangles that the bodies of a scene refer to, and lets equal bodies share one mesh."""

from __future__ import annotations

import gc
import zlib
from bisect import bisect_left, bisect_right, insort
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..diagnostics import Report
from ..model import Body, Mesh, MeshReference, Scene, Surface
from ..spatial import Array, bounds
from .files import Reader, read_mesh_file, transformed
from .lending import tell_losses, with_lent_bodies, without_lent_bodies, without_looks
from .matching import Wanted, match_bodies
from .pieces import MeshFile, Piece, joined
from .whole.lfs import is_pointer

SAME_SHAPE = 1e-5
"""Two meshes are one when no vertex differs by more than this share of their size: what is left of printed
coordinates after the way back into the part's frame."""

FARTHEST = 1e15
"""Metres: no vertex comes near it; beyond, volumes overflow and Unity's float32 has no number for it."""

_Place = tuple[int, int]
"""(index of a node, index of one of its bodies)"""


class MeshFiles:
    """Mesh files as they are asked for, each read once."""

    def __init__(self, report: Report, readers: Mapping[str, Reader] | None = None):
        """readers: by ending, lower case, of what trimesh does not read, or not as well."""
        self._report = report
        self._readers = dict(readers or {})
        self._files: dict[Path, MeshFile | None] = {}

    def get(self, path: Path, where: str, report: Report | None = None) -> MeshFile | None:
        """The file, or None with an error in the report.  where: the place that names it.  report: instead of the own one."""
        if path not in self._files and is_pointer(path):
            told = self._report if report is None else report
            told.add("GEOMETRY_LFS_POINTER", where, path=path.name)
            self._files[path] = None
        if path not in self._files:
            read = self._readers.get(path.suffix.lower(), read_mesh_file)
            self._files[path] = read(path, self._report if report is None else report, where)
            # What trimesh leaves holds on to itself and to the file's bytes, and while an export runs nobody else looks for it.
            gc.collect(0)
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
        return transformed(joined([file.pieces[n] for n in numbers]), _to_node(reference, file)).vertices


def load_geometry(
    scene: Scene, files: MeshFiles, report: Report, progress: Callable[[str, float], None]
) -> Scene:
    """The scene with the mesh of every reference of a body or collider loaded, in its own frame, metres.

    Errors (missing files, bodies that are not in them) are in the report; such bodies stay without a mesh, and such
    colliders are left out.  Of a reference that is not needed they are losses.
    """
    given, scene = scene, with_lent_bodies(scene)
    places: dict[Path, list[tuple[_Place, Wanted]]] = {}
    for i, node in enumerate(scene.nodes):
        for k, body in enumerate(node.bodies):
            if body.reference is not None and body.mesh is None:
                wanted = Wanted(f"{node.id}/{body.name}", body.reference)
                places.setdefault(body.reference.path, []).append(((i, k), wanted))
    if not places:
        return given
    seen = [len(node.bodies) for node in given.nodes]  # those after them are colliders'
    loading = _Loading(scene, report, seen)
    for done, (path, bodies) in enumerate(places.items()):
        progress("geometry", done / len(places))
        wanted = [body for _, body in bodies]
        needed = any(body.reference.needed for body in wanted)
        drawn = any(k < seen[i] for (i, k), _ in bodies)
        found = report if needed and drawn else Report()
        file = files.get(path, wanted[0].reference.where, found)
        matches = [] if file is None else match_bodies(file, wanted, found)
        if not drawn:
            without_looks(found)
        if needed and not drawn:
            report.extend(found)
        if not needed:
            tell_losses(found, [w.label for w in wanted], path.name, wanted[0].reference.where, report)
        if file is None:
            continue
        for k, ((place, body), numbers) in enumerate(zip(bodies, matches)):
            if numbers:
                loading.place(place, body, file, numbers)
            progress("geometry", (done + (k + 1) / len(bodies)) / len(places))
    progress("geometry", 1.0)
    return without_lent_bodies(given, loading.finish())


@dataclass(frozen=True, slots=True)
class _Known:
    """A mesh that others may turn out to equal.

    spread: the mean of its coordinates' amounts, metres, by which most that differ are told apart at once: where no vertex
    differs by more than a tolerance, it does not either.  tolerance: metres.
    """

    spread: float
    mesh: int
    tolerance: float


def _spread(known: _Known) -> float:
    return known.spread


class _Loading:
    """The scene's meshes, surfaces and bodies while files are being read."""

    def __init__(self, scene: Scene, report: Report, drawn: Sequence[int]):
        """drawn: of each node how many of its bodies are to be seen; the others are colliders'."""
        self._scene, self._report, self._drawn = scene, report, drawn
        self._meshes, self._surfaces = list(scene.meshes), list(scene.surfaces)
        self._stated = len(self._surfaces)
        self._bodies = [list(node.bodies) for node in scene.nodes]
        self._by_origin: dict[tuple[Path, tuple[int, ...], bytes], tuple[int, Piece]] = {}
        self._by_shape: dict[tuple[int, tuple[int, ...], tuple[bool, ...], int], list[_Known]] = {}
        self._known: dict[int, _Known] = {}
        self._first_of: dict[tuple[str, int], tuple[int, str]] = {}
        self._told: dict[int, tuple[str, str]] = {}

    def place(self, place: _Place, wanted: Wanted, file: MeshFile, numbers: tuple[int, ...]) -> None:
        """Give a body the mesh of these pieces."""
        i, k = place
        body = self._bodies[i][k]
        matrix = _to_node(wanted.reference, file)
        origin = (file.path, numbers, matrix.tobytes())  # parts with a file of their own repeat this exactly
        if origin not in self._by_origin:
            with np.errstate(over="ignore", invalid="ignore"):  # checked right below
                piece = transformed(joined([file.pieces[n] for n in numbers]), matrix)
            found = self._mesh_of_definition(place, piece)
            if found is None and not (np.abs(piece.vertices) <= FARTHEST).all():
                self._report.add("GEOMETRY_NOT_FINITE", wanted.reference.where, body=wanted.label)
                return
            self._by_origin[origin] = (self._share(body.name, piece) if found is None else found, piece)
        mesh, piece = self._by_origin[origin]
        self._tell(mesh, wanted.reference)
        surfaces = self._body_surfaces(body, piece, file) if k < self._drawn[i] else ()
        self._bodies[i][k] = replace(body, mesh=mesh, surfaces=surfaces, reference=None)
        self._compare_with_definition(place, wanted, mesh)

    def finish(self) -> Scene:
        nodes = [
            replace(node, bodies=tuple(bodies)) if bodies else node
            for node, bodies in zip(self._scene.nodes, self._bodies)
        ]
        meshes = [
            replace(mesh, origin="|".join(self._told[i])) if i in self._told else mesh
            for i, mesh in enumerate(self._meshes)
        ]
        return replace(self._scene, nodes=nodes, meshes=meshes, surfaces=self._surfaces)

    def _tell(self, mesh: int, reference: MeshReference) -> None:
        """Keep a mesh's origin: its file wherever that lies and its name in it, then how it is stretched along the file's axes;
        of files and names alike, whichever is read first."""
        name = f"{reference.path.name}|{reference.key or ''}"
        known = self._told.get(mesh)
        if known is None or name <= known[0]:
            linear = np.asarray(reference.to_node, dtype=np.float64)[:3, :3]
            stretch = np.copysign(np.linalg.norm(linear, axis=0), np.linalg.det(linear))
            told = name, ",".join(f"{x:.6g}" for x in stretch)
            self._told[mesh] = told if known is None else min(known, told)

    def _mesh_of_definition(self, place: _Place, piece: Piece) -> int | None:
        """The mesh of the first occurrence of a body's definition where this is its shape too, as it nearly always is: a search
        among all shapes takes twice the time."""
        i, k = place
        definition = self._scene.nodes[i].definition
        first = None if definition is None else self._first_of.get((definition, k))
        known = None if first is None else self._known.get(first[0])
        if known is None:
            return None
        mesh = self._meshes[known.mesh]
        alike = (
            mesh.vertices.shape == piece.vertices.shape
            and (mesh.face_counts, _stated(mesh)) == (piece.face_counts, _stated(piece))
            and np.array_equal(mesh.faces, piece.faces)
        )
        return known.mesh if alike and self._is_shape(known, piece) else None

    def _is_shape(self, known: _Known, piece: Piece) -> bool:
        """Whether a mesh with the same faces has this shape."""
        mesh = self._meshes[known.mesh]
        return (
            _deviation(mesh.vertices, piece.vertices) <= known.tolerance
            and (piece.uv is None or np.allclose(mesh.uvs[0], piece.uv, atol=SAME_SHAPE))
            and (piece.colors is None or np.array_equal(mesh.colors, piece.colors))  # type: ignore[arg-type]
        )

    def _share(self, name: str, piece: Piece) -> int:
        """The index of a mesh of this shape: one that is there already, or a new one."""
        faces = np.ascontiguousarray(piece.faces)
        key = (len(piece.vertices), piece.face_counts, _stated(piece), zlib.crc32(faces.data))
        alike = self._by_shape.setdefault(key, [])
        spread = float(np.abs(piece.vertices).mean())
        low, high = bounds(piece.vertices)
        tolerance = SAME_SHAPE * float((high - low).max())
        # The other's tolerance is its own, and the mean is rounded.
        reach = 1.001 * tolerance + 1e-12 * spread
        first = bisect_left(alike, spread - reach, key=_spread)
        last = bisect_right(alike, spread + reach, key=_spread)
        for known in sorted(alike[first:last], key=lambda known: known.mesh):
            if self._is_shape(known, piece):
                return known.mesh
        uvs = () if piece.uv is None else (piece.uv,)
        self._meshes.append(
            Mesh(name, piece.vertices, faces, piece.normals, uvs, None, piece.colors, piece.face_counts)
        )
        known = self._known[len(self._meshes) - 1] = _Known(spread, len(self._meshes) - 1, tolerance)
        insort(alike, known, key=_spread)
        return known.mesh

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

    def _body_surfaces(self, body: Body, piece: Piece, file: MeshFile) -> tuple[int, ...]:
        """One surface for each submesh: the source's where it names as many, else the file's."""
        count = max(1, len(piece.face_counts))
        if len(body.surfaces) == count:
            return body.surfaces
        if count == 1 and not body.surfaces and not any(piece.surfaces):
            return ()
        names = piece.surfaces or ("",) * count
        return tuple(self._surface(name, file, body) for name in names)

    def _surface(self, name: str, file: MeshFile, body: Body) -> int:
        """The index of the scene's surface of that name, added from the file where it is new."""
        if not name and body.surfaces:
            return body.surfaces[0]
        for index, material in enumerate(self._surfaces[: self._stated]):
            if material.name in (name, name.replace("_", " ")):
                return index
        found = file.surfaces.get(name, Surface(name or "Default"))
        if found not in self._surfaces[self._stated :]:  # two files may call different looks by one name
            self._surfaces.append(found)
        return self._surfaces.index(found, self._stated)


def _stated(shape: Mesh | Piece) -> tuple[bool, bool, bool]:
    """Whether it has texture coordinates, normals, colours."""
    uv = shape.uv is not None if isinstance(shape, Piece) else bool(shape.uvs)
    return uv, shape.normals is not None, shape.colors is not None


def _to_node(reference: MeshReference, file: MeshFile) -> Array:
    """The map into the node's frame, by the file's own unit where it states one."""
    matrix = np.array(reference.to_node, dtype=np.float64)
    if file.metres is not None and (said := abs(float(np.linalg.det(matrix[:3, :3]))) ** (1.0 / 3.0)) > 0.0:
        matrix[:3, :3] *= file.metres / said
    return matrix


def _deviation(a: Array, b: Array) -> float:
    return float(np.abs(a - b).max())
