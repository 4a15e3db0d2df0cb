"""Contacts of cylinders, cones, balls and races with their counterparts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from ...model import FaceKind, FeatureKind
from ...spatial import Array, cross
from ..shapes.features import Flat, Round, Shape, merged, sorted_pair
from ..shapes.outlines import inside
from .contact import Contact, ContactKind, Side, axial_rows

COAXIAL = 2e-5
"""Share of the smaller part's size by which axes and centres may be apart, and sine between axes."""
WIDEST = 0.15
"""Share of a bore's radius that its shaft may be smaller by."""
TIGHTEST = 0.25
"""Share of a bore's radius that its shaft may be larger by: threads are drawn so."""
SHORTEST = 0.02
"""Share of the radius that a shaft must be in its bore."""
ARC_POINTS = 5


def round_contacts(
    first: int, second: int, a: Shape, b: Shape, low: Array, high: Array, near: float, touch: float
) -> Iterator[Contact]:
    """Contacts of the surfaces of revolution of two parts that meet the box from ``low`` to ``high``.

    near: clearance up to which a flat holds a shaft or ball.  touch: up to which there is none.  Metres.
    """
    rounds_a, rounds_b = a.rounds_near(low, high), b.rounds_near(low, high)
    size = min(a.size, b.size)
    for ra in rounds_a:
        for rb in rounds_b:
            if ra.hollow is not rb.hollow:
                yield from _between(first, second, ra, rb, size, touch)
    for rounds, flats, flip in (
        (rounds_a, b.flats_near(low, high), True),
        (rounds_b, a.flats_near(low, high), False),
    ):
        for r in rounds:
            if r.hollow or r.kind not in (FaceKind.CYLINDER, FaceKind.SPHERE):
                continue
            for flat in flats:
                yield from _on_flat(first, second, r, flat, flip, near, touch)


@dataclass(frozen=True, slots=True, eq=False)
class _Pair:
    """A round of one part beside a hollow round of the other.

    first, second: the parts.  a, b: the round of each.  shaft, bore: the same two, the full one and the hollow one.
    inner: the part whose round is the shaft.  size: of the smaller part, metres.
    """

    first: int
    second: int
    a: Round
    b: Round
    shaft: Round
    bore: Round
    inner: int
    size: float


def _between(first: int, second: int, a: Round, b: Round, size: float, touch: float) -> Iterator[Contact]:
    inner = first if b.hollow else second
    shaft, bore = (a, b) if b.hollow else (b, a)
    contacts = _BETWEEN.get((shaft.kind, bore.kind))
    if contacts is not None:
        yield from contacts(_Pair(first, second, a, b, shaft, bore, inner, size), touch)


def _ball(pair: _Pair, touch: float) -> Iterator[Contact]:
    shaft, bore = pair.shaft, pair.bore
    gap = bore.radius - shaft.radius
    apart = float(np.linalg.norm(shaft.point - bore.point))
    if apart <= COAXIAL * pair.size and -0.01 * bore.radius <= gap <= WIDEST * bore.radius:
        sides = _side(pair.a, FeatureKind.SPHERE), _side(pair.b, FeatureKind.SPHERE)
        points = np.repeat(shaft.point[None], 3, axis=0)
        yield Contact(
            ContactKind.BALL, pair.first, pair.second, *sides, gap, gap <= touch, points, np.eye(3), True, pair.inner
        )  # fmt: skip


def _race(pair: _Pair, touch: float) -> Iterator[Contact]:
    """A ball in the groove of a bearing's ring."""
    ball, ring = pair.shaft, pair.bore
    offset = ball.point - ring.point
    height = float(offset @ ring.direction)
    radial = offset - ring.direction * height
    off = math.hypot(height, float(np.linalg.norm(radial)) - ring.radius)
    gap = ring.minor - ball.radius
    if off > 10.0 * COAXIAL * pair.size + abs(gap) or not -0.01 * ring.minor <= gap <= WIDEST * ring.minor:
        return
    within = ring.corners - ring.point
    radii = np.linalg.norm(within - np.outer(within @ ring.direction, ring.direction), axis=1)
    outward = radial / max(float(np.linalg.norm(radial)), 1e-300)
    push = outward if float(radii.mean()) < ring.radius else -outward  # from the race into the ball
    race = Side(FeatureKind.CIRCLE, ring.point, ring.direction, ring.radius, ring.faces)
    held = _side(ball, FeatureKind.POINT)
    sides, normal = ((held, race), -push) if pair.inner == pair.first else ((race, held), push)
    yield Contact(
        ContactKind.GROOVE, pair.first, pair.second, *sides, gap, True, ball.point[None], normal[None], False, pair.inner
    )  # fmt: skip


