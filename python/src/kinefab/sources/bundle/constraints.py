"""A bundle's constraints and DOF records: what the source states, in the frames of the parts, not
interpreted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...diagnostics import is_encodable
from ...model import Constraint, ConstraintKind, DofRecord, Feature, FeatureKind, Sense, Side
from ..reading.near import near_words
from ..reading.record import REQUIRED, Log, Record, Vector, is_object, shown
from ..reading.source_frame import SourceFrame
from .bodies import frame_index
from .components import Components

CONSTRAINT = frozenset(
    "id name kind rawKind a b c value min max sense side lockRotation suppressed reading".split()
)
FEATURE = frozenset("component geometry in p d x r halfAngle".split())
FREEDOMS = frozenset("component translations rotations center".split())

KINDS = {kind.value: kind for kind in ConstraintKind}
GEOMETRY = {kind.value: kind for kind in FeatureKind}
SENSES = {sense.value: sense for sense in Sense}
SIDES = {side.value: side for side in Side}

DIRECTED = frozenset(
    {
        FeatureKind.LINE,
        FeatureKind.PLANE,
        FeatureKind.CIRCLE,
        FeatureKind.CYLINDER,
        FeatureKind.CONE,
        FeatureKind.FRAME,
    }
)
ONE_SIDED = frozenset({ConstraintKind.GROUND, ConstraintKind.OTHER})
"""Kinds that may do without a second side."""

IN_ANGLES = frozenset({ConstraintKind.ANGLE, ConstraintKind.PARALLEL, ConstraintKind.PERPENDICULAR})
IN_RATIOS = frozenset({ConstraintKind.GEAR, ConstraintKind.BELT, ConstraintKind.LINEAR, ConstraintKind.OTHER})
IN_TRAVEL = frozenset({ConstraintKind.SCREW, ConstraintKind.RACK})
"""Kinds whose value is no length: an angle; a plain number; a travel for a turn."""


@dataclass(frozen=True, slots=True, eq=False)
class FeatureDraft:
    """A feature as given: its node, and the node in whose frame the numbers are; -1 for ground and world."""

    node: int
    inside: int
    kind: FeatureKind
    p: Vector
    d: Vector | None
    x: Vector | None
    radius: float
    half_angle: float


def read_constraints(
    bundle: Record, components: Components, frame: SourceFrame, log: Log
) -> list[Constraint]:
    """The constraints; those of unknown kind or geometry as OTHER, suppressed ones marked."""
    seen: dict[str, str] = {}
    drafts: list[FeatureDraft] = []
    found: list[tuple[Record, dict[str, Any], slice]] = []
    for record in bundle.records("constraints", CONSTRAINT):
        name = record.identity(seen)
        start = len(drafts)
        fields = _fields(record, name, components, frame, drafts, log)
        if record.sound:
            found.append((record, fields, slice(start, len(drafts))))
    features = _in_nodes(drafts, components)
    return [
        Constraint(**fields, features=tuple(features[sides]), where=log.place(record.pointer))
        for record, fields, sides in found
    ]


def _fields(
    record: Record,
    name: str,
    components: Components,
    frame: SourceFrame,
    drafts: list[FeatureDraft],
    log: Log,
) -> dict[str, Any]:
    """Everything of a constraint but its features, which are appended to ``drafts``."""
    feature = f"constraint {name}"
    word = record.text("kind")
    kind = KINDS.get(word, ConstraintKind.OTHER)
    if word and word not in KINDS:
        _unknown(log, feature, "CONSTRAINT_KIND_UNKNOWN", f"{record.pointer}/kind", word, KINDS)
    sides: dict[str, str] = {}
    for key in "abc":
        optional = key == "c" or kind in ONE_SIDED and (key == "b" or kind is ConstraintKind.OTHER)
        side = record.record(key, FEATURE, None if optional else REQUIRED)
        if side is not None:
            draft, known = _feature(side, feature, components, frame, log)
            kind = kind if known else ConstraintKind.OTHER
            sides[key] = side.text("component") if side.sound else key
            record.sound &= side.sound
            drafts.append(draft)
    if record.sound and len(sides) > 1 and sides.get("a") == sides.get("b"):
        record.fault("SAME_COMPONENT", "b", feature=feature, component=sides["a"])
    lower, upper = record.number("min", None), record.number("max", None)
    reading = _reading(record)
    signed = "c" in sides or reading.get("angle") == "directed" or not lower is upper is None
    unit = _unit(kind, signed, frame)
    value = record.number("value", 0.0) * unit
    if record.sound and lower is not None and upper is not None and lower > upper:
        record.fault("LIMITS_REVERSED", "min", lower=lower, upper=upper)
    suppressed = record.flag("suppressed")
    if suppressed and record.sound:
        log.dropped(feature, "FEATURE_SUPPRESSED", record.pointer)
    return dict(
        id=name,
        # A coincidence at a distance is what CAD programs call a mate with an offset.
        kind=ConstraintKind.DISTANCE if kind is ConstraintKind.COINCIDENT and value else kind,
        value=value,
        lower=_end(lower, upper, unit),
        upper=_end(upper, lower, unit),
        sense=record.choice("sense", SENSES, Sense.EITHER),
        side=record.choice("side", SIDES, Side.EITHER),
        lock_rotation=record.flag("lockRotation"),
        suppressed=suppressed,
        name=record.text("name", ""),
        raw_kind=record.text("rawKind", "") or word,
        reading=reading,
    )


def _unknown(log: Log, feature: str, code: str, place: str, word: str, known: Mapping[str, object]) -> None:
    near = near_words(word, known, log.report)
    log.dropped(feature, code, place, word=shown(word), near=near, known=", ".join(known))


def _unit(kind: ConstraintKind, signed: bool, frame: SourceFrame) -> float:
    """What one unit of a constraint's value is; an angle between two directions has no sign, one about an axis has."""
    if kind in IN_ANGLES:
        return frame.about if signed else frame.angle
    if kind in IN_RATIOS:
        return 1.0
    return frame.travel if kind in IN_TRAVEL else frame.length


