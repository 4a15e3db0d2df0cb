"""What holds parts together for good: bolts, nuts, washers, pressed and lined fits, pins in the part that carries them.

Judged by shape and clearance, by a name only where that says bolt, nut or washer.  A pin is a turned part inside two or
more bodies: that it spins cannot be seen, so it is fixed to the body that it sits tightest in.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np

from ...spatial import Pose, cross
from ..shapes.turned import Turned
from ..touching.contact import Contact, ContactKind, shared
from .bodies import Bodies
from .twins import Twins

THIN = 0.6
"""Thickness of a washer, as a share of its bore's diameter, at most."""
WIDE = 2.0
"""How many times its bore's radius a washer is wide, at most; more often on a bolt: beyond, a disc or a wheel turns so."""
WIDE_ON_BOLT = 3.5  # ISO 7094's extra large ones reach 3.3
THIN_AND_WIDE = 0.4
"""The same share for those that are wide; ISO 7094's reach 0.36, where a roller on a bolt is thicker."""
NUT = 2.5
"""How far a nut's sides are from its axis, in radii of its bore, at most; ISO 4032's M3 with the bore at the core has 2.2."""
LINED = 0.5
"""Share of where a bushing is in its bore that the shaft is in it, at least."""
PRESSED = 0.01
"""Share of the radius by which a pressed shaft may be larger than its bore; beyond, a thread is drawn so."""


@dataclass(frozen=True, slots=True, eq=False)
class Bolted:
    """A bolt that goes from the body it is fixed in to another part.  contact: its fit there, or its head's flat."""

    bolt: int
    host: int
    other: int
    contact: Contact


@dataclass(frozen=True, slots=True, eq=False)
class Parts:
    """What is known of single parts.  turned: or None.  named: whether the name says fastener.  kinds: a number for each
    definition, that of all its copies.  poses: WORLD."""

    turned: Sequence[Turned | None]
    named: Sequence[bool]
    kinds: Sequence[int]
    poses: Sequence[Pose]

    def is_fastener(self, part: int) -> bool:
        form = self.turned[part]
        return form is not None and (form.has_grip or self.named[part])


def fits_of(bodies: Bodies) -> dict[int, list[Contact]]:
    """The fits of each part, arcs left out."""
    found: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in bodies.contacts:
        if contact.kind is ContactKind.FIT:
            found[contact.first].append(contact)
            found[contact.second].append(contact)
    return found


def fasten(bodies: Bodies, parts: Parts) -> list[Bolted]:
    """Fix what is fastened; the bolts that hold two parts, for the assembly to judge."""
    fits = fits_of(bodies)
    flats: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in bodies.contacts:
        if contact.kind in (ContactKind.FLAT, ContactKind.CONE) and contact.touching:
            flats[contact.first].append(contact)
            flats[contact.second].append(contact)
    rolling = {c.inner for c in bodies.contacts if c.kind is ContactKind.LINE}
    _nuts(bodies, parts, fits)
    _washers(bodies, parts, fits, rolling)
    return _bolts(bodies, parts, fits, flats)


def bolts_apart(parts: Parts, bolts: Sequence[int]) -> bool:
    """Whether bolts stand on two or more axes: on one they let what they hold turn, as a hinge's do."""
    first, *others = bolts
    form = parts.turned[first]
    assert form is not None
    point, axis = parts.poses[first].point(form.point), parts.poses[first].direction(form.axis)
    for bolt in others:
        other = parts.turned[bolt]
        assert other is not None
        offset = parts.poses[bolt].point(other.point) - point
        if float(np.linalg.norm(cross(offset, axis))) > 1e-2 * form.radius:
            return True
        if abs(float(parts.poses[bolt].direction(other.axis) @ axis)) < 1.0 - 1e-6:
            return True
    return False


def press(bodies: Bodies, parts: Parts) -> None:
    """Fix what is pressed into a bore, and what lines one."""
    fits = fits_of(bodies)
    _pressed(bodies, fits)
    _liners(bodies, parts, fits)


def fasteners(parts: Parts) -> set[int]:
    """Bolts, nuts and washers, these known by their thickness alone."""
    return {
        part
        for part, form in enumerate(parts.turned)
        if form is not None
        and (
            parts.is_fastener(part)
            or (
                _is_thin(form)
                and not form.sides
                and (form.radius <= WIDE * form.bore or _is_wide_washer(form))
            )
        )
    }


def _by_gap(contacts: list[Contact]) -> list[Contact]:
    return sorted(contacts, key=lambda c: (round(c.gap, 9), c.first, c.second))


