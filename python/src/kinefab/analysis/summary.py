"""An analysis as plain data (for JSON and for the scene file) and as a table for a designer."""

from __future__ import annotations

import math
from typing import Any, Iterable, Mapping, Sequence

from ..model import RX, Joint, Motion
from .freedoms import NodeFreedom
from .result import Analysis

FREEDOM_NAMES = ("tx", "ty", "tz", "rx", "ry", "rz")
LONGEST = 44


def scene_entry(analysis: Analysis) -> dict[str, Any]:
    """What the scene file keeps, by node number and in the exporter's right-handed frame.

    ``unity.mobility`` turns it into the file's terms.
    """
    metres, degrees = analysis.worst_gap
    return {
        "mobility": analysis.mobility,
        "firstOrderMobility": analysis.first_order,
        "redundant": analysis.redundant,
        "idle": sum(idle.count for idle in analysis.idle),
        "closureGap": {"position": metres, "angle": degrees},
        "islands": [
            {"nodes": list(i.nodes), "mobility": i.mobility, "redundant": i.redundant, "loops": i.loops}
            for i in analysis.islands
        ],
        "bodies": [
            {"node": f.node, "directions": list(f.translations), "axes": list(f.rotations)}
            for f in analysis.freedoms
        ],
    }


def document(analysis: Analysis) -> dict[str, Any]:
    """Everything found, by the source's own names; right-handed, +Y up, metres and radians."""
    names = [n.id for n in analysis.source.nodes] + [n.id for n in analysis.nodes]
    fixed = _group_names(analysis)
    freedoms = {f.node: f for f in analysis.freedoms}
    return {
        "frame": "right-handed, +Y up, metres, radians",
        "mobility": analysis.mobility,
        "firstOrderMobility": analysis.first_order,
        "rows": analysis.rows,
        "rank": analysis.rank,
        "redundant": analysis.redundant,
        "parts": [
            {
                "id": names[node],
                "group": fixed[node],
                "translations": [_numbers(v) for v in freedoms[node].translations],
                "rotations": [_numbers(v) for v in freedoms[node].rotations],
                "center": None if freedoms[node].center is None else _numbers(freedoms[node].center),
            }
            for node in freedoms
        ],
        "joints": [_joint(analysis, joint, names) for joint in analysis.joints],
        "couplings": [
            {
                "id": c.id,
                "kind": c.kind.value,
                "a": c.joint_a,
                "freedomA": FREEDOM_NAMES[c.freedom_a],
                "b": c.joint_b,
                "freedomB": FREEDOM_NAMES[c.freedom_b],
                "ratio": c.ratio,
                "offset": c.offset,
            }
            for c in analysis.couplings
        ],
        "islands": [
            {
                "parts": [names[n] for n in i.nodes],
                "mobility": i.mobility,
                "firstOrderMobility": i.first_order,
                "rows": i.rows,
                "redundant": i.redundant,
                "loops": i.loops,
                "floating": i.floating,
            }
            for i in analysis.islands
        ],
        "idle": [{"parts": [names[n] for n in i.nodes], "count": i.count} for i in analysis.idle],
        "gaps": [
            {"constraint": g.constraint, "metres": g.metres, "degrees": g.degrees} for g in analysis.gaps
        ],
        "contradictory": analysis.contradictory,
        "ranges": [
            {
                "joint": r.joint,
                "freedom": FREEDOM_NAMES[r.freedom],
                "lower": lower if math.isfinite(lower) else None,
                "upper": upper if math.isfinite(upper) else None,
            }
            for r in analysis.ranges
            for lower, upper in [r.displayed]
        ],
        "findings": [
            {
                "code": d.code,
                "severity": d.severity.value,
                "message": d.message,
                "remedy": d.remedy,
                "where": d.where,
            }
            for d in analysis.report.diagnostics
        ],
    }


def _joint(analysis: Analysis, joint: Joint, names: Sequence[str]) -> dict[str, Any]:
    scene = analysis.scene(solved=True)
    frame = scene.pose(joint.a) @ joint.frame_a
    entry: dict[str, Any] = {
        "id": joint.id,
        "kind": joint.kind.value,
        "a": "ground" if joint.a is None else names[joint.a],
        "b": "ground" if joint.b is None else names[joint.b],
        "free": [FREEDOM_NAMES[i] for i, f in enumerate(joint.freedoms) if f.motion is not Motion.LOCKED],
        "origin": _numbers(frame.translation),
        "x": _numbers(frame.rotation[:, 0]),
        "y": _numbers(frame.rotation[:, 1]),
        "closesLoop": joint.closure,
        "because": list(joint.because),
    }
    if joint.lead:
        entry["lead"] = joint.lead
    return entry


