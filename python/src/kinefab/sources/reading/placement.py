"""Where the components stand, and how a vector "in the world" or "in part A" comes into a node's frame.

A part's own axes are turned like the world's: a pose R in the source is T R T' in the scene, so that an
unrotated part stays unrotated in Unity, and every vector, in whatever frame, is turned by the same T.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ...spatial import Array, BoolArray, IntArray, Pose
from .source_frame import SourceFrame

EXACT = 1e-12
"""Axes this close to orthonormal are taken as they are."""
ROUNDED = 1e-6
"""Up to here the axes differ from orthonormal by the digits an exporter prints."""
SKEWED = 1e-3
"""From here on they are no axes of a rigid frame."""

MIRROR = np.diag([-1.0, 1.0, 1.0])


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Poses of n nodes and, as the last row, of the ground.

    rotations, translations: node frame in the world, scene axes, metres, shapes (n + 1, 3, 3) and (n + 1, 3).
    local: what takes a vector in the node's own source axes to the node's frame, shape (n + 1, 3, 3): the
        turn, for a mirrored part also its mirror.
    deviation: largest entry of R'R - 1 of the source's axes, shape (n,).  mirrored: shape (n,).
    length: metres in one unit of the source.
    """

    rotations: Array
    translations: Array
    local: Array
    deviation: Array
    mirrored: BoolArray
    length: float

    def pose(self, node: int) -> Pose:
        return Pose(self.rotations[node], self.translations[node])

    def points(self, nodes: ArrayLike, inside: ArrayLike, values: ArrayLike) -> Array:
        """Source points given in the frames of ``inside``, in the frames of ``nodes``, metres.

        nodes, inside: indices of shape (m,), -1 for ground and for the world.  values: shape (m, 3).
        """
        nodes, inside = np.asarray(nodes, dtype=int), np.asarray(inside, dtype=int)
        own = self._turned(inside, np.reshape(np.asarray(values, dtype=float), (-1, 3)) * self.length)
        world = _each(self.rotations[inside], own) + self.translations[inside]
        moved = _each_inverse(self.rotations[nodes], world - self.translations[nodes])
        return np.where((nodes == inside)[:, None], own, moved)

    def directions(self, nodes: ArrayLike, inside: ArrayLike, values: ArrayLike) -> Array:
        """Source directions given in the frames of ``inside``, in the frames of ``nodes``; as ``points``."""
        nodes, inside = np.asarray(nodes, dtype=int), np.asarray(inside, dtype=int)
        own = self._turned(inside, np.reshape(np.asarray(values, dtype=float), (-1, 3)))
        moved = _each_inverse(self.rotations[nodes], _each(self.rotations[inside], own))
        return np.where((nodes == inside)[:, None], own, moved)

    def _turned(self, inside: IntArray, values: Array) -> Array:
        return _each(self.local[inside], values)


def _each(matrices: Array, vectors: Array) -> Array:
    return np.einsum("nij,nj->ni", matrices, vectors)


def _each_inverse(rotations: Array, vectors: Array) -> Array:
    return np.einsum("nji,nj->ni", rotations, vectors)


def place(axes: Array, origins: Array, frame: SourceFrame) -> Placement:
    """axes: columns are the parts' x, y, z in the source's world, shape (n, 3, 3).  origins: shape (n, 3).

    Axes off by rounding are replaced by the nearest rotation; a left-handed triad is taken as a mirrored
    part, its mirror (x to -x in the part) kept in ``local``.
    """
    count = len(axes)
    deviation = np.abs(np.swapaxes(axes, 1, 2) @ axes - np.eye(3)).reshape(count, 9).max(axis=1, initial=0.0)
    mirrored = np.linalg.det(axes) < 0.0
    proper = np.where(mirrored[:, None, None], axes @ MIRROR, axes)
    if (loose := deviation > EXACT).any():
        left, _, right = np.linalg.svd(proper[loose])
        proper[loose] = left @ right
    turn = frame.turn
    return Placement(
        rotations=np.concatenate([turn @ proper @ turn.T, np.eye(3)[None]]),
        translations=np.vstack([origins @ turn.T * frame.length, np.zeros(3)]),
        local=np.concatenate([np.where(mirrored[:, None, None], turn @ MIRROR, turn), turn[None]]),
        deviation=deviation,
        mirrored=mirrored,
        length=frame.length,
    )
