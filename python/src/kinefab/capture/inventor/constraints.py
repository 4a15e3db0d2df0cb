"""Inventor's constraints, every kind, as records of a bundle in the space of the assembly that owns them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from ..channel import MemberFailed
from ..draft import Draft, Record, reach
from .api import Constraint, Entity, Occurrence
from .geometry import entity_shape, shape

MATE, FLUSH, INSERT, ANGLE, TANGENT = "Mate", "Flush", "Insert", "Angle", "Tangent"
KINDS = {
    100665856: MATE, 100676352: MATE, 100666368: FLUSH, 100675840: FLUSH, 100665344: INSERT, 100676096: INSERT,
    100665088: ANGLE, 100675584: ANGLE, 100665600: TANGENT, 100677120: TANGENT,
    100666624: "RotateRotate", 100676608: "RotateRotate", 100666880: "RotateTranslate", 100676864: "RotateTranslate",
    100667136: "TranslateTranslate", 100677888: "TranslateTranslate", 100666112: "Transitional",
    100677376: "Transitional", 100707840: "AssemblySymmetry", 100708096: "AssemblySymmetry", 100673536: "Custom",
    100677632: "Custom", 100678144: "Composite", 100699392: "Layout",
    100699648: "Layout",
}  # fmt: skip
"""ObjectTypeEnum, native and proxy."""

SUPPRESSED, WELL = 11784, frozenset({11777, 11778, 11787, 11788})
HEALTH = {
    11779: "out of date", 11780: "driver lost", 11781: "in error", 11782: "deleted", 11783: "cannot compute",
    11785: "beyond the stop node", 11786: "inconsistent", 11789: "invalid limits", 11790: "joint freedom locked",
}  # fmt: skip
LINE, POINT = 24834, 24835
SOLUTIONS = {115457: "opposed", 115458: "aligned"}
DIRECTED, REFERENCE_VECTOR = 78593, 78595
ALONG_NORMAL = {"offset": "along_normal"}


@dataclass(slots=True)
class Owner:
    """The assembly whose constraints are read.  id: its component; frame: what a bundle calls its space.
    itself: what its own planes and axes are on."""

    draft: Draft
    id: str
    frame: str
    itself: str = "ground"

    def component(self, occurrence: Occurrence | None) -> str:
        """Id of an occurrence that the owner's constraint names: through its parents, up to the owner."""
        names: list[str] = []
        passed: set[Occurrence] = set()
        at = occurrence
        while at is not None:
            if at in passed:
                raise ValueError("an occurrence that is its own parent")
            passed.add(at)
            names.append(at.Name)
            at = at.ParentOccurrence
        return "/".join([self.id, *reversed(names)])

    def holder(self, entity: Entity) -> str:
        """Id of what an entity is on: the owner itself has no proxies of its planes and axes."""
        try:
            occurrence = entity.ContainingOccurrence
        except MemberFailed:
            occurrence = None
        if occurrence is not None:
            return self.component(occurrence)
        return self.itself


def read_constraint(owner: Owner, c: Constraint) -> None:
    """Add the constraint to the draft."""
    draft = owner.draft
    kind = KINDS.get(c.Type, f"ObjectType {c.Type}")
    name = c.Name
    record: Record = {
        "id": draft.unique(name if owner.frame == "world" else f"{owner.id}/{name}"),
        "name": name,
    }
    record["rawKind"] = kind
    health = c.HealthStatus
    if bool(c.Suppressed) or health == SUPPRESSED:
        record |= {"kind": "other", "suppressed": True}
        draft.constraints.append(record)
        return
    build = BUILDERS.get(kind)
    record["kind"] = "other"
    try:
        _sides(owner, c, kind, record)
        if build is not None:
            build(owner, c, record)
    except MemberFailed as error:
        draft.failed(f"constraint {name}", error)
        record = {k: record[k] for k in ("id", "name", "rawKind", "a", "b") if k in record} | {
            "kind": "other"
        }
    if health not in WELL:
        words = HEALTH.get(health, str(health))
        draft.report.add("CAPTURE_SICK", id=record["id"], health=words, program=draft.program)
        record |= {"suppressed": True, "extras": {"health": words}}
    draft.owners[record["id"]] = owner.frame
    draft.constraints.append(record)


def _sides(owner: Owner, c: Constraint, kind: str, record: Record) -> None:
    """Both sides with their geometry.  That of a mate is what was inferred of its face or edge."""
    expected = {INSERT: ("circle",), FLUSH: ("plane",), "Transitional": ("cylinder",)}.get(kind, ())
    both = ((c.OccurrenceOne, "One", "a"), (c.OccurrenceTwo, "Two", "b"))
    for occurrence, side, key in both:
        component = owner.component(occurrence) if occurrence is not None else owner.itself
        stated: Record | None = None
        with suppress(MemberFailed):  # none of a kind that states no geometry
            if (geometry := getattr(c, f"Geometry{side}")) is not None:
                stated = shape(geometry, owner.frame, expected)
        if stated is None:
            stated = entity_shape(getattr(c, f"Entity{side}"), owner.frame, expected)
        record[key] = {"component": component, **stated}