def _tube(pair: _Pair, touch: float) -> Iterator[Contact]:
    ball, bore = pair.shaft, pair.bore
    if not bore.is_round:
        return
    offset = ball.point - bore.point
    height = float(offset @ bore.direction)
    gap = bore.radius - ball.radius
    off = float(np.linalg.norm(offset - bore.direction * height))
    if (
        off <= COAXIAL * pair.size
        and -0.01 * bore.radius <= gap <= WIDEST * bore.radius
        and bore.span[0] <= height <= bore.span[1]
    ):
        a, b = (_side(r, FeatureKind.POINT if r is ball else FeatureKind.LINE) for r in (pair.a, pair.b))
        points, normals = axial_rows(ball.point, bore.direction, (0.0, 0.0))
        yield Contact(
            ContactKind.TUBE, pair.first, pair.second, a, b, gap, gap <= touch, points[:2], normals[:2], True, pair.inner
        )  # fmt: skip


def _side(r: Round, kind: FeatureKind) -> Side:
    return Side(
        kind,
        r.point,
        None if kind in (FeatureKind.POINT, FeatureKind.SPHERE) else r.direction,
        r.radius,
        r.faces,
    )


def coaxial(a: Round, b: Round, size: float) -> bool:
    """Whether the axes of two rounds are one, to ``COAXIAL`` of a size in metres and in radians."""
    offset = b.point - a.point
    apart = float(np.linalg.norm(cross(offset, a.direction)))
    return apart <= COAXIAL * size and float(np.linalg.norm(cross(a.direction, b.direction))) <= COAXIAL


def _in_terms_of(a: Round, b: Round) -> tuple[float, float]:
    """b's extent along a's axis, from a's point."""
    sign = 1.0 if float(a.direction @ b.direction) > 0.0 else -1.0
    shift = float((b.point - a.point) @ a.direction)
    return sorted_pair(shift + sign * b.span[0], shift + sign * b.span[1])


def meeting(a: Round, b: Round) -> tuple[tuple[float, float], ...]:
    """Where both are, along a's axis from a's point, in order; faces that follow on each other as one."""
    sign = 1.0 if float(a.direction @ b.direction) > 0.0 else -1.0
    shift = float((b.point - a.point) @ a.direction)
    others = [sorted_pair(shift + sign * low, shift + sign * high) for low, high in b.spans]
    found: list[tuple[float, float]] = []
    for low, high in sorted((max(la, lb), min(ha, hb)) for la, ha in a.spans for lb, hb in others):
        if high <= low:
            continue
        if found and low <= found[-1][1] + 1e-9:
            found[-1] = (found[-1][0], max(found[-1][1], high))
        else:
            found.append((low, high))
    return tuple(found)


def _fit(pair: _Pair, touch: float) -> Iterator[Contact]:
    a, b, shaft, bore = pair.a, pair.b, pair.shaft, pair.bore
    gap = bore.radius - shaft.radius
    if not -TIGHTEST * bore.radius <= gap <= WIDEST * bore.radius or not coaxial(a, b, pair.size):
        return
    spans = meeting(a, b)
    if sum(high - low for low, high in spans) < SHORTEST * bore.radius:
        return
    span = spans[0][0], spans[-1][1]
    sides = _side(a, FeatureKind.CYLINDER), _side(b, FeatureKind.CYLINDER)
    common = _common_arcs(a, b)
    if sum(high - low for low, high in common) >= math.radians(200.0):
        points, normals = axial_rows(a.point, a.direction, span)
        yield Contact(
            ContactKind.FIT, pair.first, pair.second, *sides, gap, gap <= touch, points, normals, True, pair.inner, spans,
            shaft_span=_in_terms_of(a, shaft),
        )  # fmt: skip
        return
    if not common or gap < -0.01 * bore.radius:
        return
    x, y = a.secondary, cross(a.direction, a.secondary)
    angles = np.concatenate([np.linspace(low, high, ARC_POINTS) for low, high in common])
    outward = np.outer(np.cos(angles), x) + np.outer(np.sin(angles), y)
    points = np.concatenate([a.point + a.direction * height + shaft.radius * outward for height in span])
    away = np.concatenate([outward, outward])
    # what is inside is pushed inwards: towards the second part where that is the shaft
    normals = -away if pair.inner == pair.second else away
    yield Contact(
        ContactKind.ARC,
        pair.first,
        pair.second,
        *sides,
        gap,
        gap <= touch,
        points,
        normals,
        False,
        pair.inner,
        spans,
    )


