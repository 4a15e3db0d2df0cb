"""Why parts are joined, and by what names a designer knows it."""

from __future__ import annotations

from collections.abc import Iterator

from ...model import Joint
from ..joints.jointing import nodes_of
from .result import Analysis


def reasons(analysis: Analysis, joint: Joint) -> list[str]:
    """Ids of what the source states that a joint comes from: itself, where it is the source's own, and constraints."""
    stated = (joint.id,) if joint.id in analysis.stated_joints else ()
    return list(dict.fromkeys([*stated, *joint.because]))


def group_names(analysis: Analysis) -> list[str]:
    """For each node the id of the first node of its rigid group, 'ground' or, without a body, its own."""
    nodes, groups = analysis.source.nodes, analysis.groups
    names: list[str] = []
    for i, node in enumerate(nodes):
        group = groups.group_of[i]
        if groups.is_ground(i):
            names.append("ground")
        else:
            names.append(node.id if group is None else nodes[groups.members[group][0]].id)
    return names


def fixings(analysis: Analysis) -> dict[int, dict[int | None, list[str]]]:
    """What holds a part still against others: for each node the nodes (None: ground) that constraints or joints join
    it to inside one rigid group, and their ids.  Each is told once, of the later part that is not grounded itself.
    """
    nodes = analysis.source.nodes
    found: dict[int, dict[int | None, list[str]]] = {}

    def place(node: int | None) -> tuple[bool, int]:
        return (node is not None and not nodes[node].grounded, -1 if node is None else node)

    for name, ends in _inside_groups(analysis):
        node = max(ends, key=place)
        for other in ends:
            if node is not None and other != node:
                found.setdefault(node, {}).setdefault(other, []).append(name)
    return {
        node: {other: found[node][other] for other in sorted(found[node], key=place)}
        for node in sorted(found)
    }


def holding(analysis: Analysis) -> dict[int, list[str]]:
    """For each node the ids of what joins it to others of its rigid group."""
    found: dict[int, list[str]] = {}
    for name, ends in _inside_groups(analysis):
        for node in ends:
            if node is not None:
                found.setdefault(node, []).append(name)
    return found


def _inside_groups(analysis: Analysis) -> Iterator[tuple[str, list[int | None]]]:
    """Id and nodes of the constraints and joints between parts that never move against each other, in the
    source's order."""
    assembly = analysis.assembly
    places = assembly.equations.places
    for statement in sorted(assembly.equations.statements, key=lambda s: places[s.id]):
        ends = list(dict.fromkeys(nodes_of(statement)))
        if len(ends) > 1 and len({assembly.body_of(node) for node in ends}) == 1:
            yield statement.id, ends
