"""What a freedom is by itself, beside any actuator, in the one drive that Unity has for it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ...diagnostics import Report
from ...model import RX, Drive, Freedom, Joint, Motion, Passive, unlocked_of
from ..scene import StatedAxes, StatedAxis
from .coordinates import canonical
from .limits import feature_of

FASTEST_LINK = 100.0
"""m/s or rad/s of a link's axis where nobody states less: PhysX's own ``maxJointVelocity``."""
OWN = "own"
"""In ``extras`` of a component: its coordinates whose drive is the joint's own spring and damper alone and may come to more than the
effort, which bounds no such drive."""
MOST = 1e36
"""Newtons, metres, radians: a 32-bit float holds it in degrees too."""


def with_passive_drives(joint: Joint, report: Report) -> Joint:
    """The joint with its passive springs and dampers made part of the drives; the report tells what Unity's joints have
    no place for (dry friction, armature), what could not be added up, and drives with numbers that none can have, or that do
    nothing."""
    if all(freedom.passive is None and freedom.drive is None for freedom in joint.freedoms):
        return joint
    freedoms = [_in_one_drive(joint, i, freedom, report) for i, freedom in enumerate(joint.freedoms)]
    return replace(joint, freedoms=tuple(freedoms))


def _in_one_drive(joint: Joint, index: int, freedom: Freedom, report: Report) -> Freedom:
    if freedom.passive is not None:
        freedom = _driven(joint, index, freedom, freedom.passive, report)
    return _without_idle(joint, index, _without_impossible(joint, index, freedom, report), report)


def _without_impossible(joint: Joint, index: int, freedom: Freedom, report: Report) -> Freedom:
    """The freedom without a drive that would push instead of pull, or is stronger than a 32-bit float can say."""
    drive = freedom.drive
    if drive is None:
        return freedom
    gains = {"stiffness": drive.stiffness, "damping": drive.damping}
    aims = {"target": drive.target, "target velocity": drive.target_velocity}
    wrong = {what: value for what, value in gains.items() if not 0.0 <= value <= MOST}
    wrong |= {what: value for what, value in aims.items() if not abs(value) <= MOST}
    wrong |= {} if drive.max_force >= 0.0 else {"largest force": drive.max_force}
    if not wrong:
        return freedom
    what, value = next(iter(wrong.items()))
    names = {"joint": joint.id, "freedom": joint.freedom_name(index), "what": what, "value": f"{value:g}"}
    where = freedom.where or joint.where
    report.dropped(feature_of(joint, "drive", index), "JOINT_DRIVE_IMPOSSIBLE", where, **names)
    return replace(freedom, drive=None)


def _without_idle(joint: Joint, index: int, freedom: Freedom, report: Report) -> Freedom:
    """The freedom without a drive that it is locked against, or that has aims and nothing that takes it there; a single such
    aim is told."""
    drive = freedom.drive
    if drive is None:
        return freedom
    if freedom.motion is Motion.LOCKED:
        report.add("JOINT_DRIVE_LOCKED", joint.where, joint=joint.id, freedom=joint.freedom_name(index))
        return replace(freedom, drive=None)
    idle: dict[str, str] = {}
    if drive.target != 0.0 and (drive.motor or not drive.stiffness):
        idle["target"] = "stiffness"
    if drive.target_velocity != 0.0 and not (drive.motor or drive.damping):
        idle["target velocity"] = "damping"
    for aim, gain in idle.items():
        why = "its motor holds a speed alone" if drive.motor else f"its drive has no {gain}"
        names = {"joint": joint.id, "freedom": joint.freedom_name(index), "aim": aim, "why": why}
        report.add("JOINT_DRIVE_IDLE", freedom.where or joint.where, **names, gain=gain)
    works = drive.motor or drive.stiffness or drive.damping
    return freedom if works or not idle else replace(freedom, drive=None)


def unkept_bounds(freedom: Freedom) -> dict[str, float]:
    """What is stated of a largest effort and speed and the freedom's own drive does not keep to, by its word."""
    passive, drive = freedom.passive or Passive(), freedom.drive
    effort = math.inf if drive is not None and drive.max_force <= passive.effort else passive.effort
    most = {"effort": effort, "speed": passive.speed}
    return {what: value for what, value in most.items() if math.isfinite(value)}


def stated_of(joint: Joint, names: Mapping[int, str]) -> dict[str, Any]:
    """Effort, speed, friction and armature as fields of Unity's joint, of those that the source states; each coordinate's own where
    they differ in them, or one turns and another slides.  names: of the component's coordinates, by the freedoms that move."""
    said = {i: joint.freedoms[i].passive or Passive() for i in names}
    kinds = {(p.effort, p.speed, p.friction, p.armature, i < RX) for i, p in said.items()}
    if len(kinds) == 1:
        return _fields(*next(iter(said.items())))
    axes = {names[i]: StatedAxis(**_fields(i, passive)) for i, passive in said.items()}
    return {"stated": StatedAxes(**axes)} if axes else {}


