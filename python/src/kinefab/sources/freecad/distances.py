"""What a Distance joint holds, by the two elements that it is measured between.

Source: FreeCAD's ``getDistanceType`` and ``makeMbdJointDistance``, which puts a plane before what lies on it, a face
before an edge and an edge before a point, and measures from the axis or the centre of what is round.
"""

from __future__ import annotations

from .elements import Element

_FIRST = {
    ("line", "line"): ("RevCylJoint", 0, 0),
    ("line", "circle"): ("RevCylJoint", 0, 1),
    ("circle", "circle"): ("RevCylJoint", 1, 1),
    ("plane", "plane"): ("PlanarJoint", 0, 0),
    ("plane", "cylinder"): ("LineInPlaneJoint", 0, 1),
    ("plane", "sphere"): ("PointInPlaneJoint", 0, 1),
    ("cylinder", "cylinder"): ("RevCylJoint", 1, 1),
    ("cylinder", "sphere"): ("CylSphJoint", 1, 1),
    ("cylinder", "torus"): ("RevCylJoint", 1, 0),
    ("torus", "sphere"): ("CylSphJoint", 0, 1),
    ("sphere", "sphere"): ("SphSphJoint", 1, 1),
    ("plane", "point"): ("PointInPlaneJoint", 0, 0),
    ("cylinder", "point"): ("CylSphJoint", 1, 0),
    ("sphere", "point"): ("SphSphJoint", 1, 0),
    ("plane", "line"): ("LineInPlaneJoint", 0, 0),
    ("line", "point"): ("CylSphJoint", 0, 0),
    ("circle", "point"): ("PointInPlaneJoint", 0, 0),
    ("curve", "point"): ("PointInPlaneJoint", 0, 0),
}
"""The solver's joint for two kinds of element, the one that comes first first, and whose radius is added.  Any other
two are held as two planes."""
_ORDER = ("plane", "cylinder", "cone", "torus", "sphere", "surface", "line", "circle", "curve", "point")
CONFUSION = 1e-10
"""Metres: a distance below is none (FreeCAD's own 1e-7 mm)."""


def distance_kind(
    first: Element, second: Element, names: list[str], distance: float
) -> tuple[str, float, bool] | None:
    """The solver's joint, its value in metres, and whether the two sides change places; None where an element's kind is
    needed and not known.  names: of the elements."""
    if not first.kind or not second.kind:
        whole = [not name.startswith(("Face", "Edge", "Vertex")) for name in names]
        return ("PlanarJoint", distance, False) if any(whole) else None
    if first.kind == second.kind == "point":
        return ("SphericalJoint" if distance < CONFUSION else "SphSphJoint"), distance, False
    swapped = _ORDER.index(first.kind) > _ORDER.index(second.kind)
    a, b = (second, first) if swapped else (first, second)
    kind, of_a, of_b = _FIRST.get((a.kind, b.kind), ("PlanarJoint", 0, 0))
    return kind, distance + of_a * a.radius + of_b * b.radius, swapped