def _nuts(bodies: Bodies, parts: Parts, fits: dict[int, list[Contact]]) -> None:
    for part, form in enumerate(parts.turned):
        if form is None or not form.bore or _is_thin(form):
            continue
        round_it = [c for c in fits.get(part, ()) if c.inner != part and parts.turned[c.inner] is not None]
        if not round_it or any(c.inner == part for c in fits.get(part, ())):
            continue
        first, *others = _by_gap(round_it)
        if _is_nut(form, parts.named[part], parts.is_fastener(first.inner)):
            bodies.fix(part, first.inner, "nut", 0.9, (first,))
            for contact in others:  # a standoff has a screw at either end
                if parts.is_fastener(contact.inner):
                    bodies.fix(part, contact.inner, "nut", 0.9, (contact,))


def _is_nut(form: Turned, named: bool, on_bolt: bool) -> bool:
    """A hexagon, or on a bolt another polygon, about as large as nuts are: a square block with a bore is a bearing."""
    if named and not form.sides:
        return True
    return (
        form.sides == 6 or (form.sides >= 4 and (named or on_bolt))
    ) and 0.0 < form.across <= NUT * form.bore


def _is_thin(form: Turned) -> bool:
    return bool(form.bore) and not form.blind and form.length <= THIN * 2.0 * form.bore


def _is_wide_washer(form: Turned) -> bool:
    return form.radius <= WIDE_ON_BOLT * form.bore and form.length <= THIN_AND_WIDE * 2.0 * form.bore


def _washers(bodies: Bodies, parts: Parts, fits: dict[int, list[Contact]], rolling: Collection[int]) -> None:
    """rolling: parts whose rim runs along a flat, which a washer's does not."""
    for part, form in enumerate(parts.turned):
        if form is None or not _is_thin(form) or form.sides or (part in rolling and not parts.named[part]):
            continue
        round_it = [c for c in fits.get(part, ()) if c.inner != part]
        if not round_it or any(c.inner == part for c in fits.get(part, ())):
            continue
        contact = _by_gap(round_it)[0]
        on_bolt = parts.named[part] or parts.is_fastener(contact.inner)
        if form.radius <= WIDE * form.bore or (on_bolt and _is_wide_washer(form)):
            bodies.fix(part, contact.inner, "washer", 0.8, (contact,))


def _bolts(
    bodies: Bodies, parts: Parts, fits: dict[int, list[Contact]], flats: dict[int, list[Contact]]
) -> list[Bolted]:
    found: list[Bolted] = []
    for part in range(len(parts.turned)):
        form = parts.turned[part]
        if form is None or not parts.is_fastener(part):
            continue
        inside = _by_gap(
            [c for c in fits.get(part, ()) if c.inner == part and not parts.is_fastener(c.other(part))]
        )
        if not inside or _drives(inside):
            continue
        host = inside[0].other(part)
        bodies.fix(part, host, "bolt", 0.9, (inside[0],))
        seen = {host}
        for contact in inside[1:] + [c for c in flats.get(part, ()) if not parts.is_fastener(c.other(part))]:
            other = contact.other(part)
            if other not in seen:
                seen.add(other)
                found.append(Bolted(part, host, other, contact))
    return found


def _drives(inside: Sequence[Contact]) -> bool:
    """Whether a screw goes through a thread between two plain bores: it turns in these and drives what has the thread.
    inside: its fits, the tightest first."""
    thread, *others = inside
    if thread.gap >= -PRESSED * thread.a.radius:
        return False
    low, high = thread.span
    before = after = False
    for contact in others:
        if contact.gap < -PRESSED * contact.a.radius:
            continue
        for span in contact.spans:
            middle = contact.a.point + contact.axis * (0.5 * sum(span))
            height = float((middle - thread.a.point) @ thread.axis)
            before, after = before or height < low, after or height > high
    return before and after


def _pressed(bodies: Bodies, fits: dict[int, list[Contact]]) -> None:
    """A part with play in one bore and none in another was made so on purpose: where there is none it is pressed.

    So are bores of one axis in different bodies, and what is only in one bore of a part that has play elsewhere (a handle, a
    dowel).  Else different axes say nothing: a crank turns without play in one bore and with some in another, a carriage is
    located by one of two rails.
    """
    beside: defaultdict[int, set[int]] = defaultdict(set)
    for contact in bodies.contacts:
        if contact.touching or contact.two_sided:
            for part in (contact.first, contact.second):
                beside[part].add(contact.other(part))
    for part, contacts in sorted(fits.items()):
        tight = [c for c in contacts if c.touching and c.gap >= -PRESSED * c.a.radius]
        loose = [c for c in contacts if not c.touching]
        for contact in tight:
            held = contact.other(part)
            elsewhere = [c for c in loose if bodies.of(c.other(part)) != bodies.of(held)]
            alone = {bodies.of(p) for p in beside[held]} - {bodies.of(held)} == {bodies.of(part)}
            if any(axes_apart((contact, c)) == 1 for c in elsewhere) or (
                elsewhere and alone and axes_apart(fits[held]) == 1
            ):
                bodies.fix(contact.first, contact.second, "pressed", 0.8, (contact,))
        for contact in tight:
            if contact.gap < -1e-4 * contact.a.radius:
                bodies.fix(contact.first, contact.second, "pressed", 0.9, (contact,))


