"""The source's geometric constraints, mirrored and written through for whoever wants them."""

from __future__ import annotations

import math
from typing import Any, Sequence

from ..model import Constraint, ConstraintKind, Feature
from . import frames
from .numbers import rounded, without_defaults


def constraint_entry(constraint: Constraint, object_of: Sequence[int]) -> dict[str, Any]:
    """The scene format's entry of one constraint.  object_of: for each node its GameObject."""
    fields = {
        "id": constraint.id,
        "name": constraint.name,
        "kind": constraint.kind.value,
        "rawKind": constraint.raw_kind,
        "features": [_feature_entry(f, object_of) for f in constraint.features],
        "value": _value(constraint, constraint.value),
        "lower": _value(constraint, constraint.lower),
        "upper": _value(constraint, constraint.upper),
        "sense": constraint.sense.value,
        "side": constraint.side.value,
        "lockRotation": constraint.lock_rotation,
        "suppressed": constraint.suppressed,
        "reading": dict(constraint.reading),
    }
    present = {key: value for key, value in fields.items() if value not in (None, "", {})}
    return without_defaults("constraint", rounded(present))


def _value(constraint: Constraint, value: float | None) -> float | None:
    """Metres stay, radians become degrees, and a screw's lead turns its sign as angles do (SPEC F8)."""
    if value is None or not math.isfinite(value):
        return None
    if constraint.kind is ConstraintKind.ANGLE:
        return math.degrees(value)
    if constraint.kind is ConstraintKind.SCREW:
        return float(frames.lead(value))
    return value


def _feature_entry(feature: Feature, object_of: Sequence[int]) -> dict[str, Any]:
    fields: dict[str, Any] = {
        "kind": feature.kind.value,
        "point": frames.point(feature.point),
        "radius": feature.radius,
        "halfAngle": math.degrees(feature.half_angle),
    }
    if feature.node is not None:
        fields["gameObject"] = object_of[feature.node]
    for key, direction in (("direction", feature.direction), ("secondary", feature.secondary)):
        if direction is not None:
            fields[key] = frames.direction(direction)
    return without_defaults("feature", rounded(fields))
