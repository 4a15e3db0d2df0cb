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


class Closures(str, Enum):
    """How a joint that closes a loop is written: whole, or with its independent equations only."""

    EXACT = "exact"
    MINIMAL = "minimal"


@dataclass(frozen=True, slots=True)
class ExportOptions:
    """colliders: shape given to every body.  density: kg/m^3 of bodies that state none.
    strict: what would be approximated or dropped with a warning is an error, and nothing is written.
    closures: see ``Closures``.  solve: parts are moved to the nearest pose that satisfies the constraints.
    limits: mechanisms are swept and the ranges found written as joint limits."""

    colliders: ColliderShape = ColliderShape.HULL
    density: float = DEFAULT_DENSITY
    strict: bool = False
    closures: Closures = Closures.MINIMAL
    solve: bool = False
    limits: bool = False
