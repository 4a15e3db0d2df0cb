"""Several joints of one freedom between the same two bodies.

UsdPhysics takes each as a constraint of its own: two hinges across each other leave nothing.  MuJoCo's joints of one body
add up, each in the frame that the ones before have moved; its converter writes a prim for each, marked by its schema, and
Newton reads them so.  Here light bodies stand between such joints.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ....diagnostics import Report
from ....model import Joint, JointKind, Node, NodeKind
from ....spatial import Pose, rotation_log
from ...robots.rigid_links import unique
from ..values import schemas
from .joints import Readings

ADDING = ("MjcJointAPI", "NewtonJointAPI")
APART = 1e-5
"""Radians, and share of a length, by which the two sides of a joint that stands at its zero may miss each other."""


def stacked(
    nodes: list[Node],
    read: Sequence[tuple[Any, Joint]],
    readings: Readings,
    report: Report,
) -> list[Joint]:
    """The joints, with light ``nodes`` added between those that add up.  read: joint prims with their joints.

    Of bodies that several other joints hold, what is left to move is told.
    """
    groups: dict[tuple[int | None, int | None], list[int]] = {}
    for i, (_, joint) in enumerate(read):
        closing = joint.extras.get("excludeFromArticulation", False)
        if joint.enabled and not closing and joint.kind in (JointKind.REVOLUTE, JointKind.PRISMATIC):
            groups.setdefault((joint.a, joint.b), []).append(i)
    joints = [joint for _, joint in read]
    for (a, b), members in groups.items():
        if len(members) < 2 or b is None:
            continue
        own = [joints[i] for i in members]
        names = ", ".join(joint.id for joint in own)
        marked = all(any(word in schemas(read[i][0]) for word in ADDING) for i in members)
        turned = any(joint.id in readings.turned for joint in own)
        if not marked or turned or not all(_at_zero(joint, nodes) for joint in own):
            report.add("USD_JOINTS_INTERSECT", own[0].where, names=names, body=nodes[b].id)
            continue
        for i, joint in zip(members, _chain(nodes, own, a, b)):
            joints[i] = joint
        report.approximated(
            f"joints of {nodes[b].id}", "USD_JOINTS_STACKED", own[0].where, names=names, body=nodes[b].id
        )
    return joints


def _at_zero(joint: Joint, nodes: Sequence[Node]) -> bool:
    """Whether the two frames are one at the exported pose."""
    sides = [
        frame if node is None else nodes[node].pose @ frame
        for node, frame in ((joint.a, joint.frame_a), (joint.b, joint.frame_b))
    ]
    gap = sides[0].inverse() @ sides[1]
    reach = max(1.0, float(np.abs(sides[0].translation).max()))
    return (
        float(np.linalg.norm(gap.translation)) <= APART * reach
        and float(np.linalg.norm(rotation_log(gap.rotation))) <= APART
    )


def _chain(nodes: list[Node], joints: Sequence[Joint], a: int | None, b: int) -> list[Joint]:
    """The joints from a to b, one after the other: all but the last to a light body that stands where b does."""
    body = nodes[b]
    known = {node.id: node for node in nodes}
    found: list[Joint] = []
    before: int | None = a
    for number, joint in enumerate(joints):
        here = b
        if number < len(joints) - 1:
            here = len(nodes)
            ident = unique(known, f"{body.id} {joint.name}")
            middle = Node(
                ident,
                ident.rpartition("/")[2],
                NodeKind.PART,
                body.parent,
                Pose(body.pose.rotation, body.pose.translation),
                colliders=(),
                dynamics=replace(body.dynamics, kinematic=False),
                where=joint.where,
                helps=b,
            )
            nodes.append(middle)
            known[ident] = middle
        frame = joint.frame_b
        if number == 0:  # as the other side has it, but for what single precision leaves
            frame = body.pose @ frame if a is None else nodes[a].pose.inverse() @ body.pose @ frame
        found.append(replace(joint, a=before, b=here, frame_a=frame))
        before = here
    return found
