"""Transformation operators that mirror: what they place OpenCASCADE turns instead, without a word.

Source: ISO 10303-42, ``base_axis``: the second axis of an operator may point to either side of the other two.
"""

from __future__ import annotations

import re

import numpy as np

from ....diagnostics import Report
from ....spatial import Array
from ..entities import EntityError, Ref, Value, entity
from ..part21 import Part21, references

NAME = "CARTESIAN_TRANSFORMATION_OPERATOR_3D"
_PLACING = re.compile(rb"\b(?:MAPPED_ITEM|REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION)\s*\([^;]*")


def tell_mirrors(text: Part21, file: str, report: Report) -> None:
    """Report each operator that places something and whose axes are left-handed.  file: name of the source, for places."""
    if NAME.encode() not in text.plain:
        return
    placing = {n for found in _PLACING.finditer(text.plain) for n in references(found[0])}
    for number in sorted(placing & text.instances.keys()):
        if NAME.encode() not in text.text(number):
            continue
        try:
            if _mirrors(text, entity(text, number)):
                where = f"{file}:#{number}"
                report.approximated(f"mirror #{number}", "STEP_MIRROR_TURNED", where, number=number)
        except EntityError:  # what is damaged OpenCASCADE leaves out
            continue


def _mirrors(text: Part21, given: dict[str, list[Value]]) -> bool:
    if len(given) == 1:  # internal mapping: name, (name, description,) axis 1, axis 2, origin, scale, axis 3
        x, y, _, _, z = [*[None] * 5, *given.get(NAME, [])][-5:]
    else:
        x, y = [*given.get("CARTESIAN_TRANSFORMATION_OPERATOR", []), None, None][:2]
        z = [*given.get(NAME, []), None][0]
    axes = [_direction(text, axis) for axis in (x, y, z)]
    if axes[1] is None:  # the second axis is then what makes it right-handed
        return False
    up = np.array([0.0, 0.0, 1.0]) if axes[2] is None else axes[2]
    first = np.array([1.0, 0.0, 0.0]) if axes[0] is None else axes[0]
    return float(np.cross(first, axes[1]) @ up) < 0.0


def _direction(text: Part21, value: Value) -> Array | None:
    if not isinstance(value, Ref):
        return None
    row = entity(text, value.number).get("DIRECTION", [])
    ratios = row[1] if len(row) > 1 else None
    found = [ratio for ratio in ratios if isinstance(ratio, float)] if isinstance(ratios, list) else []
    if len(found) != 3:
        raise EntityError("a direction has no three ratios")
    return np.array(found)