def _fields(index: int, passive: Passive) -> dict[str, float]:
    speed = math.degrees(passive.speed) if index >= RX else passive.speed
    found = {"effort": passive.effort, "speed": speed, "friction": passive.friction, "armature": passive.armature}
    return {name: value for name, value in found.items() if 0.0 < value <= MOST or (name == "effort" and value == 0.0)}


def own_force(freedom: Freedom, passive: Passive) -> float:
    """The most that a joint's own spring and damper can come to, which share its drive."""
    speed = min(passive.speed, FASTEST_LINK) if passive.speed > 0.0 else FASTEST_LINK
    force = passive.damping * speed
    if passive.stiffness > 0.0:
        limited = freedom.motion is Motion.LIMITED
        ends = (freedom.lower, freedom.upper) if limited else (-math.inf, math.inf)
        force += passive.stiffness * max(abs(end - passive.rest) for end in ends)
    return force


def unbounded(freedom: Freedom) -> bool:
    """Whether its drive is the joint's own spring and damper alone, which may come to more than the effort."""
    passive = freedom.passive
    return passive is not None and freedom.drive is None and own_force(freedom, passive) > passive.effort


def withdraw_stated(joint: Joint, report: Report) -> None:
    """Take back what ``with_passive_drives`` told of what ``stated_of`` holds."""
    if all(freedom.passive is None for freedom in joint.freedoms):
        return
    shape = canonical(joint)
    for index in (shape.name_of[i] for i in unlocked_of(shape.freedoms)):
        fields = _fields(index, joint.freedoms[index].passive or Passive())
        for what, code in (("friction", "JOINT_FRICTION_DROPPED"), ("armature", "JOINT_ARMATURE_DROPPED")):
            if what in fields:
                report.withdraw(feature_of(joint, what, index), code)
        bounds = unkept_bounds(joint.freedoms[index])
        if bounds and bounds.keys() <= fields.keys():
            withdraw_bounds(joint, index, bounds, report)


def tell_bounds(joint: Joint, index: int, bounds: Mapping[str, float], report: Report) -> None:
    """Tell that nothing of the scene holds them.  bounds: of the freedom, see ``unkept_bounds``."""
    limits = " and ".join(f"{what} ({value:g})" for what, value in bounds.items())
    names = {"joint": joint.id, "freedom": joint.freedom_name(index), "limits": limits}
    report.dropped(_bounds_feature(joint, index, bounds), "JOINT_EFFORT_DROPPED", joint.where, **names)


def withdraw_bounds(joint: Joint, index: int, bounds: Mapping[str, float], report: Report) -> None:
    """Take back what ``tell_bounds`` told."""
    report.withdraw(_bounds_feature(joint, index, bounds), "JOINT_EFFORT_DROPPED")


def _bounds_feature(joint: Joint, index: int, bounds: Mapping[str, float]) -> str:
    return feature_of(joint, f"largest {' and '.join(bounds)}", index)


def _driven(joint: Joint, index: int, freedom: Freedom, passive: Passive, report: Report) -> Freedom:
    names = {"joint": joint.id, "freedom": joint.freedom_name(index)}
    # The largest speed stays beside the freedom: Unity does not hold it, but a hinge's stops are written for it.
    bare = replace(freedom, passive=Passive(speed=passive.speed) if math.isfinite(passive.speed) else None)
    if freedom.motion is Motion.LOCKED:
        return bare
    for what, value, code in (
        ("friction", passive.friction, "JOINT_FRICTION_DROPPED"),
        ("armature", passive.armature, "JOINT_ARMATURE_DROPPED"),
    ):
        if value > 0.0:
            feature = feature_of(joint, what, index)
            report.dropped(feature, code, joint.where, value=f"{value:g}", **names)
    drive = freedom.drive
    if bounds := unkept_bounds(freedom):
        tell_bounds(joint, index, bounds, report)
    if not (passive.stiffness or passive.damping):
        return bare
    if drive is None:
        return replace(bare, drive=Drive(passive.rest, 0.0, passive.stiffness, passive.damping))
    if drive.motor or drive.acceleration or math.isfinite(drive.max_force):
        feature = feature_of(joint, "spring and damper", index)
        report.dropped(feature, "JOINT_PASSIVE_DROPPED", joint.where, **names)
        return bare
    # F = k1 (t1 - q) + d1 (v1 - u) + k2 (t2 - q) - d2 u: one spring and one damper.
    stiffness, damping = drive.stiffness + passive.stiffness, drive.damping + passive.damping
    target = drive.target
    if stiffness > 0.0:
        target = (drive.stiffness * drive.target + passive.stiffness * passive.rest) / stiffness
    velocity = drive.damping * drive.target_velocity / damping if damping > 0.0 else 0.0
    return replace(
        bare,
        drive=replace(drive, target=target, target_velocity=velocity, stiffness=stiffness, damping=damping),
    )
