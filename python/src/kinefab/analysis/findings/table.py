"""An analysis as a table that a designer can read."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from ...diagnostics import named, printable
from ...findings import JointFinding
from ...model import RX, Coupling, Joint
from .freedoms import NodeFreedom
from .reasons import fixings, group_names, reasons
from .result import Analysis

HEADINGS = ("part", "group", "freedoms", "joint", "to", "why")
LONGEST = 44
"""Characters of a list of names; the JSON has them all."""


def table(analysis: Analysis) -> str:
    """What moves against what and why, one joint a line; the mobility on the last line."""
    rows = [HEADINGS, *_rows(analysis)]
    widths = [max(len(row[i]) for row in rows) for i in range(len(HEADINGS))]
    lines = ["  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
    lines.insert(1, "  ".join("-" * width for width in widths))
    lines += [_coupling(coupling) for coupling in analysis.couplings]
    for idle in analysis.idle:
        parts = ", ".join(analysis.source.nodes[n].id for n in idle.nodes)
        can = f"can move in {_counted(idle.count, 'way')} that {'moves' if idle.count == 1 else 'move'} nothing else"
        lines.append(f"idle: {parts} {can}")
    called = _called(analysis.joints)
    for found in analysis.ranges:
        unit, factor = ("deg", math.degrees(1.0)) if found.freedom >= RX else ("m", 1.0)
        ends = " to ".join(f"{end * factor:.6g}" for end in found.displayed) + f" {unit}"
        lines.append(f"range of {called.get(found.joint, found.joint)}: {'no end' if found.endless else ends}")
    for option, names in analysis.source.offers.items():
        lines.append(f"the source also has: --{option} {_shortened(names)}")
    loops = sum(i.loops for i in analysis.islands)
    first = f", {analysis.first_order} at first order" if analysis.first_order != analysis.mobility else ""
    lines.append(
        f"mobility {analysis.mobility}{first}; {_counted(analysis.rows, 'equation')}, {analysis.redundant} redundant; "
        f"{_counted(len(analysis.islands), 'mechanism')}, {_counted(loops, 'loop')}"
    )
    return "\n".join(map(printable, lines))


def _counted(count: int, noun: str) -> str:
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def _rows(analysis: Analysis) -> Iterator[tuple[str, ...]]:
    nodes = [*analysis.source.nodes, *analysis.nodes]
    groups = group_names(analysis)
    freedoms: dict[int, NodeFreedom | None] = {f.node: f for f in analysis.freedoms}
    freedoms.update({len(analysis.source.nodes) + i: None for i in range(len(analysis.nodes))})
    lines: dict[int, list[tuple[str, str, str]]] = {}
    for node, held in fixings(analysis).items():
        others = ", ".join("ground" if other is None else nodes[other].id for other in held)
        why = dict.fromkeys(name for names in held.values() for name in names)
        lines.setdefault(_listed(analysis, node, freedoms), []).append(("fixed", others, _shortened(why)))
    for joint in analysis.joints:
        node = _listed(analysis, joint.a if joint.b is None else joint.b, freedoms)
        other = "ground" if joint.b is None or joint.a is None else nodes[joint.a].id
        if not _among_the_fixings(analysis, joint):
            kind = _kind(joint, analysis.findings[joint.id])
            lines.setdefault(node, []).append((kind, other, _shortened(reasons(analysis, joint))))
    for node, freedom in freedoms.items():
        name = nodes[node].id
        group = groups[node] if node < len(groups) else name
        start = (name, "" if group == name else group, _words(freedom) if freedom is not None else "")
        for line in lines.get(node, [("", "", "")]):
            yield (*start, *line)
            start = ("", "", "")


def _among_the_fixings(analysis: Analysis, joint: Joint) -> bool:
    """Whether both ends are parts of one rigid group; a middle body, which the source does not have, is in none."""
    own = len(analysis.source.nodes)
    stated = all(node is None or node < own for node in (joint.a, joint.b))
    return stated and analysis.groups.together(joint.a, joint.b)


def _listed(analysis: Analysis, node: int | None, freedoms: Mapping[int, Any]) -> int:
    """The part in whose line a joint of ``node`` stands: of a rigid assembly, its first part."""
    assert node is not None, "a joint has a node on one side at least"
    if node in freedoms:
        return node
    group = analysis.groups.group_of[node]
    members = () if group is None else analysis.groups.members[group]
    return next((n for n in members if n in freedoms), node)


def _kind(joint: Joint, found: JointFinding) -> str:
    """The user's name for it, what the source's constraints make of it, and what of that is left to its loop."""
    words = [found.whole_kind(joint).value.replace("_", " ")]
    if joint.name not in ("", joint.id):  # an id is among the reasons
        words.insert(0, f"{joint.name}:")
    if found.freed:
        words.append(f"(closes a loop that holds {' '.join(map(joint.freedom_name, found.freed))})")
    elif found.closure:
        words.append("(closes a loop)")
    metres, radians = found.misfit
    if metres or radians:
        words.append(f"(approximated, off by up to {metres:.2g} m or {math.degrees(radians):.2g} deg)")
    return " ".join(words)


def _called(joints: Iterable[Joint]) -> dict[str, str]:
    """Each joint's own name by its id, as the table above has it, and the id too where several are called alike."""
    joints = list(joints)
    often = Counter(joint.name for joint in joints)
    return {j.id: j.name if often[j.name] == 1 else f"{j.name} ({j.id})" for j in joints if j.name}


def _coupling(coupling: Coupling) -> str:
    """``gear G: rotation of [A] = -0.4 x rotation of [B]``."""
    turns = coupling.freedom >= RX
    follows: list[str] = []
    for term in coupling.terms:
        unit = {(True, False): " m/rad", (False, True): " rad/m"}.get((term.freedom >= RX, turns), "")
        follows.append(f"{term.ratio:g}{unit} x {_coordinate(term.joint, term.freedom)}")
    own = _coordinate(coupling.joint, coupling.freedom)
    return f"{coupling.kind.value} {coupling.id}: {own} = {' + '.join(follows)}"


def _coordinate(joint: str, freedom: int) -> str:
    return f"{'rotation' if freedom >= RX else 'translation'} of [{joint}]"


def _words(freedom: NodeFreedom) -> str:
    t, r = len(freedom.translations), len(freedom.rotations)
    words = [_counted(n, word) for n, word in ((r, "rotation"), (t, "translation")) if n]
    return ", ".join(words) or "none"


def _shortened(names: Iterable[str]) -> str:
    """As many names as fit, and how many more there are."""
    names = list(names)
    most = min(len(names), LONGEST)
    while most > 1 and len(named(names, most)) > LONGEST:
        most -= 1
    return named(names, most)
