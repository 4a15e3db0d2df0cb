"""The kind of joint that a space of twists is, with its axis: what a mate between two bodies amounts to."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model import JointKind
from ...spatial import Array, cross
from .freedom import Scale

SMALL = 1e-5
"""Singular value below which twists are none, and sine between directions that are one."""


@dataclass(frozen=True, slots=True, eq=False)
class Pair:
    """kind: GENERAL where no lower pair is it.  point, axis: WORLD; of a pin-slot ``second`` is the slot's direction.
    pitch: metres a radian, of a screw."""

    kind: JointKind
    point: Array
    axis: Array
    second: Array | None = None
    pitch: float = 0.0


_SLIDING = {1: JointKind.PRISMATIC, 2: JointKind.TRANSLATE_2, 3: JointKind.TRANSLATE_3}
"""Pairs of so many translations and no turn."""


def pair_of(space: Array, scale: Scale) -> Pair:
    """space: twists (translation, rotation * length) about ``scale.center``, shape (6, k)."""
    size = space.shape[1]
    origin = scale.center
    nowhere = np.array([1.0, 0.0, 0.0])
    if size == 0:
        return Pair(JointKind.FIXED, origin, nowhere)
    if size == 6:
        return Pair(JointKind.FREE, origin, nowhere)
    slides, turns = _split(space)
    if not turns.shape[1]:
        kind = _SLIDING[size]
        axis = slides[:3, 0] if size != 2 else cross(slides[:3, 0], slides[:3, 1])
        return Pair(kind, origin, axis / np.linalg.norm(axis))
    if turns.shape[1] == 1:
        return _turning(slides, turns[:, 0], scale)
    if turns.shape[1] == 3 and not slides.shape[1]:
        # one point keeps still: v + w x (p - origin) = 0 for all three turns
        rows = np.concatenate([_cross_rows(turns[3:, i] / scale.length) for i in range(3)])
        point = np.linalg.lstsq(rows, -turns[:3].T.reshape(-1), rcond=None)[0]
        missed = np.abs(rows @ point + turns[:3].T.reshape(-1)).max()
        if missed < SMALL:
            return Pair(JointKind.SPHERICAL, origin + point, nowhere)
    return Pair(JointKind.GENERAL, origin, nowhere)


def _split(space: Array) -> tuple[Array, Array]:
    """A basis of the pure translations, and of the rest, at right angles to them."""
    _, values, right = np.linalg.svd(space[3:])
    rank = int(np.sum(values > SMALL))
    mixed = space @ right.T
    turns, slides = mixed[:, :rank], mixed[:, rank:]
    if slides.shape[1]:
        directions = np.linalg.svd(slides[:3], full_matrices=False)[0]
        turns = turns.copy()
        turns[:3] -= directions @ (directions.T @ turns[:3])
        slides = np.vstack([directions, np.zeros_like(directions)])
    return slides, turns


def _turning(slides: Array, turn: Array, scale: Scale) -> Pair:
    spin = turn[3:] / scale.length
    speed = float(np.linalg.norm(spin))
    axis = spin / speed
    shift = turn[:3] / speed
    point = scale.center + cross(axis, shift)
    count = slides.shape[1]
    if count == 0:
        pitch = float(shift @ axis)
        if abs(pitch) > SMALL * scale.length:
            return Pair(JointKind.SCREW, point, axis, pitch=pitch)
        return Pair(JointKind.REVOLUTE, point, axis)
    along = np.abs(slides[:3].T @ axis)
    if count == 1:
        if along[0] > 1.0 - SMALL:
            return Pair(JointKind.CYLINDRICAL, point, axis)
        if along[0] < SMALL:
            return Pair(JointKind.PIN_SLOT, point, axis, slides[:3, 0])
        return Pair(JointKind.GENERAL, point, axis)
    if count == 2:
        normal = cross(slides[:3, 0], slides[:3, 1])
        if abs(float(normal @ axis)) > 1.0 - SMALL:
            return Pair(JointKind.PLANAR, point, axis)
        return Pair(JointKind.GENERAL, point, axis)
    return Pair(JointKind.PARALLEL_PLANES, point, axis)


def _cross_rows(spin: Array) -> Array:
    """The matrix of p -> w x p."""
    x, y, z = spin
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
