"""Couplings between joint coordinates (gears, belts, racks, screws), as Unity's components read them."""

from __future__ import annotations

import math
from typing import Any, Iterable, Mapping, Sequence

from ..diagnostics import Report
from ..model import RX, TX, Coupling, CouplingKind, JointKind
from .joints import UnityCoordinate, UnityJoint
from .numbers import rounded, significant


def coupling_entry(
    coupling: Coupling,
    joints: Mapping[str, tuple[UnityJoint, int]],
    object_of: Sequence[int],
    report: Report,
) -> dict[str, Any] | None:
    """The scene format's entry, or None with a report when a joint or its freedom is not there.

    joints: for each joint id its component and that component's index on its GameObject.
    """
    ends = []
    for name, freedom in ((coupling.joint_a, coupling.freedom_a), (coupling.joint_b, coupling.freedom_b)):
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
        ends.append((mapped.coordinates[freedom], object_of[mapped.owner], index, freedom >= RX))
    (a, object_a, index_a, angular_a), (b, object_b, index_b, angular_b) = ends
    ratio = b.sign * coupling.ratio * a.sign
    offset = b.sign * (coupling.ratio * a.zero + coupling.offset - b.zero)
    if angular_b:  # an angle is known up to whole turns
        offset -= 2.0 * math.pi * round(offset / (2.0 * math.pi))
    scale_a, scale_b = (math.degrees(1.0) if angular else 1.0 for angular in (angular_a, angular_b))
    entry = {
        "id": coupling.id,
        "kind": coupling.kind.value,
        "a": _coordinate(a, object_a, index_a),
        "b": _coordinate(b, object_b, index_b),
        "ratio": significant(ratio * scale_b / scale_a),
    }
    if rounded(offset * scale_b) != 0:
        entry["offset"] = rounded(offset * scale_b)
    report.kept(f"coupling {coupling.id}", coupling.where)
    return entry


def screw_couplings(joints: Iterable[UnityJoint], stated: Sequence[Coupling]) -> list[Coupling]:
    """Couplings for the screws among ``joints`` that ``stated`` does not couple already: a component alone
    leaves the slide free of the turn.  They hold at the exported pose.
    """
    coupled = {c.joint_a for c in stated if c.joint_a == c.joint_b and {c.freedom_a, c.freedom_b} == {TX, RX}}
    found = []
    for mapped in joints:
        joint = mapped.source
        if joint.kind is not JointKind.SCREW or joint.id in coupled or not mapped.coordinates.keys() >= {TX, RX}:
            continue
        ratio = joint.lead / (2.0 * math.pi)
        offset = mapped.coordinates[TX].zero - ratio * mapped.coordinates[RX].zero
        found.append(
            Coupling(f"lead:{joint.id}", CouplingKind.SCREW, joint.id, RX, joint.id, TX, ratio, offset, joint.where)
        )
    return found


def _coordinate(coordinate: UnityCoordinate, game_object: int, component: int) -> dict[str, Any]:
    return {"gameObject": game_object, "component": component, "coordinate": coordinate.name}
