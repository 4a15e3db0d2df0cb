"""From a constraint's geometry and verb to equations: every pairing that CAD programs offer.

Verbs whose equations do not depend on where things lie are built for all constraints of one kind at once: the sides
are then stacks of n features (see ``Side``), and a value has shape (n,).  The others choose by the geometry, one by one.

The number of rows is what the constraint removes in general position; special positions (parallel axes,
coplanar rods) lower the rank later, where it is measured.  Where one vendor's words mean other rows than
another's, ``Constraint.reading`` decides (``schemas/SPEC.md``, "Constraint readings").
"""

from __future__ import annotations

import math
from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field

import numpy as np

from ...model import Constraint, ConstraintKind, FeatureKind
from ...spatial import Array, cross
from .atoms import Atom
from .bounded import RangedCoordinate, bounded, is_bounded
from .coupled import COUPLED, coupled, screw
from .distances import PARALLEL_SINE, apart, lines_apart, off_line
from .features import UnknownPairing, need_directions, plain_family
from .rows import Rows, Side
from .tangency import tangent

STRAIGHT = 1e-9
"""Sine or cosine of a stated angle below which it asks for parallel directions."""


@dataclass(slots=True)
class Context:
    """What a constraint may need from the rest of its pair.

    axes: for each pair of bodies (lower number first), directions that another constraint makes common,
        WORLD; an angle without a reference vector is measured about one of them.
    ranges: coordinates that have a range instead of a value, filled in while building.
    value: of the constraint that is being built; of a stack, of all of them, shape (n,).
    """

    axes: dict[tuple[int, int], list[Array]] = field(default_factory=dict[tuple[int, int], list[Array]])
    ranges: list[RangedCoordinate] = field(default_factory=list[RangedCoordinate])
    value: float | Array = 0.0


def build(rows: Rows, constraint: Constraint, sides: list[Side], context: Context) -> None:
    """Add the constraint's equations.  Raises UnknownPairing when there are none for its geometry."""
    context.value = constraint.value
    _BUILDERS[constraint.kind](rows, constraint, *_taken(constraint, sides), context=context)


def _taken(constraint: Constraint, sides: list[Side]) -> list[Side]:
    """Without a third side where the kind has none: it says nothing there."""
    return sides if constraint.kind in _WITH_A_THIRD else sides[:2]


def stack_of(constraint: Constraint, sides: tuple[tuple[FeatureKind, bool], ...]) -> Hashable:
    """Equal for constraints that ``build_stack`` takes together; None where one goes through ``build``.

    sides: kind and ``framed`` of each of its features.
    """
    if constraint.kind in _BY_GEOMETRY or is_bounded(constraint):
        return None
    if constraint.kind is ConstraintKind.DISTANCE and FeatureKind.PLANE not in (
        kind for kind, _ in sides[:2]
    ):
        return None  # a distance of nothing has other equations
    return constraint.kind, sides, constraint.lock_rotation, constraint.reading.get("offset")


def build_stack(rows: Rows, constraints: list[Constraint], sides: list[Side], context: Context) -> None:
    """As ``build``, of constraints with one ``stack_of``; ``rows.owner`` and the sides are stacks of them."""
    context.value = np.array([c.value for c in constraints])
    first = constraints[0]
    _BUILDERS[first.kind](rows, first, *_taken(first, sides), context=context)


def _ordered(a: Side, b: Side, *order: str) -> tuple[Side, Side, tuple[str, str]]:
    """The two sides so that the first one's family stands earlier in ``order``."""
    fa, fb = (plain_family(s) for s in (a, b))
    if order.index(fa) <= order.index(fb):
        return a, b, (fa, fb)
    return b, a, (fb, fa)


def pair_of(a: Side, b: Side) -> tuple[int, int]:
    """The bodies of two single sides, the lower number first."""
    low, high = sorted((int(a.body), int(b.body)))
    return low, high


def _nearest_sign(value: float | Array, measured: Array) -> Array:
    return np.where(np.abs(measured - value) <= np.abs(measured + value), value, np.negative(value))


def _nearest_turn(value: float, measured: float) -> float:
    """The angle as it is met nearest to ``measured``: 330 degrees are -30."""
    return measured + math.remainder(value - measured, math.tau)


def _offset(rows: Rows, c: Constraint, plane: Side, other: Side, context: Context) -> None:
    """A signed distance along the plane's normal: an equation, or a range that is only noted."""
    measured = np.sum(plane.z * (other.p - plane.p), axis=-1)
    signed = c.reading.get("offset") == "along_normal"
    if is_bounded(c):
        bodies = int(plane.body), int(other.body)
        context.ranges.append(bounded(c, bodies, plane.z, float(measured), False, signed))
        return
    value = context.value
    if not signed:
        value = _nearest_sign(value, measured)
    rows.plane(plane, plane.z, other, value)


