"""Meshes: arrays, submeshes with their materials, and prototypes of what stands in several places."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....model import PLAIN, Mesh, Scene, Surface
from ....spatial import Array
from ..api import Gf, Vt
from ..physics.colliders import Contact, write_contact
from ..prims import Prim
from .materials import Materials, uv_name


INSTANCED = "Mesh"
"""Name of the one prim of a prototype."""


@dataclass(frozen=True, slots=True)
class Use:
    """One way in which a mesh is used.  surfaces: of its submeshes.  contact: what touches, None where nothing does.
    guide: it collides only, and is not drawn."""

    mesh: int
    surfaces: tuple[int, ...] = ()
    contact: Contact | None = None
    guide: bool = False


class Meshes:
    """Writes meshes in place, and as instances of one prototype where they are used alike more than once."""

    def __init__(self, scene: Scene, scope: Prim, materials: Materials, uses: Sequence[Use]):
        """scope: of the prototypes.  uses: all that will be written."""
        self._scene, self._scope, self._materials = scene, scope, materials
        self._count = Counter(uses)
        self._prototypes: dict[Use, Any] = {}

    def instanced(self, use: Use) -> bool:
        return self._count[use] > 1

    def kind(self, use: Use) -> str:
        """Type of the prim that is to show it."""
        return "Xform" if self.instanced(use) else "Mesh"

    def write(self, prim: Prim, use: Use) -> None:
        """Into a prim of that type."""
        if not self.instanced(use):
            self._fill(prim, use)
            return
        if use not in self._prototypes:
            name = self._scene.meshes[use.mesh].name or "Mesh"
            prototype = self._scope.child(name, "Xform", prototype=True)
            self._fill(prototype.child(INSTANCED, "Mesh", name=INSTANCED), use)
            self._prototypes[use] = prototype.path
        prim.refer(self._prototypes[use])

    def _fill(self, prim: Prim, use: Use) -> None:
        mesh = self._scene.meshes[use.mesh]
        surfaces = [self._scene.surfaces[i] for i in use.surfaces]
        _write_arrays(prim, mesh)
        if any(surface.double_sided for surface in surfaces):
            prim.attribute("doubleSided", "Bool", True, uniform=True)
        if use.guide:
            prim.attribute("purpose", "Token", "guide", uniform=True)
        if use.contact is not None:
            write_contact(prim, use.contact)
        if len(mesh.face_counts) > 1:
            self._split(prim, mesh.face_counts, surfaces)
        elif surfaces:
            _bound(prim, self._materials.path(surfaces[0]))

    def _split(self, prim: Prim, counts: Sequence[int], surfaces: Sequence[Surface]) -> None:
        """Subsets of the faces, with materials where any is named."""
        chosen = [surfaces[k] if k < len(surfaces) else PLAIN for k in range(len(counts))]
        prim.attribute("subsetFamily:materialBind:familyType", "Token", "partition", uniform=True)
        first = 0
        for count, surface in zip(counts, chosen):
            if count:
                subset = prim.child(surface.name or "Subset", "GeomSubset", identity=str(first))
                subset.attribute("elementType", "Token", "face", uniform=True)
                subset.attribute("familyName", "Token", "materialBind", uniform=True)
                numbers = np.arange(first, first + count, dtype=np.int32)
                subset.attribute("indices", "IntArray", Vt.IntArray.FromNumpy(numbers))
                if surfaces:
                    _bound(subset, self._materials.path(surface))
            first += count


def _bound(prim: Prim, material: Any) -> None:
    prim.apply("MaterialBindingAPI")
    prim.relation("material:binding", material)


def _write_arrays(prim: Prim, mesh: Mesh) -> None:
    written = mesh.vertices.astype(np.float32)
    low, high = written.min(axis=0), written.max(axis=0)
    corners = [Gf.Vec3f(*map(float, low)), Gf.Vec3f(*map(float, high))]
    prim.attribute("extent", "Float3Array", Vt.Vec3fArray(corners))
    prim.attribute("subdivisionScheme", "Token", "none", uniform=True)
    counts = np.full(len(mesh.faces), 3, dtype=np.int32)
    prim.attribute("faceVertexCounts", "IntArray", Vt.IntArray.FromNumpy(counts))
    corners_of_faces = np.ascontiguousarray(mesh.faces, dtype=np.int32).ravel()
    prim.attribute("faceVertexIndices", "IntArray", Vt.IntArray.FromNumpy(corners_of_faces))
    prim.attribute("points", "Point3fArray", _vectors3(mesh.vertices))
    if mesh.normals is not None:
        lengths = np.linalg.norm(mesh.normals, axis=1, keepdims=True)
        if (lengths > 0.0).all():
            _vertexwise(prim.attribute("normals", "Normal3fArray", _vectors3(mesh.normals / lengths)))
    for number, uv in enumerate(mesh.uvs):
        values = Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(uv, dtype=np.float32))
        _vertexwise(prim.attribute(f"primvars:{uv_name(number)}", "TexCoord2fArray", values))
    if mesh.colors is not None:
        _vertexwise(prim.attribute("primvars:displayColor", "Color3fArray", _vectors3(mesh.colors[:, :3])))
        alpha = Vt.FloatArray.FromNumpy(np.ascontiguousarray(mesh.colors[:, 3], dtype=np.float32))
        if (mesh.colors[:, 3] < 1.0).any():
            _vertexwise(prim.attribute("primvars:displayOpacity", "FloatArray", alpha))


def _vertexwise(spec: Any) -> None:
    spec.SetInfo("interpolation", "vertex")


def _vectors3(values: Array) -> Any:
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, dtype=np.float32))
