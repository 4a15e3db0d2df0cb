"""Where two parts touch, or are held apart by a clearance: shafts in bores, seats, flats, lines.

A contact is stated as geometry for a constraint and as normals at points: there the second part cannot move against
the normal (nor along it, where the contact holds from both sides).
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

import numpy as np

from ...model import FeatureKind
from ...spatial import Array, cross, perpendicular


class ContactKind(str, Enum):
    FIT = "fit"  # a shaft in a bore
    ARC = "arc"  # a shaft in a part of a bore
    CONE = "cone"
    BALL = "ball"  # a ball in a socket
    GROOVE = "groove"  # a ball in a race
    RACE = "race"  # two races by way of their balls
    TUBE = "tube"  # a ball in a bore
    FLAT = "flat"
    LINE = "line"  # a shaft on a flat
    POINT = "point"  # a ball on a flat


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """What a contact touches of one part, WORLD.  faces: labels."""

    kind: FeatureKind
    point: Array
    direction: Array | None
    radius: float
    faces: tuple[str, ...]


@dataclass(frozen=True, slots=True, eq=False)
class Contact:
    """A contact of part ``second`` with part ``first`` (numbers of parts), WORLD, metres.

    gap: the clearance; below zero where they interfere.  touching: no clearance to speak of.
    points, normals: shape (n, 3) each; normals lead from the first part into the second.
    two_sided: the second part can move neither way along these normals.
    inner: the part of the shaft or ball, -1 where there is none.  spans: where they meet, along a.direction from a.point.
    area: m^2, of flats.  shaft_span: of a fit's whole shaft, as ``spans``.
    """

    kind: ContactKind
    first: int
    second: int
    a: Side
    b: Side
    gap: float
    touching: bool
    points: Array
    normals: Array
    two_sided: bool
    inner: int = -1
    spans: tuple[tuple[float, float], ...] = ()
    area: float = 0.0
    shaft_span: tuple[float, float] = (0.0, 0.0)

    @property
    def is_axial(self) -> bool:
        """Whether it gives the two parts a common axis."""
        return self.kind in (ContactKind.FIT, ContactKind.CONE, ContactKind.RACE)

    @property
    def span(self) -> tuple[float, float]:
        """From the first to the last place where they meet; (0, 0) of what is not along an axis."""
        return (self.spans[0][0], self.spans[-1][1]) if self.spans else (0.0, 0.0)

    @property
    def reach(self) -> float:
        """Length over which they meet, metres."""
        return sum(high - low for low, high in self.spans)

    @property
    def axis(self) -> Array:
        assert self.a.direction is not None
        return self.a.direction

    def other(self, part: int) -> int:
        return self.second if part == self.first else self.first

    def side(self, part: int) -> Side:
        return self.a if part == self.first else self.b


def axial_rows(point: Array, axis: Array, span: tuple[float, float]) -> tuple[Array, Array]:
    """Points and normals that hold a common axis: two across it at either end of where they meet."""
    x = perpendicular(axis)
    y = cross(axis, x)
    low, high = point + axis * span[0], point + axis * span[1]
    return np.array([low, low, high, high]), np.array([x, y, x, y])


def shared(a: Contact, b: Contact) -> float:
    """Length along the axis that two fits have in common over which they are at one place, metres."""
    sign = 1.0 if float(a.axis @ b.axis) > 0.0 else -1.0
    shift = float((b.a.point - a.a.point) @ a.axis)
    length = 0.0
    for low, high in a.spans:
        for other in b.spans:
            first, last = sorted((shift + sign * other[0], shift + sign * other[1]))
            length += max(0.0, min(high, last) - max(low, first))
    return length
