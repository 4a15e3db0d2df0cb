"""A tessellated B-rep, face by face, and the scene's mesh that it becomes."""

from __future__ import annotations

import math
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from ...model import Mesh
from ...spatial import Array, IntArray

Look = TypeVar("Look", bound=Hashable)

RELATIVE_CHORD = 1.0 / 500.0
"""Share of a shape's diagonal that a chord may lie off its curve where no length is asked for."""


@dataclass(frozen=True, slots=True)
class Tolerance:
    """How far triangles may lie off the surface.

    chord: metres between a chord and its curve; None takes ``RELATIVE_CHORD`` of the shape's diagonal, so that
        a screw and a ship both come out round.  angle: radians between the normals of neighbouring triangles.
    """

    chord: float | None = None
    angle: float = math.radians(20.0)


@dataclass(frozen=True, slots=True, eq=False)
class Tessellation:
    """A shape's triangles in the shape's own frame and unit.

    vertices, normals: shape (n, 3); normals are unit and of the surface, outward where the shape is a solid.
        Vertices belong to one face of the B-rep each, so that edges stay sharp.
    triangles: shape (m, 3), outward side counter-clockwise.
    counts: triangles of each face of the B-rep, in the order of ``faces_of``; 0 where a face could not be meshed.
    """

    vertices: Array
    normals: Array
    triangles: IntArray
    counts: tuple[int, ...]

    @property
    def missing(self) -> int:
        """Faces of the B-rep without a triangle."""
        return sum(count == 0 for count in self.counts)


def mesh_of(
    name: str, shape: Tessellation, to_node: Array, looks: Sequence[Look]
) -> tuple[Mesh, tuple[Look, ...]]:
    """The mesh in its node's frame, metres, and the look of each of its submeshes.

    to_node: affine map from the shape's frame and unit to the node's frame in metres, shape (4, 4); where it
        mirrors, the winding is turned too.
    looks: what each face of the B-rep looks like, in the order of ``counts``; equal ones share a submesh, in the
        order in which they first come.  Fewer than there are faces: the last one stands for the rest, none for None.
    """
    linear = to_node[:3, :3]
    vertices = shape.vertices @ linear.T + to_node[:3, 3]
    normals = shape.normals @ np.linalg.inv(linear)  # normals go by the inverse transpose
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    triangles = shape.triangles[:, ::-1] if np.linalg.det(linear) < 0.0 else shape.triangles
    if not looks:
        return Mesh(name, vertices, triangles, normals, face_counts=(len(triangles),)), ()
    order: dict[Look, int] = {}
    of_face = [
        order.setdefault(looks[min(face, len(looks) - 1)], len(order)) if count else 0
        for face, count in enumerate(shape.counts)
    ]
    group = np.repeat(np.asarray(of_face, dtype=np.int64), np.asarray(shape.counts, dtype=np.int64))
    sizes = np.bincount(group, minlength=len(order))
    ordered = triangles[np.argsort(group, kind="stable")]
    return Mesh(name, vertices, ordered, normals, face_counts=tuple(int(size) for size in sizes)), tuple(
        order
    )
