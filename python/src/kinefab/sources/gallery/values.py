"""Values of a Gallery assembly, checked as they are taken: what is none raises, and whoever asked leaves that record out."""

from __future__ import annotations

from typing import Any, cast

import numpy as np

from ...diagnostics import is_encodable
from ...spatial import Array, Pose
from ..reading.record import MAX_NUMBER, MIN_DIRECTION, is_number, is_object

Json = dict[str, Any]


class BadValueError(ValueError):
    """Why a record is left out, in words."""


def objects(value: object) -> Json:
    """An object; empty where it is missing or something else."""
    return cast(Json, value) if is_object(value) else {}


def needed(value: object, words: str) -> Json:
    if not is_object(value):
        raise BadValueError(f"its {words} is no object")
    return cast(Json, value)


def text(value: object, default: str = "") -> str:
    """A name of printable characters."""
    if not isinstance(value, str) or not is_encodable(value):
        return default
    return "".join(c if c.isprintable() else " " for c in value).strip() or default


def segment(value: object, default: str) -> str:
    """A name that can be one step of an id."""
    return text(value, default).replace("/", "_")


def number(value: object, words: str) -> float:
    if not is_number(value) or not abs(value) <= MAX_NUMBER:
        raise BadValueError(f"its {words} is no number")
    return float(value)


def vector(value: object, words: str) -> Array:
    """A ``Point3D`` or ``Vector3D``."""
    found = needed(value, words)
    return np.array([number(found.get(axis), words) for axis in "xyz"])


def direction(value: object, words: str) -> Array:
    found = vector(value, words)
    length = float(np.linalg.norm(found))
    if not length > MIN_DIRECTION:
        raise BadValueError(f"its {words} has no length")
    return found / length


def transform(value: object) -> Pose:
    """An occurrence's ``transform``: its axes and origin in its parent."""
    found = needed(value, "transform")
    axes = [vector(found.get(f"{axis}_axis"), f"{axis} axis") for axis in "xyz"]
    return Pose(np.array(axes).T, vector(found.get("origin"), "origin"))
