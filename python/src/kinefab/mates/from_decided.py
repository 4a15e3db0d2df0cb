"""From what was decided to mates: one constraint for each fixing and each joint, with the geometry of its faces."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..model import ConstraintKind, FeatureKind, JointKind
from ..spatial import Array, cross
from .deciding.bodies import Fixing
from .deciding.decide import Decided
from .deciding.edge import Edge
from .deciding.freedom import null_space
from .deciding.pairs import Pair, pair_of
from .mate import Mate, MateSide
from .shapes.gears import Mesh, Wheel
from .touching.contact import Contact, ContactKind, Side

MOST_FACES = 8
"""Faces that a mate lists of each part."""
SNAP = 1e-4
"""Share of the pair's length, and sine, by which a joint's axis may miss a fit's and still is that fit's."""


def mate_of_fixing(
    fixing: Fixing, nodes: Sequence[int], middles: Sequence[Array], names: Sequence[str]
) -> Mate:
    """names: of the parts."""
    sides = tuple(
        MateSide(nodes[part], FeatureKind.BODY, middles[part], faces=_faces(fixing.contacts, part))
        for part in (fixing.first, fixing.second)
    )
    reason = fixing.reason
    if (twin := fixing.twin) is not None:
        of = (f"{names[p]} {', '.join(_faces(twin.contacts, p))}" for p in (twin.first, twin.second))
        reason += f", as its twin: {' with '.join(of)}"
    return Mate(0, ConstraintKind.LOCK, sides, "fixed", reason, fixing.confidence)


def mates_of_edge(
    edge: Edge, nodes: Sequence[int], middles: Sequence[Array], names: Sequence[str]
) -> list[Mate]:
    """Usually one; several where no lower pair has the freedoms that are left.  names: of the parts."""
    pair = pair_of(edge.space, edge.scale)
    main = _main(edge, pair)
    first, second = edge.parts if main is None else (main.first, main.second)
    reason = _reason(edge, names)
    if pair.kind is JointKind.FIXED:
        sides = tuple(
            MateSide(nodes[part], FeatureKind.BODY, middles[part], faces=_faces(edge.contacts, part))
            for part in (first, second)
        )
        return [Mate(0, ConstraintKind.LOCK, sides, "fixed", reason, edge.confidence)]
    pair = _snapped(pair, edge)
    if pair.kind is JointKind.PIN_SLOT and pair.second is not None:
        slotted, pin = _slot_and_pin(edge, main)
        sides = (
            MateSide(
                nodes[slotted],
                FeatureKind.LINE,
                pair.point,
                pair.second,
                faces=_faces(edge.contacts, slotted),
            ),
            MateSide(nodes[pin], FeatureKind.LINE, pair.point, pair.axis, faces=_faces(edge.contacts, pin)),
        )
        return [Mate(0, ConstraintKind.PIN_SLOT, sides, "pin_slot", reason, edge.confidence)]
    if pair.kind not in _LOWER:
        return _single_contacts(edge, nodes)
    kind, geometry = _LOWER[pair.kind]
    turned = geometry not in (FeatureKind.POINT,)
    sides = tuple(
        MateSide(
            nodes[part], geometry, pair.point, pair.axis if turned else None,
            radius=main.side(part).radius if main is not None and main.is_axial else 0.0, faces=_faces(edge.contacts, part),
        )
        for part in (first, second)
    )  # fmt: skip
    if geometry is FeatureKind.PLANE:
        sides = (sides[0], replace(sides[1], direction=-pair.axis))
    value = pair.pitch * 2.0 * np.pi if pair.kind is JointKind.SCREW else 0.0
    return [Mate(0, kind, sides, pair.kind.value, reason, edge.confidence, value)]


def _reason(edge: Edge, names: Sequence[str]) -> str:
    """What was seen; of a joint that was taken from a twin, that twin and its faces."""
    twin = edge.twin
    if twin is None or edge.swapped:
        return edge.reason
    of = (f"{names[p]} {', '.join(_faces(twin.contacts, p))}".rstrip() for p in (twin.part, twin.other))
    return f"{edge.reason}, as its twin: {' with '.join(of)}"


def _slot_and_pin(edge: Edge, main: Contact | None) -> tuple[int, int]:
    """The part with the slot and that with the pin."""
    slot = next((c for c in edge.contacts if c.kind is ContactKind.LINE), main)
    if slot is not None:
        pin = slot.inner if slot.inner >= 0 else slot.second
        return slot.other(pin), pin
    twin = edge.twin
    assert twin is not None  # there is no other reason for a joint that nothing touches
    pins = {c.inner for c in twin.contacts if c.kind is ContactKind.LINE}
    return (twin.copy, twin.other_copy) if twin.other in pins else (twin.other_copy, twin.copy)


def mate_of_mesh(mesh: Mesh, decided: Decided, axles: Axles, nodes: Sequence[int]) -> Mate | None:
    """Two wheels in mesh, counted from what carries both: a body on which the one turns, and which turns about the
    other's axis or carries that too.  None where there is no such body, or both wheels are one."""
    bodies = decided.bodies
    a, b = bodies.of(mesh.first), bodies.of(mesh.second)
    carriers = _turning_on(axles, a, mesh.a) + _turning_on(axles, b, mesh.b)
    for carrier in carriers:
        if carrier in (a, b) or a == b:
            continue
        others = [w for body, w in ((a, mesh.a), (b, mesh.b)) if carrier not in _turning_on(axles, body, w)]
        if all(_turning_on(axles, carrier, wheel) for wheel in others):
            sides = tuple(
                MateSide(
                    nodes[part],
                    FeatureKind.LINE,
                    wheel.point,
                    mesh.a.axis,
                    radius=0.5 * (wheel.low + wheel.high),
                )
                for part, wheel in ((mesh.first, mesh.a), (mesh.second, mesh.b))
            )
            whole = (*sides, MateSide(nodes[carrier], FeatureKind.BODY, mesh.a.point))
            reason = f"teeth {mesh.a.teeth} and {mesh.b.teeth}"
            return Mate(0, ConstraintKind.GEAR, whole, "gear", reason, 0.8, mesh.ratio)
    return None


