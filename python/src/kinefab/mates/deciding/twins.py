"""Copies decide alike: what is doubtful at one, and sure at another in corresponding surroundings, is taken from that one.

Two parts correspond as copies of one definition, or as shapes of like volume with like bores: a mirrored arm, or one with
another clearance or chamfer, is such a shape.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence

import numpy as np

from ...model import FaceKind
from ...spatial import Array
from ..shapes.features import Shape
from ..touching.contact import Contact
from .bodies import Bodies, Fixing

VOLUME, BORE = 0.02, 0.05
"""Shares by which volumes and bores of parts that correspond may differ."""


class Twins:
    """Fixings of some reasons, for each definition by the definitions of what its copies are fixed to.

    kinds: of each part its definition's number.  fixed: the parts in such a fixing.
    """

    def __init__(self, bodies: Bodies, kinds: Sequence[int], reasons: Collection[str]) -> None:
        self._bodies, self._kinds = bodies, kinds
        self._bores: dict[int, Array] = {}
        self.fixed: set[int] = set()
        self._hosts: defaultdict[int, dict[int, tuple[int, Fixing]]] = defaultdict(dict)
        for fixing in bodies.fixings:
            if fixing.reason in reasons:
                for part, host in ((fixing.first, fixing.second), (fixing.second, fixing.first)):
                    self._hosts[kinds[part]].setdefault(kinds[host], (host, fixing))
                    self.fixed.add(part)

    def host(self, part: int, by_body: Mapping[int, Sequence[Contact]]) -> tuple[int | None, Fixing | None]:
        """The body that corresponds to the one its twins are fixed to, with such a fixing; None where they do not say
        just one."""
        found: dict[int, Fixing] = {}
        for host, fixing in self._hosts.get(self._kinds[part], {}).values():
            for body, contacts in by_body.items():
                if any(self.correspond(host, contact.other(part)) for contact in contacts):
                    found.setdefault(body, fixing)
        return next(iter(found.items())) if len(found) == 1 else (None, None)

    def correspond(self, a: int, b: int) -> bool:
        """Whether two parts may take each other's place: one definition, or one volume and the same bores."""
        if self._kinds[a] == self._kinds[b]:
            return True
        first, second = self._bodies.shapes[a], self._bodies.shapes[b]
        if abs(first.volume - second.volume) > VOLUME * max(first.volume, second.volume):
            return False
        bores = self._bores_of(a), self._bores_of(b)
        return len(bores[0]) == len(bores[1]) > 0 and np.allclose(*bores, rtol=BORE, atol=0.0)

    def _bores_of(self, part: int) -> Array:
        kind = self._kinds[part]
        if kind not in self._bores:
            self._bores[kind] = _bores(self._bodies.shapes[part])
        return self._bores[kind]


def _bores(shape: Shape) -> Array:
    return np.sort([r.radius for r in shape.rounds if r.hollow and r.kind is FaceKind.CYLINDER])


def fix_loose(bodies: Bodies, kinds: Sequence[int], fasteners: Collection[int]) -> None:
    """Fix a fastener that is in no bore (its hole is drawn wider than a fit) to what its seat lies on, where a copy lies
    with the same face on a part that corresponds and is fixed to it, and no copy that lies so moves.

    fasteners: numbers of the parts that are bolts, nuts, washers.
    """
    twins = Twins(bodies, kinds, ("bolt", "nut", "washer"))
    moving: set[int] = set()
    seats: defaultdict[tuple[int, tuple[str, ...]], list[tuple[int, int, Contact]]] = defaultdict(list)
    for contact in bodies.contacts:
        pair = contact.first, contact.second
        if contact.two_sided and bodies.of(pair[0]) != bodies.of(pair[1]):
            moving.update(map(bodies.of, pair))
        if contact.touching and not contact.two_sided:
            for part in pair:
                seats[kinds[part], contact.side(part).faces].append((part, contact.other(part), contact))
    loose = {
        body
        for body, members in bodies.members().items()
        if body not in moving and all(part in fasteners for part in members)
    }
    for alike in [own for _, own in sorted(seats.items())] if loose else []:
        if any(bodies.of(p) in moving and bodies.of(p) != bodies.of(o) for p, o, _ in alike):
            continue
        for part, other, contact in alike:
            if bodies.of(part) not in loose or bodies.of(other) in loose:
                continue
            copies = [
                Fixing(p, o, "bolted", 0.9, (c,))
                for p, o, c in alike
                if bodies.of(p) == bodies.of(o) and p in twins.fixed and twins.correspond(o, other)
            ]
            if copies:
                bodies.fix(part, other, "bolted", 0.6, (contact,), copies[0])
