"""A joint record of a bundle, checked: what the source says, before its frames are brought together."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches

from ...model import UNLOCKED, JointKind
from ..reading.joint_frames import freedom_names
from ..reading.record import REQUIRED, Record, Vector, shown
from ..reading.source_frame import SourceFrame
from .bodies import frame_index
from .components import Components

JOINT = frozenset("id name type a b frameA frameB dof lead flipped suppressed because driver".split())
FRAME = frozenset("in o z x".split())
DOF = frozenset("name value min max rest minEnabled maxEnabled restEnabled".split())

TYPES = {
    "rigid": JointKind.FIXED,
    "revolute": JointKind.REVOLUTE,
    "slider": JointKind.PRISMATIC,
    "cylindrical": JointKind.CYLINDRICAL,
    "pin_slot": JointKind.PIN_SLOT,
    "planar": JointKind.PLANAR,
    "ball": JointKind.SPHERICAL,
    "universal": JointKind.UNIVERSAL,
    "screw": JointKind.SCREW,
}

OTHER_WORDS = {
    "hinge": "revolute",
    "prismatic": "slider",
    "fixed": "rigid",
    "weld": "rigid",
    "spherical": "ball",
    "cardan": "universal",
    "hooke": "universal",
    "helical": "screw",
}
"""What other programs call these types: suggested, never taken, for a word may mean another joint there."""

PARALLEL = 1.0 - 1e-9
"""Cosine from which on two directions span no plane."""


@dataclass(frozen=True, slots=True, eq=False)
class FrameDraft:
    """A joint frame as given: node in whose frame (-1: world), origin, z, and x where it is stated."""

    inside: int
    o: Vector
    z: Vector
    x: Vector | None


@dataclass(frozen=True, slots=True, eq=False)
class Coordinate:
    """What the source says of one freedom, metres or radians: its value at the exported pose, its range."""

    record: Record
    value: float | None
    lower: float
    upper: float


@dataclass(frozen=True, slots=True, eq=False)
class JointDraft:
    """A joint record without faults.  a, b: nodes, -1 for ground.  dof: by freedom.  lead: metres a turn.
    flipped: None where the source does not say."""

    record: Record
    id: str
    kind: JointKind
    a: int
    b: int
    frame_a: FrameDraft
    frame_b: FrameDraft | None
    dof: dict[int, Coordinate]
    lead: float
    name: str
    flipped: bool | None
    because: tuple[str, ...]


def read_draft(
    record: Record, name: str, components: Components, frame: SourceFrame, inactive: set[str]
) -> JointDraft | None:
    """The joint ``name``; None after a fault, and where it is left out (then its id is put into
    ``inactive``)."""
    feature = f"joint {name}"
    word = record.text("type")
    if word and word not in TYPES:
        near, known = _near(word), ", ".join(TYPES)
        record.fault("JOINT_TYPE_UNKNOWN", "type", feature=feature, word=shown(word), near=near, known=known)
        inactive.add(name)
    if word not in TYPES:  # its parts are looked at all the same, so that everything is told at once
        _ = components.find(record, "a", feature), components.find(record, "b", feature)
        return None
    kind = TYPES[word]
    a, b = components.find(record, "a", feature), components.find(record, "b", feature)
    if record.sound and record.text("a") == record.text("b"):
        record.fault("SAME_COMPONENT", "b", feature=feature, component=record.text("a"))
    elif record.sound and b < 0:
        record.fault("JOINT_GROUND_SECOND", "b", feature=feature)
    frame_a = _frame(record, "frameA", a, kind, components.index)
    frame_b = _frame(record, "frameB", b, kind, components.index)
    if frame_a is None:  # only a rigid joint has none: any common frame will do
        frame_a = FrameDraft(b, (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    dof = _coordinates(record, kind, word, frame)
    lead = record.number("lead") * frame.travel if kind is JointKind.SCREW else 0.0
    if kind is JointKind.SCREW and record.sound and lead == 0.0:
        record.fault("SCREW_LEAD_ZERO", "lead", feature=feature)
    suppressed = record.flag("suppressed")
    flipped = record.flag("flipped") if record.has("flipped") else None
    label, because = record.text("name", ""), record.texts("because")
    if record.text("driver", ""):
        record.log.dropped(f"driver of {feature}", "JOINT_DRIVER_DROPPED", f"{record.pointer}/driver")
    if not record.sound:
        return None
    if suppressed:
        record.log.dropped(feature, "FEATURE_SUPPRESSED", record.pointer)
    elif asleep := [node for node in (a, b) if not components.is_active(node)]:
        sleeper = components.nodes[asleep[0]].id
        record.log.dropped(feature, "COMPONENT_SUPPRESSED", record.pointer, component=sleeper)
    else:
        return JointDraft(record, name, kind, a, b, frame_a, frame_b, dof, lead, label, flipped, because)
    inactive.add(name)
    return None


def _near(word: str) -> str:
    """The types that an unknown word may have meant, for a message."""
    asked = word[:40].lower().replace("-", "_").replace(" ", "_")
    close = get_close_matches(asked, [*TYPES, *OTHER_WORDS])
    return ", ".join(dict.fromkeys(OTHER_WORDS.get(match, match) for match in close)) or "none"


def _frame(joint: Record, key: str, own: int, kind: JointKind, index: Mapping[str, int]) -> FrameDraft | None:
    """A frame of the joint; None when absent or at fault (the joint is then no longer sound)."""
    optional = key == "frameB" or kind is JointKind.FIXED
    record = joint.record(key, FRAME, None if optional else REQUIRED)
    if record is None:
        return None
    inside = frame_index(record, own, index)
    o, z = record.vector("o"), record.direction("z")
    x = record.direction("x", REQUIRED if kind is JointKind.UNIVERSAL else None)
    if record.sound and x is not None and abs(math.fsum(p * q for p, q in zip(x, z))) > PARALLEL:
        record.fault("AXES_PARALLEL", "x")
    joint.sound &= record.sound
    return FrameDraft(inside, o, z, x) if record.sound else None


def _coordinates(joint: Record, kind: JointKind, word: str, frame: SourceFrame) -> dict[int, Coordinate]:
    """What is said of the joint's freedoms, by freedom."""
    found: dict[int, Coordinate] = {}
    names = {name: i for name, i in freedom_names(kind).items() if i in UNLOCKED[kind]}
    for record in joint.records("dof", DOF):
        name = record.text("name")
        freedom = names.get(name)
        unit = frame.coordinate(name)
        value = record.number("value", None)
        ends = {end: record.number(end, None) for end in ("min", "max", "rest")}
        # A limit that is stored but not switched on is no limit (every CAD program keeps old numbers).
        enabled = {end: record.flag(f"{end}Enabled") for end in ends}
        for end in ends:
            if enabled[end] and ends[end] is None:
                record.fault("BUNDLE_FIELD_MISSING", "", field=end)
        if freedom is None and record.sound:
            record.fault("JOINT_FREEDOM_UNKNOWN", "name", freedom=name, kind=word, known=", ".join(names))
        elif freedom is not None and freedom in found:
            record.fault("JOINT_FREEDOM_REPEATED", "name", freedom=name)
        elif freedom is not None and record.sound:
            low, high = (ends[end] if enabled[end] else None for end in ("min", "max"))
            lower, upper = -math.inf if low is None else low, math.inf if high is None else high
            if lower > upper:
                record.fault("LIMITS_REVERSED", "min", lower=ends["min"], upper=ends["max"])
            if unused := [
                end for end in ("min", "max") if ends[end] is not None and not record.has(f"{end}Enabled")
            ]:
                record.log.dropped(
                    f"limits of joint {joint.text('id')}, {name}", "LIMIT_NOT_ENABLED", record.pointer,
                    ends=" and ".join(unused), flags=" and ".join(f"{end}Enabled" for end in unused),
                )  # fmt: skip
            if enabled["rest"]:
                record.log.dropped(
                    f"rest position of joint {joint.text('id')}", "JOINT_REST_DROPPED", record.pointer
                )
            lower, upper = sorted((lower * unit, upper * unit))
            found[freedom] = Coordinate(record, None if value is None else value * unit, lower, upper)
        joint.sound &= record.sound
    return found
