"""Couplings between joint coordinates: gears, racks, screws, mimics."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class CouplingKind(str, Enum):
    GEAR = "gear"
    BELT = "belt"
    RACK = "rack"
    SCREW = "screw"
    LINEAR = "linear"


@dataclass(frozen=True, slots=True)
class Term:
    """``ratio`` times a joint coordinate.  joint: its id.  freedom: TX..RZ.  ratio: metres and radians."""

    joint: str
    freedom: int
    ratio: float


@dataclass(frozen=True, slots=True, eq=False)
class Coupling:
    """``q = sum of term.ratio * q_term + offset`` between joint coordinates, metres and radians.

    joint, freedom: the coordinate q, by the id of its joint and TX..RZ.  Ids, since the analysis orders and adds joints.
    terms: what it follows, one for a gear, a rack, a mimic (of a screw: a coordinate of the same joint).
    """

    id: str
    kind: CouplingKind
    joint: str
    freedom: int
    terms: tuple[Term, ...]
    offset: float = 0.0
    where: str = ""

    @property
    def joints(self) -> frozenset[str]:
        """Ids of all joints that it counts from."""
        return frozenset((self.joint, *(term.joint for term in self.terms)))