def _value(record: Record, c: Constraint, value: float) -> None:
    """The nominal value, or the range where limits are switched on: then the value is not enforced."""
    limits = c.ConstraintLimits
    if limits is None:
        record["value"] = value
        return
    lower, upper = limits.Minimum, limits.Maximum
    low = reach(bool(limits.MinimumEnabled), None if lower is None else lower.Value)
    high = reach(bool(limits.MaximumEnabled), None if upper is None else upper.Value)
    if low is None and high is None:
        record["value"] = value
        return
    record |= {key: end for key, end in (("min", low), ("max", high)) if end is not None}
    record["extras"] = {"nominal": value}


def _inferred(record: Record, key: str, inferred: int) -> None:
    """A mate's cylinder or cone means its axis, a sphere or torus its centre, where Inventor inferred that."""
    if inferred == LINE and record[key]["geometry"] in ("cylinder", "circle"):
        record[key] = {**record[key], "geometry": "line"}
        record[key].pop("r", None)
    elif inferred == POINT and record[key]["geometry"] != "point":
        record[key] = {k: v for k, v in record[key].items() if k not in ("d", "r")} | {"geometry": "point"}


def _mate(owner: Owner, c: Constraint, record: Record) -> None:
    _inferred(record, "a", c.EntityOneInferredType)
    _inferred(record, "b", c.EntityTwoInferredType)
    words = [record[key]["geometry"] for key in "ab"]
    _value(record, c, c.Offset.Value)
    record["kind"] = "coincident"
    if words == ["plane", "plane"]:
        record |= {"sense": "opposed", "reading": ALONG_NORMAL}
    elif "plane" in words:
        record["reading"] = ALONG_NORMAL
    elif "d" in record["a"] and "d" in record["b"]:
        record["sense"] = SOLUTIONS.get(c.SolutionType, "either")
        if record.get("value"):
            record |= {"kind": "distance", "reading": {"line_line_distance": "parallel"}}
        else:
            record["kind"] = "concentric"
    elif record.get("value"):
        record["kind"] = "distance"


def _flush(owner: Owner, c: Constraint, record: Record) -> None:
    record |= {"kind": "coincident", "sense": "aligned", "reading": ALONG_NORMAL}
    _value(record, c, c.Offset.Value)


def _insert(owner: Owner, c: Constraint, record: Record) -> None:
    record |= {"kind": "insert", "sense": "opposed" if c.AxesOpposed else "aligned", "reading": ALONG_NORMAL}
    if c.LockRotation:
        record["lockRotation"] = True
    _value(record, c, c.Distance.Value)


def _angle(owner: Owner, c: Constraint, record: Record) -> None:
    record["kind"] = "angle"
    solution = c.SolutionType
    _value(record, c, c.Angle.Value)
    if solution == REFERENCE_VECTOR and (entity := c.ReferenceVectorEntity) is not None:
        axis = entity_shape(entity, owner.frame)
        record["c"] = {"component": owner.holder(entity), **axis, "geometry": "line"}
        record["c"].pop("r", None)
    if solution in (DIRECTED, REFERENCE_VECTOR):
        record["reading"] = {"angle": "directed"}


def _tangent(owner: Owner, c: Constraint, record: Record) -> None:
    record |= {"kind": "tangent", "side": "inside" if c.InsideTangency else "outside"}
    offset = c.Offset.Value
    if offset:  # a gap to a round side is a round side so much larger
        round_side = next((record[key] for key in "ab" if record[key].get("r")), None)
        if round_side is None or c.InsideTangency:
            record |= {"kind": "other", "extras": {"offset": offset}}
            raw(owner, record)
        else:
            round_side["r"] += offset


def _motion(kind: str) -> Callable[[Owner, Constraint, Record], None]:
    def build(owner: Owner, c: Constraint, record: Record) -> None:
        sign = 1.0 if c.ForwardDirection else -1.0
        record["kind"] = kind
        if kind == "rack":  # travel a turn becomes travel a radian
            try:
                travel = c.Distance.Value
            except MemberFailed:  # before 2014
                travel = c.Ratio.Value
            record["value"] = sign * travel / math.tau
        else:
            record["value"] = sign * c.Ratio.Value

    return build


def _symmetry(owner: Owner, c: Constraint, record: Record) -> None:
    entity = c.SymmetryPlane
    plane = entity_shape(entity, owner.frame, ("plane",))
    _inferred(record, "a", c.EntityOneInferredType)
    _inferred(record, "b", c.EntityTwoInferredType)
    record |= {
        "kind": "symmetry",
        "c": {"component": owner.holder(entity), **plane},
    }
    with suppress(MemberFailed):  # before 2015; what it means for the equations is not documented
        record["extras"] = {"normalsOpposed": bool(c.NormalsOpposed)}


def _other(owner: Owner, c: Constraint, record: Record) -> None:
    raw(owner, record)


def raw(owner: Owner, record: Record) -> None:
    """Written down as it stands: there are no equations for it."""
    owner.draft.report.approximated(
        f"constraint {record['id']}", "CAPTURE_KIND_RAW", kind=record["rawKind"], program=owner.draft.program
    )


BUILDERS: Mapping[str, Callable[[Owner, Constraint, Record], Any]] = {
    MATE: _mate,
    FLUSH: _flush,
    INSERT: _insert,
    ANGLE: _angle,
    TANGENT: _tangent,
    "RotateRotate": _motion("gear"),
    "RotateTranslate": _motion("rack"),
    "TranslateTranslate": _motion("linear"),
    "AssemblySymmetry": _symmetry,
    "Transitional": _other,
}
