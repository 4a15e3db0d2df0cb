"""Values as they stand in the file: no noise, no negative zero, no infinity."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from ..spatial import Array

DECIMALS = 12
"""Decimals kept of lengths, directions and angles: a picometre, and what is left of sin(pi) is 0."""

WHOLE = 1e15
"""Below it a whole number is written without a decimal point."""


def rising(times: Array) -> Array:
    """A clip's seconds as 32-bit floats of which no two are alike: where two keys are a step, the later comes a float after."""
    found = times.astype(np.float32)
    if (found[1:] <= found[:-1]).any():
        for k in range(1, len(found)):
            found[k] = max(found[k], np.nextafter(found[k - 1], np.float32(np.inf)))
    return found.astype(np.float64)


def plain_value(value: Any) -> Any:
    """Lengths, directions, quaternions and angles as plain JSON values, rounded to ``DECIMALS`` decimals.

    Takes a number or sequences and mappings of them; an infinite number is None, anything else passes through.
    """
    if isinstance(value, float):
        return _rounded(value)
    if isinstance(value, (list, tuple)):
        return [  # most are floats, and many of them whole numbers, which need no rounding
            plain_value(item)
            if type(item) is not float
            else int(item)
            if item.is_integer() and -WHOLE < item < WHOLE
            else _rounded(item)
            for item in cast(Sequence[Any], value)
        ]
    if isinstance(value, (str, int)):
        return value
    if isinstance(value, Mapping):
        return {key: plain_value(item) for key, item in cast(Mapping[Any, Any], value).items()}
    return value


def significant(value: Any) -> Any:
    """Masses, inertias and gains: a number or a sequence of them rounded to ``DECIMALS`` significant digits."""
    if isinstance(value, (list, tuple)):
        return [significant(x) for x in cast(Sequence[Any], value)]
    return _plain(float(f"{value:.{DECIMALS}g}"))


def whole_numbers(value: Any) -> Any:
    """What a source or a user says beside the format: whole numbers as the others in the file, all else as it is."""
    if isinstance(value, float):
        return _plain(value)
    if isinstance(value, Mapping):
        return {key: whole_numbers(item) for key, item in cast(Mapping[Any, Any], value).items()}
    if isinstance(value, (list, tuple)):
        return [whole_numbers(item) for item in cast(Sequence[Any], value)]
    return value


def _rounded(x: float) -> float | int | None:
    return None if math.isinf(x) else _plain(round(x, DECIMALS))


def _plain(x: float) -> float | int:
    """Whole numbers without a decimal point, so that -0.0 and 0.0 are both 0."""
    return int(x) if x.is_integer() and -WHOLE < x < WHOLE else x
