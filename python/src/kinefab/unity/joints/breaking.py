"""At what joints break."""

from __future__ import annotations

import math
from dataclasses import replace

from ...diagnostics import Report
from ...model import Joint, Scene

LEAST, MOST = 1e-37, 1e38
"""Newtons or newton metres: the ends of what a 32-bit float holds."""


def with_sound_breaks(scene: Scene, report: Report) -> Scene:
    """The scene with joints that break at something.  One that would at nothing, or at what is no number, does not break, which
    the report tells; nor does one that would at more than a float holds."""
    if all(joint.break_force == joint.break_torque == math.inf for joint in scene.joints):
        return scene  # as nearly always
    return replace(scene, joints=[_sound(joint, report) for joint in scene.joints])


def _sound(joint: Joint, report: Report) -> Joint:
    force, torque = (
        _limit(joint, what, value, report)
        for what, value in (("force", joint.break_force), ("torque", joint.break_torque))
    )
    return replace(joint, break_force=force, break_torque=torque)


def _limit(joint: Joint, what: str, value: float, report: Report) -> float:
    if LEAST <= value <= MOST:
        return value
    if not value > MOST:
        told = {"joint": joint.id, "what": what, "value": f"{value:g}"}
        report.approximated(f"break {what} of joint {joint.id}", "JOINT_BREAKS_AT_NOTHING", joint.where, **told)
    return math.inf
