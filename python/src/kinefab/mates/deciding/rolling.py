"""Ball bearings: two races become one joint, the balls go with the inner one."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import replace

import numpy as np

from ...spatial import cross
from ..touching.contact import Contact, ContactKind, Side, axial_rows
from .bodies import Bodies


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
