"""A joint that is doubtful between two parts, or not seen at all, is taken from the copies of these parts that are sure.

A copy is the same definition or a mirror image; the other part may be a copy too, or the same part with the features for it
again.  Twists go with a part: how a copy may move is what takes the part to it, applied to how the part may move, at whatever
place along its way the copy stands.  Taken is only what the copy's own contacts do not prevent, and where the features that
guide the sure one are there again, with whatever clearance; what locks more than was seen to be held is taken back where
nothing would move then.
"""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...model import FeatureKind, JointKind
from ...spatial import Array
from ..shapes.features import Shape
from ..touching.contact import Contact, ContactKind
from .bodies import Bodies, scale_of
from .copies import Copies, Move, is_there
from .edge import Edge, Twin
from .freedom import Scale, null_space
from .motions import shift_of
from .pairs import pair_of

SURE = 0.8
"""Confidence from which on a joint is what others take theirs from, where these are less sure by ``LESS``."""
LESS = 0.04
ONE_WAY = 0.05
"""What a contact that stands off on one side takes from how sure a joint is: the other side may have been left out."""
FIXINGS = frozenset({"bolted", "held", "clamped", "pressed", "bushing", "set screw"})
"""What fastens parts by themselves, not by what they are (a nut, a washer, a pin)."""
TAKEN = 0.7
"""Confidence of what is taken."""
SAID = frozenset(
    {
        JointKind.REVOLUTE,
        JointKind.CYLINDRICAL,
        JointKind.PRISMATIC,
        JointKind.PLANAR,
        JointKind.SPHERICAL,
        JointKind.PIN_SLOT,
    }
)
"""Joints that one mate says."""
MOST_ALIKE = 4
"""Sure joints of the same definitions that are kept, of each count of freedoms."""
WITHIN = 1e-4
"""How much of a unit twist may lie outside of a space that holds it."""
WIDE = 0.5
"""Share by which the radius of a feature that is there again may differ."""
FAR = 0.1
"""Share of the smaller part's size by which a flat that is there again may be farther off."""


@dataclass(frozen=True, slots=True, eq=False)
class Sure:
    """Two parts, and how the second's body moves against the first's.  contacts: those that say so.  space, scale: see Edge."""

    part: int
    other: int
    contacts: Sequence[Contact]
    space: Array
    scale: Scale
    confidence: float


@dataclass(slots=True, eq=False)
class _Doubt:
    """A pair of bodies.  edge: what was seen, None where nothing was.  parts: pairs of parts of theirs that are near."""

    pair: tuple[int, int]
    edge: Edge | None
    confidence: float
    parts: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])


def inherit(
    bodies: Bodies,
    edges: Sequence[Edge],
    copies: Copies,
    kinds: Sequence[int],
    near: Iterable[tuple[int, int]],
    fasteners: Collection[int],
) -> list[Edge]:
    """The edges, those in doubt replaced by what their twins are, and those that only twins tell of added.

    near: pairs of parts that come near each other.
    """
    confidence = {edge.pair: edge.confidence - ONE_WAY * _stands_off(bodies, edge) for edge in edges}
    known = _sure(bodies, edges, kinds, confidence, fasteners)
    if not known:
        return list(edges)
    doubts = _doubts(bodies, edges, near, confidence)
    beside: defaultdict[int, set[int]] = defaultdict(set)
    for doubt in doubts:
        for a, b in doubt.parts:
            beside[a].add(b)
            beside[b].add(a)
    found = {edge.pair: edge for edge in edges}
    twinning = _Twinning(bodies, copies, kinds, known, beside)
    for doubt in doubts:
        taken = _taken(bodies, doubt, list(twinning.offers(doubt)))
        if taken is not None:
            found[taken.pair] = taken
    return [found[pair] for pair in sorted(found)]


def _stands_off(bodies: Bodies, edge: Edge) -> bool:
    """Whether something is near on one side that neither touches nor is held from the other."""
    if all(contact.two_sided or contact.touching for contact in edge.contacts):
        return False
    freedom, _ = bodies.freedom(edge.pair, edge.contacts)
    return any(not closed and not c.touching for closed, c in zip(freedom.closed, edge.contacts))


