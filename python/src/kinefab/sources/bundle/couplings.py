"""A bundle's couplings: gears, belts, racks, screws and linear relations between joint coordinates."""

from __future__ import annotations

import math

from ...model import RX, Coupling, CouplingKind, Joint, Term
from ..reading.joint_frames import freedom_names
from ..reading.near import near_matches
from ..reading.record import REQUIRED, Log, Record
from ..reading.source_frame import SourceFrame
from .joints import GAP_ANGLE, GAP_LENGTH, Joints

COUPLING = frozenset(
    "id name kind a b ratio radiusA radiusB teethA teethB radius pitch offset reversed suppressed".split()
)
END = frozenset("joint dof".split())
KINDS = {kind.value: kind for kind in CouplingKind}


def read_couplings(bundle: Record, joints: Joints, frame: SourceFrame, log: Log) -> list[Coupling]:
    """Couplings as ``q_b = ratio * q_a + offset`` in the coordinates of the scene's joints."""
    by_id = {joint.id: joint for joint in joints.joints}
    seen: dict[str, str] = {}
    found: list[Coupling] = []
    for record in bundle.records("couplings", COUPLING):
        name = record.identity(seen)
        feature = f"coupling {name}"
        kind = record.choice("kind", KINDS)
        ends = [_end(record, key, feature, by_id, joints) for key in "ab"]
        backwards = record.flag("reversed")
        suppressed = record.flag("suppressed")
        record.text("name", "")
        if not record.sound:
            continue
        if suppressed:
            log.dropped(feature, "FEATURE_SUPPRESSED", record.pointer)
            continue
        known = [end for end in ends if end is not None]
        if len(known) < len(ends):
            log.dropped(feature, "COUPLING_JOINT_DROPPED", record.pointer)
        elif (ratio := _ratio(record, kind, known, frame)) is not None:
            ratio = -ratio if backwards else ratio
            found.append(_coupling(record, name, kind, known, ratio, joints, frame))
    return found


def _end(
    coupling: Record, key: str, feature: str, by_id: dict[str, Joint], joints: Joints
) -> tuple[Joint, int] | None:
    """Joint and freedom of one end; None after a fault and where the joint was left out."""
    record = coupling.record(key, END, REQUIRED)
    if record is None:
        return None
    name, word = record.text("joint"), record.text("dof")
    joint = by_id.get(name)
    if joint is None and record.sound and name not in joints.inactive:
        near = near_matches(name, by_id, record.log.report)
        record.fault("JOINT_UNKNOWN", "joint", feature=feature, joint=name, near=near)
    freedom = freedom_names(joint.kind).get(word) if joint is not None else None
    if joint is not None and record.sound and freedom not in joint.unlocked:
        record.fault("COUPLING_FREEDOM_LOCKED", "dof", feature=feature, joint=name, freedom=word)
    coupling.sound &= record.sound
    return (joint, freedom) if joint is not None and freedom is not None and record.sound else None


def _ratio(
    record: Record, kind: CouplingKind, ends: list[tuple[Joint, int]], frame: SourceFrame
) -> float | None:
    """dq_b / dq_a in metres and radians, from whichever way the source states it; None after a report."""
    turning = [freedom >= RX for _, freedom in ends]
    units = [_unit(joint, freedom, frame) for joint, freedom in ends]
    if record.has("ratio"):
        ratio = record.number("ratio") * units[1] / units[0]
    elif kind in (CouplingKind.GEAR, CouplingKind.BELT) and (key := _pair(record)):
        a, b = record.number(f"{key}A"), record.number(f"{key}B")
        # Wheels in mesh turn against each other, wheels in a belt turn alike.
        ratio = (-a if kind is CouplingKind.GEAR else a) / (b or math.nan)
    elif kind in (CouplingKind.RACK, CouplingKind.SCREW) and turning[0] != turning[1] and _travel_key(record):
        travel = record.number("pitch") / (2.0 * math.pi) if record.has("pitch") else record.number("radius")
        travel *= frame.travel
        ratio = travel if turning[0] else 1.0 / (travel or math.nan)
    else:
        record.fault("COUPLING_RATIO_MISSING", "", kind=kind.value)
        return None
    if record.sound and not (math.isfinite(ratio) and ratio != 0.0):
        record.fault("COUPLING_RATIO_ZERO", "", kind=kind.value)
    return ratio if record.sound else None


def _unit(joint: Joint, freedom: int, frame: SourceFrame) -> float:
    """Metres or radians in one unit of a joint's coordinate."""
    return frame.coordinate(next(name for name, i in freedom_names(joint.kind).items() if i == freedom))


def _pair(record: Record) -> str:
    """Which pair of sizes is stated: teeth or radii."""
    return next((key for key in ("teeth", "radius") if record.has(f"{key}A") and record.has(f"{key}B")), "")


def _travel_key(record: Record) -> bool:
    return record.has("pitch") or record.has("radius")


def _coupling(
    record: Record,
    name: str,
    kind: CouplingKind,
    ends: list[tuple[Joint, int]],
    ratio: float,
    joints: Joints,
    frame: SourceFrame,
) -> Coupling:
    (a, freedom_a), (b, freedom_b) = ends
    q_a, q_b = joints.positions[a.id][freedom_a], joints.positions[b.id][freedom_b]
    offset = q_b - ratio * q_a
    if record.has("offset"):
        unit, slack = _unit(b, freedom_b, frame), GAP_ANGLE if freedom_b >= RX else GAP_LENGTH
        # Stated for the coordinates that the CAD displays, which may have whole turns more.
        stated = record.number("offset") * unit
        stated += ratio * joints.turns[a.id][freedom_a] - joints.turns[b.id][freedom_b]
        if abs(stated - offset) > slack:
            record.fault(
                "COUPLING_GAP", "offset", feature=f"coupling {name}", gap=f"{abs(stated - offset):.3g}"
            )
        offset = stated
    terms = (Term(a.id, freedom_a, ratio),)
    return Coupling(name, kind, b.id, freedom_b, terms, offset, record.log.place(record.pointer))
