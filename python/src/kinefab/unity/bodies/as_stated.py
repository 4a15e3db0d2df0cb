"""What no component of a part's object holds, in the object's ``extras``: the mass of one that stands, the name of its only body.

Right-handed, as ``model.MassProperties`` has it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from ...model import MassProperties
from ...spatial import Array

AS_STATED = "asStated"
"""Beside what a source says there itself."""
BODY = "body"
_FIELDS = {"mass": (), "center": (3,), "inertia": (3, 3)}
MOST = 3.4e38
"""What a 32-bit float holds: no number of a scene file is larger."""


def with_stated(extras: Mapping[str, object], mass: MassProperties | None, body: str) -> dict[str, object]:
    """The extras of an object with what there is to be told.  mass: None for none.  body: "" for the name of its mesh."""
    told: dict[str, object] = {BODY: body} if body else {}
    if mass is not None:
        values = {name: np.asarray(getattr(mass, name)) for name in _FIELDS}
        if all((np.abs(value) <= MOST).all() for value in values.values()):
            told |= {name: _rounded(value).tolist() for name, value in values.items()}
    return {**extras, AS_STATED: told} if told else dict(extras)


def _rounded(value: Array) -> Array:
    """Twelve digits of the largest number."""
    largest = float(np.abs(value).max())
    return np.round(value, 11 - math.floor(math.log10(largest))) + 0.0 if largest > 0.0 else value


def without_stated(extras: Mapping[str, object]) -> dict[str, object]:
    """What a source says there itself."""
    return {key: value for key, value in extras.items() if key != AS_STATED}


def stated_body(extras: Mapping[str, object]) -> str:
    """The name of the only body, "" where none is told."""
    told: Any = extras.get(AS_STATED)
    name: Any = cast("Mapping[str, Any]", told).get(BODY, "") if isinstance(told, Mapping) else ""
    return name if isinstance(name, str) else ""


def stated_mass(extras: Mapping[str, object]) -> MassProperties | None:
    """The mass; None where none is told, or it is none."""
    told: Any = extras.get(AS_STATED)
    try:
        values = {name: np.array(told[name], dtype=np.float64) for name in _FIELDS}
    except (LookupError, TypeError, ValueError, OverflowError):
        return None
    sound = all(
        value.shape == _FIELDS[name] and bool((np.abs(value) <= MOST).all()) for name, value in values.items()
    )
    if not sound or not values["mass"] > 0.0:
        return None
    return MassProperties(float(values["mass"]), values["center"], values["inertia"])
