"""Values as they stand in the file: no noise, no negative zero, nothing that Unity would assume anyway."""

from __future__ import annotations

import json
from collections.abc import Mapping
from functools import cache
from typing import Any

import numpy as np

from ..diagnostics import schema_directory

DECIMALS = 12
"""Decimals kept of lengths, directions and angles: a picometre, and what is left of sin(pi) is 0."""


def rounded(value: Any) -> Any:
    """Lengths, directions, quaternions and angles as plain JSON values, rounded to ``DECIMALS`` decimals.

    Takes a number, an array, or dicts and lists of them; anything else passes through.
    """
    if isinstance(value, (float, np.floating)):
        return _plain(round(float(value), DECIMALS))
    if isinstance(value, np.ndarray):
        return [_plain(round(x, DECIMALS)) for x in value.tolist()]
    if isinstance(value, (list, tuple)):
        return [rounded(item) for item in value]
    if isinstance(value, Mapping):
        return {key: rounded(item) for key, item in value.items()}
    return value


def significant(value: Any) -> Any:
    """Masses, inertias and gains: a number or array rounded to ``DECIMALS`` significant digits."""
    if isinstance(value, np.ndarray):
        return [significant(x) for x in value.tolist()]
    return _plain(float(f"{value:.{DECIMALS}g}"))


def _plain(x: float) -> float | int:
    """Whole numbers without a decimal point, so that -0.0 and 0.0 are both 0."""
    return int(x) if abs(x) < 1e15 and x == int(x) else x


@cache
def _definitions() -> Mapping[str, Any]:
    schema = json.loads((schema_directory() / "scene.schema.json").read_text(encoding="utf-8"))
    return schema["$defs"]


_NONE = object()
"""The default of a field that has none."""


@cache
def _properties(name: str) -> Mapping[str, tuple[str, Any]]:
    """Of each property of the schema's definition ``name``: the definition of the object that it holds ("" for other
    values), and its default."""
    found = {}
    for key, rule in _definitions()[name]["properties"].items():
        reference = rule.get("$ref", "").removeprefix("#/$defs/")
        is_object = _definitions().get(reference, {}).get("type") == "object"
        found[key] = (reference if is_object else "", rule.get("default", _NONE))
    return found


def without_defaults(name: str, fields: Mapping[str, Any]) -> dict[str, Any]:
    """``fields`` in the order of the schema's definition ``name``, less those at the default it states.

    Raises KeyError for a field that the definition does not have: a programmer's mistake.
    """
    properties = _properties(name)
    if unknown := fields.keys() - properties.keys():
        raise KeyError(f"{name} has no {', '.join(sorted(unknown))}")
    kept: dict[str, Any] = {}
    for key, (reference, default) in properties.items():
        if key not in fields:
            continue
        value = fields[key]
        if reference and isinstance(value, Mapping):
            value = without_defaults(reference, value) if reference != "extras" else value
            if not value:
                continue
        elif default is not _NONE and value == default:
            continue
        kept[key] = value
    return kept