def _numbers(v: Iterable[float]) -> list[float]:
    return [float(x) + 0.0 for x in v]


def _group_names(analysis: Analysis) -> list[str]:
    """For each node the id of the first node of its rigid group, 'ground' or, without a body, its own."""
    nodes, groups = analysis.source.nodes, analysis.groups
    names = []
    for i, node in enumerate(nodes):
        group = groups.group_of[i]
        if groups.is_ground(i):
            names.append("ground")
        else:
            names.append(node.id if group is None else nodes[groups.members[group][0]].id)
    return names


HEADINGS = ("part", "group", "freedoms", "joint", "to", "why")


def table(analysis: Analysis) -> str:
    """What moves against what and why, one joint a line; the mobility on the last line."""
    rows = [HEADINGS, *_rows(analysis)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEADINGS))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    for coupling in analysis.couplings:
        lines.append(
            f"{coupling.kind.value} {coupling.id}: "
            f"{coupling.joint_b} = {coupling.ratio:g} x {coupling.joint_a}"
        )
    for idle in analysis.idle:
        parts = ", ".join(analysis.source.nodes[n].id for n in idle.nodes)
        lines.append(f"idle: {idle.count} of {parts} moves nothing else")
    for found in analysis.ranges:
        unit, factor = ("deg", math.degrees(1.0)) if found.freedom >= RX else ("m", 1.0)
        ends = " to ".join(f"{end * factor:.6g}" for end in found.displayed) + f" {unit}"
        lines.append(f"range of {found.joint}: {'no end' if found.endless else ends}")
    loops = sum(i.loops for i in analysis.islands)
    first = f", {analysis.first_order} at first order" if analysis.first_order != analysis.mobility else ""
    lines.append(
        f"mobility {analysis.mobility}{first}; {analysis.rows} equations, {analysis.redundant} redundant; "
        f"{_counted(len(analysis.islands), 'mechanism')}, {_counted(loops, 'loop')}"
    )
    return "\n".join(lines)


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _rows(analysis: Analysis) -> list[tuple[str, ...]]:
    nodes = [*analysis.source.nodes, *analysis.nodes]
    groups = _group_names(analysis)
    freedoms: dict[int, NodeFreedom | None] = {f.node: f for f in analysis.freedoms}
    freedoms.update({len(analysis.source.nodes) + i: None for i in range(len(analysis.nodes))})
    by_node: dict[int, list[Joint]] = {}
    for joint in analysis.joints:
        by_node.setdefault(_listed(analysis, joint.a if joint.b is None else joint.b, freedoms), []).append(
            joint
        )
    rows = []
    for node, freedom in freedoms.items():
        name = nodes[node].id
        group = groups[node] if node < len(groups) else name
        start = (name, "" if group == name else group, _words(freedom) if freedom is not None else "")
        joints = by_node.get(node, [])
        for joint in joints or [None]:
            if joint is None:
                rows.append((*start, "", "", ""))
            else:
                other = None if joint.b is None else joint.a
                kind = joint.kind.value + (" (closes a loop)" if joint.closure else "")
                rows.append(
                    (*start, kind, "ground" if other is None else nodes[other].id, _shortened(joint.because))
                )
            start = ("", "", "")
    return rows


def _listed(analysis: Analysis, node: int, freedoms: Mapping[int, Any]) -> int:
    """The part in whose line a joint of ``node`` stands: of a rigid assembly, its first part."""
    if node in freedoms:
        return node
    group = analysis.groups.group_of[node]
    return next((n for n in analysis.groups.members[group] if n in freedoms), node)


def _words(freedom: NodeFreedom) -> str:
    t, r = len(freedom.translations), len(freedom.rotations)
    if not t + r:
        return "none"
    words = [f"{n} {word}{'s' if n > 1 else ''}" for n, word in ((r, "rotation"), (t, "translation")) if n]
    return ", ".join(words)


def _shortened(because: Sequence[str]) -> str:
    text = ", ".join(because)
    return text if len(text) <= LONGEST else f"{text[:LONGEST - 3]}..."
