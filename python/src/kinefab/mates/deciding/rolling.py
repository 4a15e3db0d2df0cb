"""Ball and roller bearings: two races become one joint, what rolls between them goes with the inner one."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ...model import FaceKind, FeatureKind
from ...spatial import cross
from ..shapes.features import Round, Shape
from ..touching.contact import Contact, ContactKind, Side, axial_rows
from ..touching.round_contacts import COAXIAL, WIDEST, coaxial, meeting
from .bodies import Bodies

FEWEST = 3
"""Rollers that hold two races on one axis."""


def join_races(bodies: Bodies) -> None:
    """Put a contact between the two races of each ball, and fix the balls to the inner race.

    A ball rolls at half the speed; that it goes with the inner ring is an approximation of no consequence to the rings.
    """
    by_ball: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in bodies.contacts:
        if contact.kind is ContactKind.GROOVE:
            by_ball[contact.inner].append(contact)
    joined: set[tuple[int, int]] = set()
    for ball, grooves in sorted(by_ball.items()):
        races = {contact.other(ball): contact for contact in grooves}
        inner = [c for c in races.values() if _pushes_out(c, ball)]
        outer = [c for c in races.values() if not _pushes_out(c, ball)]
        if not inner or not outer:
            continue
        a, b = outer[0], inner[0]
        bodies.fix(ball, b.other(ball), "rolls", 0.7, (b,))
        pair = a.other(ball), b.other(ball)
        side_a, side_b = a.side(pair[0]), b.side(pair[1])
        if pair in joined or side_a.direction is None or side_b.direction is None:
            continue
        off = float(np.linalg.norm(cross(side_b.point - side_a.point, side_a.direction)))
        if (
            off > 1e-3 * side_a.radius
            or float(np.linalg.norm(cross(side_a.direction, side_b.direction))) > 1e-4
        ):
            continue
        joined.add(pair)
        bodies.contacts.append(_race(pair, side_a, side_b))


def _pushes_out(contact: Contact, ball: int) -> bool:
    """Whether the race is inside: it pushes the ball away from the axis."""
    race = contact.side(contact.other(ball))
    push = contact.normals[0] if contact.second == ball else -contact.normals[0]
    return float(push @ (contact.points[0] - race.point)) > 0.0


def _race(pair: tuple[int, int], a: Side, b: Side) -> Contact:
    assert a.direction is not None
    half = 0.25 * a.radius
    points, normals = axial_rows(a.point, a.direction, (-half, half))
    points, normals = np.vstack([points, a.point]), np.vstack([normals, a.direction])
    if pair[0] > pair[1]:
        pair, a, b = (pair[1], pair[0]), b, replace(a)
    return Contact(ContactKind.RACE, *pair, a, b, 0.0, False, points, normals, True, -1, ((-half, half),))


def join_rollers(bodies: Bodies, near: Sequence[tuple[int, int]]) -> None:
    """Put a contact between two coaxial races with cylinders that touch both between them, and fix these to the inner race.

    near: pairs of parts that come near each other.  Nothing is held along the axis but by flanges, whose flats say so.
    """
    rollers = {
        part: roller for part, shape in enumerate(bodies.shapes) if (roller := _roller(shape)) is not None
    }
    races: defaultdict[int, list[tuple[int, Round]]] = defaultdict(list)
    for pair in near:
        for part, other in (pair, pair[::-1]):
            if part in rollers:
                races[part] += [(other, race) for race in _raced(rollers[part], bodies.shapes[other])]
    between: defaultdict[tuple[int, int], dict[int, tuple[Round, Round]]] = defaultdict(dict)
    for part, found in sorted(races.items()):
        for outer, bore in found:
            for inner, shaft in found:
                if bore.hollow and not shaft.hollow and outer != inner and coaxial(bore, shaft, bore.radius):
                    between[outer, inner].setdefault(part, (bore, shaft))
    for (outer, inner), rolling in sorted(between.items()):
        if len(rolling) < FEWEST or outer in rolling or inner in rolling:
            continue
        bore, shaft = next(iter(rolling.values()))
        contact = _rolled((outer, inner), bore, shaft)
        bodies.contacts.append(contact)
        for part in rolling:
            bodies.fix(part, inner, "rolls", 0.7, (contact,))


def _roller(shape: Shape) -> Round | None:
    """The barrel of a part that is a full cylinder, with rims perhaps; None of any other."""
    barrels = [r for r in shape.rounds if r.kind is FaceKind.CYLINDER]
    if len(barrels) != 1 or barrels[0].hollow or not barrels[0].is_round:
        return None
    return barrels[0]


def _raced(roller: Round, shape: Shape) -> Iterator[Round]:
    """The cylinders of a part that a roller rolls on, round its own axis or round the roller."""
    for race in shape.rounds:
        if race.kind is not FaceKind.CYLINDER or not race.is_round or race.radius <= roller.radius:
            continue
        if float(np.linalg.norm(cross(race.direction, roller.direction))) > COAXIAL:
            continue
        apart = float(np.linalg.norm(cross(roller.point - race.point, race.direction)))
        gap = race.radius - roller.radius - apart if race.hollow else apart - race.radius - roller.radius
        if abs(gap) <= WIDEST * roller.radius and meeting(race, roller):
            yield race


def _rolled(pair: tuple[int, int], bore: Round, shaft: Round) -> Contact:
    points, normals = axial_rows(bore.point, bore.direction, bore.span)
    a, b = (Side(FeatureKind.CYLINDER, r.point, r.direction, r.radius, r.faces) for r in (bore, shaft))
    spans = (bore.span,)
    if pair[0] > pair[1]:
        pair, a, b = (pair[1], pair[0]), replace(b, point=bore.point, direction=bore.direction), a
    return Contact(ContactKind.RACE, *pair, a, b, 0.0, False, points, normals, True, -1, spans)
