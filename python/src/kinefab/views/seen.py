"""What of a written scene is seen, as Unity shows it: which objects, and their meshes as triangles with colours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..spatial import Array, IntArray
from .freedoms import Placement

Entry = Mapping[str, Any]
PLAIN = (0.7, 0.7, 0.72)
"""The colour of what has no material."""


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """A mesh that is seen.  index: of its object.  corners: shape (n, 3), metres, in the object's own frame at its scale.
    faces: shape (m, 3), Unity's winding.  colours: linear RGB of the faces, shape (m, 3)."""

    index: int
    corners: Array
    faces: IntArray
    colours: Array


def shown(objects: Sequence[Entry]) -> list[bool]:
    """Of each GameObject whether its renderer, if it has one, is on, and neither it nor an object above it inactive."""
    active: list[bool] = []
    for item in objects:
        parent: int | None = item.get("parent")
        active.append(bool(item.get("active", True)) and (parent is None or active[parent]))
    renderers = (_component(item, "MeshRenderer") for item in objects)
    return [own and renderer.get("enabled", True) for own, renderer in zip(active, renderers)]


def shapes(
    document: Entry, buffers: Sequence[bytes], placements: Sequence[Placement], most: int
) -> Iterator[Shape]:
    """Every mesh that is seen, by object.  most: triangles, all together; of more each mesh is the box around it."""
    objects, materials = document["gameObjects"], document.get("materials", [])
    drawn = [(i, _component(item, "MeshFilter").get("mesh")) for i, item in enumerate(objects)]
    meshes: list[tuple[int, Entry]] = [
        (i, document["meshes"][mesh])
        for (i, mesh), seen in zip(drawn, shown(objects))
        if seen and mesh is not None
    ]
    boxed = sum(s["indexCount"] for _, mesh in meshes for s in mesh["submeshes"]) > 3 * most
    for i, mesh in meshes:
        corners, faces = _box(mesh["bounds"]) if boxed else mesh_triangles(mesh, buffers)
        slots: Sequence[int] = _component(objects[i], "MeshRenderer").get("materials", ())
        colours = np.tile(PLAIN, (len(faces), 1))
        for slot, part in reversed(list(zip(slots, mesh["submeshes"]))):
            first = 0 if boxed else part["indexStart"] // 3
            last = len(faces) if boxed else first + part["indexCount"] // 3
            colours[first:last] = materials[slot].get("color", (1, 1, 1, 1))[:3]
        scale = placements[i][2]
        if scale.prod() < 0.0:  # a mirror, behind which the outside is to be outside
            faces = faces[:, ::-1]
        yield Shape(i, corners * scale, faces, colours)


def mesh_triangles(mesh: Entry, buffers: Sequence[bytes]) -> tuple[Array, IntArray]:
    """Vertices of a written scene's mesh, shape (n, 3), metres, and its triangles, shape (m, 3)."""
    place = mesh["positions"]
    held: bytes = buffers[int(place["buffer"])]
    corners = np.frombuffer(held, "<f4", 3 * mesh["vertexCount"], place["offset"])
    count = sum(s["indexCount"] for s in mesh["submeshes"])
    kind = "<u2" if mesh["indexFormat"] == "uint16" else "<u4"
    place = mesh["indices"]
    held = buffers[int(place["buffer"])]
    faces = np.frombuffer(held, kind, count, place["offset"]).astype(np.int64)
    return corners.reshape(-1, 3).astype(np.float64), faces.reshape(-1, 3)


def _box(bounds: Entry) -> tuple[Array, IntArray]:
    """Corners and outward triangles (in Unity's winding) of an axis-aligned box."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], float)
    corners = np.array(bounds["center"]) + signs * np.array(bounds["extents"])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return corners, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


def _component(item: Entry, kind: str) -> Entry:
    none: Entry = {}
    return next((c for c in item.get("components", ()) if c["type"] == kind), none)
