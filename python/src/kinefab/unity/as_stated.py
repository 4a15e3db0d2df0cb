"""What no component of a part's object holds, in the object's ``extras``: of one that stands its mass, and the first part that it is one
piece with; the name of its only body.

Right-handed, as ``model.MassProperties`` has it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

import numpy as np

from ..model import MassProperties, Scene
from ..spatial import Array
from .placing import at_home

AS_STATED = "asStated"
"""Beside what a source says there itself."""
BODY, PIECE = "body", "onePieceWith"
_FIELDS = {"mass": (), "center": (3,), "inertia": (3, 3)}
MOST = 3.4e38
"""What a 32-bit float holds: no number of a scene file is larger."""


def with_stated(scene: Scene, node: int, standing: Sequence[int | None], stands: bool) -> dict[str, object]:
    """The extras of a node's object with what there is to be told.  standing: see ``RigidGroups``.  stands: whether nothing moves it."""
    own, told = scene.nodes[node], dict[str, object]()
    bodies = [body for body in own.bodies if body.mesh is not None]
    if len(bodies) == 1 and at_home(bodies[0]) and bodies[0].name != scene.meshes[bodies[0].mesh or 0].name:
        told[BODY] = bodies[0].name
    if stands and standing and standing[node] not in (None, node):
        told[PIECE] = scene.nodes[standing[node] or 0].id
    if stands and own.mass is not None:
        values = {name: np.asarray(getattr(own.mass, name)) for name in _FIELDS}
        if all((np.abs(value) <= MOST).all() for value in values.values()):
            told |= {name: _rounded(value).tolist() for name, value in values.items()}
    return {**own.extras, AS_STATED: told} if told else dict(own.extras)


def _rounded(value: Array) -> Array:
    """Twelve digits of the largest number."""
    largest = float(np.abs(value).max())
    return np.round(value, 11 - math.floor(math.log10(largest))) + 0.0 if largest > 0.0 else value


def without_stated(extras: Mapping[str, object]) -> dict[str, object]:
    """What a source says there itself."""
    return {key: value for key, value in extras.items() if key != AS_STATED}


def stated_body(extras: Mapping[str, object]) -> str:
    """The name of the only body, "" where none is told."""
    return _word(extras, BODY)


def stated_piece(extras: Mapping[str, object]) -> str:
    """Id of the part that a standing one is one piece with, "" where none is told."""
    return _word(extras, PIECE)


def _word(extras: Mapping[str, object], key: str) -> str:
    told: Any = extras.get(AS_STATED)
    word: Any = cast("Mapping[str, Any]", told).get(key, "") if isinstance(told, Mapping) else ""
    return word if isinstance(word, str) else ""


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
