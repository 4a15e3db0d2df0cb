"""What a space of relative twists looks like: the axes, directions and points that it fixes.

r is the number of independent rotation directions, t the dimension of its pure translations.  With P the
projection onto the complement of the translations, the rotations' common point c solves
P (v_i + w_i x (c - o)) = 0 (Hunt, *Kinematic Geometry of Mechanisms*, ch. 4; Herve's displacement groups).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...spatial import ROUNDING, Array, cross, skew
from .stacks import alike

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
        return v - self.translations.T @ (self.translations @ v) if self.t else v


def twist_space(basis: Array, origin: Array, length: float, axes: Array, split: float = SPLIT) -> TwistSpace:
    """The space spanned by scaled twists (v / length, w), columns of ``basis``, shape (6, k).

    axes: see ``System.axes``; of the many bases of a span the one nearest to them is taken.
    split: error that the twists may have.
    """
    return twist_spaces([basis], origin[None], np.array([length]), axes, split)[0]


def twist_spaces(
    bases: Sequence[Array], origins: Array, lengths: Array, axes: Array, split: float = SPLIT
) -> list[TwistSpace]:
    """``twist_space`` of many: bases of shape (6, k) each, origins (n, 3), lengths (n,)."""
    found: dict[int, TwistSpace] = {}
    for k, group in alike(basis.shape[1] for basis in bases):
        members: list[int] = group.tolist()
        if k == 6:  # whatever the basis, everything: along and about every axis of every point
            every, still = axes.T, np.zeros((3, 3))
            found |= {i: TwistSpace(origins[i], every, every, still, origins[i]) for i in members}
            continue
        basis = np.array([bases[i] for i in members]).reshape(len(group), 6, k)
        u, s, vt = np.linalg.svd(basis[:, 3:], full_matrices=True)
        for r, own in alike(np.sum(s > split, axis=1).tolist()):
            sliding = basis[own, :3] @ np.swapaxes(vt[own, r:], 1, 2)
            across, size, _ = np.linalg.svd(sliding, full_matrices=False)
            for t, part in alike(np.sum(size > split, axis=1).tolist()):
                i, at = group[own[part]], own[part]
                turns, scale = np.swapaxes(u[at, :, :r], 1, 2), s[at, None, :r]
                translations = _nearest_bases(np.swapaxes(across[part], 1, 2)[:, :t], axes)
                rotations = _nearest_bases(turns, axes)
                moving = np.swapaxes(basis[at, :3] @ np.swapaxes(vt[at, :r], 1, 2) / scale, 1, 2)
                velocity = rotations @ np.swapaxes(turns, 1, 2) @ moving * lengths[i, None, None]
                centers = _centers(origins[i], translations, rotations, velocity, lengths[i], split)
                for own_space in zip(i, origins[i], translations, rotations, velocity, centers):
                    found[int(own_space[0])] = TwistSpace(*own_space[1:])
    return [found[i] for i in range(len(bases))]


def snapped(space: TwistSpace, points: Array, directions: Array, length: float) -> TwistSpace:
    """The space with its point and a single rotation or translation moved onto named ones within ``NAMED``.

    Where a pose is singular, motions are known to the root of the closing tolerance; the geometry is exact.
    points, directions: shape (n, 3), WORLD.
    """

    def turned(single: Array) -> Array:
        for d in directions if len(single) == 1 else ():
            if np.linalg.norm(cross(d, single[0])) < NAMED:
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


def _nearest_bases(directions: Array, axes: Array) -> Array:
    """The spans of orthonormal ``directions``, shape (n, k, 3), by what the nearest of the axes leave in them."""
    k = directions.shape[1]
    every = np.arange(len(directions))
    if k < 2:
        parts = directions @ axes
        nearest = np.argmax(np.abs(parts).round(ROUNDING), axis=2)
        return directions * np.sign(np.take_along_axis(parts, nearest[..., None], axis=2))
    inside = np.swapaxes(directions, 1, 2) @ directions
    found = np.zeros_like(directions)
    for i in range(k):
        shadows = np.swapaxes(inside @ axes, 1, 2)
        size = np.linalg.norm(shadows, axis=2)
        nearest = np.argmax(size.round(ROUNDING), axis=1)
        found[:, i] = shadows[every, nearest] / size[every, nearest, None]
        inside = inside - found[:, i, :, None] * found[:, i, None]
    return found


def _centers(
    origins: Array, translations: Array, rotations: Array, velocity: Array, lengths: Array, split: float
) -> Iterable[Array | None]:
    """The point c of the module's formula nearest to the origin, of spaces of one shape."""
    count, r, _ = rotations.shape
    t = translations.shape[1]
    if r == 0:
        return [None] * count
    if r == 1 and t == 0:
        return origins + cross(rotations[:, 0], velocity[:, 0])
    project = np.eye(3) - np.swapaxes(translations, 1, 2) @ translations
    if r == 1:  # a screw's travel along its axis has no point to vanish at
        project = project @ (np.eye(3) - np.swapaxes(rotations, 1, 2) @ rotations)
    matrix = (project[:, None] @ skew(rotations)).reshape(count, 3 * r, 3)
    target = -np.swapaxes(project @ np.swapaxes(velocity, 1, 2), 1, 2).reshape(count, 3 * r, 1)
    u, s, vt = np.linalg.svd(matrix, full_matrices=False)
    inverse = np.divide(1.0, s, out=np.zeros_like(s), where=s > split)
    offset = np.swapaxes(vt, 1, 2) @ (inverse[..., None] * (np.swapaxes(u, 1, 2) @ target))
    misfit = np.linalg.norm(matrix @ offset - target, axis=(1, 2))
    return [c if m < split * l else None for c, m, l in zip(origins + offset[..., 0], misfit, lengths)]


def revolving_point(space: TwistSpace, near: Array) -> Array:
    """The point of a single rotation axis closest to ``near``."""
    axis = space.rotations[0]
    assert space.center is not None, "a single axis is asked for its point where it has one"
    return space.center + axis * (axis @ (near - space.center))
