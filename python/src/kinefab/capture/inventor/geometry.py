"""Inventor's transient geometry as features of a bundle."""

from __future__ import annotations

from typing import Any, cast

from ..channel import MemberFailed
from ..draft import Record
from .api import Point, Vector

SHAPES = (
    ("cylinder", "BasePoint", "AxisVector"),
    ("line", "RootPoint", "Direction"),
    ("plane", "RootPoint", "Normal"),
    ("circle", "Center", "Normal"),
    ("sphere", "CenterPoint", ""),
)
"""Word of the bundle, the member that is a point, the one that is a direction: no two kinds have the same."""
ROUND = frozenset({"cylinder", "circle", "sphere"})


def numbers(vector: Point | Vector) -> list[float]:
    return [float(vector.X), float(vector.Y), float(vector.Z)]


def shape(geometry: Any, inside: str, expected: tuple[str, ...] = ()) -> Record:
    """A piece of geometry: its word, p, d and r.  inside: the frame its numbers are in.

    expected: words to try first; Inventor's geometry has no kind that all versions name alike, so it is told by the
    members that it has.  Raises MemberFailed where it has none of the known.
    """
    order = sorted(SHAPES, key=lambda entry: entry[0] not in expected)
    for word, point, direction in order:
        try:
            d = numbers(cast(Vector, getattr(geometry, direction))) if direction else None
            p = numbers(cast(Point, getattr(geometry, point)))
        except (MemberFailed, AttributeError):
            continue
        found: Record = {"geometry": word, "in": inside, "p": p, **({"d": d} if d else {})}
        if word in ROUND:
            found["r"] = float(geometry.Radius)
        return found
    return {"geometry": "point", "in": inside, "p": numbers(cast(Point, geometry))}


def side(geometry: Any, entity: Any, inside: str, expected: tuple[str, ...] = ()) -> Record:
    """As ``shape``; of a kind of constraint that states no geometry that of its entity."""
    return shape(geometry if geometry is not None else entity().Geometry, inside, expected)
