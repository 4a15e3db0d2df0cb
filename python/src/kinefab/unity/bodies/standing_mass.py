"""The mass of a part that stands, which no Rigidbody tells, in ``extras`` of its object; right-handed, as ``model.MassProperties`` has it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from ...model import MassProperties
from ...spatial import Array

AS_STATED = "asStated"
"""Beside what a source says there itself."""
_FIELDS = {"mass": (), "center": (3,), "inertia": (3, 3)}
MOST = 3.4e38
"""What a 32-bit float holds: no number of a scene file is larger."""


def with_mass(extras: Mapping[str, object], mass: MassProperties) -> dict[str, object]:
    """The extras of an object of that mass."""
    values = {name: np.asarray(getattr(mass, name)) for name in _FIELDS}
    if not all((np.abs(value) <= MOST).all() for value in values.values()):
        return dict(extras)
    return {**extras, AS_STATED: {name: _rounded(value).tolist() for name, value in values.items()}}


def _rounded(value: Array) -> Array:
    """Twelve digits of the largest number."""
    largest = float(np.abs(value).max())
    return np.round(value, 11 - math.floor(math.log10(largest))) + 0.0 if largest > 0.0 else value


def stated_mass(extras: Mapping[str, object]) -> tuple[MassProperties | None, dict[str, object]]:
    """The mass, None where none is told or it is none, and the extras without it."""
    told: Any = extras.get(AS_STATED)
    rest = {key: value for key, value in extras.items() if key != AS_STATED}
    try:
        values = {name: np.array(told[name], dtype=np.float64) for name in _FIELDS}
    except (LookupError, TypeError, ValueError, OverflowError):
        return None, rest
    sound = all(
        value.shape == _FIELDS[name] and bool((np.abs(value) <= MOST).all()) for name, value in values.items()
    )
    if not sound or not values["mass"] > 0.0:
        return None, rest
    return MassProperties(float(values["mass"]), values["center"], values["inertia"]), rest