Axles = Mapping[int, Sequence[tuple[int, Pair, float]]]
"""By body: the bodies that it turns on or that turn on it, the pair they make, and its length, metres."""


def axles_of(edges: Sequence[Edge]) -> Axles:
    """For each body the hinges and cylindrical pairs that it has: the other body, the pair, a length of its size,
    metres."""
    found: defaultdict[int, list[tuple[int, Pair, float]]] = defaultdict(list)
    for edge in edges:
        pair = pair_of(edge.space, edge.scale)
        if pair.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL):
            for body, other in (edge.pair, edge.pair[::-1]):
                found[body].append((other, pair, edge.scale.length))
    return found


def _turning_on(axles: Axles, body: int, wheel: Wheel) -> list[int]:
    """Bodies that a body turns against about a wheel's axis."""
    return [
        other
        for other, pair, length in axles.get(body, ())
        if float(np.linalg.norm(cross(pair.axis, wheel.axis))) <= SNAP
        and float(np.linalg.norm(cross(pair.point - wheel.point, wheel.axis)))
        < SNAP * max(wheel.high, length)
    ]


_LOWER = {
    JointKind.REVOLUTE: (ConstraintKind.INSERT, FeatureKind.CIRCLE),
    JointKind.CYLINDRICAL: (ConstraintKind.CONCENTRIC, FeatureKind.CYLINDER),
    JointKind.SCREW: (ConstraintKind.SCREW, FeatureKind.LINE),
    JointKind.PRISMATIC: (ConstraintKind.SLIDER, FeatureKind.LINE),
    JointKind.PLANAR: (ConstraintKind.COINCIDENT, FeatureKind.PLANE),
    JointKind.SPHERICAL: (ConstraintKind.COINCIDENT, FeatureKind.POINT),
}
"""The constraint and geometry that leave just a lower pair."""


def _main(edge: Edge, pair: Pair) -> Contact | None:
    """The contact that says most about a joint: a fit on its axis, else a ball, else the largest flat; None where none
    was seen."""

    def weight(c: Contact) -> tuple[bool, bool, bool, float, float]:
        on_axis = c.is_axial and _off(c, pair) < SNAP * max(edge.scale.length, 1e-12)
        return on_axis, c.kind is ContactKind.BALL, c.is_axial, c.area, c.reach

    return max(edge.contacts, key=weight, default=None)


def _off(contact: Contact, pair: Pair) -> float:
    """How far a fit's axis is from the pair's; infinite where they are not parallel."""
    if float(np.linalg.norm(cross(contact.axis, pair.axis))) > SNAP:
        return float("inf")
    return float(np.linalg.norm(cross(pair.point - contact.a.point, contact.axis)))


