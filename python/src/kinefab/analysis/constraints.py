"""From a constraint's geometry and verb to equations: every pairing that CAD programs offer.

The number of rows is what the constraint removes in general position; special positions (parallel axes,
coplanar rods) lower the rank later, where it is measured.  Where one vendor's words mean other rows than
another's, ``Constraint.reading`` decides (``schemas/SPEC.md``, "Constraint readings").
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Callable, Mapping

import numpy as np

from ..model import Constraint, ConstraintKind, FeatureKind, Sense, Side as Surface
from ..spatial import Array
from .atoms import Atom
from .features import family
from .rows import Rows, Side

PARALLEL_SINE = 1e-3
"""Below this sine two directions of the exported pose count as meant to be parallel."""


class UnknownPairing(Exception):
    """There are no equations for this verb between these features."""


@dataclass(slots=True)
class Context:
    """What a constraint may need from the rest of its pair.

    axes: for each pair of bodies (lower number first), directions that another constraint makes common,
        WORLD; an angle without a reference vector is measured about one of them.
    ranges: coordinates that have a range instead of a value, filled in while building.
    """

    axes: Mapping[tuple[int, int], list[Array]] = field(default_factory=dict)
    ranges: list["RangedCoordinate"] = field(default_factory=list)


@dataclass(frozen=True, slots=True, eq=False)
class RangedCoordinate:
    """A length along or an angle about ``axis`` (WORLD, fixed on a) that the source bounds, not fixes.

    measured: its value at the exported pose.
    """

    constraint: Constraint
    body_a: int
    body_b: int
    axis: Array
    is_angle: bool
    measured: float


def build(rows: Rows, constraint: Constraint, sides: list[Side], context: Context) -> None:
    """Add the constraint's equations.  Raises UnknownPairing when there are none for its geometry."""
    _BUILDERS[constraint.kind](rows, constraint, *sides, context=context)


def _ordered(a: Side, b: Side, *order: str) -> tuple[Side, Side, tuple[str, str]]:
    """The two sides so that the first one's family stands earlier in ``order``."""
    fa, fb = (_plain(s) for s in (a, b))
    if order.index(fa) <= order.index(fb):
        return a, b, (fa, fb)
    return b, a, (fb, fa)


def _plain(side: Side) -> str:
    name = family(side.kind)
    return "line" if name == "frame" else name


def _ranged(c: Constraint) -> bool:
    return c.lower is not None or c.upper is not None


def _nearest_sign(value: float, measured: float) -> float:
    return value if abs(measured - value) <= abs(measured + value) else -value


def _offset(rows: Rows, c: Constraint, plane: Side, other: Side, context: Context, value: float | None = None) -> None:
    """A signed distance along the plane's normal: an equation, or a range that is only noted."""
    measured = float(plane.z @ (other.p - plane.p))
    if _ranged(c):
        context.ranges.append(RangedCoordinate(c, plane.body, other.body, plane.z, False, measured))
        return
    value = c.value if value is None else value
    if c.reading.get("offset") != "along_normal":
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


def _angle(rows: Rows, c: Constraint, a: Side, b: Side, reference: Side | None = None, *, context: Context) -> None:
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if "point" in pair:
        raise UnknownPairing
    if pair == ("plane", "line"):
        rows.dot(first, first.z, second, second.z, math.sin(c.value))
        return
    about = _angle_axis(c, a, b, reference, context)
    if about is not None:
        measured = math.atan2(about @ np.cross(a.z, b.z), a.z @ b.z)
        if _ranged(c):
            context.ranges.append(RangedCoordinate(c, a.body, b.body, about, True, measured))
            return
        directed = reference is not None or c.reading.get("angle") == "directed"
        rows.angle(a, a.z, about, b, b.z, c.value if directed else _nearest_sign(c.value, measured))
    elif _ranged(c):
        raise UnknownPairing
    elif abs(math.sin(c.value)) < 1e-9:
        rows.parallel(a, b)  # a.b = +-1 has no gradient
    else:
        rows.dot(a, a.z, b, b.z, math.cos(c.value))


