"""Pins that are shafts: they sit with play in bodies that do not turn against each other."""

from __future__ import annotations

from collections import defaultdict

from ..touching.contact import Contact, ContactKind
from .edge import Decided
from .motions import motions_of
from .pieces import parted

TURN = 1e-6
"""Entries of orthonormal twists below this are rounding."""


def shafts_of(decided: Decided, most: int) -> set[int]:
    """Parts fixed as pins that nothing turns on.  most: bodies of a machine beyond which nobody looks."""
    bodies = decided.bodies
    pins = [f.first for f in bodies.fixings if f.reason == "pin" and not any(c.touching for c in f.contacts)]
    if not pins:
        return set()
    bores: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in bodies.contacts:
        if contact.kind is ContactKind.FIT and bodies.of(contact.first) != bodies.of(contact.second):
            bores[contact.inner].append(contact)
    still, turning = set[int](), set[int]()
    for edges, _ in parted(len(bodies.shapes), decided.edges, ()):
        members = sorted({body for edge in edges for body in edge.pair})
        index = {body: 6 * i + 3 for i, body in enumerate(members)}
        asked = [
            (pin, contact, index[bodies.of(pin)], index[bodies.of(contact.other(pin))])
            for pin in pins
            for contact in bores[pin]
            if bodies.of(pin) in index and bodies.of(contact.other(pin)) in index
        ]
        if not asked or len(members) > most:
            turning.update(pin for pin, *_ in asked)
            continue
        motions = motions_of(members, edges)
        for pin, contact, host, other in asked:
            turned = contact.axis @ (motions[other : other + 3] - motions[host : host + 3])
            (turning if float(abs(turned).max(initial=0.0)) > TURN else still).add(pin)
    return still - turning
