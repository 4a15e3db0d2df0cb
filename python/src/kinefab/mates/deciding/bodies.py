"""Parts joined to rigid bodies step by step, and the contacts between the bodies."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from ...partition import Partition
from ...spatial import Array, cross
from ..shapes.features import Shape
from ..touching.contact import Contact, ContactKind
from .freedom import Freedom, Scale, freedom_of

RIM = 0.25
"""Length of a fit, of its radius, up to which it guides nothing against a longer one across: a disc in a pipe turns on its shaft."""
AIR, AIR_TO_CLOSEST = 0.05, 10.0
"""Share of the radius, and how many times the closest fit's, a clearance is at least that is air beside a closer fit."""


@dataclass(frozen=True, slots=True, eq=False)
class Fixing:
    """Why two parts are one body.  confidence: 0..1.  contacts: those that say so.  twin: the fixing of a copy that it
    was decided like."""

    first: int
    second: int
    reason: str
    confidence: float
    contacts: tuple[Contact, ...] = ()
    twin: Fixing | None = None


@dataclass(slots=True, eq=False)
class Bodies:
    """shapes: of each part, WORLD.  contacts: of the parts, those that are still believed in."""

    shapes: list[Shape]
    contacts: list[Contact]
    fixings: list[Fixing] = field(default_factory=list[Fixing])
    _sets: Partition = field(init=False)
    _count: list[int] = field(init=False)

    def __post_init__(self) -> None:
        self._sets = Partition(len(self.shapes))
        self._count = [1] * len(self.shapes)

    def copy(self) -> Bodies:
        """The same parts, contacts and fixings, to go on apart."""
        same = Bodies(self.shapes, [*self.contacts], [*self.fixings])
        same._sets, same._count = self._sets.copy(), [*self._count]
        return same

    def of(self, part: int) -> int:
        """The body of a part: the number of its first part."""
        return self._sets.find(part)

    def count(self, part: int) -> int:
        """How many parts its body has."""
        return self._count[self.of(part)]

    def fix(
        self, first: int, second: int, reason: str, confidence: float, contacts: tuple[Contact, ...] = (),
        twin: Fixing | None = None,
    ) -> bool:  # fmt: skip
        """Make two parts one body; whether they were two."""
        a, b = self.of(first), self.of(second)
        if not self._sets.join(a, b):
            return False
        self._count[min(a, b)] += self._count[max(a, b)]
        self.fixings.append(Fixing(first, second, reason, confidence, contacts, twin))
        return True

    def members(self) -> dict[int, list[int]]:
        """Parts of each body, in their order."""
        found: defaultdict[int, list[int]] = defaultdict(list)
        for part in range(len(self.shapes)):
            found[self.of(part)].append(part)
        return dict(found)

    def pairs(self) -> dict[tuple[int, int], list[Contact]]:
        """Contacts between different bodies, by the bodies, lower number first; in order.  Of fits only those that guide."""
        found: defaultdict[tuple[int, int], list[Contact]] = defaultdict(list)
        for contact in self.contacts:
            a, b = self.of(contact.first), self.of(contact.second)
            if a != b:
                found[min(a, b), max(a, b)].append(contact)
        return {pair: _guiding(contacts) for pair, contacts in sorted(found.items())}

    def freedom(self, pair: tuple[int, int], contacts: list[Contact]) -> tuple[Freedom, Scale]:
        """What contacts leave free of the second body of a pair against the first."""
        scale = scale_of(contacts)
        flips = [self.of(contact.first) != pair[0] for contact in contacts]
        return freedom_of(contacts, flips, scale), scale


def _guiding(contacts: list[Contact]) -> list[Contact]:
    """Without what is no guide beside a fit that is one: wide fits (a ring of a gimbal has air round it, and pivots in
    it), the rims of discs that turn on a shaft across, and flats that a turn about the fit's axis swings clear of."""
    closest = min((max(c.gap, 0.0) for c in contacts if c.kind is ContactKind.FIT), default=0.0)
    close = [
        c
        for c in contacts
        if c.kind is not ContactKind.FIT or c.gap <= AIR * c.a.radius or c.gap <= AIR_TO_CLOSEST * closest
    ]
    fits = [c for c in close if c.kind is ContactKind.FIT]
    long = [c for c in fits if c.reach >= c.a.radius]
    guides = [c for c in fits if c.reach > RIM * c.a.radius or not any(_across(c, other) for other in long)]
    guided = len(guides) > 0 and not any(_across(guides[0], other) for other in guides)
    rims = {id(c) for c in fits} - {id(c) for c in guides}
    return [c for c in close if id(c) not in rims and not (guided and _swings_clear(c, guides[0]))]


def _across(a: Contact, b: Contact) -> bool:
    """Whether two fits have axes of different directions."""
    return abs(float(a.axis @ b.axis)) < 1.0 - 1e-4


def _swings_clear(flat: Contact, fit: Contact) -> bool:
    """Whether two flats that face each other over a gap, along the axis of a fit, let the inner one turn past the outer."""
    if flat.kind is not ContactKind.FLAT or flat.touching or not len(flat.points):
        return False
    normal = flat.normals[0]
    if abs(float(normal @ fit.axis)) > 1e-6:
        return False
    inner, outer = sorted((float((side.point - fit.a.point) @ normal) for side in (flat.a, flat.b)), key=abs)
    along = (flat.points - fit.a.point) @ cross(fit.axis, normal)
    return inner * outer > 0.0 and float(np.hypot(inner, np.abs(along).max())) < abs(outer)


def scale_of(contacts: list[Contact]) -> Scale:
    """A centre and a length to which the contacts' lever arms compare."""
    points = [c.points for c in contacts if len(c.points)]
    everything = np.concatenate(points) if points else np.zeros((1, 3))
    low, high = everything.min(axis=0), everything.max(axis=0)
    length = float(np.linalg.norm(high - low))
    radii = [s.radius for c in contacts for s in (c.a, c.b)]
    return Scale(0.5 * (low + high), max(length, max(radii, default=0.0), 1e-9))


def spread(points: Array) -> float:
    """Diagonal of the box of points, shape (n, 3), in their unit; 0 of none."""
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0
