"""Inventor's transient geometry as features of a bundle."""

from __future__ import annotations

from typing import Any, cast

from ..channel import MemberFailed
from ..draft import Record
from .api import Entity, Point, Vector

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


def entity_shape(entity: Entity, inside: str, expected: tuple[str, ...] = ()) -> Record:
    """As ``shape`` of what a face or edge is of, a work plane, axis or point, or a vertex.  Raises MemberFailed for anything else."""
    for member in ("Geometry", "Plane", "Line", "Point"):
        try:
            geometry = getattr(entity, member)
            if geometry is not None:
                return shape(geometry, inside, expected)
        except (MemberFailed, AttributeError):
            continue
    raise MemberFailed("Geometry", "a kind of entity that is not known")
