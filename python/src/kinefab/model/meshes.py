"""Triangles, and where they are to be loaded from."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from pathlib import Path

from ..spatial import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Triangles in the frame of the node that uses them.

    vertices: shape (n, 3), metres.  faces: shape (m, 3), indices into vertices, outward side
    counter-clockwise (right-handed).  normals: shape (n, 3), unit, or None.
    uvs: texture coordinates, one array of shape (n, 2) a set, v upwards.
    tangents: shape (n, 4), unit x y z and the sense of the bitangent, +1 or -1 (right-handed), or None.
    colors: of the vertices, linear RGBA in 0..1, shape (n, 4), or None.
    face_counts: number of faces of each submesh, in order; they add up to m.
    origin: what it is in the source, whoever uses it and whatever its shape: a file and a name in it, a prim; "" where
        nobody says.  Several meshes may have one.
    volume: cubic metres inside, of a mesh that was weighed and found closed; None of any other.
    """

    name: str
    vertices: Array
    faces: IntArray
    normals: Array | None = None
    uvs: tuple[Array, ...] = ()
    tangents: Array | None = None
    colors: Array | None = None
    face_counts: tuple[int, ...] = ()
    origin: str = ""
    volume: float | None = None


class MeshKey(str, Enum):
    """What names a body inside a mesh file: OBJ's ``o`` or ``g`` (other formats: the node's name)."""

    OBJECT = "object"
    GROUP = "group"


@dataclass(frozen=True, slots=True, eq=False)
class MeshReference:
    """Where the triangles of a body are: a reader states it, the geometry stage loads them.

    path: the mesh file.  key: the body's name in it, matched by ``keyed_by``; None takes the whole file.
    to_node: affine map from the file's axes and units to the node's frame in metres, shape (4, 4).  It holds
        the unit, the turn of the axes, the inverse pose where the file is in world coordinates, and the mirror
        of a mirrored part: where its determinant is negative the winding must be reversed.
    needed: whether a file that cannot be read is an error; else the body is left out, and the report says so.
    where: place in the source, for diagnostics.
    """

    path: Path
    to_node: Array
    key: str | None = None
    keyed_by: MeshKey = MeshKey.OBJECT
    where: str = ""
    needed: bool = True
