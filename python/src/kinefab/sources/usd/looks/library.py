"""Meshes of the scene, each once: by instance, and by content."""

from __future__ import annotations

import zlib
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import Any

import numpy as np

from ....model import Mesh
from ....spatial import Array
from ..found import Piece
from ..prims import source_path
from ..values import Values
from . import gprims
from .meshes import Polygons, read_mesh

COLORS = frozenset(("primvars:displayColor", "primvars:displayOpacity"))
SHAPES = frozenset("Sphere Cube Capsule Capsule_1 Cylinder Cylinder_1 Cone Plane".split())


@dataclass(frozen=True, slots=True, eq=False)
class Shared:
    """mesh: index into the scene's meshes.  title: the prim's name as a user sees it.
    subsets: prims whose materials the submeshes have, None for the mesh's own."""

    mesh: int
    title: str
    subsets: tuple[Any, ...]
    uv_names: tuple[str, ...]


@dataclass(slots=True, eq=False)
class Library:
    """Turns gprims into meshes of the scene: vertices in the prim's own axes, turned like the world and in metres.

    covers: whether materials hide the colours that a mesh states for its points or faces.
    """

    values: Values
    covers: Callable[[Piece], bool]
    meshes: list[Mesh] = field(default_factory=list[Mesh])
    _by_source: dict[tuple[str, bytes, bool], Shared | None] = field(
        default_factory=dict[tuple[str, bytes, bool], Shared | None]
    )
    _polygons: dict[str, Polygons | None] = field(default_factory=dict[str, Polygons | None])
    _by_content: dict[tuple[object, ...], list[int]] = field(
        default_factory=dict[tuple[object, ...], list[int]]
    )

    def shared(self, piece: Piece, bake: Array | None = None) -> Shared | None:
        """The mesh of a gprim, None where it has none (the report says why).

        bake: linear map of the vertices in the prim's axes, shape (3, 3), a mirror or a shear.
        """
        source, traits = piece.seen.source, piece.seen.traits
        bare = traits.kind == "Mesh" and not traits.names.isdisjoint(COLORS) and self.covers(piece)
        key = (source, b"" if bake is None else np.round(bake, 9).tobytes(), bare)
        if key not in self._by_source:
            self._by_source[key] = self._made(piece.prim, source, bake, bare)
        return self._by_source[key]

    def _made(self, prim: Any, source: str, bake: Array | None, bare: bool) -> Shared | None:
        """bare: without the colours of its vertices."""
        if bake is not None or source not in self._polygons:
            polygons = self.polygons(prim)
        else:
            polygons = self._polygons[source]
        if polygons is None:
            return None
        if bare and polygons.colors is not None:
            polygons = replace(polygons, colors=None)
            self.values.report.dropped(
                f"colors of {prim.GetPath()}", "USD_FEATURE_DROPPED", self.values.opened.place(prim),
                detail="its material does not show them, here as in the stage",
            )  # fmt: skip
        name = self.values.title(prim)
        index = self._added(name, polygons, bake)
        mesh, origin = self.meshes[index], _origin(prim, polygons)
        if not mesh.origin or origin < mesh.origin:  # of prims alike, whichever is read first
            self.meshes[index] = replace(mesh, origin=origin)
        return Shared(index, name, polygons.subsets, polygons.uv_names)

    def _added(self, name: str, p: Polygons, bake: Array | None) -> int:
        frame = self.values.opened.frame
        linear = frame.turn if bake is None else frame.turn @ bake
        vertices = p.vertices @ (linear.T * frame.length)
        faces, normals = p.faces, p.normals
        if normals is not None:
            normals = normals @ np.linalg.inv(linear)
            if bake is not None:
                normals = normals / np.maximum(np.linalg.norm(normals, axis=1), 1e-300)[:, None]
        if bake is not None and np.linalg.det(bake) < 0.0:
            faces = faces[:, ::-1]
        faces = np.ascontiguousarray(faces)
        content = (len(faces), p.face_counts, zlib.crc32(np.ascontiguousarray(vertices).data))
        alike = self._by_content.setdefault(content, [])
        for index in alike:
            if _same(self.meshes[index], vertices, faces, normals, p):
                return index
        self.meshes.append(Mesh(name, vertices, faces, normals, p.uvs, None, p.colors, p.face_counts))
        alike.append(len(self.meshes) - 1)
        return len(self.meshes) - 1

    def polygons(self, prim: Any) -> Polygons | None:
        """Triangles of a gprim in its own axes and units."""
        source = source_path(prim)
        kind = str(prim.GetTypeName())
        if kind == "Mesh":
            return read_mesh(prim, self.values)
        if kind in SHAPES:
            s = shape_of(prim, self.values)
            return Polygons(s.vertices, s.faces, s.normals, subsets=(None,))
        if source not in self._polygons:
            self.values.report.dropped(
                f"{kind} {prim.GetPath()}", "USD_FEATURE_DROPPED", self.values.opened.place(prim),
                detail=f"a {kind} has no triangles",
            )  # fmt: skip
            self._polygons[source] = None
        return None


