"""Screws across a shaft whose tip stands on it: they hold the shaft in the bore that it is in, as in a pulley or a collar."""

from __future__ import annotations

from collections import defaultdict

import numpy as np

from ...spatial import Array, cross
from ..shapes.features import Shape, corners_of
from ..touching.contact import Contact, ContactKind
from .bodies import Bodies
from .fasten import Parts

SQUARE = 1e-3
"""Cosine between the axes of a screw and of the shaft that it is across."""
ABOVE, BELOW = 0.2, 1.0
"""How far a tip may end above the shaft's surface, and below it (a point is drawn into the shaft), of the screw's radius."""


def fix_set_screws(bodies: Bodies, parts: Parts) -> None:
    """Fix each shaft to the body whose bore it is in, where a screw in that body stands on it.

    One beside whose tip the shaft has walls, or a hole round it, is a guide: there it slides, or turns.
    """
    screws = [(f.first, bodies.of(f.second)) for f in bodies.fixings if f.reason == "bolt"]
    if not screws:
        return
    fits: defaultdict[int, list[Contact]] = defaultdict(list)
    guided: set[tuple[int, int]] = set()
    for contact in bodies.contacts:
        if contact.kind is ContactKind.FIT:
            fits[bodies.of(contact.other(contact.inner))].append(contact)
        if contact.kind in (ContactKind.FIT, ContactKind.LINE):
            guided |= {(contact.first, contact.second), (contact.second, contact.first)}
    for screw, host in screws:
        for fit in fits.get(host, ()):
            shaft = fit.inner
            if shaft == screw or bodies.of(shaft) == bodies.of(host) or (screw, shaft) in guided:
                continue
            if _stands_on(bodies.shapes[screw], _line(parts, screw), bodies.shapes[shaft], fit):
                bodies.fix(shaft, fit.other(shaft), "set screw", 0.8, (fit,))


def _line(parts: Parts, screw: int) -> tuple[Array, Array]:
    """A point of the screw's axis, and its direction, WORLD."""
    form, pose = parts.turned[screw], parts.poses[screw]
    assert form is not None  # what is no turned part is no bolt
    return pose.point(form.point), pose.direction(form.axis)


def _stands_on(screw: Shape, line: tuple[Array, Array], shaft: Shape, fit: Contact) -> bool:
    """Whether a screw, on an axis across that of a shaft's fit, ends at the shaft's surface."""
    point, axis = line
    if abs(float(axis @ fit.axis)) > SQUARE:
        return False
    offset = point - fit.a.point
    if abs(float(offset @ cross(axis, fit.axis))) > 0.5 * fit.a.radius:
        return False
    crossing = float(offset @ fit.axis)
    if not any(low <= crossing <= high for low, high in fit.spans):
        return False  # as in a groove, in which it keeps the shaft from sliding
    heights = (corners_of(screw).reshape(-1, 3) - point) @ axis
    middle = -float(offset @ axis)
    low, high = float(heights.min()) - middle, float(heights.max()) - middle
    if low < 0.0 < high:
        return False  # it goes through
    tip = low if low >= 0.0 else -high
    surface = _pierced(point + axis * middle, axis if low >= 0.0 else -axis, corners_of(shaft))
    radius = min((r.radius for r in screw.rounds if not r.hollow and r.radius > 0.0), default=0.0)
    return -BELOW * radius <= tip - surface <= ABOVE * radius


def _pierced(origin: Array, axis: Array, triangles: Array) -> float:
    """How far from a point along a direction the last of some triangles is pierced; minus infinity where none is."""
    a = triangles[:, 0]
    first, second = triangles[:, 1] - a, triangles[:, 2] - a
    across = np.cross(axis, second)
    determinant = np.einsum("ij,ij->i", first, across)
    hit = np.abs(determinant) > 1e-12 * np.einsum("ij,ij->i", first, first)
    a, first, second, across, determinant = a[hit], first[hit], second[hit], across[hit], determinant[hit]
    to_origin = origin - a
    u = np.einsum("ij,ij->i", to_origin, across) / determinant
    turned = np.cross(to_origin, first)
    v = turned @ axis / determinant
    distance = np.einsum("ij,ij->i", second, turned) / determinant
    inside = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9)
    return float(distance[inside].max(initial=-np.inf))
