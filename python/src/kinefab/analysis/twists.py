"""What a space of relative twists looks like: the axes, directions and points that it fixes.

r is the number of independent rotation directions, t the dimension of its pure translations.  With P the
projection onto the complement of the translations, the rotations' common point c solves
P (v_i + w_i x (c - o)) = 0 (Hunt, *Kinematic Geometry of Mechanisms*, ch. 4; Herve's displacement groups).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..spatial import ROUNDING, Array, skew

SPLIT = 1e-4
"""Below this rotation part (of an orthonormal basis) a twist counts as a pure translation."""


@dataclass(frozen=True, slots=True, eq=False)
class TwistSpace:
    """A space of twists about the point ``origin``.

    translations: shape (t, 3), orthonormal.  rotations: shape (r, 3), orthonormal directions.
    velocity: shape (r, 3), velocity of the origin for a unit rate about each of ``rotations``.
    center: the point c of the module's formula, WORLD, metres; None where the rotations have none.
    """

    origin: Array
    translations: Array
    rotations: Array
    velocity: Array
    center: Array | None

    @property
    def r(self) -> int:
        return len(self.rotations)

    @property
    def t(self) -> int:
        return len(self.translations)

    @property
    def pitch(self) -> float:
        """Metres of travel per radian about a single axis, translations that are free anyway left out."""
        return float(self._fixed(self.velocity[0]) @ self.rotations[0])

    def _fixed(self, v: Array) -> Array:
        return v - self.translations.T @ (self.translations @ v)


def twist_space(basis: Array, origin: Array, length: float, axes: Array) -> TwistSpace:
    """The space spanned by scaled twists (v / length, w), columns of ``basis``, shape (6, k).

    axes: see ``System.axes``; of the many bases of a span the one nearest to them is taken.
    """
    k = basis.shape[1]
    if not k:
        return TwistSpace(origin, np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)), None)
    u, s, vt = np.linalg.svd(basis[3:], full_matrices=True)
    r = int(np.sum(s > SPLIT))
    translations = _nearest_basis(_orthonormal(basis[:3] @ vt[r:].T), axes)
    rotations = _nearest_basis(u[:, :r].T, axes)
    velocity = rotations @ u[:, :r] @ (basis[:3] @ vt[:r].T / s[:r]).T * length
    space = TwistSpace(origin, translations, rotations, velocity, None)
    return TwistSpace(origin, translations, rotations, velocity, _center(space, length))


def _orthonormal(columns: Array) -> Array:
    if not columns.shape[1]:
        return np.zeros((0, 3))
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    return u.T[: int(np.sum(s > SPLIT))]


def _nearest_basis(directions: Array, axes: Array) -> Array:
    """The span of orthonormal ``directions``, shape (k, 3), by what the nearest of the axes leave in it."""
    inside = directions.T @ directions
    found = np.zeros_like(directions)
    for i in range(len(directions)):
        shadows = (inside @ axes).T
        size = np.linalg.norm(shadows, axis=1)
        nearest = int(np.argmax(size.round(ROUNDING)))
        found[i] = shadows[nearest] / size[nearest]
        inside = inside - np.outer(found[i], found[i])
    return found


def _center(space: TwistSpace, length: float) -> Array | None:
    if space.r == 0:
        return None
    project = np.eye(3) - space.translations.T @ space.translations
    matrix = np.concatenate([project @ skew(w) for w in space.rotations])
    if space.r == 1:  # a screw's travel along its axis has no point to vanish at
        w = space.rotations[0]
        project = project @ (np.eye(3) - np.outer(w, w))
        matrix = project @ skew(w)
    target = np.concatenate([-project @ v for v in space.velocity])
    offset = np.linalg.lstsq(matrix, target, rcond=SPLIT)[0]
    misfit = np.linalg.norm(matrix @ offset - target)
    return space.origin + offset if misfit < SPLIT * length else None


def revolving_point(space: TwistSpace, near: Array) -> Array:
    """The point of a single rotation axis closest to ``near``."""
    axis = space.rotations[0]
    return space.center + axis * (axis @ (near - space.center))
