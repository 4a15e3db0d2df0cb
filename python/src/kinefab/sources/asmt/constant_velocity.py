"""A joint of constant velocity: two shafts that meet in a point and turn alike at every angle between them.

Turning one shaft into the other never turns about the line between them: the quaternion of J in I has no part along z, which is
just what x, then y, then x by the same angle again can make: Rx(p) Ry(2q) Rx(p) = (cos q cos p, cos q sin p, sin q, 0).  So
it is three hinges with two light bodies between, the third coupled to the first; nothing is singular where the shafts are in line.

Source: ISO 10303-105 splits a homokinetic pair's first rotation so; OndselSolver's ``ConstVelConstraintIJ`` is xI.yJ + yI.xJ = 0.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...model import (
    RX,
    Coupling,
    CouplingKind,
    Freedom,
    Joint,
    JointKind,
    Motion,
    Node,
    NodeKind,
    Scene,
    Term,
    freedoms_of,
)
from ...spatial import Array, Pose, quaternion_from_matrix, rotation_about
from ..robots.rigid_links import unique

ALIKE = 1e-4
"""Parts of a quaternion, up to which both half turns do as well: the axes then point the same way in one line."""
FIRST = np.eye(3)
SECOND: Array = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
"""Columns y, z, x: the axes of a hinge about y, which has its axis along X."""


def turned_against(between: Array) -> Array | None:
    """The half turn of J under which OndselSolver's equation is that J turns about no part of z; None where both may be meant.

    between: J's axes in I's.  Its equation is that the product of the quaternion's parts along x and y is zero.
    """
    x, y = np.abs(quaternion_from_matrix(between)[:2])
    if max(x, y) < ALIKE:
        return None
    return np.diag([1.0, -1.0, -1.0]) if y <= x else np.diag([-1.0, 1.0, -1.0])


def add_constant_velocity(
    scene: Scene,
    ident: str,
    name: str,
    ends: tuple[tuple[int | None, Pose], tuple[int | None, Pose]],
    where: str,
) -> None:
    """Add the joint between two nodes (None: the ground), each with its frame: z along its shaft, one way through the joint."""
    if ends[1][0] is None:  # a scene's joint hangs on a node; the other way round it is the same
        ends = ends[1], ends[0]
    (a, frame_a), (b, frame_b) = ends
    assert b is not None
    first, last = ((Pose() if n is None else scene.nodes[n].pose) @ frame for n, frame in ends)
    x, y, _, w = quaternion_from_matrix(first.rotation.T @ last.rotation)
    turn, bend = math.atan2(x, w), 2.0 * math.asin(min(max(y, -1.0), 1.0))
    inner = first.rotation @ rotation_about(np.eye(3)[0], turn)
    outer = inner @ rotation_about(np.eye(3)[1], bend)
    known = {node.id: node for node in scene.nodes}
    between = [
        _light(scene, unique(known, f"{scene.nodes[b].id} {name} {word}"), b, pose, where)
        for word, pose in (
            ("inner", Pose(inner, first.translation)),
            ("outer", Pose(outer, first.translation)),
        )
    ]
    free = freedoms_of(JointKind.REVOLUTE, rx=Freedom(Motion.FREE))
    at = Pose()
    chain = (
        (f"{ident} in", a, frame_a, between[0], at, FIRST),
        (ident, between[0], at, between[1], at, SECOND),
        (f"{ident} out", between[1], at, b, frame_b, FIRST),
    )
    for key, here, frame, there, other, axes in chain:
        in_a, in_b = (Pose(side.rotation @ axes, side.translation) for side in (frame, other))
        joint = Joint(key, JointKind.REVOLUTE, here, there, in_a, in_b, free, name=key, where=where)
        scene.joints.append(joint)
    half = Term(f"{ident} in", RX, 1.0)
    scene.couplings.append(
        Coupling(f"{ident} halves", CouplingKind.GEAR, f"{ident} out", RX, (half,), where=where)
    )


def _light(scene: Scene, ident: str, beside: int, pose: Pose, where: str) -> int:
    """Add a body of no consequence; its node."""
    body = scene.nodes[beside]
    dynamics = replace(body.dynamics, kinematic=False)
    label = ident.rpartition("/")[2]
    scene.nodes.append(
        Node(
            ident,
            label,
            NodeKind.PART,
            body.parent,
            pose,
            colliders=(),
            dynamics=dynamics,
            where=where,
            helps=beside,
        )
    )
    return len(scene.nodes) - 1
