"""What a link's drives and joint are bounded by beside their limits: dry friction, largest effort, largest speed."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ...diagnostics import Report
from ...model import RX, Joint, Passive
from ..joints.coordinates import canonical
from ..joints.limits import feature_of
from ..joints.passive import own_force, tell_bounds, unbounded, unkept_bounds, withdraw_bounds
from ..scene import ArticulationDrive

AXES = ("xDrive", "yDrive", "zDrive")


def bounded(moving: Mapping[str, Any], stated: Joint, report: Report) -> dict[str, Any]:
    """The link's fields with what the source's joint is bounded by: each drive's ``forceLimit``, ``maxJointVelocity`` and
    ``jointFriction``.  moving: fields of a link that is not Fixed.  What was told as lost, as Unity's joints have no place for
    it, is told again only where a link has none either."""
    found = dict(moving)
    axes = _axes(stated)
    speed = _speed([stated.freedoms[i].passive or Passive() for i in axes.values()])
    if speed is not None:
        found["maxJointVelocity"] = speed
    if found["jointType"] == "Revolute":  # whose range PhysX holds within a whole turn to either side
        for index in axes.values():
            report.withdraw(feature_of(stated, "stop", index), "JOINT_STOP_WRAPS")
    for name, index in axes.items():
        freedom = stated.freedoms[index]
        if (passive := freedom.passive) is None:
            continue
        told = unkept_bounds(freedom)
        lost = {what: value for what, value in told.items() if what == "effort" or speed is None}
        drive = found.get(name, ArticulationDrive())
        if "effort" in lost and (bound := _force_limit(stated, index, drive, passive, report)) is not None:
            found[name] = replace(drive, forceLimit=bound)
            del lost["effort"]
        elif freedom.drive is not None:  # the component's drive may be that of another freedom, which is stronger
            found[name] = replace(drive, forceLimit=min(drive.forceLimit, passive.effort))
        if lost != told:
            withdraw_bounds(stated, index, told, report)
            if lost:
                tell_bounds(stated, index, lost, report)
    return found | {"jointFriction": _friction(stated, report)}


def _axes(stated: Joint) -> dict[str, int]:
    """Of each drive that a link has the freedom of the source's joint that it drives, as ``joints.configurable`` names them."""
    shape = canonical(stated)
    acting = [*shape.translations, *(RX + i for i in shape.rotations)]
    if len(acting) == 1:
        return {"xDrive": shape.name_of[acting[0]]}
    return {AXES[i]: shape.name_of[RX + i] for i in shape.rotations}


def _speed(bounds: list[Passive]) -> float | None:
    """A link has one for all its axes; with 0 it would stand still for ever, and what that means the source does not say."""
    speeds = {bound.speed for bound in bounds}
    speed = speeds.pop() if len(speeds) == 1 else math.inf
    return speed if 0.0 < speed < math.inf else None


def _force_limit(
    stated: Joint, index: int, drive: ArticulationDrive, passive: Passive, report: Report
) -> float | None:
    """The least of the drive's own largest force and the effort; None where that would hold a spring or damper of the joint
    itself, which no effort bounds, and nothing else."""
    freedom = stated.freedoms[index]
    if unbounded(freedom) and stated.slerp is None:
        return None
    if own_force(freedom, passive) > passive.effort:
        value, name = f"{passive.effort:g}", stated.freedom_name(index)
        told = {"joint": stated.id, "freedom": name, "value": value}
        feature = feature_of(stated, "largest effort", index)
        report.approximated(feature, "JOINT_EFFORT_SHARED", stated.where, **told)
    return min(drive.forceLimit, passive.effort)


def _friction(stated: Joint, report: Report) -> float:
    """The link's coefficient, which stands for a force."""
    frictions = [f.passive.friction for f in stated.freedoms if f.passive is not None]
    most = max(frictions, default=0.0)
    if most > 0.0:
        feature = f"friction of joint {stated.id}"
        for freedom in stated.unlocked:
            report.withdraw(feature_of(stated, "friction", freedom), "JOINT_FRICTION_DROPPED")
        told = {"joint": stated.id, "value": f"{most:g}"}
        report.approximated(feature, "JOINT_FRICTION_COEFFICIENT", stated.where, **told)
    return most
