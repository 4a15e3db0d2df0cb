"""The source's geometric constraints, mirrored and written through for whoever wants them."""

from __future__ import annotations

import math
from collections.abc import Sequence

from ..model import Constraint, ConstraintKind, Feature
from . import frames
from .scene import Constraint as UnityConstraint
from .scene import Feature as UnityFeature
from .scene.vectors import vector3


def map_constraint(constraint: Constraint, object_of: Sequence[int]) -> UnityConstraint:
    """One constraint in Unity's frame.  object_of: for each node its GameObject."""
    return UnityConstraint(
        id=constraint.id,
        kind=constraint.kind.value,
        features=tuple(_feature(f, object_of) for f in constraint.features),
        name=constraint.name,
        rawKind=constraint.raw_kind,
        value=_value(constraint, constraint.value),
        lower=_value(constraint, constraint.lower),
        upper=_value(constraint, constraint.upper),
        sense=constraint.sense.value,
        side=constraint.side.value,
        lockRotation=constraint.lock_rotation,
        suppressed=constraint.suppressed,
        reading=dict(constraint.reading),
    )


def _value(constraint: Constraint, value: float | None) -> float | None:
    """Metres stay, radians become degrees, and a screw's lead turns its sign as angles do (SPEC F8)."""
    if value is None or not math.isfinite(value):
        return None
    if constraint.kind is ConstraintKind.ANGLE:
        return math.degrees(value)
    if constraint.kind is ConstraintKind.SCREW:
        return float(frames.lead(value))
    return value


def _feature(feature: Feature, object_of: Sequence[int]) -> UnityFeature:
    directions = (feature.direction, feature.secondary)
    direction, secondary = (None if d is None else vector3(frames.direction(d)) for d in directions)
    return UnityFeature(
        kind=feature.kind.value,
        gameObject=None if feature.node is None else object_of[feature.node],
        point=vector3(frames.point(feature.point)),
        direction=direction,
        secondary=secondary,
        radius=feature.radius,
        halfAngle=math.degrees(feature.half_angle),
    )