def _end(own: float | None, other: float | None, unit: float) -> float | None:
    """One end of a range in the scene's terms: where the unit turns the sign, the other one becomes it."""
    end = own if unit > 0.0 else other
    return None if end is None else end * unit


def _reading(constraint: Record) -> dict[str, str]:
    """The vendor's meaning of the words: texts by text."""
    values = constraint.values.get("reading")
    known = frozenset(filter(is_encodable, values) if is_object(values) else ())
    record = constraint.record("reading", known)
    if record is None:
        return {}
    found = {key: record.text(key) for key in record.values if key in known}
    constraint.sound &= record.sound
    return found


def _feature(
    record: Record, feature: str, components: Components, frame: SourceFrame, log: Log
) -> tuple[FeatureDraft, bool]:
    """A side of a constraint, and whether its geometry is known (else it is kept as BODY)."""
    node = components.find(record, "component", feature)
    word = record.text("geometry")
    kind = GEOMETRY.get(word, FeatureKind.BODY)
    if word and word not in GEOMETRY:
        _unknown(log, feature, "CONSTRAINT_GEOMETRY_UNKNOWN", f"{record.pointer}/geometry", word, GEOMETRY)
    bare = kind is FeatureKind.BODY
    inside = node if bare and not record.has("in") else frame_index(record, node, components.index)
    draft = FeatureDraft(
        node,
        inside,
        kind,
        p=record.vector("p", (0.0, 0.0, 0.0) if bare else REQUIRED),
        d=record.direction("d", REQUIRED if kind in DIRECTED else None),
        x=record.direction("x", REQUIRED if kind is FeatureKind.FRAME else None),
        radius=record.number("r", 0.0) * frame.length,
        half_angle=record.number("halfAngle", REQUIRED if kind is FeatureKind.CONE else 0.0) * frame.angle,
    )
    if record.sound and draft.radius < 0.0:
        record.fault("RADIUS_NEGATIVE", "r", feature=feature)
    return draft, not word or word in GEOMETRY


def _in_nodes(drafts: list[FeatureDraft], components: Components) -> list[Feature]:
    """All features at once, in the frames of their nodes."""
    nodes = np.array([draft.node for draft in drafts], dtype=int)
    inside = np.array([draft.inside for draft in drafts], dtype=int)
    place = components.placement
    zero = (0.0, 0.0, 0.0)
    points = place.points(nodes, inside, [draft.p for draft in drafts])
    directions = place.directions(nodes, inside, [draft.d or zero for draft in drafts])
    seconds = place.directions(nodes, inside, [draft.x or zero for draft in drafts])
    return [
        Feature(
            node=None if draft.node < 0 else draft.node,
            kind=draft.kind,
            point=points[i],
            direction=directions[i] if draft.d else None,
            secondary=seconds[i] if draft.x else None,
            radius=draft.radius,
            half_angle=draft.half_angle,
        )
        for i, draft in enumerate(drafts)
    ]


def read_freedoms(bundle: Record, components: Components, log: Log) -> list[DofRecord]:
    """The source's own statement of remaining freedoms; given and stored in world directions."""
    found: list[DofRecord] = []
    for record in bundle.records("dof", FREEDOMS):
        name = record.text("component")
        node = components.find(record, "component", "the DOF record")
        translations, rotations = record.vectors("translations"), record.vectors("rotations")
        center = record.vector("center", None)
        if record.sound and node < 0:
            record.fault("DOF_OF_GROUND", "component")
        for key, vectors in (("translations", translations), ("rotations", rotations)):
            if record.sound and len(vectors) > 3:
                record.fault("DOF_TOO_MANY", key, component=name, count=len(vectors), field=key)
        if not record.sound:
            continue
        if not components.is_active(node):
            log.dropped(f"DOF record of {name}", "COMPONENT_SUPPRESSED", record.pointer, component=name)
            continue
        world, place = -1, components.placement
        found.append(
            DofRecord(
                node,
                place.directions([world] * len(translations), [world] * len(translations), translations),
                place.directions([world] * len(rotations), [world] * len(rotations), rotations),
                None if center is None else place.points([world], [world], [center])[0],
                log.place(record.pointer),
            )
        )
    return found
