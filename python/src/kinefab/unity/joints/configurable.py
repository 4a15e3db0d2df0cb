"""The fields of a ConfigurableJoint: motions, limits, drives and targets.

Everything here is in terms of c, PhysX's "actor1 in actor0" at the component's axes.  A CAD coordinate q
of axis i reads on c as ``sign * q``: see ``frames.Senses``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import MOTOR_DAMPING, RX, Drive, Freedom, Joint, Motion, SphericalDrive
from ...spatial import Array, quaternion_from_matrix, rotation_exp, rotation_log
from ..frames import Senses
from ..scene import JointDrive, SoftJointLimit, SoftJointLimitSpring
from ..scene.joints.configurable_joint import MOTION_FIELDS, SWING_RANGES, TWIST_RANGE
from ..scene.vectors import quaternion4, vector3
from .coordinates import CanonicalJoint, Coordinates
from .limits import feature_of, may_wrap, one_sided, report_outside
from .placement import Placement

OPEN_TRAVEL = 100.0
"""Metres of travel written for a slide that ends on one side only: Unity's linear limit has two ends."""
TURNED = 1e-4
"""Radians that the frames may be turned against each other before it is reported."""

MOTION_TITLES = (
    "X Motion",
    "Y Motion",
    "Z Motion",
    "Angular X Motion",
    "Angular Y Motion",
    "Angular Z Motion",
)
"""The motions, as Unity's inspector names them."""
_TITLES = {Motion.LOCKED: "Locked", Motion.LIMITED: "Limited", Motion.FREE: "Free"}


@dataclass(slots=True, eq=False)
class _Writing:
    """One joint on its way out: what is read, and the fields written so far."""

    joint: Joint
    shape: CanonicalJoint
    zeros: Array
    senses: Senses
    report: Report
    fields: dict[str, Any]

    def approximated(self, code: str, **values: object) -> None:
        self.report.approximated(
            f"joint {self.joint.id}", code, self.joint.where, joint=self.joint.id, **values
        )

    def name(self, freedom: int) -> str:
        """The source's name of a freedom."""
        return self.joint.freedom_name(self.shape.name_of[freedom])


def configurable_fields(
    joint: Joint, shape: CanonicalJoint, coordinates: Coordinates, placement: Placement, report: Report
) -> tuple[dict[str, Any], Array]:
    """The component's fields apart from anchors and axes, and the zero of its linear coordinates.

    Returns (fields, middle); middle: metres along a's joint axes, shape (3,), where a's anchor must stand.
    """
    zeros = coordinates.values.copy()
    for i in shape.rotations:
        zeros[RX + i] = shape.freedoms[RX + i].nearest_turn(zeros[RX + i])
    writing = _Writing(joint, shape, zeros, placement.actors, report, {})
    for i, freedom in enumerate(shape.freedoms):
        if freedom.motion is Motion.LIMITED:
            report_outside(joint, shape.name_of[i], freedom, zeros[i], report)
    motions = [freedom.motion for freedom in shape.freedoms]
    _report_turned_axes(writing)
    middle = _linear_limits(writing)
    _twist_limits(writing, motions)
    _swing_limits(writing, motions)
    swung = max(abs(zeros[RX + 1]), abs(zeros[RX + 2])) > TURNED
    if swung and len(shape.rotations) == 3 and not shape.plain(range(RX, RX + 3)):
        # Unity's zero is the exported pose, but a swing there is no shift of the angles.
        writing.approximated("JOINT_ZERO_SHIFTED")
    _linear_drives(writing, middle)
    if joint.slerp is None:
        _angular_drives(writing)
    else:
        _slerp_drive(writing, joint.slerp, coordinates)
    if placement.swap:
        writing.fields["swapBodies"] = True
    written = {name: _TITLES[motion] for name, motion in zip(MOTION_FIELDS, motions)}
    return written | writing.fields, middle


def _report_turned_axes(w: _Writing) -> None:
    """With two rotations the component's frame follows b's axis, so it stands turned against a's at export;
    that is no matter where the slides across the turned axis are both locked or both plain and free."""
    if len(w.shape.rotations) != 2:
        return
    about = w.shape.rotations[1]
    across = [i for i in range(3) if i != about]
    alike = len({w.shape.freedoms[i].motion for i in across}) == 1 and w.shape.plain(across)
    if not alike and abs(w.zeros[RX + about]) > TURNED:
        w.approximated("JOINT_AXES_TURNED", degrees=f"{math.degrees(w.zeros[RX + about]):.3g}")