def _angle_axis(c: Constraint, a: Side, b: Side, reference: Side | None, context: Context) -> Array | None:
    """The axis the angle turns about: the stated one, else one that the pair's bodies share."""
    if reference is not None:
        candidates = [reference.z]
    else:
        candidates = context.axes.get((min(a.body, b.body), max(a.body, b.body)), [])
    for axis in candidates:
        if max(abs(axis @ a.z), abs(axis @ b.z)) < PARALLEL_SINE:
            across = axis - a.z * (axis @ a.z)
            return across / np.linalg.norm(across)
    return None


def _distance(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    first, second, pair = _ordered(a, b, "plane", "line", "point")
    if first.kind is FeatureKind.PLANE:
        _coincident(rows, c, first, second, context=context)
    elif _ranged(c):
        raise UnknownPairing
    elif pair == ("point", "point"):
        _apart(rows, first, second, abs(c.value))
    elif pair == ("line", "point"):
        _off_line(rows, first, second, abs(c.value))
    else:
        _lines_apart(rows, first, second, abs(c.value), c.reading.get("line_line_distance"))


def _apart(rows: Rows, a: Side, b: Side, d: float) -> None:
    if d == 0.0:
        rows.point(a, b)
    else:
        rows.atom(rows.row(True), Atom.DIST, a.body, b.body, p_a=a.p, p_b=b.p, d=d)


def _off_line(rows: Rows, line: Side, point: Side, d: float) -> None:
    if d == 0.0:
        rows.on_line(line, point)
    else:
        rows.atom(rows.row(True), Atom.PLD, line.body, point.body, p_a=line.p, dir_a=line.z, p_b=point.p, d=d)


def _lines_apart(rows: Rows, a: Side, b: Side, d: float, reading: str | None) -> None:
    normal = np.cross(a.z, b.z)
    if reading is None:
        reading = "parallel" if np.linalg.norm(normal) < PARALLEL_SINE else "skew"
    if reading == "parallel":
        rows.parallel(a, b)
        _off_line(rows, a, b, d)
    else:
        measured = float(normal @ (b.p - a.p))
        rows.atom(
            rows.row(True), Atom.LLD, a.body, b.body,
            p_a=a.p, dir_a=a.z, p_b=b.p, dir_b=b.z, d=math.copysign(d, measured),
        )


def _tangent(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    order = (FeatureKind.PLANE, FeatureKind.CYLINDER, FeatureKind.LINE, FeatureKind.CONE,
             FeatureKind.CIRCLE, FeatureKind.SPHERE, FeatureKind.POINT)
    if a.kind not in order or b.kind not in order:
        raise UnknownPairing
    first, second = (a, b) if order.index(a.kind) <= order.index(b.kind) else (b, a)
    kinds = (_plain(first), second.kind)
    height = float(first.z @ (second.p - first.p))
    if first.kind is FeatureKind.PLANE and second.kind in (FeatureKind.SPHERE, FeatureKind.POINT):
        rows.plane(first, first.z, second, _side_of_plane(c, second.radius, height))
    elif first.kind is FeatureKind.PLANE and second.kind in (FeatureKind.CYLINDER, FeatureKind.LINE):
        rows.dot(first, first.z, second, second.z)
        rows.plane(first, first.z, second, _side_of_plane(c, second.radius, height))
    elif first.kind is FeatureKind.PLANE and second.kind is FeatureKind.CONE:
        # the plane holds the apex and a generator: n.axis = +-sin(half angle)
        sine = math.copysign(math.sin(second.half_angle), float(first.z @ second.z))
        rows.dot(first, first.z, second, second.z, sine)
        rows.plane(first, first.z, second)
    elif first.kind is FeatureKind.PLANE and second.kind is FeatureKind.CIRCLE:
        rows.atom(
            rows.row(True), Atom.CPT, first.body, second.body, p_a=first.p, dir_a=first.z,
            k=second.x * second.radius, p_b=second.p, dir_b=second.z, d=_side_of_plane(c, 1.0, height),
        )
    elif kinds == ("line", FeatureKind.SPHERE) or kinds == ("line", FeatureKind.POINT):
        offset = second.p - first.p
        measured = float(np.linalg.norm(offset - first.z * (offset @ first.z)))
        _off_line(rows, first, second, _radii(c, first.radius, second.radius, measured))
    elif {first.kind, second.kind} <= {FeatureKind.CYLINDER, FeatureKind.LINE}:
        normal = np.cross(first.z, second.z)
        size = float(np.linalg.norm(normal))
        offset = second.p - first.p
        reading = c.reading.get("tangent_cylinders") or ("parallel" if size < PARALLEL_SINE else "skew")
        if reading == "parallel":
            measured = float(np.linalg.norm(offset - first.z * (offset @ first.z)))
        else:
            measured = abs(float(normal @ offset)) / max(size, PARALLEL_SINE)
        _lines_apart(rows, first, second, _radii(c, first.radius, second.radius, measured), reading)
    elif {first.kind, second.kind} <= {FeatureKind.SPHERE, FeatureKind.POINT}:
        measured = float(np.linalg.norm(second.p - first.p))
        _apart(rows, first, second, _radii(c, first.radius, second.radius, measured))
    else:
        raise UnknownPairing


def _side_of_plane(c: Constraint, radius: float, height: float) -> float:
    if c.side is Surface.EITHER:
        return math.copysign(radius, height)
    return radius if c.side is Surface.OUTSIDE else -radius


def _radii(c: Constraint, first: float, second: float, measured: float) -> float:
    outside, inside = first + second, abs(first - second)
    if c.side is Surface.EITHER:
        return outside if abs(measured - outside) <= abs(measured - inside) else inside
    return outside if c.side is Surface.OUTSIDE else inside


def _insert(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    if "point" in (_plain(a), _plain(b)):
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
        x, y, z = np.eye(3)
        for along_a, along_b in ((x, z), (y, z), (x, y)):
            rows.dot(a, along_a, b, along_b)


def _lock(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    _lock_orientation(rows, c, a, b, context=context)
    if a.kind is FeatureKind.FRAME and b.kind is FeatureKind.FRAME:
        rows.point(a, b)
    else:
        for axis in np.eye(3):
            rows.plane(a, axis, b, float(axis @ (b.p - a.p)))


def _concentric(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    if "plane" in (_plain(a), _plain(b)):
        raise UnknownPairing
    _coincident(rows, c, a, b, context=context)
    if c.lock_rotation and _plain(a) == _plain(b) == "line":
        _lock_spin(rows, a, b)


def _slider(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    _need_lines(a, b)
    rows.parallel(a, b)
    _lock_spin(rows, a, b)
    rows.on_line(a, b)


def _pin_slot(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    """a: the slot, along its direction (or its secondary, where the direction is the pin's); b: the pin."""
    _need_lines(a, b)
    slot = a.z if abs(a.z @ b.z) < 0.5 else a.x
    normal = b.z - slot * (slot @ b.z)
    normal /= np.linalg.norm(normal)
    across = np.cross(normal, slot)
    rows.dot(a, slot, b, b.z)
    rows.dot(a, across, b, b.z)
    rows.plane(a, normal, b)
    rows.plane(a, across, b)


def _universal(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    _need_lines(a, b)
    rows.point(a, b)
    rows.dot(a, a.z, b, b.z)


def _screw(rows: Rows, c: Constraint, a: Side, b: Side, *, context: Context) -> None:
    _need_lines(a, b)
    rows.parallel(a, b)
    rows.on_line(a, b)
    # C = z - lead/(2 pi) theta - const: one axial translation per turn, counted from the exported pose
    row = rows.row(True)
    slide(rows, row, a, b, 1.0)
    spin(rows, row, a, b, -c.value / math.tau)


def slide(rows: Rows, row: int, a: Side, b: Side, weight: float) -> None:
    """weight * (translation of b along a's direction since the exported pose), added to a row."""
    rows.atom(row, Atom.PIP, a.body, b.body, p_a=a.p, dir_a=a.z, p_b=b.p, d=float(a.z @ (b.p - a.p)), weight=weight)


def spin(rows: Rows, row: int, a: Side, b: Side, weight: float) -> None:
    """weight * (rotation of b about a's direction since the exported pose), added to a row."""
    rows.atom(row, Atom.ANG, a.body, b.body, dir_a=a.x, k=a.z, p_b=b.p, dir_b=a.x, d=0.0, weight=weight)


def _need_lines(*sides: Side) -> None:
    if any(_plain(s) == "point" for s in sides):
        raise UnknownPairing


def _symmetry(rows: Rows, c: Constraint, a: Side, b: Side, plane: Side, *, context: Context) -> None:
    """b is the mirror image of a in the plane (Householder H = I - 2 n n', n fixed on the plane's body)."""
    if plane.kind is not FeatureKind.PLANE or _plain(a) != _plain(b):
        raise UnknownPairing

    def mirrored_offset(direction: Array, point_a: Side, point_b: Side) -> None:
        # C = e.(p_b - p_0) - (H e).(p_a - p_0)
        row = rows.row(True)
        image = direction - 2.0 * plane.z * (plane.z @ direction)
        rows.atom(row, Atom.PIP, plane.body, point_b.body, p_a=plane.p, dir_a=direction, p_b=point_b.p)
        rows.atom(row, Atom.PIP, plane.body, point_a.body, p_a=plane.p, dir_a=image, p_b=point_a.p, weight=-1.0)

    def mirrored_direction(direction: Array, sense: float) -> None:
        # C = e.z_b - sense (H e).z_a
        row = rows.row(False)
        image = direction - 2.0 * plane.z * (plane.z @ direction)
        rows.atom(row, Atom.DOT, plane.body, b.body, dir_a=direction, p_b=b.p, dir_b=b.z)
        rows.atom(row, Atom.DOT, plane.body, a.body, dir_a=image, p_b=a.p, dir_b=a.z, weight=-sense)

    if _plain(a) == "point":
        for direction in (plane.z, plane.x, plane.y):
            mirrored_offset(direction, a, b)
        return
    raise UnknownPairing


def _coupled(rows: Rows, c: Constraint, a: Side, b: Side, carrier: Side | None = None, *, context: Context) -> None:
    """q_b = value * q_a, counted from the exported pose; the axes are carried by ``carrier`` (ground)."""
    _need_lines(a, b)
    body = carrier.body if carrier is not None else 0
    turning = {ConstraintKind.GEAR: (spin, spin), ConstraintKind.BELT: (spin, spin),
               ConstraintKind.RACK: (spin, slide), ConstraintKind.LINEAR: (slide, slide)}[c.kind]
    row = rows.row(turning[1] is slide)
    for coordinate, side, weight in ((turning[0], a, -c.value), (turning[1], b, 1.0)):
        fixed = Side(body, side.p, side.z, side.x, side.y)
        coordinate(rows, row, fixed, side, weight)


_BUILDERS: Mapping[ConstraintKind, Callable[..., None]] = {
    ConstraintKind.COINCIDENT: _coincident,
    ConstraintKind.CONCENTRIC: _concentric,
    ConstraintKind.PARALLEL: _parallel,
    ConstraintKind.PERPENDICULAR: _perpendicular,
    ConstraintKind.ANGLE: _angle,
    ConstraintKind.DISTANCE: _distance,
    ConstraintKind.TANGENT: _tangent,
    ConstraintKind.INSERT: _insert,
    ConstraintKind.SYMMETRY: _symmetry,
    ConstraintKind.LOCK: _lock,
    ConstraintKind.LOCK_ORIENTATION: _lock_orientation,
    ConstraintKind.SLIDER: _slider,
    ConstraintKind.PIN_SLOT: _pin_slot,
    ConstraintKind.UNIVERSAL: _universal,
    ConstraintKind.SCREW: _screw,
    ConstraintKind.GEAR: _coupled,
    ConstraintKind.BELT: _coupled,
    ConstraintKind.RACK: _coupled,
    ConstraintKind.LINEAR: _coupled,
}