def _sure(
    bodies: Bodies,
    edges: Sequence[Edge],
    kinds: Sequence[int],
    confidence: Mapping[tuple[int, int], float],
    fasteners: Collection[int],
) -> dict[int, list[Sure]]:
    """By the definition of the first part; of those alike in both definitions and freedoms a few."""
    found: defaultdict[int, list[Sure]] = defaultdict(list)
    seen: Counter[tuple[int, int, int]] = Counter()

    def add(a: int, b: int, contacts: Sequence[Contact], space: Array, scale: Scale, sure: float) -> None:
        for part, other in ((a, b), (b, a)):
            key = kinds[part], kinds[other], space.shape[1]
            seen[key] += 1
            if seen[key] <= MOST_ALIKE:
                found[kinds[part]].append(Sure(part, other, contacts, space, scale, sure))

    for edge in edges:
        if confidence[edge.pair] < SURE or edge.one_sided:
            continue
        if pair_of(edge.space, edge.scale).kind in SAID:
            for a, b in dict.fromkeys((contact.first, contact.second) for contact in edge.contacts):
                add(a, b, edge.contacts, edge.space, edge.scale, confidence[edge.pair])
    fixed = [f for f in bodies.fixings if f.reason in FIXINGS and f.confidence >= SURE and f.twin is None]
    of_part: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in bodies.contacts if fixed else ():
        of_part[contact.first].append(contact)
        of_part[contact.second].append(contact)
    for fixing in fixed:
        contacts = list(fixing.contacts)
        if fixing.reason == "bolted":
            ends = fixing.first, fixing.second
            bolts = [{c.other(part) for c in of_part[part]} for part in ends]
            through = bolts[0] & bolts[1] & set(fasteners)
            contacts = [c for part in ends for c in of_part[part] if c.other(part) in (*through, *ends)]
        add(fixing.first, fixing.second, contacts, np.zeros((6, 0)), scale_of(contacts), fixing.confidence)
    return dict(found)


def _doubts(
    bodies: Bodies,
    edges: Sequence[Edge],
    near: Iterable[tuple[int, int]],
    confidence: Mapping[tuple[int, int], float],
) -> list[_Doubt]:
    """Pairs of bodies that are near, but for those of which nothing could be surer."""
    by_pair = {edge.pair: edge for edge in edges}
    found: dict[tuple[int, int], _Doubt] = {}
    for a, b in near:
        first, second = bodies.of(a), bodies.of(b)
        pair = min(first, second), max(first, second)
        if first != second and confidence.get(pair, 0.0) < 0.9:
            found.setdefault(pair, _Doubt(pair, by_pair.get(pair), confidence.get(pair, 0.0))).parts.append(
                (a, b)
            )
    return [found[pair] for pair in sorted(found)]


@dataclass(frozen=True, slots=True, eq=False)
class _Offer:
    """How a sure joint would let two parts move, a copy and its other part.  space, scale: see Edge."""

    sure: Sure
    copy: int
    other: int
    space: Array
    scale: Scale


@dataclass(frozen=True, slots=True, eq=False)
class _Twinning:
    """kinds: of each part its definition.  known: sure joints by the first part's.  beside: of each part those near it
    whose joint with it is in doubt."""

    bodies: Bodies
    copies: Copies
    kinds: Sequence[int]
    known: Mapping[int, Sequence[Sure]]
    beside: Mapping[int, set[int]]

    def offers(self, doubt: _Doubt) -> Iterator[_Offer]:
        """What surer joints of its parts' copies would make of a doubt, where its own contacts let it move so."""
        contacts = [] if doubt.edge is None else doubt.edge.contacts
        for copy, other in (both for pair in doubt.parts for both in (pair, pair[::-1])):
            for sure, move in self._surer(copy, doubt.confidence):
                if not self._corresponds(sure, copy, other, move):
                    continue
                space, scale = move.twists(sure.space), move.scale(sure.scale)
                if _is_open(self.bodies, doubt.pair, contacts, space, scale):
                    yield _Offer(sure, copy, other, space, scale)

    def _surer(self, copy: int, confidence: float) -> Iterator[tuple[Sure, Move]]:
        """Joints of a part's copies that are surer than this, and what takes the copy to the part."""
        for kind in self.copies.like(copy):
            for sure in self.known.get(kind, ()):
                if sure.part != copy and sure.confidence >= confidence + LESS:
                    move = self.copies.move(sure.part, copy)
                    if move is not None:
                        yield sure, move

    def _corresponds(self, sure: Sure, copy: int, other: int, move: Move) -> bool:
        """Whether the other part of a copy is to it what the other part of its twin is to that."""
        bodies, kinds = self.bodies, self.kinds
        if kinds[sure.other] == kinds[other] and sure.other != other:
            carried = self.copies.move(sure.other, other)
            if carried is not None and _same_move(carried, move, bodies.shapes[other]):
                return True
        elif sure.other != other and kinds[other] not in self.copies.like(sure.other):
            return False
        body = bodies.of(other)
        parts = [p for p in sorted(self.beside.get(copy, {other})) if bodies.of(p) == body]
        shapes = [bodies.shapes[p] for p in parts or [other]]
        return _guided(bodies, sure, move, bodies.shapes[copy], shapes)


