"""What a user may choose about an export; imports nothing heavy, as the command line needs it for --help."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

DEFAULT_DENSITY = 1000.0
"""kg/m^3, water: of bodies whose source and user say nothing."""


class ColliderShape(str, Enum):
    NONE = "none"
    BOX = "box"
    HULL = "hull"
    MESH = "mesh"


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """colliders: shape given to every body.  density: kg/m^3 of bodies that state none.
    strict: what would be approximated or dropped with a warning is an error, and nothing is written."""

    colliders: ColliderShape = ColliderShape.HULL
    density: float = DEFAULT_DENSITY
    strict: bool = False
