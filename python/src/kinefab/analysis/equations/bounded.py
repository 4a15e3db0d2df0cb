"""Lengths and angles that a constraint bounds instead of stating: they make no equation, and become limits of a joint."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...model import Constraint
from ...spatial import Array


@dataclass(frozen=True, slots=True, eq=False)
class RangedCoordinate:
    """A length along or an angle about ``axis`` (WORLD, fixed on a) that the source bounds, not fixes.

    measured: its value at the exported pose, in the sense in which the bounds count.
    """

    constraint: Constraint
    body_a: int
    body_b: int
    axis: Array
    is_angle: bool
    measured: float


def is_bounded(constraint: Constraint) -> bool:
    return constraint.lower is not None or constraint.upper is not None


def bounded(
    constraint: Constraint,
    bodies: tuple[int, int],
    axis: Array,
    measured: float,
    is_angle: bool,
    signed: bool,
) -> RangedCoordinate:
    """The coordinate as its bounds count it: met at the turn that is nearest to them, and where the source gives no sign
    (``signed``) on the side of zero that is."""
    lower = -math.inf if constraint.lower is None else constraint.lower
    upper = math.inf if constraint.upper is None else constraint.upper
    senses = (1.0,) if signed else (1.0, -1.0)
    found = [(sense, _turned(sense * measured, lower, upper, is_angle)) for sense in senses]
    sense, here = min(found, key=lambda own: _outside(own[1], lower, upper))
    return RangedCoordinate(constraint, *bodies, sense * axis, is_angle, here)


def _outside(value: float, lower: float, upper: float) -> float:
    return max(lower - value, value - upper, 0.0)


def _turned(value: float, lower: float, upper: float, is_angle: bool) -> float:
    """The angle, some whole turns further on where it is nearer to the range then."""
    if not is_angle:
        return value
    beyond = [end - value for end in (lower, upper) if math.isfinite(end)]
    turns = {0, *(round(way / math.tau + part) for way in beyond for part in (-0.5, 0.0, 0.5))}
    nearest = min(
        sorted(turns, key=abs), key=lambda turn: round(_outside(value + turn * math.tau, lower, upper), 12)
    )
    return value + nearest * math.tau
