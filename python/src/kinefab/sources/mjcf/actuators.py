"""Actuators as drives, where Unity's law is theirs: force = k (target - q) + d (speed - qdot), within a largest force.

The control is, at the exported pose, that of the keyframe, else zero within its range (``robots/actuation.py`` has the law).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from ...diagnostics import Report
from ...model import Drive
from ..robots.actuation import APART, FORCE, GROWS, LAG, UNEVEN, Law, clipped_apart, drive_of
from .engine import Compiled


@dataclass(slots=True)
class Driven:
    """By MuJoCo's id of a joint.  efforts: largest force of what is no drive in Unity."""

    drives: dict[int, Drive] = field(default_factory=dict[int, Drive])
    efforts: dict[int, float] = field(default_factory=dict[int, float])


@dataclass(frozen=True, slots=True)
class _Told:
    """An actuator that became a drive.  reason: what of it the drive is not, "" for nothing."""

    name: str
    where: str
    numbers: str
    law: Law
    reason: str


def read_actuators(compiled: Compiled, report: Report) -> Driven:
    """Drives and efforts of joints; what an actuator does that no joint says is told, with its numbers."""
    m, enums = compiled.model, compiled.mujoco
    driving: dict[int, list[_Told]] = {}
    driven = Driven()
    count = int(getattr(m, "nactuator", m.nu))
    for i in range(count):
        name = compiled.name("actuator", i) or f"actuator {i}"
        where = compiled.files.nth("actuator", i, count)
        numbers = _numbers(compiled, i)
        reason = _unlike(compiled, i)
        if reason:
            report.dropped(
                f"actuator {name}", "MJCF_ACTUATOR", where, actuator=name, reason=reason, numbers=numbers
            )
            continue
        joint = int(m.actuator_trnid[i][0])
        law, most_control = _law(compiled, i)
        if law.is_force:
            driven.efforts[joint] = driven.efforts.get(joint, 0.0) + min(law.most, most_control)
            report.approximated(
                f"actuator {name}", "MJCF_ACTUATOR", where, actuator=name, reason=FORCE, numbers=numbers
            )
            continue
        if bool(m.actuator_forcelimited[i]) and abs(float(np.sum(m.actuator_forcerange[i]))) > 1e-9:
            reason = UNEVEN
        elif int(m.actuator_dyntype[i]) != int(enums.mjtDyn.mjDYN_NONE):
            reason = LAG
        driving.setdefault(joint, []).append(_Told(name, where, numbers, law, reason))
    for joint, several in driving.items():
        laws = [one.law for one in several]
        driven.drives[joint] = drive_of(laws)
        clipped = clipped_apart(laws)
        for one in several:
            reason = one.reason
            if clipped and not reason:
                reason = APART
            if reason:
                report.approximated(
                    f"actuator {one.name}", "MJCF_ACTUATOR", one.where,
                    actuator=one.name, reason=reason, numbers=one.numbers,
                )  # fmt: skip
            else:
                report.kept(f"actuator {one.name}", one.where)
    return driven


def _law(compiled: Compiled, i: int) -> tuple[Law, float]:
    """The law, and the largest force that the control alone can make."""
    m = compiled.model
    gear, gain = float(m.actuator_gear[i][0]), float(m.actuator_gainprm[i][0])
    bias = [0.0, 0.0, 0.0]
    if int(m.actuator_biastype[i]) == int(compiled.mujoco.mjtBias.mjBIAS_AFFINE):
        bias = [float(v) for v in m.actuator_biasprm[i][:3]]
    channel = int(m.actuator_ctrladr[i]) if hasattr(m, "actuator_ctrladr") else i
    control, reach = float(compiled.ctrl[channel]), math.inf
    if m.actuator_ctrllimited[channel]:
        low, high = (float(v) for v in m.actuator_ctrlrange[channel])
        control, reach = min(max(control, low), high), max(abs(low), abs(high))
    most = math.inf
    if m.actuator_forcelimited[i]:
        most = abs(gear) * float(np.abs(m.actuator_forcerange[i]).max())
    law = Law(gear * (gain * control + bias[0]), -bias[1] * gear * gear, -bias[2] * gear * gear, most)
    force = abs(gear * gain) * reach if gear * gain else 0.0
    return law, force


def _unlike(compiled: Compiled, i: int) -> str:
    """Why no drive of Unity acts so, "" where one does."""
    m, enums = compiled.model, compiled.mujoco
    word = _words(compiled, i)
    transmission = int(m.actuator_trntype[i])
    if transmission not in (int(enums.mjtTrn.mjTRN_JOINT), int(enums.mjtTrn.mjTRN_JOINTINPARENT)):
        return f"it acts through a {word['trn']}"
    joint = int(m.actuator_trnid[i][0])
    if int(m.jnt_type[joint]) not in (int(enums.mjtJoint.mjJNT_HINGE), int(enums.mjtJoint.mjJNT_SLIDE)):
        return "its joint has more than one coordinate"
    lagging = (enums.mjtDyn.mjDYN_NONE, enums.mjtDyn.mjDYN_FILTER, enums.mjtDyn.mjDYN_FILTEREXACT)
    if int(m.actuator_dyntype[i]) not in [int(v) for v in lagging]:
        return f"its activation is '{word['dyn']}'"
    if int(m.actuator_gaintype[i]) != int(enums.mjtGain.mjGAIN_FIXED):
        return f"its gain is '{word['gain']}'"
    if int(m.actuator_biastype[i]) not in (int(enums.mjtBias.mjBIAS_NONE), int(enums.mjtBias.mjBIAS_AFFINE)):
        return f"its bias is '{word['bias']}'"
    if (
        int(m.actuator_biastype[i]) == int(enums.mjtBias.mjBIAS_AFFINE)
        and max(m.actuator_biasprm[i][1:3]) > 0.0
    ):
        return GROWS
    return ""


def _words(compiled: Compiled, i: int) -> dict[str, str]:
    m, enums = compiled.model, compiled.mujoco
    found: dict[str, str] = {}
    for key, column, enum in (
        ("trn", m.actuator_trntype, enums.mjtTrn),
        ("dyn", m.actuator_dyntype, enums.mjtDyn),
        ("gain", m.actuator_gaintype, enums.mjtGain),
        ("bias", m.actuator_biastype, enums.mjtBias),
    ):
        found[key] = str(enum(int(column[i])).name).split("_", 1)[-1].lower()
    return found


def _numbers(compiled: Compiled, i: int) -> str:
    """What a script needs to do what is left out."""
    m = compiled.model

    def few(values: object) -> str:
        return " ".join(f"{float(v):g}" for v in np.trim_zeros(np.asarray(values, dtype=float), "b")) or "0"

    parts = [
        f"gear {few(m.actuator_gear[i])}",
        f"gain {few(m.actuator_gainprm[i])}",
        f"bias {few(m.actuator_biasprm[i])}",
    ]
    if m.actuator_forcelimited[i]:
        parts.append(f"force {few(m.actuator_forcerange[i])}")
    return ", ".join(parts)
