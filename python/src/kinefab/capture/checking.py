"""The self check: each captured joint and constraint is evaluated at the captured pose, where it must close.

The residuals are those of the analysis' own equations.  What does not close is read in the other ways that the programs'
documentation leaves open; the first that closes is taken and told, and what none closes is told with its residual.
"""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ..analysis.equations.scene_equations import Equations, equations_of, joint_sides
from ..diagnostics import KinefabError, Report
from ..model import RX, Constraint, Joint, JointKind, Scene, Sense
from ..sources.bundle.reader import scene_from_values
from ..sources.reading.joint_frames import coordinates, freedom_names
from ..sources.reading.source_frame import METRES
from .draft import Draft, Record
from .readings import Poses, poses_of, readings

CLOSED = 2e-6
"""Metres or radians up to which a joint or constraint closes: a program states its numbers with that much."""
CHECKED = frozenset({"joints", "constraints"})
_NOTHING: dict[str, list[Record]] = {key: [] for key in (*CHECKED, "couplings", "dof")}


def check(draft: Draft) -> None:
    """Try every joint and constraint of the draft, put the readings that close into it, and report."""
    poses = poses_of(draft.components)
    for kind, records in (("joints", draft.joints), ("constraints", draft.constraints)):
        found = residuals(draft, **{kind: records})
        open_ones = {
            i for i, r in enumerate(records) if found.get(r["id"], 0.0) > CLOSED and not r.get("suppressed")
        }
        closing = _closing(draft, kind, [records[i] for i in sorted(open_ones)], poses)
        for i in sorted(open_ones):
            name = records[i]["id"]
            told = {"id": name, "residual": f"{found[name]:.3g}", "program": draft.program}
            if name in closing:
                words, other = closing[name]
                dofs = zip(records[i].get("dof", []), other.get("dof", []))
                draft.turned ^= {
                    (name, dof["name"]) for was, dof in dofs if was.get("value") != dof.get("value")
                }
                records[i] = {**other, "extras": {**other.get("extras", {}), "reading": words}}
                draft.report.add("CAPTURE_READING_CHANGED", words=words, **told)
            else:
                draft.report.add("CAPTURE_NOT_CLOSED", **told)


def _closing(draft: Draft, kind: str, open_ones: list[Record], poses: Poses) -> dict[str, tuple[str, Record]]:
    """Of records that are open, by id: the first other reading that closes."""
    others: dict[str, tuple[str, str, Record]] = {}
    for record in open_ones:
        owner = draft.owners.get(record["id"], "world")
        for number, (words, other) in enumerate(readings(record, owner, poses)):
            key = f"{record['id']}\x1f{number}"
            others[key] = (record["id"], words, {**other, "id": key})
    found = residuals(draft, **{kind: [other for _, _, other in others.values()]}) if others else {}
    closing: dict[str, tuple[str, Record]] = {}
    for key, (name, words, other) in others.items():
        if found.get(key, math.inf) <= CLOSED:
            closing.setdefault(name, (words, {**other, "id": name}))
    return closing


def residuals(draft: Draft, **records: list[Record]) -> dict[str, float]:
    """Largest residual of each joint or constraint at the captured pose, metres or radians, by id; those that no
    equation is known for, or that the bundle's reader refuses, have none."""
    values = {**plain(draft), **records}
    for key in ("couplings", "dof", *(CHECKED - records.keys())):
        values.pop(key, None)
    if "joints" in values:
        values["joints"] = [_without_values(joint) for joint in values["joints"]]
    try:
        scene = scene_from_values(values, Path("capture.bundle.json"), b"", Report())
    except KinefabError:
        return _one_by_one(draft, records)
    equations = equations_of(scene, Report())
    found = _of_rows(equations)
    for number, statement in enumerate(equations.statements):
        if (
            isinstance(statement, Constraint)
            and number in equations.directions
            and statement.sense is not Sense.EITHER
        ):
            wanted = 1.0 if statement.sense is Sense.ALIGNED else -1.0
            found[statement.id] = max(
                found.get(statement.id, 0.0), 1.0 - wanted * equations.directions[number]
            )
    for ranged in equations.ranges:
        c = ranged.constraint
        low, high = -math.inf if c.lower is None else c.lower, math.inf if c.upper is None else c.upper
        found[c.id] = max(found.get(c.id, 0.0), low - ranged.measured, ranged.measured - high)
    length = METRES[draft.length]
    stated = {record["id"]: record for record in records.get("joints", [])}
    for joint in scene.joints:
        found[joint.id] = max(found.get(joint.id, 0.0), _off_value(joint, stated[joint.id], scene, length))
    return found


def _one_by_one(draft: Draft, records: dict[str, list[Record]]) -> dict[str, float]:
    """Where a record is faulty it alone has no residual; where the components are, none has."""
    found: dict[str, float] = {}
    try:
        scene_from_values({**plain(draft), **_NOTHING}, Path("capture.bundle.json"), b"", Report())
    except KinefabError:
        return found
    for key, listed in records.items():
        if len(listed) > 1:
            half = len(listed) // 2
            found |= residuals(draft, **{key: listed[:half]}) | residuals(draft, **{key: listed[half:]})
        elif listed:
            found[listed[0]["id"]] = math.inf
    return found


def _without_values(joint: Record) -> Record:
    """The joint as its frames alone have it; the reader would place them so that they read the value."""
    return {k: v for k, v in joint.items() if k not in ("dof", "flipped", "because")}


def _of_rows(equations: Equations) -> dict[str, float]:
    system = equations.system
    values = np.abs(system.residual(system.start())) * np.where(system.is_length, system.row_length, 1.0)
    found: dict[str, float] = {}
    for owner, value in zip(map(int, system.owner), map(float, values)):
        name = equations.statements[owner].id
        found[name] = max(found.get(name, 0.0), value)
    return found


def _off_value(joint: Joint, record: Record, scene: Scene, length: float) -> float:
    """How far the frames are from the coordinates that the program displays, and these from their limits."""
    a, b = joint_sides(joint, scene)
    axes_a, axes_b = np.array([a.z, a.x, a.y]), np.array([b.z, b.x, b.y]).T
    measured = coordinates((axes_a @ axes_b)[None], (axes_a @ (b.p - a.p))[None])[0]
    names, whole = freedom_names(joint.kind), "frameB" in record
    angles = whole and all("x" in record[key] for key in ("frameA", "frameB"))
    off = 0.0
    for dof in record.get("dof", []):
        freedom, value = names.get(dof["name"]), dof.get("value")
        if freedom is None or value is None or joint.kind is JointKind.SPHERICAL:
            continue
        unit = 1.0 if freedom >= RX else length
        if freedom >= RX and angles:
            off = max(off, abs(math.remainder(value - measured[freedom], math.tau)))
        elif freedom < RX and whole:
            off = max(off, abs(value * unit - measured[freedom]))
        low = dof["min"] if dof.get("minEnabled") else -math.inf
        high = dof["max"] if dof.get("maxEnabled") else math.inf
        off = max(off, (low - value) * unit, (value - high) * unit)
    return off


def plain(draft: Draft) -> Record:
    """The bundle's values without geometry and materials."""
    values = draft.values()
    values.pop("materials", None)
    left = ("bodies", "mass")
    values["components"] = [{k: v for k, v in c.items() if k not in left} for c in draft.components]
    return values
