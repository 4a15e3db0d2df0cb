"""What takes a part to its copy: the same definition elsewhere, or its mirror image."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...spatial import Array, Pose
from ..shapes.features import Round, Shape
from .freedom import Scale

LIKE = 0.02
"""Share by which volumes, areas and radii of a part and its mirror image may differ: clearances and chamfers do."""
TURNED = 1e-5
"""Sine between directions that are one."""
OFF = 1e-4
"""Share of a part's size by which its features may be off those of its copy."""
MOST_TRIED = 6
"""Parts of either definition that are tried for being mirror images of each other where they stand."""


@dataclass(frozen=True, slots=True, eq=False)
class Move:
    """x -> matrix x + shift.  matrix: orthogonal; of a mirror image its determinant is -1."""

    matrix: Array
    shift: Array

    def point(self, point: Array) -> Array:
        return point @ self.matrix.T + self.shift

    def direction(self, direction: Array) -> Array:
        return direction @ self.matrix.T

    def twists(self, space: Array) -> Array:
        """Twists (translation, rotation * length), shape (6, k), about the moved centre; a mirror turns rotations round."""
        turns = self.matrix * float(np.sign(np.linalg.det(self.matrix)))
        return np.concatenate([self.matrix @ space[:3], turns @ space[3:]])

    def scale(self, scale: Scale) -> Scale:
        return Scale(self.point(scale.center), scale.length)


class Copies:
    """Which parts are copies of which.  shapes, poses: of all parts, WORLD.  kinds: a number for each definition."""

    def __init__(self, shapes: Sequence[Shape], poses: Sequence[Pose], kinds: Sequence[int]) -> None:
        self._shapes, self._poses, self._kinds = shapes, poses, kinds
        self._of_kind: dict[int, list[int]] = {}
        for part, kind in enumerate(kinds):
            self._of_kind.setdefault(kind, []).append(part)
        self._mirrors: dict[tuple[int, int], Move | None] = {}
        firsts = [parts[0] for parts in self._of_kind.values()]
        self._firsts = sorted(firsts, key=lambda part: shapes[part].volume)
        self._volumes = np.array([shapes[part].volume for part in self._firsts])

    def like(self, part: int) -> list[int]:
        """The part's definition and those that may be its mirror image, by volume."""
        volume = self._shapes[part].volume
        low, high = np.searchsorted(self._volumes, [volume * (1.0 - LIKE), volume * (1.0 + LIKE)])
        return [
            self._kinds[part],
            *(k for p in self._firsts[low:high] if (k := self._kinds[p]) != self._kinds[part]),
        ]

    def move(self, part: int, copy: int) -> Move | None:
        """What takes a part to its copy; None where it is none."""
        if self._kinds[part] == self._kinds[copy]:
            rotation = self._poses[copy].rotation @ self._poses[part].rotation.T
            return Move(rotation, self._poses[copy].translation - rotation @ self._poses[part].translation)
        local = self._mirror(self._kinds[part], self._kinds[copy])
        if local is None:
            return None
        to, back = self._poses[copy], self._poses[part].inverse()
        matrix = to.rotation @ local.matrix @ back.rotation
        shift = to.rotation @ (local.matrix @ back.translation + local.shift) + to.translation
        return Move(matrix, shift)

    def _mirror(self, kind: int, other: int) -> Move | None:
        """From a definition's own frame to that of its mirror image, found where two parts of them stand mirrored."""
        if (kind, other) not in self._mirrors:
            tried = (
                (p, q) for p in self._of_kind[kind][:MOST_TRIED] for q in self._of_kind[other][:MOST_TRIED]
            )
            self._mirrors[kind, other] = next((m for p, q in tried if (m := self._reflected(p, q))), None)
        return self._mirrors[kind, other]

    def _reflected(self, part: int, other: int) -> Move | None:
        """Whether the plane midway between two parts reflects the one into the other; in their own frames."""
        a, b = self._shapes[part], self._shapes[other]
        if abs(a.volume - b.volume) > LIKE * max(a.volume, b.volume):
            return None
        first, second = _middle(a), _middle(b)
        apart = second - first
        distance = float(np.linalg.norm(apart))
        size = max(a.size, b.size)
        if distance < OFF * size:
            return None
        normal = apart / distance
        matrix = np.eye(3) - 2.0 * np.outer(normal, normal)
        world = Move(matrix, normal * float(normal @ (first + second)))
        if not _same_features(a, b, world, size):
            return None
        back, to = self._poses[other].inverse(), self._poses[part]
        shift = back.rotation @ world.point(to.translation) + back.translation
        return Move(back.rotation @ matrix @ to.rotation, shift)


def _middle(shape: Shape) -> Array:
    """A point that goes with the shape: of its flats weighed by their areas, else of its axes."""
    if shape.flats:
        centers = np.array([_center_of(flat.corners) for flat in shape.flats])
        areas = np.array([flat.area for flat in shape.flats])
        return areas @ centers / areas.sum()
    return np.mean([axis_middle(r) for r in shape.rounds], axis=0)


def _center_of(triangles: Array) -> Array:
    """Centre of area of triangles (n, 3, 3)."""
    sizes = np.linalg.norm(
        np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1
    )
    return sizes @ triangles.mean(axis=1) / max(float(sizes.sum()), 1e-300)


def axis_middle(r: Round) -> Array:
    """The middle of a surface along its axis, shape (3,), in its frame."""
    return r.point + r.direction * (0.5 * (r.span[0] + r.span[1]))


def _same_features(a: Shape, b: Shape, move: Move, size: float) -> bool:
    """Whether the flats and surfaces of revolution of one are where those of the other are taken to, but for a few small ones."""
    if not b.flats or not a.flats:
        return False
    normals, points = np.array([f.normal for f in b.flats]), np.array([f.point for f in b.flats])
    areas = np.array([f.area for f in b.flats])
    missed = 0.0
    for flat in a.flats:
        normal = move.direction(flat.normal)
        offset = np.abs((points - move.point(flat.point)) @ normal)
        alike = (normals @ normal > 1.0 - TURNED) & (offset < OFF * size)
        alike &= np.abs(areas - flat.area) < 5.0 * LIKE * max(flat.area, 1e-300)
        missed += 0.0 if alike.any() else flat.area
    if missed > LIKE * sum(flat.area for flat in a.flats):
        return False
    for r in a.rounds:
        point, direction = move.point(axis_middle(r)), move.direction(r.direction)
        if not any(
            is_there(other, r.hollow, point, direction, r.radius, size, 3.0 * LIKE)
            for other in b.rounds
            if other.kind is r.kind
        ):
            return False
    return True


def is_there(
    r: Round, hollow: bool, point: Array, direction: Array | None, radius: float, size: float, wide: float
) -> bool:
    """Whether a surface of revolution is hollow or not, and lies about a point or an axis with about a radius.

    wide: share by which the radius may differ.
    """
    if r.hollow is not hollow or abs(r.radius - radius) > wide * max(radius, 1e-12):
        return False
    offset = r.point - point
    if direction is None:
        return float(np.linalg.norm(offset)) <= OFF * size
    if float(np.linalg.norm(np.cross(r.direction, direction))) > 1e-4:
        return False
    return float(np.linalg.norm(np.cross(offset, direction))) <= OFF * size
