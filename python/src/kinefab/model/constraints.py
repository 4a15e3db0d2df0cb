"""Geometric constraints and freedoms as the source states them, before any analysis."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from ..spatial import Array


class FeatureKind(str, Enum):
    """Geometry that a constraint refers to."""

    POINT = "point"
    LINE = "line"
    PLANE = "plane"
    CIRCLE = "circle"
    CYLINDER = "cylinder"
    SPHERE = "sphere"
    CONE = "cone"
    FRAME = "frame"
    BODY = "body"


@dataclass(frozen=True, slots=True, eq=False)
class Feature:
    """A piece of geometry on a node (None: ground), in THAT NODE'S frame (the world for ground).

    point: on the point, line, plane or axis; centre of a circle or sphere; apex of a cone; shape (3,).
    direction: of a line or axis, or a plane's outward normal; unit vector; None for point and sphere.
    secondary: second direction where the geometry is a whole frame (its X), or None.
    radius, half_angle: metres, radians; 0 where they mean nothing.

    >>> import kinefab
    >>> scene = kinefab.Scene()
    >>> feature = scene.plane(scene.add_part("Table", translation=(0, 0.7, 0)), point=(0, 0.7, 0), normal=(0, 1, 0))
    >>> feature.kind.value, feature.point.tolist()
    ('plane', [0.0, 0.0, 0.0])
    """

    node: int | None
    kind: FeatureKind
    point: Array
    direction: Array | None = None
    secondary: Array | None = None
    radius: float = 0.0
    half_angle: float = 0.0


class ConstraintKind(str, Enum):
    """What a constraint holds between two features, and how many freedoms that takes (``schemas/SPEC.md``, section 7).

    A sphere counts as its centre, a circle, cylinder or cone as its axis.

    coincident: point on point 3, on line 2, on plane 1; line on line 4, in a plane 2; plane on plane 3; frame on frame 6
    concentric: axis on axis 4; with ``lock_rotation`` 5
    parallel, perpendicular: two directions 2, 1; a line with a plane 1, 2
    angle: between two directions 1
    distance: of points, point and line, point and plane 1; line and plane 2; planes 3; lines 1 or 3
    tangent: plane with sphere 1, cylinder 2, cone 2, edge of a circle 1; spheres 1; cylinder and sphere 1; cylinders 1 or 3
    insert: axis on axis and edge on edge 5; with ``lock_rotation`` 6
    symmetry: b is the mirror image of a in the plane c: two points or planes 3, two lines 4
    lock, lock_orientation: everything 6, every turn 3, as they stand now
    slider: axis on axis without a turn 5
    pin_slot: b, the pin, in a, the slot 4
    universal: a point in common, two axes square to each other 4
    screw: axis on axis, a slide of ``value`` a turn 5
    gear, belt: b turns ``value`` times as far as a 1
    rack: b slides ``value`` for each radian of a 1
    linear: b slides ``value`` times as far as a 1
    ground: fixed to the world 6
    other: kept, never interpreted 0

    >>> import kinefab
    >>> kinefab.ConstraintKind("insert") is kinefab.ConstraintKind.INSERT
    True
    """

    COINCIDENT = "coincident"
    CONCENTRIC = "concentric"
    PARALLEL = "parallel"
    PERPENDICULAR = "perpendicular"
    ANGLE = "angle"
    DISTANCE = "distance"
    TANGENT = "tangent"
    INSERT = "insert"
    SYMMETRY = "symmetry"
    LOCK = "lock"
    LOCK_ORIENTATION = "lock_orientation"
    SLIDER = "slider"
    PIN_SLOT = "pin_slot"
    UNIVERSAL = "universal"
    SCREW = "screw"
    GEAR = "gear"
    BELT = "belt"
    RACK = "rack"
    LINEAR = "linear"
    GROUND = "ground"
    OTHER = "other"  # stored and written through, never interpreted


class Sense(str, Enum):
    """How two directions stand: along each other, against each other, or either."""

    ALIGNED = "aligned"
    OPPOSED = "opposed"
    EITHER = "either"


class Side(str, Enum):
    """On which side of the other surface a tangency is; EITHER takes that of the exported pose."""

    INSIDE = "inside"
    OUTSIDE = "outside"
    EITHER = "either"


@dataclass(frozen=True, slots=True, eq=False)
class Constraint:
    """A geometric constraint as the source states it, before any analysis.

    features: the constrained geometry: a then b, and a third for symmetry (the plane).
    value: distance (m) or angle (rad), lead of a screw (m a turn), ratio of a coupling.
    lower, upper: range where the source gives one instead of a value (None: an equality).
    reading: the vendor's meaning where the same words remove different rows, for example
        ``line_line_distance: skew | parallel``; keys and values are listed in ``schemas/SPEC.md``.
    raw_kind: the source's own word for it.

    >>> import kinefab
    >>> scene = kinefab.Scene()
    >>> top = scene.plane(None, point=(0, 0.7, 0), normal=(0, 1, 0))
    >>> foot = scene.plane(scene.add_part("Vase"), point=(0, 0.7, 0), normal=(0, -1, 0))
    >>> constraint = scene.add_constraint("coincident", top, foot)
    >>> constraint.kind.value, len(constraint.features)
    ('coincident', 2)
    """

    id: str
    kind: ConstraintKind
    features: tuple[Feature, ...]
    value: float = 0.0
    lower: float | None = None
    upper: float | None = None
    sense: Sense = Sense.EITHER
    side: Side = Side.EITHER
    lock_rotation: bool = False
    suppressed: bool = False
    name: str = ""
    raw_kind: str = ""
    reading: Mapping[str, str] = field(default_factory=dict[str, str])
    where: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class DofRecord:
    """The source's own statement of a component's remaining freedoms to ground.

    translations: directions, unit, WORLD frame, shape (t, 3).  rotations: axes, unit, WORLD frame,
    shape (r, 3).  center: a point that the rotations pass through, WORLD frame, or None.
    """

    node: int
    translations: Array
    rotations: Array
    center: Array | None = None
    where: str = ""
