"""Which curve or surface an element of a shape is: a distance is measured from a face in another way than from an edge."""

from __future__ import annotations

import re
from dataclasses import dataclass

from .document import UNIT, Thing
from .shapes import Shapes


@dataclass(frozen=True, slots=True)
class Element:
    """kind: point, line, circle, curve, plane, cylinder, sphere, cone, torus, surface; "" where it cannot be told.
    radius: metres, of a circle, a cylinder or a sphere, else 0."""

    kind: str
    radius: float = 0.0


def element_of(owner: Thing | None, name: str, shapes: Shapes) -> Element:
    """name: ``Face6``, ``Edge2``, ``Vertex1``."""
    match = re.fullmatch(r"(Vertex|Edge|Face)(\d{1,7})", name)
    if match is None:
        return Element("")
    if match[1] == "Vertex":
        return Element("point")
    found = None if owner is None else shapes.element(owner, match[1], int(match[2]))
    return Element("") if found is None else Element(found[0], found[1] * UNIT)