def _snapped(pair: Pair, edge: Edge) -> Pair:
    """The pair with the exact axis of a fit or the centre of a ball, where it is that."""
    main = _main(edge, pair)
    if main is None:
        return pair
    if pair.kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL, JointKind.SCREW) and main.is_axial:
        if _off(main, pair) < SNAP * max(edge.scale.length, 1e-12):
            middle = main.a.point + main.axis * (0.5 * (main.span[0] + main.span[1]))
            return replace(pair, point=middle, axis=main.axis)  # a thread's hand hangs on no direction
    if pair.kind is JointKind.SPHERICAL and main.kind is ContactKind.BALL:
        return replace(pair, point=main.a.point)
    if pair.kind in (JointKind.PRISMATIC, JointKind.PLANAR):
        point = np.mean(np.concatenate([c.points for c in edge.contacts if len(c.points)]), axis=0)
        return replace(pair, point=point, axis=_exact_direction(pair, edge))
    return pair


def _exact_direction(pair: Pair, edge: Edge) -> Array:
    """A fit's axis or a flat's normal where the direction is one, the cross product of two normals where it is that."""
    normals = [c.normals[0] for c in edge.contacts if c.kind is ContactKind.FLAT]
    axes = [c.axis for c in edge.contacts if c.is_axial]
    for direction in axes + (normals if pair.kind is JointKind.PLANAR else []):
        if float(np.linalg.norm(cross(direction, pair.axis))) < SNAP:
            return direction
    for i, a in enumerate(normals):
        for b in normals[i + 1 :]:
            along = cross(a, b)
            length = float(np.linalg.norm(along))
            if length > 0.1 and float(np.linalg.norm(cross(along / length, pair.axis))) < SNAP:
                return along / length
    return pair.axis


def _single_contacts(edge: Edge, nodes: Sequence[int]) -> list[Mate]:
    """Contact by contact, those that the others do not already say."""
    found: list[Mate] = []
    rows = np.zeros((0, 6))
    rank = 0
    for contact in sorted(edge.contacts, key=lambda c: (not c.two_sided, not c.touching)):
        if contact.kind not in _SINGLE or not len(contact.points):
            continue
        more = np.concatenate([rows, edge.scale.rows(contact.points, contact.normals)])
        if (
            edge.space.shape[1]
            and float(np.abs(edge.scale.rows(contact.points, contact.normals) @ edge.space).max()) > 1e-4
        ):
            continue  # it would stop what was found to move
        now = 6 - null_space(more).shape[1]
        if now == rank:
            continue
        rows, rank = more, now
        kind = _SINGLE[contact.kind]
        sides = tuple(
            MateSide(
                nodes[part], side.kind, side.point, side.direction, None, side.radius, side.faces[:MOST_FACES]
            )
            for part, side in zip((contact.first, contact.second), _closed(contact), strict=True)
        )
        found.append(Mate(0, kind, sides, contact.kind.value, edge.reason, edge.confidence))
    return found


def _closed(contact: Contact) -> tuple[Side, Side]:
    """Its sides, a flat moved over the clearance to what it faces: the mate holds at the pose that was drawn."""
    a, b = contact.a, contact.b
    if contact.kind not in (ContactKind.FLAT, ContactKind.LINE, ContactKind.POINT):
        return a, b
    over = contact.normals[0] * contact.gap
    if b.kind is FeatureKind.PLANE:
        return a, replace(b, point=b.point - over)
    return replace(a, point=a.point + over), b


_SINGLE = {
    ContactKind.FIT: ConstraintKind.CONCENTRIC,
    ContactKind.CONE: ConstraintKind.CONCENTRIC,
    ContactKind.BALL: ConstraintKind.COINCIDENT,
    ContactKind.TUBE: ConstraintKind.COINCIDENT,
    ContactKind.FLAT: ConstraintKind.COINCIDENT,
    ContactKind.LINE: ConstraintKind.TANGENT,
    ContactKind.POINT: ConstraintKind.TANGENT,
}


def _faces(contacts: Sequence[Contact], part: int) -> tuple[str, ...]:
    found: dict[str, None] = {}
    for contact in contacts:
        if part in (contact.first, contact.second):
            found.update(dict.fromkeys(contact.side(part).faces))
    return tuple(list(found)[:MOST_FACES])
