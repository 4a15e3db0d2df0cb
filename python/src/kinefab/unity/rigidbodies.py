"""Which GameObjects get a Rigidbody: one for each rigid group, on the node that holds just this group."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..diagnostics import Report
from ..geometry.mass import combined, moved, principal
from ..model import MassProperties, Node, NodeKind, Scene
from ..rigid import RigidGroups
from ..spatial import quaternion_from_matrix
from . import frames
from .numbers import rounded, significant

UNITY_DEFAULT = MassProperties(1.0, np.zeros(3), np.eye(3))
"""A Rigidbody's mass and inertia before anyone sets them: 1 kg and 1 kg m^2."""


@dataclass(frozen=True, slots=True, eq=False)
class Rigidbodies:
    """carrier_of: for each node the node whose Rigidbody moves it, or None (ground, or no body).
    carriers: every node that gets a Rigidbody, with the nodes it moves, in scene order.
    fixed: pairs (own, connected) of carriers that a FixedJoint holds together.
    """

    carrier_of: tuple[int | None, ...]
    carriers: dict[int, tuple[int, ...]]
    fixed: tuple[tuple[int, int], ...]


def place_rigidbodies(scene: Scene, groups: RigidGroups) -> Rigidbodies:
    """One Rigidbody at the node whose subtree is exactly the group; else one for each member that has mass,
    and FixedJoints to the first of them."""
    carrier_of: list[int | None] = [None] * len(scene.nodes)
    carriers: dict[int, tuple[int, ...]] = {}
    fixed: list[tuple[int, int]] = []
    subtree = _subtree_bodies(scene, groups)
    for group, members in enumerate(groups.members):
        if groups.grounded[group]:
            continue
        parts = [i for i in members if scene.nodes[i].kind is NodeKind.PART] or list(members)
        top = _common_ancestor(scene, members)
        whole = top is not None and subtree[top] == len(members)
        if len(parts) == 1 and (not whole or len(members) == 1):
            top, whole = parts[0], True
        if whole:
            carriers[top] = members
            for i in members:
                carrier_of[i] = top
            continue
        for i in parts:
            carriers[i] = (i,)
            carrier_of[i] = i
            if i != parts[0]:
                fixed.append((i, parts[0]))
        for i in members:
            if carrier_of[i] is None:
                carrier_of[i] = parts[0]
    return Rigidbodies(tuple(carrier_of), dict(sorted(carriers.items())), tuple(fixed))


def rigidbody_fields(
    scene: Scene, carrier: int, moved_nodes: tuple[int, ...], report: Report
) -> dict[str, object]:
    """Mass, centre of mass and principal inertia of everything a carrier moves, in the carrier's frame."""
    own = scene.nodes[carrier]
    if own.mass is not None and (own.kind is NodeKind.ASSEMBLY or moved_nodes == (carrier,)):
        known = [own.mass]
    else:
        to_carrier = own.pose.inverse()
        counted, weightless = _weighed(scene, moved_nodes)
        known = [moved(node.mass, to_carrier @ node.pose) for node in counted]
        for node in weightless if known else ():
            report.add("MASS_LEFT_OUT", node.where, node=node.id, carrier=own.id)
    if not known:
        report.approximated(f"mass {own.id}", "MASS_UNKNOWN", own.where, node=own.id)
    total = combined(known) if known else UNITY_DEFAULT
    moments, axes = principal(total.inertia)
    return {
        "type": "Rigidbody",
        "mass": significant(total.mass),
        "centerOfMass": rounded(frames.point(total.center)),
        "inertiaTensor": significant(moments),
        "inertiaTensorRotation": rounded(frames.quaternion(quaternion_from_matrix(axes))),
    }


def _weighed(scene: Scene, indices: tuple[int, ...]) -> tuple[list[Node], list[Node]]:
    """Of some nodes those whose masses add up, and the parts that have none.

    What stands below an assembly with a mass of its own is in neither: its mass is already that assembly's.
    """
    whole = {i for i in indices if scene.nodes[i].kind is NodeKind.ASSEMBLY and scene.nodes[i].mass is not None}
    outer = [scene.nodes[i] for i in indices if whole.isdisjoint(_line(scene, i)[1:])]
    weightless = [node for node in outer if node.mass is None and node.kind is NodeKind.PART]
    return [node for node in outer if node.mass is not None], weightless


def _subtree_bodies(scene: Scene, groups: RigidGroups) -> list[int]:
    """For each node how many bodies its subtree holds, itself included."""
    counts = [0 if group is None else 1 for group in groups.group_of]
    for i in range(len(scene.nodes) - 1, -1, -1):
        parent = scene.nodes[i].parent
        if parent is not None:
            counts[parent] += counts[i]
    return counts


def _common_ancestor(scene: Scene, members: tuple[int, ...]) -> int | None:
    """The deepest node whose subtree holds all members; a member counts as its own ancestor."""
    common = _line(scene, members[0])
    for i in members[1:]:
        line = set(_line(scene, i))
        common = [n for n in common if n in line]
    return common[0] if common else None


def _line(scene: Scene, node: int) -> list[int]:
    """A node and its ancestors, upwards."""
    line = [node]
    while (parent := scene.nodes[line[-1]].parent) is not None:
        line.append(parent)
    return line