def _liners(bodies: Bodies, parts: Parts, fits: dict[int, list[Contact]]) -> None:
    """A bushing sits in the bore that it lines: there its shaft is.  In a telescope's tube the next one is elsewhere.  So does
    an insert without play, in whose thread a screw is."""
    for part, form in enumerate(parts.turned):
        if form is None or not form.bore or form.has_grip:
            continue
        inside = [c for c in fits.get(part, ()) if c.inner == part]
        around = [c for c in fits.get(part, ()) if c.inner != part]
        if not inside or not around or len({c.other(part) for c in around}) != 1:
            continue
        if len({bodies.of(c.other(part)) for c in inside}) != 1 or bodies.of(part) == bodies.of(
            inside[0].other(part)
        ):
            continue
        if sum(shared(c, shaft) for c in inside for shaft in around) < LINED * sum(c.reach for c in inside):
            continue
        if any(c.gap < -PRESSED * c.a.radius for c in around):
            if any(c.touching for c in inside):
                bodies.fix(part, inside[0].other(part), "insert", 0.8, tuple(inside))
        elif (
            min(c.gap for c in inside) <= min(c.gap for c in around) + 1e-12 and form.radius < 2.0 * form.bore
        ):
            bodies.fix(part, inside[0].other(part), "bushing", 0.8, tuple(inside))


def fix_pins(bodies: Bodies, parts: Parts, shafts: Collection[int] = ()) -> None:
    """Fix each turned part that sits in two or more bodies to the one that holds it tightest; where all hold it alike, to
    the one that its twin is fixed to, else by its ends.  shafts: parts that are known to turn in all of them."""
    fits = fits_of(bodies)
    equal: list[int] = []
    for part, form in enumerate(parts.turned):
        if form is None or form.bore or part in shafts:
            continue
        inside = [c for c in fits.get(part, ()) if c.inner == part]
        if any(c.gap < -PRESSED * c.a.radius for c in inside):
            continue  # a thread: whether it is driven, the assembly tells
        by_body = _holders(bodies, part, inside)
        if len(by_body) < 2 or bodies.count(part) > 1:
            continue
        if len({round(min(c.gap for c in own), 9) for own in by_body.values()}) == 1:
            equal.append(part)
            continue
        host = min(by_body, key=lambda body: _looseness(by_body[body], body))  # noqa: B023 (called at once)
        bodies.fix(part, by_body[host][0].other(part), "pin", 0.8, tuple(by_body[host]))
    twins = Twins(bodies, parts.kinds, ("pin", "pressed"))
    for part in equal:
        by_body = _holders(bodies, part, [c for c in fits.get(part, ()) if c.inner == part])
        if len(by_body) < 2 or bodies.count(part) > 1:
            continue
        host, twin = twins.host(part, by_body)
        if host is None:
            host = min(by_body, key=lambda body: _looseness(by_body[body], body))  # noqa: B023 (called at once)
        bodies.fix(part, by_body[host][0].other(part), "pin", 0.7, tuple(by_body[host]), twin)


def _holders(bodies: Bodies, part: int, inside: Sequence[Contact]) -> dict[int, list[Contact]]:
    """The fits of a shaft by the other bodies that it sits in."""
    found: defaultdict[int, list[Contact]] = defaultdict(list)
    for contact in inside:
        body = bodies.of(contact.other(part))
        if body != bodies.of(part):
            found[body].append(contact)
    return dict(found)


def _looseness(contacts: Sequence[Contact], body: int) -> tuple[float, int, int, float, int]:
    """How loosely a body holds a pin: by its play, then by how few of the pin's ends and places are in it."""
    gap = min(round(c.gap, 9) for c in contacts)
    places = sum(len(c.spans) for c in contacts)
    return gap, -sum(map(_ends, contacts)), -places, -round(sum(c.reach for c in contacts), 9), body


def _ends(contact: Contact) -> int:
    """How many ends of the whole shaft are in the bore, or flush with it."""
    low, high = contact.shaft_span
    slack = 0.05 * (high - low)
    return int(contact.span[0] <= low + slack) + int(contact.span[1] >= high - slack)


def axes_apart(contacts: Sequence[Contact]) -> int:
    """How many different axes the fits among contacts have."""
    lines: list[Contact] = []
    for contact in contacts:
        if not contact.is_axial:
            continue
        same = False
        for other in lines:
            offset = contact.a.point - other.a.point
            off = float(np.linalg.norm(cross(offset, other.axis)))
            same |= (
                off < 1e-2 * max(contact.a.radius, 1e-9)
                and abs(float(contact.axis @ other.axis)) > 1.0 - 1e-6
            )
        if not same:
            lines.append(contact)
    return len(lines)
