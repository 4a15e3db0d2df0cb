"""Which axes of a joint's frame those are that a script names."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..model import JointKind
from ..spatial import Array, cross, frame_from_axes
from .arguments import ROUNDED, checked_axes

SECOND_IS_Z = frozenset({JointKind.UNIVERSAL, JointKind.PERPENDICULAR, JointKind.LINE_IN_PLANE})
"""Kinds whose second axis, the one that a carries, is the frame's Z."""
SQUARE = {
    JointKind.UNIVERSAL: "a universal joint's two axes are square to each other: axis on b, secondary on a",
    JointKind.PERPENDICULAR: "the two lines are square to each other: axis on b, secondary on a",
    JointKind.LINE_IN_PLANE: "the line (axis, on b) is square to the plane's normal (secondary, on a)",
    JointKind.PIN_SLOT: "a slot (secondary, on a) is square to its pin (axis)",
}
"""Kinds of which both axes mean something, with what they have to be; of the others the second only says where Y is near."""


def joint_axes(kind: JointKind, axis: Any, secondary: Any) -> Array:
    """The axes of a joint's frame in the world, columns X, Y, Z.

    axis: what the kind turns about, slides along, or is normal to.  secondary: the second axis of a kind that has two, else
    a direction that Y (of a point on a plane: X) is near to; None for one that is chosen.
    Raises ValueError for an axis that is none, and where the two have to be square to each other and are not.
    """
    main, beside = checked_axes(axis, secondary)
    if beside is not None and kind in SQUARE:
        _check_square(SQUARE[kind], main, beside)
    if beside is not None and kind in SECOND_IS_Z:
        beside = cross(beside, main)
    frame = frame_from_axes(main, beside)
    # A point's plane has its normal as Z, which is the axis that one names of a plane.
    return frame[:, [1, 2, 0]] if kind is JointKind.POINT_ON_PLANE else frame


def _check_square(rule: str, main: Array, beside: Array) -> None:
    """Up to the rounding of typed digits."""
    cosine = float(main @ beside / (np.linalg.norm(main) * np.linalg.norm(beside)))
    if abs(cosine) > ROUNDED:
        angle = math.degrees(math.acos(min(1.0, max(-1.0, cosine))))
        raise ValueError(f"axis and secondary stand at {angle:.4g} degrees, and {rule}; pass two that are")
