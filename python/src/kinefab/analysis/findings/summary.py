"""An analysis as plain data, for JSON and for the scene file."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from ...model import FREEDOM_NAMES, Joint
from .reasons import fixings, group_names, reasons
from .result import Analysis


def scene_entry(analysis: Analysis) -> dict[str, Any]:
    """What the scene file keeps, by node number and in the exporter's right-handed frame.

    ``unity.mobility`` turns it into the file's terms.
    """
    metres, degrees = analysis.worst_gap
    return {
        "mobility": analysis.mobility,
        "firstOrderMobility": analysis.first_order,
        # bodies that only a loop holds together are merged, and what joined them is then held more than once
        "redundant": max(analysis.redundant, sum(island.redundant for island in analysis.islands)),
        "idle": None if _has_loops_that_nothing_closes(analysis) else sum(idle.count for idle in analysis.idle),
        "closureGap": {"position": metres, "angle": degrees},
        "islands": [
            {"nodes": list(i.nodes), "mobility": i.mobility, "redundant": i.redundant, "loops": i.loops}
            for i in analysis.islands
        ],
        "bodies": [
            {"node": f.node, "directions": f.translations, "axes": f.rotations} for f in analysis.freedoms
        ],
    }


def _has_loops_that_nothing_closes(analysis: Analysis) -> bool:
    """Whether a slack rope, or a closing joint whose rows the loop holds all, stands between two parts and holds nothing:
    from the joints no one can tell that there is a loop, in which alone freedoms are idle."""
    freed = any(not joint.locked and analysis.findings[joint.id].freed for joint in analysis.joints)
    return freed or any(island.slack for island in analysis.islands)


def document(analysis: Analysis) -> dict[str, Any]:
    """Everything found, by the source's own names; right-handed, +Y up, metres and radians."""
    names = [n.id for n in analysis.source.nodes] + [n.id for n in analysis.nodes]
    groups, held = group_names(analysis), fixings(analysis)
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
                "group": groups[node],
                "fixed": [
                    {"to": "ground" if other is None else names[other], "because": why}
                    for other, why in held.get(node, {}).items()
                ],
                "translations": [_numbers(v) for v in freedoms[node].translations],
                "rotations": [_numbers(v) for v in freedoms[node].rotations],
                "center": None if (center := freedoms[node].center) is None else _numbers(center),
            }
            for node in freedoms
        ],
        "joints": [_joint(analysis, joint, names) for joint in analysis.joints],
        "couplings": [
            {
                "id": c.id,
                "kind": c.kind.value,
                "joint": c.joint,
                "freedom": FREEDOM_NAMES[c.freedom],
                "terms": [
                    {"joint": t.joint, "freedom": FREEDOM_NAMES[t.freedom], "ratio": t.ratio} for t in c.terms
                ],
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
        "offers": {option: list(names) for option, names in analysis.source.offers.items()},
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
    scene, found = analysis.scene(solved=True), analysis.findings[joint.id]
    frame = scene.pose(joint.a) @ joint.frame_a
    entry: dict[str, Any] = {
        "id": joint.id,
        "kind": joint.kind.value,
        "a": "ground" if joint.a is None else names[joint.a],
        "b": "ground" if joint.b is None else names[joint.b],
        "free": [FREEDOM_NAMES[i] for i in joint.unlocked],
        "origin": _numbers(frame.translation),
        "x": _numbers(frame.rotation[:, 0]),
        "y": _numbers(frame.rotation[:, 1]),
        "closesLoop": found.closure,
        "because": reasons(analysis, joint),
    }
    if joint.name:
        entry["name"] = joint.name
    if found.closure:
        entry["loop"] = [scene.name(node) for node in found.loop]
    if found.freed:
        entry |= {
            "wholeKind": found.whole_kind(joint).value,
            "heldByLoop": [FREEDOM_NAMES[i] for i in found.freed],
        }
    if any(found.misfit):
        entry["misfit"] = {"metres": found.misfit[0], "radians": found.misfit[1]}
    if joint.lead:
        entry["lead"] = joint.lead
    return entry


def _numbers(v: Iterable[float]) -> list[float]:
    return [float(x) + 0.0 for x in v]