def _linear_limits(w: _Writing) -> Array:
    """``linearLimit``: one radius about where the anchors meet, so that is the middle of the range."""
    middle = np.zeros(3)
    limited = [i for i in w.shape.translations if w.shape.freedoms[i].motion is Motion.LIMITED]
    if not limited:
        return middle
    halves: list[float] = []
    for i in limited:
        freedom = w.shape.freedoms[i]
        lower, upper = freedom.lower, freedom.upper
        if math.isinf(lower) or math.isinf(upper):
            w.approximated("JOINT_LIMIT_ONE_SIDED", stop=f"{OPEN_TRAVEL:g} m from its end")
            lower = upper - OPEN_TRAVEL if math.isinf(lower) else lower
            upper = lower + OPEN_TRAVEL if math.isinf(upper) else upper
        middle[i] = 0.5 * (lower + upper)
        halves.append(0.5 * (upper - lower))
    if len(limited) > 1 and not all(w.shape.freedoms[i].radial for i in limited):
        w.approximated("JOINT_LIMITS_SHARED", radius=f"{max(halves):g}", axes=", ".join(map(w.name, limited)))
    first = _stiffest(w, limited)
    w.fields["linearLimit"] = SoftJointLimit(max(halves), first.restitution)
    w.fields["linearLimitSpring"] = _limit_spring(first)
    return middle


def _twist_limits(w: _Writing, motions: list[Motion]) -> None:
    """``lowAngularXLimit`` and ``highAngularXLimit``: a range of c's twist, within half a turn."""
    freedom = w.shape.freedoms[RX]
    if freedom.motion is not Motion.LIMITED:
        return
    sign = w.senses.angular[0]
    lower, upper = (math.degrees(x - w.zeros[RX]) for x in (freedom.lower, freedom.upper))
    if math.isinf(lower) or math.isinf(upper):
        w.approximated("JOINT_LIMIT_ONE_SIDED", stop="180 degrees from the exported pose")
        lower, upper = one_sided(lower, upper, 180.0)
    if lower < -180.0 or upper > 180.0:
        w.approximated("JOINT_LIMIT_BEYOND_TURN", low=f"{lower:g}", high=f"{upper:g}")
        motions[RX] = Motion.FREE
        w.fields["extras"] = {TWIST_RANGE: sorted((sign * lower, sign * upper))}
        return
    if may_wrap(w.joint, w.shape, lower, upper):
        feature = feature_of(w.joint, "stop", w.shape.name_of[RX])
        told = {"joint": w.joint.id, "angle": f"{max(-lower, upper):g}"}
        w.report.approximated(feature, "JOINT_STOP_WRAPS", w.joint.where, **told)
    low, high = sorted((sign * lower, sign * upper))
    w.fields["lowAngularXLimit"] = SoftJointLimit(low, freedom.restitution)
    w.fields["highAngularXLimit"] = SoftJointLimit(high, freedom.restitution)
    w.fields["angularXLimitSpring"] = _limit_spring(freedom)


def _swing_limits(w: _Writing, motions: list[Motion]) -> None:
    """``angularYLimit`` and ``angularZLimit``: half angles of a cone about X, the same to either side."""
    limited = [i for i in (1, 2) if w.shape.freedoms[RX + i].motion is Motion.LIMITED]
    halves: dict[int, float] = {}
    # The cone has one bounce for both swings, which may be either's: Unity's choice is not documented.
    bounce = max((w.shape.freedoms[RX + i].restitution for i in limited), default=0.0)
    if limited and bounce > 0.0:
        w.fields["angularYLimit"] = SoftJointLimit(0.0, bounce)
        w.fields["angularZLimit"] = SoftJointLimit(0.0, bounce)
    for i in limited:
        freedom = w.shape.freedoms[RX + i]
        lower, upper = (math.degrees(x - w.zeros[RX + i]) for x in (freedom.lower, freedom.upper))
        halves[i] = half = max(-lower, upper)
        if half >= 180.0:
            w.approximated("JOINT_LIMIT_BEYOND_TURN", low=f"{lower:g}", high=f"{upper:g}")
            motions[RX + i] = Motion.FREE
            continue
        if abs(lower + upper) > 1e-6:
            w.approximated(
                "JOINT_LIMIT_ASYMMETRIC",
                freedom=w.name(RX + i),
                low=f"{lower:g}",
                high=f"{upper:g}",
                half=f"{half:g}",
            )
            ends = sorted(w.senses.angular[i] * end for end in (lower, upper))
            w.fields.setdefault("extras", {})[SWING_RANGES[i - 1]] = ends
        key = "angularYLimit" if i == 1 else "angularZLimit"
        w.fields[key] = SoftJointLimit(half, bounce)
    kept = {i: half for i, half in halves.items() if motions[RX + i] is Motion.LIMITED}
    if len(kept) == 1 and any(motions[RX + 3 - i] is Motion.FREE for i in kept):
        for i, half in kept.items():
            w.approximated("JOINT_LIMIT_ELEVATION", freedom=w.name(RX + i), half=f"{half:g}")
    if kept:
        w.fields["angularYZLimitSpring"] = _limit_spring(_stiffest(w, [RX + i for i in kept]))