def _origin(prim: Any, polygons: Polygons) -> str:
    """Where the prim is defined: in the file that all which refer to it have in common, if it comes from another.  A shape is what
    it measures, in whichever prims it stands."""
    if (kind := str(prim.GetTypeName())) in SHAPES:
        return " ".join([kind, *(f"{size:.9g}" for size in np.ptp(polygons.vertices, axis=0))])
    stack = prim.GetPrimStack()
    if not stack:
        return f"<{prim.GetPath()}>"
    first = stack[-1]
    local = first.layer == prim.GetStage().GetRootLayer()
    return f"{'' if local else PurePath(first.layer.GetDisplayName()).name}<{first.path}>"


def _same(mesh: Mesh, vertices: Array, faces: np.ndarray, normals: Array | None, p: Polygons) -> bool:
    return (
        np.array_equal(mesh.vertices, vertices)
        and np.array_equal(mesh.faces, faces)
        and (mesh.normals is None) == (normals is None)
        and (normals is None or mesh.normals is not None and np.array_equal(mesh.normals, normals))
        and len(mesh.uvs) == len(p.uvs)
        and all(np.array_equal(a, b) for a, b in zip(mesh.uvs, p.uvs))
        and (mesh.colors is None) == (p.colors is None)
        and (p.colors is None or mesh.colors is not None and np.array_equal(mesh.colors, p.colors))
    )


def shape_of(prim: Any, values: Values) -> gprims.Surface3:
    """Triangles of an analytic gprim; sizes are taken by their amount."""
    kind = str(prim.GetTypeName())

    def size(name: str, default: float) -> float:
        return abs(values.number(prim, name, default)) or 1e-9

    axis = values.token(prim, "axis", tuple("XYZ"), "Z")
    if kind == "Cube":
        return gprims.box(size("size", 2.0))
    if kind == "Sphere":
        return gprims.sphere(size("radius", 1.0))
    if kind == "Plane":
        return gprims.plane(size("width", 2.0), size("length", 2.0), axis)
    if kind == "Capsule":
        radius = size("radius", 0.5)
        return gprims.capsule(radius, radius, size("height", 1.0), axis)
    if kind == "Capsule_1":
        return gprims.capsule(size("radiusBottom", 0.5), size("radiusTop", 0.5), size("height", 1.0), axis)
    if kind == "Cylinder":
        radius = size("radius", 1.0)
        return gprims.cylinder(radius, radius, size("height", 2.0), axis)
    if kind == "Cylinder_1":
        return gprims.cylinder(size("radiusBottom", 1.0), size("radiusTop", 1.0), size("height", 2.0), axis)
    return gprims.cylinder(size("radius", 1.0), 0.0, size("height", 2.0), axis)