def _coincident(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    if a.kind is FeatureKind.FRAME and b.kind is FeatureKind.FRAME:
        rows.point(a, b)
        rows.parallel(a, b)
        rows.dot(a, a.x, b, b.y)
        return
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if pair == ("point", "point"):
        rows.point(first, second)
    elif pair == ("line", "point"):
        rows.on_line(first, second)
    elif pair == ("plane", "point"):
        _offset(rows, c, first, second, context)
    elif pair == ("line", "line"):
        rows.parallel(first, second)
        rows.on_line(first, second)
    elif pair == ("plane", "line"):
        rows.dot(first, first.z, second, second.z)
        _offset(rows, c, first, second, context)
    else:
        rows.parallel(first, second)
        _offset(rows, c, first, second, context)


def _parallel(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if "point" in pair:
        raise UnknownPairing
    if pair == ("plane", "line"):
        rows.dot(first, first.z, second, second.z)
    else:
        rows.parallel(first, second)


def _perpendicular(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if "point" in pair:
        raise UnknownPairing
    if pair == ("plane", "line"):
        rows.parallel(first, second)
    else:
        rows.dot(first, first.z, second, second.z)


def _angle(
    rows: Rows, c: Constraint, a: Side, b: Side, reference: Side | None = None, *, context: Context
) -> None:
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if "point" in pair:
        raise UnknownPairing
    if pair == ("plane", "line"):
        if is_bounded(c):
            _tilt_range(c, first, second, reference, context)
        elif abs(math.cos(c.value)) < STRAIGHT:
            rows.parallel(first, second)  # a.b = +-1 has no gradient
        else:
            rows.dot(first, first.z, second, second.z, math.sin(c.value))
        return
    about = _angle_axis(a, b, reference, context)
    if about is not None:
        measured = math.atan2(about @ cross(a.z, b.z), a.z @ b.z)
        signed = reference is not None or c.reading.get("angle") == "directed"
        if is_bounded(c):
            bodies = int(a.body), int(b.body)
            context.ranges.append(bounded(c, bodies, about, measured, True, signed))
            return
        value = _nearest_turn(c.value, measured)
        if not signed:
            other = _nearest_turn(-c.value, measured)
            value = value if abs(measured - value) <= abs(measured - other) else other
        rows.angle(a, a.z, about, b, b.z, value)
    elif is_bounded(c):
        return  # about no axis that the bodies share
    elif abs(math.sin(c.value)) < STRAIGHT:
        rows.parallel(a, b)  # a.b = +-1 has no gradient
    else:
        rows.dot(a, a.z, b, b.z, math.cos(c.value))


def _tilt_range(c: Constraint, plane: Side, line: Side, reference: Side | None, context: Context) -> None:
    """How far a line may be tilted out of a plane, about an axis that lies in the plane and across the line."""
    about = _angle_axis(plane, line, reference, context)
    if about is not None:
        within = cross(about, plane.z)
        within = within if within @ line.z >= 0.0 else -within
        measured = math.atan2(about @ cross(within, line.z), within @ line.z)
        bodies = int(plane.body), int(line.body)
        context.ranges.append(bounded(c, bodies, about, measured, True, reference is not None))


def _angle_axis(a: Side, b: Side, reference: Side | None, context: Context) -> Array | None:
    """The axis the angle turns about: the stated one, else one that the pair's bodies share."""
    if reference is not None:
        candidates = [reference.z]
    else:
        candidates = context.axes.get(pair_of(a, b), [])
    for axis in candidates:
        if max(abs(axis @ a.z), abs(axis @ b.z)) < PARALLEL_SINE:
            across = axis - a.z * (axis @ a.z)
            return across / np.linalg.norm(across)
    return None


def _distance(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if first.kind is FeatureKind.PLANE:
        _coincident(rows, c, first, second, context=context)
    elif is_bounded(c):
        return  # no coordinate of a joint
    elif pair == ("point", "point"):
        apart(rows, first, second, abs(c.value))
    elif pair == ("line", "point"):
        off_line(rows, first, second, abs(c.value))
    else:
        lines_apart(rows, first, second, abs(c.value), c.reading.get("line_line_distance"))


def _insert(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    if "point" in (plain_family(a), plain_family(b)):
        raise UnknownPairing
    rows.parallel(a, b)
    rows.on_line(a, b)
    _offset(rows, c, a, b, context)
    if c.lock_rotation:
        _lock_spin(rows, a, b)


def _lock_spin(rows: Rows, a: Side, b: Side) -> None:
    """Rotation about a's axis stays as it is, or as the two frames say where both are whole frames."""
    if a.framed and b.framed:
        rows.dot(a, a.x, b, b.y)
    else:
        rows.dot(a, a.x, b, a.y)


def _lock_orientation(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    if FeatureKind.FRAME in (a.kind, b.kind) and a.framed and b.framed:
        rows.parallel(a, b)
        rows.dot(a, a.x, b, b.y)
    else:
        x, y, z = rows.axes.T
        for along_a, along_b in ((x, z), (y, z), (x, y)):
            rows.dot(a, along_a, b, along_b)


def _lock(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    _lock_orientation(rows, c, a, b, context=context)
    if a.kind is FeatureKind.FRAME and b.kind is FeatureKind.FRAME:
        rows.point(a, b)
    else:
        for axis in rows.axes.T:
            rows.plane(a, axis, b, (b.p - a.p) @ axis)


def _concentric(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    if "plane" in (plain_family(a), plain_family(b)):
        raise UnknownPairing
    _coincident(rows, c, a, b, context=context)
    if c.lock_rotation and plain_family(a) == plain_family(b) == "line":
        _lock_spin(rows, a, b)


def _slider(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    need_directions(a, b)
    rows.parallel(a, b)
    _lock_spin(rows, a, b)
    rows.on_line(a, b)


def _pin_slot(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    """a: the slot, along its direction (or its secondary, where the direction is the pin's); b: the pin."""
    need_directions(a, b)
    slot = a.z if abs(a.z @ b.z) < 0.5 else a.x
    normal = b.z - slot * (slot @ b.z)
    normal /= np.linalg.norm(normal)
    across = cross(normal, slot)
    rows.dot(a, slot, b, b.z)
    rows.dot(a, across, b, b.z)
    rows.plane(a, normal, b)
    rows.plane(a, across, b)


def _universal(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    need_directions(a, b)
    rows.point(a, b)
    rows.dot(a, a.z, b, b.z)


def _symmetry(rows: Rows, c: Constraint, a: Side, b: Side, plane: Side, *, context: Context) -> None:
    """b is the mirror image of a in the plane: H = I - 2 n n', n fixed on the plane's body."""
    kinds = {plain_family(a), plain_family(b)}
    if plane.kind is not FeatureKind.PLANE or len(kinds) != 1:
        raise UnknownPairing

    def image(direction: Array) -> Array:
        return direction - 2.0 * plane.z * (plane.z @ direction)

    if kinds == {"point"}:
        for e in (plane.z, plane.x, plane.y):
            # C = e.(p_b - p_0) - (H e).(p_a - p_0)
            row = rows.row(True)
            rows.atom(row, Atom.PIP, plane.body, b.body, p_a=plane.p, dir_a=e, p_b=b.p)
            rows.atom(row, Atom.PIP, plane.body, a.body, p_a=plane.p, dir_a=image(e), p_b=a.p, weight=-1.0)
        return
    sense = math.copysign(1.0, float(b.z @ image(a.z)))
    for e in (b.x, b.y):
        # C = e.z_b - sense (H e).z_a, e fixed on the plane's body
        row = rows.row(False)
        rows.atom(row, Atom.DOT, plane.body, b.body, dir_a=e, p_b=b.p, dir_b=b.z)
        rows.atom(row, Atom.DOT, plane.body, a.body, dir_a=image(e), p_b=a.p, dir_b=a.z, weight=-sense)
    if kinds == {"line"}:
        for e in (b.x, b.y):
            # C = e.m_b + sense (H e).m_a, m = (p - p_0) x z: a moment is an axial vector, its image is -H m.
            # Moments do not change with the point that names the line; the third, along z, is zero anyway.
            row = rows.row(True)
            rows.atom(row, Atom.MOM, plane.body, b.body, p_a=plane.p, dir_a=e, p_b=b.p, dir_b=b.z)
            rows.atom(
                row,
                Atom.MOM,
                plane.body,
                a.body,
                p_a=plane.p,
                dir_a=image(e),
                p_b=a.p,
                dir_b=a.z,
                weight=sense,
            )
        return
    # C = z_b.(p_0 - p_b) - sense z_a.(p_0 - p_a): the plane's point is as far from the one as from the other
    row = rows.row(True)
    rows.atom(row, Atom.PIP, b.body, plane.body, p_a=b.p, dir_a=b.z, p_b=plane.p)
    rows.atom(row, Atom.PIP, a.body, plane.body, p_a=a.p, dir_a=a.z, p_b=plane.p, weight=-sense)


_BUILDERS: Mapping[ConstraintKind, Callable[..., None]] = {
    ConstraintKind.COINCIDENT: _coincident,
    ConstraintKind.CONCENTRIC: _concentric,
    ConstraintKind.PARALLEL: _parallel,
    ConstraintKind.PERPENDICULAR: _perpendicular,
    ConstraintKind.ANGLE: _angle,
    ConstraintKind.DISTANCE: _distance,
    ConstraintKind.TANGENT: tangent,
    ConstraintKind.INSERT: _insert,
    ConstraintKind.SYMMETRY: _symmetry,
    ConstraintKind.LOCK: _lock,
    ConstraintKind.LOCK_ORIENTATION: _lock_orientation,
    ConstraintKind.SLIDER: _slider,
    ConstraintKind.PIN_SLOT: _pin_slot,
    ConstraintKind.UNIVERSAL: _universal,
    ConstraintKind.SCREW: screw,
    **dict.fromkeys(COUPLED, coupled),
}

_WITH_A_THIRD = COUPLED | {ConstraintKind.ANGLE, ConstraintKind.SYMMETRY}

_BY_GEOMETRY = COUPLED | {
    ConstraintKind.ANGLE,
    ConstraintKind.TANGENT,
    ConstraintKind.SYMMETRY,
    ConstraintKind.PIN_SLOT,
    ConstraintKind.SCREW,
}
"""Their builders look at where things lie and take single sides; the others take stacks too."""
