"""What a script says of one joint that follows another, in degrees and metres, as the model's coupling."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Union

import numpy as np

from ..model import FREEDOM_NAMES, RX, Coupling, CouplingKind, Joint, Term
from .arguments import LARGEST, checked_number, shown

JointLike = Union[Joint, str, tuple[Union[Joint, str], str], list[Union[Joint, str]]]
"""A joint or its id; with the name of one of its freedoms where it has several."""
LARGEST_RATIO = 1e6
"""Metres and radians; beyond, the analysis cannot tell the slower of the two from one that stands still."""


def coupling_between(
    joints: Sequence[Joint], a: JointLike, b: JointLike, ratio: float, offset: float, name: str, number: int
) -> Coupling:
    """The coupling q_b = ratio q_a + offset; ratio and offset in degrees and metres.

    joints: of the scene.  name: without one it is called by its kind and ``number``.
    Raises ValueError for a joint that is none of them, a freedom that is locked, a coordinate with itself, and a ratio
    of 0 or that is no number.
    """
    (joint_a, freedom_a), (joint_b, freedom_b) = _coordinate(joints, "a", a), _coordinate(joints, "b", b)
    factor, shift = checked_number("the ratio", ratio), checked_number("the offset", offset)
    if factor == 0.0:
        raise ValueError("the ratio is 0; nothing would follow. Pass how far b moves for one of a")
    if abs(shift) > LARGEST:
        raise ValueError(f"the offset is {offset}; pass a number, none beyond {LARGEST:g}")
    if (joint_a.id, freedom_a) == (joint_b.id, freedom_b):
        raise ValueError(
            f"a and b are both {FREEDOM_NAMES[freedom_a]} of joint {joint_a.id}; pass two coordinates"
        )
    turns = [freedom >= RX for freedom in (freedom_a, freedom_b)]
    unit_a, unit_b = (math.radians(1.0) if turn else 1.0 for turn in turns)
    term = Term(joint_a.id, freedom_a, factor * unit_b / unit_a)
    if not 1.0 / LARGEST_RATIO <= abs(term.ratio) <= LARGEST_RATIO:
        raise ValueError(
            f"the ratio is {ratio}, {term.ratio:g} in metres and radians; no gear has it and the"
            f" slower of the two would stand still. Pass one from {1.0 / LARGEST_RATIO:g} to {LARGEST_RATIO:g}"
        )
    kind = CouplingKind.GEAR if all(turns) else CouplingKind.RACK if any(turns) else CouplingKind.LINEAR
    return Coupling(name or f"{kind.value}:{number}", kind, joint_b.id, freedom_b, (term,), shift * unit_b)


def _stands_as(joint: Joint, other: Joint) -> bool:
    """Whether they are one joint, or copies of one: ids of other scenes are the same words."""
    if joint is other:
        return True
    frames = ((joint.frame_a, other.frame_a), (joint.frame_b, other.frame_b))
    return (joint.a, joint.b) == (other.a, other.b) and all(
        np.array_equal(own.rotation, its.rotation) and np.array_equal(own.translation, its.translation)
        for own, its in frames
    )


def _coordinate(joints: Sequence[Joint], argument: str, asked: JointLike) -> tuple[Joint, int]:
    which, name = asked if isinstance(asked, (tuple, list)) and len(asked) == 2 else (asked, "")
    wanted: object = which.id if isinstance(which, Joint) else which
    named = isinstance(wanted, str)
    joint = next((joint for joint in joints if named and joint.id == wanted), None)
    if joint is None or (isinstance(which, Joint) and not _stands_as(joint, which)):
        raise ValueError(f"{argument} is {shown(asked)}; pass a joint of this scene, or its id")
    free = [FREEDOM_NAMES[i] for i in joint.unlocked]
    if not name and len(free) != 1:
        raise ValueError(
            f"{argument} is joint {joint.id}, which leaves {', '.join(free) or 'nothing'} free; pass (joint, name)"
        )
    if name and name not in free:
        raise ValueError(
            f"{argument} is {shown(name)} of joint {joint.id}, which leaves {', '.join(free)} free"
        )
    return joint, FREEDOM_NAMES.index(name or free[0])