def _common_arcs(a: Round, b: Round) -> list[tuple[float, float]]:
    """Extents about a's axis, from a's secondary, that both cover."""
    x, y = a.secondary, cross(a.direction, a.secondary)
    start = math.atan2(float(b.secondary @ y), float(b.secondary @ x))
    sign = 1.0 if float(a.direction @ b.direction) > 0.0 else -1.0
    others = merged([sorted_pair(start + sign * low, start + sign * high) for low, high in b.arcs])
    found = [
        (max(low, low_b), min(high, high_b))
        for low, high in merged(a.arcs)
        for low_b, high_b in others
        if min(high, high_b) - max(low, low_b) > 1e-3
    ]
    return found


def _cone(pair: _Pair, touch: float) -> Iterator[Contact]:
    a, b, shaft, bore = pair.a, pair.b, pair.shaft, pair.bore
    if (
        abs(a.half_angle - b.half_angle) > 1e-4
        or not coaxial(a, b, pair.size)
        or float(a.direction @ b.direction) < 0.0
    ):
        return
    height = float((shaft.point - bore.point) @ bore.direction)
    gap = height * math.sin(bore.half_angle)
    spans = meeting(a, b)
    if abs(gap) > max(touch, 1e-3 * pair.size) or not spans:
        return
    span = spans[0][0], spans[-1][1]
    points, normals = axial_rows(a.point, a.direction, span)
    sides = _side(a, FeatureKind.LINE), _side(b, FeatureKind.LINE)
    yield Contact(
        ContactKind.CONE, pair.first, pair.second, *sides, gap, True, points, normals, True, pair.inner, spans
    )
    leaving = bore.direction if pair.inner == pair.second else -bore.direction
    yield Contact(
        ContactKind.FLAT, pair.first, pair.second, _seat(a), _seat(b), gap, True, a.point[None] + a.direction * span[1], leaving[None],
        False, pair.inner, spans,
    )  # fmt: skip


_BETWEEN: dict[tuple[FaceKind, FaceKind], Callable[[_Pair, float], Iterator[Contact]]] = {
    (FaceKind.CYLINDER, FaceKind.CYLINDER): _fit,
    (FaceKind.CONE, FaceKind.CONE): _cone,
    (FaceKind.SPHERE, FaceKind.SPHERE): _ball,
    (FaceKind.SPHERE, FaceKind.TORUS): _race,
    (FaceKind.SPHERE, FaceKind.CYLINDER): _tube,
}
"""Of a shaft's face and a bore's: the contacts that they make."""


def _seat(r: Round) -> Side:
    return Side(FeatureKind.PLANE, r.point, r.direction if not r.hollow else -r.direction, 0.0, r.faces)


def _on_flat(
    first: int, second: int, r: Round, flat: Flat, flip: bool, near: float, touch: float
) -> Iterator[Contact]:
    """flip: the round is the first part's."""
    height = float((r.point - flat.point) @ flat.normal)
    gap = height - r.radius
    if not -touch <= gap <= near:
        return
    foot = r.point - flat.normal * height
    normal = -flat.normal if flip else flat.normal
    if r.kind is FaceKind.SPHERE:
        if inside(flat.corners, flat.normal, foot[None])[0]:
            sides = (
                (_side(r, FeatureKind.SPHERE), _plane(flat))
                if flip
                else (_plane(flat), _side(r, FeatureKind.SPHERE))
            )
            yield Contact(
                ContactKind.POINT, first, second, *sides, gap, gap <= touch, foot[None], normal[None], False
            )
        return
    if abs(float(r.direction @ flat.normal)) > COAXIAL or not _faces(r, -flat.normal):
        return
    low, high = r.span
    heights = np.linspace(low, high, 17)
    points = foot + np.outer(heights, r.direction)
    on = np.flatnonzero(inside(flat.corners, flat.normal, points))
    if len(on) < 2:
        return
    ends = points[[on[0], on[-1]]]
    sides = (
        (_side(r, FeatureKind.CYLINDER), _plane(flat))
        if flip
        else (_plane(flat), _side(r, FeatureKind.CYLINDER))
    )
    yield Contact(
        ContactKind.LINE, first, second, *sides, gap, gap <= touch, ends, np.array([normal, normal]), False,
        first if flip else second,
    )  # fmt: skip


def _faces(r: Round, direction: Array) -> bool:
    """Whether the faces of a cylinder are on its side in that direction."""
    angle = math.atan2(float(direction @ cross(r.direction, r.secondary)), float(direction @ r.secondary)) % (
        2.0 * math.pi
    )
    return any(low - 1e-3 <= angle <= high + 1e-3 for low, high in merged(r.arcs))


def _plane(flat: Flat) -> Side:
    return Side(FeatureKind.PLANE, flat.point, flat.normal, 0.0, (flat.face,))
