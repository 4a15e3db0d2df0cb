"""Ranges of joints that none can have, found before anything is worked out with them."""

from __future__ import annotations

import math

from ...diagnostics import Report
from ...model import Freedom, Motion, Scene


def check_limits(scene: Scene, report: Report) -> None:
    """An error for each joint that has a range without a number in it: reversed, not a number, all of it at infinity."""
    for joint in scene.joints:
        wrong = next(
            (f for f in joint.freedoms if f.motion is Motion.LIMITED and not _holds_a_number(f)), None
        )
        if wrong is not None:
            ends = {"lower": wrong.lower, "upper": wrong.upper}
            report.add("JOINT_LIMITS_REVERSED", wrong.where or joint.where, joint=joint.id, **ends)


def _holds_a_number(freedom: Freedom) -> bool:
    return freedom.lower <= freedom.upper and freedom.lower < math.inf and freedom.upper > -math.inf