def _stiffest(w: _Writing, limited: list[int]) -> Freedom:
    """The freedom whose limit stands for all of ``limited``, where Unity has one spring for them."""
    freedoms = [w.shape.freedoms[i] for i in limited]
    settings = {(f.stiffness, f.damping, f.restitution) for f in freedoms}
    if len(settings) > 1:
        w.approximated("JOINT_LIMIT_SPRING_SHARED", axes=", ".join(map(w.name, limited)))
    return max(freedoms, key=lambda f: (f.stiffness, f.damping, f.restitution))


def _limit_spring(freedom: Freedom) -> SoftJointLimitSpring:
    return SoftJointLimitSpring(freedom.stiffness, freedom.damping)


def _linear_drives(w: _Writing, middle: Array) -> None:
    """``xDrive`` .. and their targets: the goal of c's position and of its speed."""
    target, velocity = np.zeros(3), np.zeros(3)
    for i in w.shape.translations:
        drive = w.shape.freedoms[i].drive
        if drive is None:
            continue
        target[i] = w.senses.linear[i] * (drive.target - middle[i])
        velocity[i] = w.senses.linear[i] * drive.target_velocity
        w.fields["xyz"[i] + "Drive"] = _joint_drive(w, drive, i)
    w.fields["targetPosition"], w.fields["targetVelocity"] = vector3(target), vector3(velocity)


def _angular_drives(w: _Writing) -> None:
    """``angularXDrive`` and ``angularYZDrive`` (mode XYAndZ) and their targets, radians/s."""
    stated = ((i, w.shape.freedoms[RX + i].drive) for i in w.shape.rotations)
    driven = {i: drive for i, drive in stated if drive is not None}
    turn, velocity = np.zeros(3), np.zeros(3)
    for i, drive in driven.items():
        turn[i] = w.senses.angular[i] * (0.0 if drive.motor else drive.target - w.zeros[RX + i])
        # PhysX drives w0 - w1 here, the speed of actor0 against actor1: the opposite of c's own.
        velocity[i] = -w.senses.angular[i] * drive.target_velocity
    if 0 in driven:
        w.fields["angularXDrive"] = _joint_drive(w, driven[0], RX)
    swings = [i for i in w.shape.rotations if i != 0]
    drives = [driven[i] for i in swings if i in driven]
    if drives:
        gains = {(d.stiffness, d.damping, d.max_force, d.acceleration, d.motor) for d in drives}
        if len(gains) > 1 or len(drives) < len(swings):
            w.approximated("JOINT_DRIVE_SHARED", axes=", ".join(w.name(RX + i) for i in swings))
        strongest = max(drives, key=lambda d: (d.motor, d.stiffness, d.damping))
        w.fields["angularYZDrive"] = _joint_drive(w, strongest, RX + swings[0])
    w.fields["targetRotation"] = quaternion4(quaternion_from_matrix(rotation_exp(turn)))
    w.fields["targetAngularVelocity"] = vector3(velocity)


def _slerp_drive(w: _Writing, drive: SphericalDrive, coordinates: Coordinates) -> None:
    """``slerpDrive`` and its targets, radians/s.

    With the component's frame frozen at export (in_a, in_b: seen from a's and b's joint frame), c = in_a' R in_b for R the
    rotation of b's joint frame in a's; seen the other way round it is the inverse, which the senses turn.
    """
    if len(w.shape.rotations) < 3:
        w.approximated("JOINT_SLERP_LOCKED")
    order = [i - RX for i in w.shape.name_of[RX:]]
    target, spin = drive.target[np.ix_(order, order)], drive.target_velocity[order]
    senses = np.array(w.senses.angular)
    turn = senses * rotation_log(coordinates.in_a.T @ target @ coordinates.in_b)
    w.fields["rotationDriveMode"] = "Slerp"
    w.fields["slerpDrive"] = JointDrive(drive.stiffness, drive.damping, drive.max_force, drive.acceleration)
    w.fields["targetRotation"] = quaternion4(quaternion_from_matrix(rotation_exp(turn)))
    # As for the single drives: PhysX drives the speed of actor0 against actor1.
    w.fields["targetAngularVelocity"] = vector3(-senses * (coordinates.in_a.T @ spin))


def _joint_drive(w: _Writing, drive: Drive, freedom: int) -> JointDrive:
    if drive.motor:
        w.approximated("JOINT_MOTOR_AS_DRIVE", freedom=w.name(freedom), damper=f"{MOTOR_DAMPING:g}")
        return JointDrive(0.0, MOTOR_DAMPING, drive.max_force)
    return JointDrive(drive.stiffness, drive.damping, drive.max_force, drive.acceleration)
