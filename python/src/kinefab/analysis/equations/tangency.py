"""Tangency of planes, cylinders, cones, circle edges and spheres."""

from __future__ import annotations

import math

import numpy as np

from ...model import Constraint, FeatureKind
from ...model import Side as Surface
from ...spatial import cross
from .atoms import Atom
from .distances import PARALLEL_SINE, apart, lines_apart, off_line
from .features import UnknownPairing, plain_family
from .rows import Rows, Side


def tangent(rows: Rows, c: Constraint, a: Side, b: Side, *, context: object) -> None:
    """Two surfaces that touch.  Raises UnknownPairing for a pairing without equations."""
    order = (
        FeatureKind.PLANE,
        FeatureKind.CYLINDER,
        FeatureKind.LINE,
        FeatureKind.CONE,
        FeatureKind.CIRCLE,
        FeatureKind.SPHERE,
        FeatureKind.POINT,
    )
    if a.kind not in order or b.kind not in order:
        raise UnknownPairing
    first, second = (a, b) if order.index(a.kind) <= order.index(b.kind) else (b, a)
    kinds = (plain_family(first), second.kind)
    height = float(first.z @ (second.p - first.p))
    if first.kind is FeatureKind.PLANE and second.kind in (FeatureKind.SPHERE, FeatureKind.POINT):
        rows.plane(first, first.z, second, _side_of_plane(c, second.radius, height))
    elif first.kind is FeatureKind.PLANE and second.kind in (FeatureKind.CYLINDER, FeatureKind.LINE):
        rows.dot(first, first.z, second, second.z)
        rows.plane(first, first.z, second, _side_of_plane(c, second.radius, height))
    elif first.kind is FeatureKind.PLANE and second.kind is FeatureKind.CONE:
        # the plane holds the apex and a generator: n.axis = +-sin(half angle)
        sine = math.copysign(math.sin(second.half_angle), float(first.z @ second.z))
        rows.dot(first, first.z, second, second.z, sine)
        rows.plane(first, first.z, second)
    elif first.kind is FeatureKind.PLANE and second.kind is FeatureKind.CIRCLE:
        rows.atom(
            rows.row(True),
            Atom.CPT,
            first.body,
            second.body,
            p_a=first.p,
            dir_a=first.z,
            k=second.x * second.radius,
            p_b=second.p,
            dir_b=second.z,
            d=_side_of_plane(c, 1.0, height),
        )
    elif kinds == ("line", FeatureKind.SPHERE) or kinds == ("line", FeatureKind.POINT):
        offset = second.p - first.p
        measured = float(np.linalg.norm(offset - first.z * (offset @ first.z)))
        off_line(rows, first, second, _radii(c, first.radius, second.radius, measured))
    elif {first.kind, second.kind} <= {FeatureKind.CYLINDER, FeatureKind.LINE}:
        normal = cross(first.z, second.z)
        size = float(np.linalg.norm(normal))
        offset = second.p - first.p
        reading = c.reading.get("tangent_cylinders") or ("parallel" if size < PARALLEL_SINE else "skew")
        if reading == "parallel":
            measured = float(np.linalg.norm(offset - first.z * (offset @ first.z)))
        else:
            measured = abs(float(normal @ offset)) / max(size, PARALLEL_SINE)
        lines_apart(rows, first, second, _radii(c, first.radius, second.radius, measured), reading)
    elif {first.kind, second.kind} <= {FeatureKind.SPHERE, FeatureKind.POINT}:
        measured = float(np.linalg.norm(second.p - first.p))
        apart(rows, first, second, _radii(c, first.radius, second.radius, measured))
    else:
        raise UnknownPairing


def _side_of_plane(c: Constraint, radius: float, height: float) -> float:
    if c.side is Surface.EITHER:
        return math.copysign(radius, height)
    return radius if c.side is Surface.OUTSIDE else -radius


def _radii(c: Constraint, first: float, second: float, measured: float) -> float:
    outside, inside = first + second, abs(first - second)
    if c.side is Surface.EITHER:
        return outside if abs(measured - outside) <= abs(measured - inside) else inside
    return outside if c.side is Surface.OUTSIDE else inside
