"""Which joint each pair of bodies has, judged by what the whole assembly leaves free.

A contact that holds one way only may be a seat (a link lying on its neighbour) or a stop (a closed drawer).  Everything
is first taken as a seat; where the machine then cannot move, what stops it is taken as a stop.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Sequence

import numpy as np

from ...partition import Partition
from ...spatial import Array, cross
from ..touching.contact import Contact, ContactKind
from .bodies import Bodies
from .copies import Copies
from .edge import Decided, Edge
from .fasten import PRESSED, Bolted, Parts, bolts_apart, fasten, fasteners, fix_pins, press
from .freedom import RANK, Scale, freedom_of, held_both_ways, null_space
from .inherited import inherit
from .motions import held_rows, motions_of
from .pieces import parted
from .rolling import join_races, join_rollers
from .set_screws import fix_set_screws
from .shafts import shafts_of
from .twins import fix_loose

DENSE = 400
"""Bodies of a connected piece up to which its mobility is counted; beyond, seats stay seats."""


def decide(bodies: Bodies, parts: Parts, near: Sequence[tuple[int, int]]) -> Decided:
    """near: pairs of parts that come near each other.

    A pin is fixed to one of the bodies that it sits in with play; where these turn out not to turn against each other it
    is a shaft in its bearings, and everything is decided once more with it.
    """
    decided = _decided(bodies.copy(), parts, near, ())
    shafts = shafts_of(decided, DENSE)
    return _decided(bodies, parts, near, shafts) if shafts else decided


def _decided(
    bodies: Bodies, parts: Parts, near: Sequence[tuple[int, int]], shafts: Collection[int]
) -> Decided:
    join_races(bodies)
    join_rollers(bodies, near)
    bolted = fasten(bodies, parts)
    fix_set_screws(bodies, parts)
    single = _bolt_groups(bodies, parts, bolted)
    _clamp(bodies)
    press(bodies, parts)
    single = _bolt_groups(bodies, parts, single)  # in what has been pressed: inserts
    fix_loose(bodies, parts.kinds, fasteners(parts))
    fix_pins(bodies, parts, shafts)
    _fix_held(bodies)
    edges = _edges(bodies, single)
    copies = Copies(bodies.shapes, parts.poses, parts.kinds)
    edges = inherit(bodies, edges, copies, parts.kinds, near, fasteners(parts))
    return _settled(bodies, edges)


def _bolt_groups(bodies: Bodies, parts: Parts, bolted: Sequence[Bolted]) -> list[Bolted]:
    """Fix parts that bolts on two or more axes hold together; the bolts that are alone, or in line as a hinge's are."""
    while True:
        groups: defaultdict[tuple[int, int], list[Bolted]] = defaultdict(list)
        for b in bolted:
            pair = bodies.of(b.host), bodies.of(b.other)
            if pair[0] != pair[1]:
                groups[min(pair), max(pair)].append(b)
        several = [g for _, g in sorted(groups.items()) if bolts_apart(parts, [b.bolt for b in g])]
        if not several:
            return [b for _, g in sorted(groups.items()) for b in g]
        for group in several:
            for b in group:
                bodies.fix(b.host, b.other, "bolted", 0.95, (b.contact,))


def _clamp(bodies: Bodies) -> None:
    """What two halves grip that are drawn together over a gap: a pipe in its clamp."""
    touching = {
        (min(c.first, c.second), max(c.first, c.second))
        for c in bodies.contacts
        if c.kind is ContactKind.FLAT and c.touching
    }
    grips: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in bodies.contacts:
        if contact.kind is ContactKind.ARC and contact.touching:
            grips[contact.inner].append(contact)
    for part, contacts in sorted(grips.items()):
        halves = sorted({c.other(part) for c in contacts})
        for i, a in enumerate(halves):
            for b in halves[i + 1 :]:
                if bodies.of(a) == bodies.of(b) != bodies.of(part) and (a, b) not in touching:
                    bodies.fix(part, a, "clamped", 0.85, tuple(contacts))


