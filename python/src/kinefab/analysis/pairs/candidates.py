"""Joints that a space of twists suggests, with anchors and axes from the CAD geometry, likeliest first.

For displacement groups (revolute, cylindrical, planar, ...) the twists fix the joint.  For the others
they do not: a pin in a slot may have its anchor anywhere along the slot, and which body carries an axis
does not show in first order.  So points and directions of the constraints are offered one after another;
``finite`` decides.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import islice

import numpy as np

from ...model import FREE, LOCKED, RX, RZ, TX, TY, Freedom, JointKind
from ...spatial import Array, cross, frame_from_axes, perpendicular
from ..freedom.finite import Candidate
from ..freedom.twists import TwistSpace, revolving_point

MOST = 24
"""Candidates offered for one pair at most."""
ALIGNED = 1e-4
"""Sine (or cosine) below which directions count as parallel (at right angles)."""


@dataclass(frozen=True, slots=True, eq=False)
class Geometry:
    """Points and directions that the pair's constraints name, WORLD.

    points: shape (n, 3), the likeliest anchor first.  first, second: directions fixed on either body.
    axes: see ``System.axes``.
    """

    points: Array
    first: Array
    second: Array
    axes: Array

    def frame(self, x: Array) -> Array:
        """Joint axes with X along ``x`` (unit vector), the others where the geometry's axes put them."""
        y = perpendicular(x, self.axes)
        return np.array([x, y, cross(x, y)]).T.copy()


def candidates(space: TwistSpace, geometry: Geometry, length: float) -> Iterator[Candidate]:
    """What to try, in order; empty where no joint of one ConfigurableJoint has these twists."""
    return islice(_OFFERS.get(space.r, _none)(space, geometry, length), MOST)


def _none(space: TwistSpace, geometry: Geometry, length: float) -> Iterator[Candidate]:
    return iter(())


def _sliding(space: TwistSpace, geometry: Geometry, length: float) -> Iterator[Candidate]:
    anchor = geometry.points[0]
    if space.t == 0:
        yield Candidate(JointKind.FIXED, geometry.axes, anchor)
    elif space.t == 1:
        yield Candidate(JointKind.PRISMATIC, geometry.frame(space.translations[0]), anchor)
    elif space.t == 2:
        yield Candidate(JointKind.TRANSLATE_2, geometry.frame(cross(*space.translations)), anchor)
    else:
        yield Candidate(JointKind.TRANSLATE_3, geometry.axes, anchor)


def _turning_once(space: TwistSpace, geometry: Geometry, length: float) -> Iterator[Candidate]:
    axis = space.rotations[0]
    anchor = geometry.points[0]
    on_axis = revolving_point(space, anchor) if space.center is not None else anchor
    if space.t == 0:
        if abs(space.pitch) > ALIGNED * length:
            yield Candidate(JointKind.SCREW, geometry.frame(axis), on_axis, lead=space.pitch * 2.0 * np.pi)
        else:
            yield Candidate(JointKind.REVOLUTE, geometry.frame(axis), on_axis)
    elif space.t == 1:
        along = space.translations[0]
        if np.linalg.norm(cross(axis, along)) < ALIGNED:
            yield Candidate(JointKind.CYLINDRICAL, geometry.frame(axis), on_axis)
        elif abs(axis @ along) < ALIGNED:
            yield from _both_orders(JointKind.PIN_SLOT, frame_from_axes(axis, along), geometry.points)
    elif space.t == 2:
        if np.abs(space.translations @ axis).max() < ALIGNED:
            yield Candidate(JointKind.PLANAR, geometry.frame(axis), anchor)
        elif abs(np.linalg.norm(space.translations @ axis) - 1.0) < ALIGNED:
            across = cross(axis, cross(*space.translations))
            free = tuple(FREE if i in (TX, TY, RX) else LOCKED for i in range(6))
            yield from _both_orders(JointKind.GENERAL, frame_from_axes(axis, across), geometry.points, free)
    else:
        yield Candidate(JointKind.PARALLEL_PLANES, geometry.frame(axis), anchor)


def _turning_twice(space: TwistSpace, geometry: Geometry, length: float) -> Iterator[Candidate]:
    normal = cross(*space.rotations)
    if space.t == 2:
        z = cross(*space.translations)
        if abs(z @ normal) < ALIGNED:
            axes = _columns(cross(normal, z), z)
            yield from _both_orders(JointKind.LINE_IN_PLANE, axes, geometry.points)
        return
    kind = {0: JointKind.UNIVERSAL, 1: JointKind.GENERAL, 3: JointKind.PERPENDICULAR}[space.t]
    points = (
        geometry.points
        if space.center is None or space.t
        else np.concatenate([space.center[None], geometry.points])
    )
    for first_is_a in (True, False):
        on_a, on_b = (geometry.first, geometry.second) if first_is_a else (geometry.second, geometry.first)
        for z in _within(on_a, normal):
            for x in _within(on_b, normal):
                if abs(x @ z) > ALIGNED:
                    continue
                axes = _columns(x, z)
                free = _one_slide(space, axes) if space.t == 1 else ()
                if free is None:
                    continue
                for point in points[:3]:
                    yield Candidate(kind, axes, point, first_is_a, freedoms=free)


def _one_slide(space: TwistSpace, axes: Array) -> tuple[Freedom, ...] | None:
    along = np.abs(axes.T @ space.translations[0])
    slide = int(np.argmax(along))
    if along[slide] < 1.0 - ALIGNED:
        return None
    return tuple(FREE if i in (slide, RX, RZ) else LOCKED for i in range(6))


def _turning_freely(space: TwistSpace, geometry: Geometry, length: float) -> Iterator[Candidate]:
    if space.t == 3:
        yield Candidate(JointKind.FREE, geometry.axes, geometry.points[0])
    elif space.t == 0:
        if space.center is not None:
            yield Candidate(JointKind.SPHERICAL, geometry.axes, space.center)
    elif space.t == 1:
        yield from _both_orders(
            JointKind.POINT_ON_LINE, geometry.frame(space.translations[0]), geometry.points
        )
    else:
        x, y = space.translations
        yield from _both_orders(
            JointKind.POINT_ON_PLANE, np.column_stack([x, y, cross(x, y)]), geometry.points
        )


_OFFERS = {0: _sliding, 1: _turning_once, 2: _turning_twice, 3: _turning_freely}


def _both_orders(
    kind: JointKind, axes: Array, points: Array, freedoms: tuple[Freedom, ...] = ()
) -> Iterator[Candidate]:
    for point in points:
        for first_is_a in (True, False):
            yield Candidate(kind, axes, point, first_is_a, freedoms=freedoms)


def _columns(x: Array, z: Array) -> Array:
    x = x / np.linalg.norm(x)
    z = z / np.linalg.norm(z)
    return np.column_stack([x, cross(z, x), z])


def _within(directions: Array, normal: Array) -> Iterable[Array]:
    """Directions at right angles to ``normal``, each once."""
    seen: list[Array] = []
    for d in directions:
        if abs(d @ normal) < ALIGNED and not any(np.linalg.norm(cross(d, e)) < ALIGNED for e in seen):
            seen.append(d)
    return seen
