"""A source's own joint from which other statements about its pair take freedoms: it goes on with those that are left.

So its name, ranges and drives outlive a screw's lead on a cylindrical joint, or a distance that holds its slide.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from ...model import LOCKED, RX, TX, Joint, JointKind, freedoms_of
from ...spatial import Array, Pose
from ..freedom.finite import Candidate

ABOUT_ONE_AXIS = (JointKind.REVOLUTE, JointKind.PRISMATIC, JointKind.CYLINDRICAL, JointKind.SCREW)
PARALLEL = 1e-6
"""Radians between the axes of what was found and of the joint."""


def narrowed(joint: Joint, found: Candidate, a: Pose, b: Pose) -> Joint | None:
    """``joint`` with the freedoms that ``found`` leaves, None where they are not among its own.

    found: what all statements about the pair leave together, WORLD; about one axis, or None is returned.
    a, b: poses of the joint's bodies, WORLD, closed.
    A turn must be the joint's only one, since of several no single one is about a fixed axis.
    """
    if found.kind not in ABOUT_ONE_AXIS:
        return None
    frame_a, frame_b = a @ joint.frame_a, b @ joint.frame_b
    across = np.linalg.norm(np.cross(frame_a.rotation.T, found.axes[:, 0]), axis=1)
    axis = int(np.argmin(across))
    slides, turns = TX in found.unlocked, RX in found.unlocked
    own_turns = tuple(i for i in joint.unlocked if i >= RX)
    if (
        across[axis] > PARALLEL
        or (slides and TX + axis not in joint.unlocked)
        or (turns and own_turns != (RX + axis,))
    ):
        return None
    x = frame_a.rotation[:, axis]
    order = [axis, (axis + 1) % 3, (axis + 2) % 3]
    turn_a = frame_a.rotation[:, order]
    turn_b = frame_b.rotation[:, order] if turns else turn_a
    # across the axis both origins are where the axis is, along it each is where it was, or where b is if that is locked
    beside = found.origin if turns else frame_b.translation
    starts = frame_a.translation if slides else frame_b.translation
    along = float(x @ starts), float(x @ frame_b.translation)
    foot = beside - (x @ beside) * x
    at_a, at_b = foot + along[0] * x, foot + along[1] * x
    slide = joint.freedoms[TX + axis] if slides else LOCKED
    turn = joint.freedoms[RX + axis] if turns else LOCKED
    if found.kind is JointKind.SCREW:
        start = _beginning(found.lead, along[1] - along[0], _angle(turn_a, turn_b))
        at_a, slide = at_a + start * x, slide.counted_from(start)
    return replace(
        joint,
        kind=found.kind,
        frame_a=a.inverse() @ Pose(turn_a, at_a),
        frame_b=b.inverse() @ Pose(turn_b, at_b),
        freedoms=freedoms_of(found.kind, tx=slide, rx=turn),
        lead=found.lead,
        slerp=None,
    )


def _angle(a: Array, b: Array) -> float:
    """From a's Y to b's about their common X, radians."""
    return math.atan2(float(a[:, 2] @ b[:, 1]), float(a[:, 1] @ b[:, 1]))


def _beginning(lead: float, slide: float, angle: float) -> float:
    """Where a slide stands when its screw's angle is zero, metres: half a lead to either side at the most."""
    return math.remainder(slide - lead * angle / (2.0 * math.pi), lead) if lead else 0.0