def _fix_held(bodies: Bodies) -> None:
    """Join bodies that cannot move against each other in any direction, until there are none."""
    known: dict[
        tuple[int, int], int
    ] = {}  # contacts of a pair when it was last looked at: more can hold more
    while True:
        found = False
        for pair, contacts in bodies.pairs().items():
            if known.get(pair) == len(contacts):
                continue
            if pair != (bodies.of(pair[0]), bodies.of(pair[1])):
                continue  # one of them has just been joined to another
            known[pair] = len(contacts)
            freedom, _ = bodies.freedom(pair, contacts)
            if freedom.held.shape[1] == 0:
                first = contacts[0]
                found |= bodies.fix(first.first, first.second, "held", 0.85, tuple(contacts))
        if not found:
            return


def _edges(bodies: Bodies, single: Sequence[Bolted]) -> list[Edge]:
    alone: defaultdict[tuple[int, int], list[Bolted]] = defaultdict(list)
    for b in single:
        pair = bodies.of(b.host), bodies.of(b.other)
        if pair[0] != pair[1]:
            alone[min(pair), max(pair)].append(b)
    found: list[Edge] = []
    for pair, contacts in bodies.pairs().items():
        edge = _edge(bodies, pair, contacts, bool(alone.get(pair)))
        if edge is not None:
            found.append(edge)
    return found


def _edge(bodies: Bodies, pair: tuple[int, int], contacts: list[Contact], bolted: bool) -> Edge | None:
    freedom, scale = bodies.freedom(pair, contacts)
    kept, held = freedom.kept, freedom.held
    area = sum(c.area for c in contacts if c.touching)
    nothing = np.zeros((6, 0))
    if held.shape[1] == 6:
        if kept.shape[1] == 6:
            return None  # near, and nothing touches
        confidence = 0.6 if kept.shape[1] else 0.55
        return Edge(pair, contacts, scale, kept, confidence, "rests", None, True, area)
    screw = _screw(contacts, kept, scale)
    if screw is not None:
        return Edge(pair, contacts, scale, nothing, 0.6, "thread", screw, False, area)
    if bolted:
        return Edge(
            pair, contacts, scale, nothing, 0.6, "one bolt", kept if kept.shape[1] else held, False, area
        )
    if not _has_turn(kept) and _has_turn(held) or not kept.shape[1]:
        seats = [c for c in contacts if c.two_sided or not c.touching or _is_shoulder(c, contacts)]
        without, _ = bodies.freedom(pair, seats)
        if without.kept.shape[1] and held.shape[1] <= 2 and _has_turn(held):
            return Edge(
                pair,
                contacts,
                scale,
                _in_scale(bodies, pair, seats, scale),
                0.75,
                "fits, at a stop",
                None,
                False,
                area,
            )
        if not kept.shape[1]:
            return Edge(pair, contacts, scale, nothing, 0.6, "seated", held, False, area)
    if kept.shape[1] == held.shape[1]:
        return Edge(pair, contacts, scale, held, 0.9, "fits", None, False, area)
    return Edge(pair, contacts, scale, kept, 0.8, "fits and rests", None, False, area)


def _screw(contacts: Sequence[Contact], kept: Array, scale: Scale) -> Array | None:
    """The twist of a thread: of two bodies that turn and slide on one axis, where the shaft is drawn larger than its
    bore.  A bore at the core tells the pitch, P = (d - D) / 1.0825 (ISO 68-1); the thread is right-handed."""
    threads = [c for c in contacts if c.kind is ContactKind.FIT and c.gap < -PRESSED * c.a.radius]
    if not threads or kept.shape[1] not in (1, 2) or not _has_turn(kept):
        return None
    thread = max(threads, key=lambda c: c.reach)
    pitch = -2.0 * thread.gap / 1.0825
    axis, turn = thread.axis, 1.0 / scale.length
    # v = lead / 2 pi along the axis, and w x (center - p) about it
    arm = cross(axis, scale.center - thread.a.point)
    twist = np.concatenate([axis * pitch / (2.0 * np.pi) + arm, axis / turn])
    return (twist / np.linalg.norm(twist))[:, None]


