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
    """

    node: int | None
    kind: FeatureKind
    point: Array
    direction: Array | None = None
    secondary: Array | None = None
    radius: float = 0.0
    half_angle: float = 0.0


class ConstraintKind(str, Enum):
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
