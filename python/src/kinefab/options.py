"""What a user may choose about an export; imports nothing heavy, as the command line needs it for --help."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from numbers import Real

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
    limits: mechanisms are swept and the ranges found written as joint limits.

    colliders and closures may be given by their words ("box").  Raises ValueError for a word that is none and for a
    density that is no number above zero, TypeError for a density that is no number and for a flag that is no bool.
    """

    colliders: ColliderShape = ColliderShape.HULL
    density: float = DEFAULT_DENSITY
    strict: bool = False
    closures: Closures = Closures.MINIMAL
    solve: bool = False
    limits: bool = False

    def __post_init__(self) -> None:
        for name, kind in (("colliders", ColliderShape), ("closures", Closures)):
            try:
                object.__setattr__(self, name, kind(getattr(self, name)))
            except ValueError:
                words = ", ".join(member.value for member in kind)
                raise ValueError(f"{name} is {getattr(self, name)!r}; pass one of: {words}") from None
        if isinstance(self.density, bool) or not isinstance(self.density, Real):
            raise TypeError(f"the density is {self.density!r}; pass a number, kg/m^3")
        if not 0.0 < self.density < math.inf:
            raise ValueError(f"the density is {self.density}; it must be a number above zero")
        for name in ("strict", "solve", "limits"):
            if not isinstance(getattr(self, name), bool):
                raise TypeError(f"{name} is {getattr(self, name)!r}; pass True or False")
