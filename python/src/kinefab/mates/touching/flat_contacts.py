"""Plane faces of two parts that lie on each other, or stand opposite at a clearance."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ...model import FeatureKind
from ...spatial import Array
from ..shapes.features import Flat, Shape
from ..shapes.outlines import common
from .contact import Contact, ContactKind, Side

OPPOSED = 1e-5
"""Sine between the normals of flats that lie on each other."""


def flat_contacts(
    first: int, second: int, a: Shape, b: Shape, low: Array, high: Array, near: float, touch: float
) -> Iterator[Contact]:
    """Contacts of the flats of two parts within a box.  near: widest clearance.  touch: up to which there is none."""
    flats_a, flats_b = a.flats_near(low, high), b.flats_near(low, high)
    if not flats_a or not flats_b:
        return
    normals_a, normals_b = (np.array([f.normal for f in flats]) for flats in (flats_a, flats_b))
    points_a, points_b = (np.array([f.point for f in flats]) for flats in (flats_a, flats_b))
    heights = np.einsum("ijk,ik->ij", points_b[None] - points_a[:, None], normals_a)
    opposed = normals_a @ normals_b.T < -1.0 + 0.5 * OPPOSED**2 + 1e-12
    for i, j in np.argwhere(opposed & (heights >= -touch) & (heights <= near)).tolist():
        contact = _contact(first, second, flats_a[i], flats_b[j], float(heights[i, j]), touch)
        if contact is not None:
            yield contact


def _contact(first: int, second: int, a: Flat, b: Flat, gap: float, touch: float) -> Contact | None:
    points, area = common(a.outline, b.outline, a.normal)
    if not len(points):
        return None
    if gap > touch and gap * gap > area:
        return None  # farther apart than they are wide: they face each other by chance
    normals = np.repeat(a.normal[None], len(points), axis=0)
    sides = [Side(FeatureKind.PLANE, f.point, f.normal, 0.0, (f.face,)) for f in (a, b)]
    return Contact(
        ContactKind.FLAT,
        first,
        second,
        sides[0],
        sides[1],
        gap,
        gap <= touch,
        points,
        normals,
        False,
        area=area,
    )
