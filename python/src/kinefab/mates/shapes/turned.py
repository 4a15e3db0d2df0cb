"""Which parts are turned about an axis, and which of those are bolts, nuts and washers, by their shape."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace

import numpy as np

from ...model import FaceKind
from ...spatial import Array, cross, perpendicular
from .features import Round, Shape, corners_of
from .outlines import inside

NEAR = 1e-5
"""Share of the part's size, and sine, by which a face may be off the axis."""
STOUT = 3.0
"""How far a bolt's or nut's faces are from its axis, in radii of its shank or bore, at most; ISO 7045's pan heads reach 2.1."""
THREAD_END = 0.1
"""Area of a flat that ends a thread's groove, of the square of the part's radius, at most."""
DRIVE = re.compile(r"\b(lead|ball|feed|power|jack)[ -]?screws?\b", re.IGNORECASE)
"""A screw that turns and drives, and the nut on it."""
FASTENER = re.compile(
    r"\b(bolts?|screws?|nuts?|washers?|rivets?|studs?|dowels?|schrauben?|muttern?|scheiben?|vis|[eé]crou|rondelle)\b|"
    r"^M\d+([x.]\d+)?|\b(ISO|DIN|ANSI|EN)[ _-]*\d{3,}", re.IGNORECASE,
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Turned:
    """A part all of whose faces go round one axis, but for a spanner's flats and a thread.

    point, axis: in the frame of the shape.  sides: of the hexagon (or other regular polygon), 0 where there is none;
    across: from the axis to one of them, below zero where they face inwards.
    threaded: it has a helical face near an end, where a screw that drives has journals.  length: along the axis.
    radius: the largest, bore: the smallest, or 0; blind: whether a flat face shuts it.
    shank: the smallest round part of its outside, or 0.
    """

    point: Array
    axis: Array
    sides: int
    across: float
    threaded: bool
    length: float
    radius: float
    bore: float
    blind: bool
    shank: float

    @property
    def has_grip(self) -> bool:
        """Whether a tool grips it, as one does a bolt or a nut; a square cut on the end of a shaft carries a handle."""
        return self.threaded or (self.sides >= 4 and (self.across < 0.0 or self.across > self.shank))


def is_named_fastener(name: str) -> bool:
    words = name.replace("_", " ")
    return FASTENER.search(words) is not None and DRIVE.search(words) is None


def fastener(shape: Shape) -> Turned | None:
    """A part whose name says bolt, nut or washer as a turned one, without what is cut or cast on it beside its axis: the
    cross in a screw's head, the corners of a rectangular nut.  None where it is larger than those are, or not turned at all."""
    axial = [r for r in shape.rounds if r.kind is FaceKind.CYLINDER]
    if not axial:
        return None
    main = max(axial, key=lambda r: (r.span[1] - r.span[0]) * r.radius)
    round_it = [r for r in shape.rounds if _on_axis(r, main.point, main.direction, shape.size)]
    across = [f for f in shape.flats if abs(float(f.normal @ main.direction)) > 1.0 - NEAR]
    offset = corners_of(shape).reshape(-1, 3) - main.point
    off_axis = offset - np.outer(offset @ main.direction, main.direction)
    thinnest = min(r.radius for r in round_it if r.kind is FaceKind.CYLINDER)
    if float(np.linalg.norm(off_axis, axis=1).max()) > STOUT * thinnest:
        return None
    return turned(replace(shape, rounds=tuple(round_it), flats=tuple(across), others=np.zeros((0, 3))))


def turned(shape: Shape) -> Turned | None:
    """The part as a turned one, or None."""
    axial = [r for r in shape.rounds if r.kind is not FaceKind.SPHERE]
    if not axial:
        return None
    main = max(axial, key=lambda r: len(r.faces) * 0 + (r.span[1] - r.span[0]) * max(r.radius, r.minor, 1e-9))
    point, axis = main.point, main.direction
    if not all(_on_axis(r, point, axis, shape.size) for r in shape.rounds):
        return None
    threaded = len(shape.others) > 0 and _is_helical(shape.others, point, axis)
    if len(shape.others) and not threaded:
        return None
    radii = [r.radius for r in shape.rounds if r.kind is FaceKind.CYLINDER]
    end = THREAD_END * max(radii, default=0.0) ** 2 if threaded else 0.0
    sides: list[tuple[float, Array]] = []
    for flat in shape.flats:
        if flat.area < end:
            continue
        along = abs(float(flat.normal @ axis))
        if along > 1.0 - NEAR:
            continue
        if along > NEAR:
            return None
        sides.append((float((flat.point - point) @ flat.normal), flat.normal))
    count = _polygon(sides)
    if sides and not count:
        return None
    heights = [h for r in shape.rounds for h in _heights(r, point, axis)]
    heights += [float((f.corners[0, 0] - point) @ axis) for f in shape.flats]
    bores = [r.radius for r in shape.rounds if r.kind is FaceKind.CYLINDER and r.hollow]
    shanks = [r.radius for r in shape.rounds if r.kind is FaceKind.CYLINDER and not r.hollow]
    if threaded:
        along = (shape.others - point) @ axis
        plain = min(float(along.min()) - min(heights), max(heights) - float(along.max()))
        threaded = plain <= max(radii, default=0.0)
    return Turned(
        point, axis, count, sides[0][0] if sides else 0.0, threaded, max(heights) - min(heights),
        max(radii, default=0.0), min(bores, default=0.0), _is_shut(shape, point, axis), min(shanks, default=0.0),
    )  # fmt: skip


def _is_shut(shape: Shape, point: Array, axis: Array) -> bool:
    """Whether the axis goes through a flat face of the part."""
    for flat in shape.flats:
        slope = float(flat.normal @ axis)
        if abs(slope) > NEAR:
            foot = point + axis * (float((flat.point - point) @ flat.normal) / slope)
            if inside(flat.corners, flat.normal, foot[None])[0]:
                return True
    return False


def _on_axis(r: Round, point: Array, axis: Array, size: float) -> bool:
    apart = float(np.linalg.norm(cross(r.point - point, axis)))
    if apart > NEAR * size:
        return False
    return r.kind is FaceKind.SPHERE or float(np.linalg.norm(cross(r.direction, axis))) < NEAR


def _heights(r: Round, point: Array, axis: Array) -> tuple[float, float]:
    heights = (r.corners - point) @ axis
    return float(heights.min()), float(heights.max())


def _polygon(sides: list[tuple[float, Array]]) -> int:
    """Sides of the regular polygon that the flats along the axis make, 0 where they make none."""
    distances = sorted({round(abs(d) * 1e7) for d, _ in sides})
    count = len(sides)
    if len(distances) != 1 or count not in (4, 6, 8, 12) or distances[0] == 0:
        return 0
    normals = np.array([n for _, n in sides])
    x = normals[0]
    cosines = np.sort(normals @ x)
    wanted = np.sort(np.cos(2.0 * math.pi * np.arange(count) / count))
    return count if np.allclose(cosines, wanted, atol=1e-4) else 0


def _is_helical(points: Array, point: Array, axis: Array) -> bool:
    """Whether faces on no elementary surface lie about the axis at nearly one radius: a thread's flanks."""
    x = perpendicular(axis)
    offset = points - point
    radii = np.hypot(offset @ x, offset @ cross(axis, x))
    middle = np.abs(np.mean(offset - np.outer(offset @ axis, axis), axis=0)).max()
    low, high = float(radii.min()), float(radii.max())
    return low > 0.5 * high and middle < 0.2 * high
