"""Meshes made ready for drawing: corners with smooth normals, and the edges that a draughtsman would draw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...spatial import Array, IntArray, Pose

CREASE = float(np.cos(np.radians(30.0)))
"""Faces that meet at less than this angle are one smooth surface."""


@dataclass(frozen=True, slots=True, eq=False)
class Solid:
    """corners, normals: (n, 3, 3), of each triangle's corners.  colours: (n, 3), linear.  facing: (n, 3), of the triangles.

    sharp: (m, 2, 3), edges always drawn.  smooth: (k, 2, 3), drawn where they part front from back; across: (k, 2, 3), the
    normals of their two faces.
    """

    corners: Array
    normals: Array
    facing: Array
    colours: Array
    sharp: Array
    smooth: Array
    across: Array

    def drawn(self, toward: Array) -> Array:
        """The edges that are drawn from a side, shape (n, 2, 3): the sharp ones and the outline."""
        sides = self.across @ toward
        return np.concatenate([self.sharp, self.smooth[(sides[:, 0] > 0.0) != (sides[:, 1] > 0.0)]])

    def placed(self, pose: Pose) -> Solid:
        """The solid where its object is."""
        turn = pose.rotation.T
        return Solid(
            self.corners @ turn + pose.translation,
            self.normals @ turn,
            self.facing @ turn,
            self.colours,
            self.sharp @ turn + pose.translation,
            self.smooth @ turn + pose.translation,
            self.across @ turn,
        )


def solid(corners: Array, faces: IntArray, colours: Array) -> Solid:
    """corners: (v, 3).  faces: (n, 3).  colours: (n, 3), of the faces."""
    place, same = np.unique(np.round(corners, 7), axis=0, return_inverse=True)
    welded = same.reshape(-1)[faces]
    raw = np.cross(corners[faces[:, 1]] - corners[faces[:, 0]], corners[faces[:, 2]] - corners[faces[:, 0]])
    size = np.linalg.norm(raw, axis=1)
    facing = raw / np.maximum(size, 1e-300)[:, None]
    ends = np.concatenate([welded[:, [i, (i + 1) % 3]] for i in range(3)])
    face = np.tile(np.arange(len(faces)), 3)
    key = np.sort(ends, axis=1)
    order = np.lexsort((key[:, 1], key[:, 0]))
    key, face = key[order], face[order]
    first = (
        np.flatnonzero(np.append(True, np.any(key[1:] != key[:-1], axis=1))) if len(key) else np.zeros(0, int)
    )
    count = np.diff(np.append(first, len(key)))
    pairs = first[count == 2]
    one, other = facing[face[pairs]], facing[face[pairs + 1]] if len(pairs) else facing[face[pairs]]
    flat = np.einsum("ni,ni->n", one, other) >= CREASE
    sharp = np.concatenate([key[first[count != 2]], key[pairs[~flat]]])
    smooth = key[pairs[flat]]
    return Solid(
        corners[faces],
        _normals(welded, facing, size),
        facing,
        colours,
        place[sharp],
        place[smooth],
        np.stack([one[flat], other[flat]], axis=1),
    )


def _normals(welded: IntArray, facing: Array, size: Array) -> Array:
    """Of each corner, over the faces around its vertex that are one surface with its own."""
    vertex = welded.ravel()
    order = np.argsort(vertex, kind="stable")
    starts = np.searchsorted(vertex[order], np.arange(int(vertex.max(initial=-1)) + 2))
    degree = np.diff(starts)[vertex]
    corner = np.repeat(np.arange(len(vertex)), degree)
    at = np.arange(len(corner)) - np.repeat(np.cumsum(degree) - degree, degree)
    around = order[starts[vertex[corner]] + at] // 3
    own = corner // 3
    alike = np.einsum("ni,ni->n", facing[around], facing[own]) > CREASE
    total = np.zeros((len(vertex), 3))
    for i in range(3):
        total[:, i] = np.bincount(
            corner[alike], (facing[around, i] * size[around])[alike], minlength=len(vertex)
        )
    length = np.linalg.norm(total, axis=1)
    return (total / np.maximum(length, 1e-300)[:, None]).reshape(-1, 3, 3)