def _in_scale(bodies: Bodies, pair: tuple[int, int], contacts: list[Contact], scale: Scale) -> Array:
    """What contacts leave free, about another centre than their own."""
    return freedom_of(contacts, [bodies.of(c.first) != pair[0] for c in contacts], scale).kept


def _has_turn(space: Array) -> bool:
    return bool(space.shape[1]) and float(np.abs(space[3:]).max()) > RANK


def _is_shoulder(contact: Contact, contacts: Iterable[Contact]) -> bool:
    """Whether a flat stands across the axis of a fit of the same two bodies."""
    if contact.kind is not ContactKind.FLAT:
        return False
    return any(c.is_axial and abs(float(contact.normals[0] @ c.axis)) > 1.0 - 1e-6 for c in contacts)


def _settled(bodies: Bodies, edges: list[Edge]) -> Decided:
    """Take what rests as joined where nothing else joins it; take back what stops the machine."""
    sure = [e for e in edges if not e.one_sided]
    resting = sorted(
        (e for e in edges if e.one_sided), key=lambda e: (e.space.shape[1], -round(e.area, 12), e.pair)
    )
    piece = Partition(len(bodies.shapes))
    for edge in sure:
        piece.join(*edge.pair)
    chosen, inside = list(sure), list[Edge]()
    for edge in resting:
        if piece.join(*edge.pair):
            chosen.append(edge)
        else:
            inside.append(edge)
    final: list[Edge] = []
    for own, others in parted(len(bodies.shapes), chosen, inside):
        final += _settle_piece(bodies, own, others)
    return Decided(bodies, sorted(final, key=lambda e: e.pair))


def _settle_piece(bodies: Bodies, edges: list[Edge], resting: list[Edge]) -> list[Edge]:
    """The joints of one machine: those that are doubtful as they let it move, and of what rests all but what would stop it."""
    members = sorted({b for e in [*edges, *resting] for b in e.pair})
    doubtful = [e for e in edges if e.otherwise is not None]
    if len(members) > DENSE or not (doubtful or resting):
        return [*edges, *resting]
    motions = motions_of(members, edges)
    if doubtful and not motions.shape[1]:
        for edge in doubtful:
            _swap(edge)
        moving = _untrapped(bodies, members, [*edges, *resting], motions_of(members, edges))
        for edge in doubtful:
            if not _moves(members, edge, moving):
                _swap(edge)
        motions = motions_of(members, edges)
    base = edges[0].scale
    for edge in resting:
        left = motions @ null_space(held_rows(members, edge, base) @ motions)
        if motions.shape[1] and not left.shape[1]:
            continue  # a stop, as of a drawer that is closed
        edges.append(edge)
        motions = left
    return edges


def _untrapped(bodies: Bodies, members: list[int], edges: Sequence[Edge], motions: Array) -> Array:
    """Of a machine's motions those that nothing bars from both sides: a key can leave the bottom of its groove as far as the
    other one is above it, and is held between both."""
    index = {body: 6 * i for i, body in enumerate(members)}
    rows = [np.zeros((0, motions.shape[1]))]
    for edge in edges:
        a, b = (motions[index[body] : index[body] + 6] for body in edge.pair)
        for contact in edge.contacts:
            if not contact.two_sided and len(contact.points):
                way = 1.0 if bodies.of(contact.first) == edge.pair[0] else -1.0
                rows.append(edges[0].scale.rows(contact.points, way * contact.normals) @ (b - a))
    barred = np.concatenate(rows)
    return motions @ null_space(barred[held_both_ways(barred)])


def _swap(edge: Edge) -> None:
    if edge.otherwise is not None:
        edge.space, edge.otherwise, edge.swapped = edge.otherwise, edge.space, not edge.swapped


def _moves(members: list[int], edge: Edge, motions: Array) -> bool:
    index = {body: i for i, body in enumerate(members)}
    a, b = (6 * index[body] for body in edge.pair)
    return bool(motions.shape[1]) and float(np.abs(motions[b : b + 6] - motions[a : a + 6]).max()) > 1e-6
