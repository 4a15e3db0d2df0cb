"""What a space of relative twists looks like: the axes, directions and points that it fixes.

r is the number of independent rotation directions, t the dimension of its pure translations.  With P the
projection onto the complement of the translations, the rotations' common point c solves
P (v_i + w_i x (c - o)) = 0 (Hunt, *Kinematic Geometry of Mechanisms*, ch. 4; Herve's displacement groups).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ..spatial import ROUNDING, Array, skew
from .atoms import cross

SPLIT = 1e-4
"""Below this rotation part (of an orthonormal basis) a twist counts as a pure translation."""
NAMED = 1e-3
"""Distance (as a fraction of the length) and sine up to which a point or direction is a named one."""


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


def twist_space(
    basis: Array, origin: Array, length: float, axes: Array, split: float = SPLIT
) -> TwistSpace:
    """The space spanned by scaled twists (v / length, w), columns of ``basis``, shape (6, k).

    axes: see ``System.axes``; of the many bases of a span the one nearest to them is taken.
    split: error that the twists may have.
    """
    k = basis.shape[1]
    if not k:
        return TwistSpace(origin, np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3)), None)
    u, s, vt = np.linalg.svd(basis[3:], full_matrices=True)
    r = int(np.sum(s > split))
    translations = _nearest_basis(_orthonormal(basis[:3] @ vt[r:].T, split), axes)
    rotations = _nearest_basis(u[:, :r].T, axes)
    velocity = rotations @ u[:, :r] @ (basis[:3] @ vt[:r].T / s[:r]).T * length
    space = TwistSpace(origin, translations, rotations, velocity, None)
    return TwistSpace(origin, translations, rotations, velocity, _center(space, length, split))


def _orthonormal(columns: Array, split: float) -> Array:
    if not columns.shape[1]:
        return np.zeros((0, 3))
    u, s, _ = np.linalg.svd(columns, full_matrices=False)
    return u.T[: int(np.sum(s > split))]


def snapped(space: TwistSpace, points: Array, directions: Array, length: float) -> TwistSpace:
    """The space with its point and a single rotation or translation moved onto named ones within ``NAMED``.

    Where a pose is singular, motions are known to the root of the closing tolerance; the geometry is exact.
    points, directions: shape (n, 3), WORLD.
    """

    def turned(single: Array) -> Array:
        for d in directions if len(single) == 1 else ():
            if np.linalg.norm(np.cross(d, single[0])) < NAMED:
                return d[None] * np.sign(d @ single[0])
        return single

    rotations, center = turned(space.rotations), space.center
    if center is not None and len(points):
        offsets = points - center
        if space.r == 1:
            offsets = offsets - np.outer(offsets @ rotations[0], rotations[0])
        distances = np.linalg.norm(offsets, axis=1)
        if distances.min() < NAMED * length:
            center = points[np.argmin(distances)]
    return replace(space, rotations=rotations, translations=turned(space.translations), center=center)


def _nearest_basis(directions: Array, axes: Array) -> Array:
    """The span of orthonormal ``directions``, shape (k, 3), by what the nearest of the axes leave in it."""
    if len(directions) < 2:
        parts = directions @ axes
        return directions * np.sign(parts[:, np.argmax(np.abs(parts[0]).round(ROUNDING))]) if len(parts) else directions
    inside = directions.T @ directions
    found = np.zeros_like(directions)
    for i in range(len(directions)):
        shadows = (inside @ axes).T
        size = np.linalg.norm(shadows, axis=1)
        nearest = int(np.argmax(size.round(ROUNDING)))
        found[i] = shadows[nearest] / size[nearest]
        inside = inside - np.outer(found[i], found[i])
    return found


def _center(space: TwistSpace, length: float, split: float) -> Array | None:
    if space.r == 0:
        return None
    if space.r == 1 and space.t == 0:
        return space.origin + cross(space.rotations[0], space.velocity[0])
    project = np.eye(3) - space.translations.T @ space.translations
    matrix = np.concatenate([project @ skew(w) for w in space.rotations])
    if space.r == 1:  # a screw's travel along its axis has no point to vanish at
        w = space.rotations[0]
        project = project @ (np.eye(3) - np.outer(w, w))
        matrix = project @ skew(w)
    target = np.concatenate([-project @ v for v in space.velocity])
    offset = np.linalg.lstsq(matrix, target, rcond=split)[0]
    misfit = np.linalg.norm(matrix @ offset - target)
    return space.origin + offset if misfit < split * length else None


def revolving_point(space: TwistSpace, near: Array) -> Array:
    """The point of a single rotation axis closest to ``near``."""
    axis = space.rotations[0]
    return space.center + axis * (axis @ (near - space.center))