def _taken(bodies: Bodies, doubt: _Doubt, offers: Sequence[_Offer]) -> Edge | None:
    """The joint of the twins; None where there are none, or they do not agree."""
    if not offers:
        return None
    first, *more = offers
    sure, copy, other, space, scale = first.sure, first.copy, first.other, first.space, first.scale
    if any(not _same(space, scale, offer.space, offer.scale) for offer in more):
        return None
    own = doubt.edge
    contacts = [] if own is None else own.contacts
    a = copy if bodies.of(copy) == doubt.pair[0] else other
    b = other if a == copy else copy
    twin = Twin(sure.part, sure.other, copy, other, tuple(sure.contacts))
    reason = "near" if own is None else own.reason
    taken = Edge(doubt.pair, contacts, scale, space, TAKEN, reason, parts=(a, b), twin=twin)
    if own is not None:
        if not own.one_sided and _same(space, scale, own.space, own.scale):
            return None  # it was seen alike
        base = contacts[0]
        taken.parts = (
            (base.first, base.second) if bodies.of(base.first) == doubt.pair[0] else (base.second, base.first)
        )
        taken.area = own.area
        seen = shift_of(scale, own.scale) @ own.space if own.space.shape[1] else own.space
        if not own.one_sided and not _within(seen, space):
            taken.otherwise = np.linalg.qr(seen)[0]
    return taken


def _same_move(a: Move, b: Move, shape: Shape) -> bool:
    middle = 0.5 * (shape.low + shape.high)
    apart = float(np.linalg.norm(a.point(middle) - b.point(middle)))
    return apart <= 1e-4 * shape.size and float(np.abs(a.matrix - b.matrix).max()) <= 1e-4


def _guided(bodies: Bodies, sure: Sure, move: Move, copy: Shape, shapes: Sequence[Shape]) -> bool:
    """Whether what guides the sure one is there for the copy: every bore, shaft or ball, and a flat for each direction in
    which flats hold it."""
    size = min([copy.size, *(shape.size for shape in shapes)])
    low, high = copy.low - FAR * size, copy.high + FAR * size
    rounds = [r for shape in shapes for r in shape.rounds_near(low, high)]
    flats = [f for shape in shapes for f in shape.flats_near(low, high)]
    other = bodies.of(sure.other)
    fixed = other == bodies.of(sure.part)
    directions: list[tuple[Array, bool]] = []
    guides = 0
    for contact in sure.contacts:
        inside = [
            p
            for p in (contact.first, contact.second)
            if (p == sure.other if fixed else bodies.of(p) == other)
        ]
        if not inside:
            continue
        part, side = inside[0], contact.side(inside[0])
        if side.kind is FeatureKind.PLANE:
            normal, point = move.direction(side.direction), move.point(side.point)  # type: ignore[arg-type]
            there = any(
                float(f.normal @ normal) > 1.0 - 1e-5 and abs(float((f.point - point) @ normal)) <= FAR * size
                for f in flats
            )
            same = next((i for i, (d, _) in enumerate(directions) if abs(float(d @ normal)) > 1.0 - 1e-5), -1)
            if same < 0:
                directions.append((normal, there))
            elif there:
                directions[same] = (normal, True)
            continue
        if contact.kind in (ContactKind.LINE, ContactKind.POINT, ContactKind.GROOVE):
            continue  # the flat, or the ball, of it is on the other side
        guides += 1
        direction = None if side.direction is None else move.direction(side.direction)
        hollow = contact.inner not in (-1, part)
        if contact.kind is ContactKind.RACE:
            continue
        if not any(
            is_there(r, hollow, move.point(side.point), direction, side.radius, size, WIDE) for r in rounds
        ):
            return False
    return all(there for _, there in directions) and bool(guides or directions)


def _is_open(
    bodies: Bodies, pair: tuple[int, int], contacts: list[Contact], space: Array, scale: Scale
) -> bool:
    """Whether the copy's own contacts let it move so, and leave no more where what is near held it both ways."""
    if not contacts:
        return True
    freedom, own = bodies.freedom(pair, contacts)
    moved = shift_of(own, scale) @ space if space.shape[1] else space
    if not _within(moved, freedom.held):
        return False
    if not any(c.two_sided for c in contacts):
        return True
    every = [own.rows(c.points, c.normals) for c in contacts if len(c.points)]
    return _within(null_space(np.concatenate(every)), moved)


def _same(a: Array, at: Scale, b: Array, other: Scale) -> bool:
    if a.shape[1] != b.shape[1]:
        return False
    return not b.shape[1] or _within(shift_of(at, other) @ b, a)


def _within(vectors: Array, space: Array) -> bool:
    """Whether twists lie in the span of others."""
    if not vectors.shape[1]:
        return True
    if not space.shape[1]:
        return False
    unit = vectors / np.linalg.norm(vectors, axis=0)
    basis = np.linalg.qr(space)[0]
    return float(np.abs(unit - basis @ (basis.T @ unit)).max()) <= WITHIN
