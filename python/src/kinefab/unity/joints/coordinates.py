"""A joint's coordinates at the exported pose, in a frame that one Unity component can carry.

A D6 joint treats its three angles unequally: X is the twist, Y and Z the swing.  ``canonical`` therefore
renames the axes (a cyclic permutation, so still right-handed) until the rotations that are left are X,
or X and one swing, or all three.  ``read_coordinates`` then splits the pose accordingly.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...model import FREE, LOCKED, RX, RY, RZ, Freedom, Joint, Motion, Scene, unlocked_of
from ...spatial import Array, Pose, quaternion_from_matrix, rotation_about, rotation_log

AXES = np.eye(3)


@dataclass(frozen=True, slots=True, eq=False)
class CanonicalJoint:
    """A joint with its axes renamed.  name_of[i]: index in the source joint of this joint's freedom i."""

    frame_a: Pose
    frame_b: Pose
    freedoms: tuple[Freedom, ...]
    name_of: tuple[int, ...]

    @property
    def rotations(self) -> tuple[int, ...]:
        """The unlocked rotations, 0 to 2 for X to Z."""
        return tuple(i - RX for i in unlocked_of(self.freedoms) if i >= RX)

    @property
    def translations(self) -> tuple[int, ...]:
        """The unlocked translations, 0 to 2 for X to Z."""
        return tuple(i for i in unlocked_of(self.freedoms) if i < RX)

    def plain(self, which: Iterable[int]) -> bool:
        """Whether none of these freedoms has a limit or a drive."""
        return not any(self.freedoms[i].acts for i in which)


@dataclass(frozen=True, slots=True, eq=False)
class Coordinates:
    """values: six coordinates at the exported pose, metres and radians, 0 where locked.
    in_a, in_b: the component's frame at that pose, in a's and in b's joint frame, shape (3, 3).
    gap_length, gap_angle: how far the locked freedoms are from being met, metres and radians.
    """

    values: Array
    in_a: Array
    in_b: Array
    gap_length: float
    gap_angle: float


def removes_nothing(joint: Joint, shape: CanonicalJoint | None = None) -> bool:
    """Whether a joint leaves all six freedoms, and nothing limits or drives one.  shape: the same joint, see ``canonical``."""
    if joint.locked or joint.slerp is not None:  # as nearly always
        return False
    shape = shape or canonical(joint)
    return len(shape.rotations) == len(shape.translations) == 3 and shape.plain(range(6))


def canonical(joint: Joint) -> CanonicalJoint:
    """The joint with its single free rotation named X, or the locked one of three not named X."""
    unlocked = unlocked_of(tuple(_plain(f) for f in joint.freedoms[RX:]))
    locked = [i for i in range(3) if i not in unlocked]
    first = unlocked[0] if len(unlocked) == 1 else (locked[0] + 1) % 3 if len(unlocked) == 2 else 0
    if len(unlocked) == 2 and locked[0] != 0:
        first = 0  # X is unlocked already: keep the source's names
    order = [first, (first + 1) % 3, (first + 2) % 3]
    name_of = (*order, *(RX + i for i in order))
    frame_a, frame_b = _reordered(joint.frame_a, order), _reordered(joint.frame_b, order)
    freedoms = tuple(joint.freedoms[i] for i in name_of)
    return _hold_single_values(CanonicalJoint(frame_a, frame_b, freedoms, name_of))


def _reordered(frame: Pose, order: list[int]) -> Pose:
    return Pose(frame.rotation[:, order], frame.translation)


def _plain(freedom: Freedom) -> Freedom:
    """A limit without ends is free, a range of one value is locked."""
    if freedom.motion is not Motion.LIMITED:
        return freedom
    if math.isinf(freedom.lower) and math.isinf(freedom.upper):
        return replace(freedom, motion=FREE.motion)
    return LOCKED if freedom.lower == freedom.upper else freedom


def _hold_single_values(joint: CanonicalJoint) -> CanonicalJoint:
    """Turn ranges of one value into locked freedoms of frames that stand at that value."""
    values = np.zeros(6)
    for i, freedom in enumerate(joint.freedoms):
        if freedom.motion is Motion.LIMITED and freedom.lower == freedom.upper:
            values[i] = freedom.lower
    freedoms = tuple(_plain(f) for f in joint.freedoms)
    if not values.any():  # as nearly always: the frames stay
        return replace(joint, freedoms=freedoms)
    twist = rotation_about(AXES[0], -values[RX])
    swing = rotation_about(AXES[2], values[RZ]) @ rotation_about(AXES[1], values[RY])
    return replace(
        joint,
        frame_a=joint.frame_a @ Pose(swing, values[:3]),
        frame_b=joint.frame_b @ Pose(twist, np.zeros(3)),
        freedoms=freedoms,
    )


def coordinates_in(scene: Scene, joint: Joint, shape: CanonicalJoint) -> Coordinates:
    """Where a joint stands in a scene.  shape: the same joint, see ``canonical``."""
    frame_a, frame_b = scene.pose(joint.a) @ shape.frame_a, scene.pose(joint.b) @ shape.frame_b
    return read_coordinates(shape, frame_a.inverse() @ frame_b)


def read_coordinates(joint: CanonicalJoint, relative: Pose) -> Coordinates:
    """Split ``relative`` (b's joint frame in a's) into the joint's coordinates and what does not fit them."""
    r, values, frame = relative.rotation, np.zeros(6), np.eye(3)
    free = list(joint.translations)
    values[free] = relative.translation[free]
    rotations = joint.rotations
    if rotations == (0, 2):  # R = Rz Ry Rx: X fixed in b, Z fixed in a, Y must not turn
        values[RX], values[RZ] = math.atan2(r[2, 1], r[2, 2]), math.atan2(r[1, 0], r[0, 0])
        gap_angle = math.asin(min(1.0, abs(r[2, 0])))
        frame = rotation_about(AXES[2], values[RZ])
    elif rotations == (0, 1):  # R = Ry Rz Rx: X fixed in b, Y fixed in a, Z must not turn
        values[RX], values[RY] = math.atan2(-r[1, 2], r[1, 1]), math.atan2(-r[2, 0], r[0, 0])
        gap_angle = math.asin(min(1.0, abs(r[1, 0])))
        frame = rotation_about(AXES[1], values[RY])
    else:  # R = swing * twist about X
        q = quaternion_from_matrix(r)
        twist = 2.0 * math.atan2(q[0], q[3])
        swing = r @ rotation_about(AXES[0], -twist)
        turn = rotation_log(swing)
        if rotations == ():
            gap_angle = float(np.linalg.norm(rotation_log(r)))
        elif rotations == (0,):
            values[RX], gap_angle = twist, float(np.linalg.norm(turn))
        else:
            values[RX], values[RY], values[RZ], gap_angle = twist, turn[1], turn[2], 0.0
    off = relative.translation - values[:3]
    return Coordinates(values, frame, r.T @ frame, float(np.linalg.norm(off)), gap_angle)
