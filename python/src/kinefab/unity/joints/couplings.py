"""Couplings between joint coordinates (gears, belts, racks, screws, mimics), as Unity's components read them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from ...diagnostics import Report
from ...model import RX, TX, Coupling, CouplingKind, Joint, JointKind, Term
from ..scene import Coupling as UnityCoupling
from ..scene import CouplingTerm, JointCoordinate
from .mapping import UnityCoordinate, UnityJoint


@dataclass(frozen=True, slots=True)
class _End:
    """A joint coordinate on its component.  unit: degrees a radian for an angle, 1 for a distance."""

    reading: UnityCoordinate
    coordinate: JointCoordinate
    unit: float


def map_coupling(
    coupling: Coupling,
    joints: Mapping[str, tuple[UnityJoint, int]],
    object_of: Sequence[int],
    report: Report,
) -> UnityCoupling | None:
    """The coupling in Unity's terms, or None with a report when a joint or its freedom is not there.

    joints: for each joint id its component and that component's index on its GameObject.
    """
    ends: list[_End] = []
    for name, freedom in [
        (coupling.joint, coupling.freedom),
        *((t.joint, t.freedom) for t in coupling.terms),
    ]:
        mapped, index = joints.get(name, (None, -1))
        if mapped is None or freedom not in mapped.coordinates:
            report.dropped(
                f"coupling {coupling.id}",
                "COUPLING_WITHOUT_JOINT",
                coupling.where,
                coupling=coupling.id,
                joint=name,
            )
            return None
        reading = mapped.coordinates[freedom]
        place = JointCoordinate(object_of[mapped.owner], index, reading.name)
        ends.append(_End(reading, place, math.degrees(1.0) if freedom >= RX else 1.0))
    own, *others = ends
    # u = sign (q - zero) on every component, and q = sum ratio_i q_i + offset
    offset = coupling.offset - own.reading.zero
    terms: list[CouplingTerm] = []
    for term, end in zip(coupling.terms, others):
        offset += term.ratio * end.reading.zero
        ratio = own.reading.sign * term.ratio * end.reading.sign
        terms.append(CouplingTerm(end.coordinate, ratio * own.unit / end.unit))
    offset *= own.reading.sign
    if coupling.freedom >= RX:  # an angle is known up to whole turns
        offset -= 2.0 * math.pi * round(offset / (2.0 * math.pi))
    report.kept(f"coupling {coupling.id}", coupling.where)
    return UnityCoupling(coupling.id, coupling.kind.value, own.coordinate, tuple(terms), offset * own.unit)


def screw_couplings(joints: Sequence[UnityJoint], stated: Sequence[Coupling]) -> list[Coupling]:
    """Couplings for the screws among ``joints`` that ``stated`` does not couple already: a component alone
    leaves the slide free of the turn."""
    mapped = {own.source.id: own.coordinates for own in joints if own.coordinates.keys() >= {TX, RX}}
    sources = (own.source for own in joints if own.source.id in mapped)
    return [
        lead_coupling(joint, mapped[joint.id][TX].zero, mapped[joint.id][RX].zero)
        for joint in uncoupled_screws(sources, stated)
    ]


def uncoupled_screws(joints: Iterable[Joint], couplings: Sequence[Coupling]) -> list[Joint]:
    """The screws whose slide no coupling ties to their turn."""
    coupled = {
        c.joint
        for c in couplings
        if c.joints == frozenset({c.joint}) and {c.freedom, *(term.freedom for term in c.terms)} == {TX, RX}
    }
    return [joint for joint in joints if joint.kind is JointKind.SCREW and joint.id not in coupled]


def lead_coupling(joint: Joint, slide: float, turn: float) -> Coupling:
    """A screw's lead, which holds at the exported pose.  slide, turn: where it stands there, metres and radians."""
    ratio = joint.lead / (2.0 * math.pi)
    terms = (Term(joint.id, RX, ratio),)
    offset = slide - ratio * turn
    return Coupling(f"lead:{joint.id}", CouplingKind.SCREW, joint.id, TX, terms, offset, joint.where)
