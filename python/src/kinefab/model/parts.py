"""Parts and assemblies: what stands where, with which geometry and mass."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Mapping

import numpy as np

from ..spatial import Array, Pose


class NodeKind(str, Enum):
    PART = "part"
    ASSEMBLY = "assembly"


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """name; color: linear RGBA in 0..1; metallic and smoothness in 0..1 (Unity's Standard/Lit meaning)."""

    name: str
    color: tuple[float, float, float, float] = (0.8, 0.8, 0.8, 1.0)
    metallic: float = 0.0
    smoothness: float = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Triangles in the frame of the node that uses them.

    vertices: shape (n, 3), metres.  faces: shape (m, 3), indices into vertices, outward side
    counter-clockwise (right-handed).  normals: shape (n, 3), unit, or None.  uv: shape (n, 2) or None.
    face_counts: number of faces of each submesh, in order; they add up to m.
    """

    name: str
    vertices: Array
    faces: np.ndarray
    normals: Array | None = None
    uv: Array | None = None
    face_counts: tuple[int, ...] = ()


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
    where: place in the source, for diagnostics.
    """

    path: Path
    to_node: Array
    key: str | None = None
    keyed_by: MeshKey = MeshKey.OBJECT
    where: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """One solid or surface body of a part: a mesh with a material for each submesh.

    mesh: index into ``Scene.meshes``, or None where the geometry is not loaded or was not found.
    materials: indices into ``Scene.materials``, one for each submesh.
    density: kg/m^3, or None for the scene's default.
    reference: where the geometry is to be loaded from, or None for a body without (or with loaded) geometry.
    """

    name: str
    mesh: int | None = None
    materials: tuple[int, ...] = ()
    density: float | None = None
    reference: MeshReference | None = None


@dataclass(frozen=True, slots=True, eq=False)
class MassProperties:
    """mass: kg.  center: centre of mass, node's frame, metres, shape (3,).
    inertia: about the centre of mass, along the node's axes, kg m^2, shape (3, 3)."""

    mass: float
    center: Array
    inertia: Array


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """A component of the source: a part, or an assembly that holds others.

    id: stable path in the source, unique (``Lever/Crank:1/Shaft:1``).
    parent: index into ``Scene.nodes`` of an earlier node, or None for a root.
    pose: node frame in the WORLD at the exported pose.
    definition: id shared by all occurrences of the same part, or None.
    grounded: fixed to the world.  flexible: for an assembly, whether its parts may move against each
    other (an inflexible assembly is one rigid group).  suppressed: present in the source but inactive.
    mass: as given by the source; None means "from geometry".
    where: place in the source, for diagnostics.
    """

    id: str
    name: str
    kind: NodeKind = NodeKind.PART
    parent: int | None = None
    pose: Pose = field(default_factory=Pose)
    definition: str | None = None
    bodies: tuple[Body, ...] = ()
    mass: MassProperties | None = None
    grounded: bool = False
    flexible: bool = False
    suppressed: bool = False
    visible: bool = True
    where: str = ""
    extras: Mapping[str, object] = field(default_factory=dict)
