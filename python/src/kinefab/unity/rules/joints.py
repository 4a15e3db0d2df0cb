"""Joint components.  One that is switched off could be switched on, so it must be sound too."""

from __future__ import annotations

import math
from collections.abc import Sequence

from .findings import Entry, Findings
from .hierarchy import Hierarchy
from .shape import NOTHING

SINE = 1e-4
"""Up to here a secondary axis lies along the axis."""


def check_joint(joint: Entry, index: int, at: str, places: Hierarchy, found: Findings) -> None:
    """index: of its object."""
    if not places.has_body[index] or places.is_link[index]:
        found.add("JOINT_WITHOUT_RIGIDBODY", at)
    connected, place = joint.get("connectedBody"), f"{at}/connectedBody"
    if found.reference(connected, "gameObjects", len(places.objects), place) and connected is not None:
        if connected == index:
            found.add("JOINT_CONNECTS_ITSELF", place)
        elif not places.has_body[connected]:
            found.add("CONNECTED_BODY_WITHOUT_RIGIDBODY", place, gameObject=connected)
    if joint["type"] == "FixedJoint":
        return
    if _vanishes(joint.get("axis", (1,))):
        found.add("JOINT_AXIS_ZERO", f"{at}/axis")
    if joint["type"] == "HingeJoint":
        _check_hinge(joint, at, found)
    else:
        _check_configurable(joint, at, found)


def _check_hinge(joint: Entry, at: str, found: Findings) -> None:
    limits: Entry = joint.get("limits", {})
    low, high = limits.get("min", 0), limits.get("max", 0)
    if low > high:
        found.add("HINGE_LIMITS_ORDER", f"{at}/limits", min=low, max=high)


def _check_configurable(joint: Entry, at: str, found: Findings) -> None:
    axis, secondary = joint.get("axis", (1, 0, 0)), joint.get("secondaryAxis", (0, 1, 0))
    if not _vanishes(axis) and (_vanishes(secondary) or _parallel(axis, secondary)):
        found.add("JOINT_SECONDARY_AXIS_PARALLEL", f"{at}/secondaryAxis")
    low, high = (joint.get(f"{end}AngularXLimit", {}).get("limit", 0) for end in ("low", "high"))
    if low > high:
        found.add("ANGULAR_X_LIMITS_ORDER", f"{at}/lowAngularXLimit", low=low, high=high)
    for name in ("linearLimit", "angularYLimit", "angularZLimit"):
        limit = joint.get(name, {}).get("limit", 0)
        if limit < 0:
            found.add("LIMIT_NEGATIVE", f"{at}/{name}/limit", limit=limit)


def _vanishes(axis: Sequence[float]) -> bool:
    """Whether nothing is left of it as 32-bit floats, in which Unity computes."""
    return all(abs(number) <= NOTHING for number in axis)


def _parallel(a: Sequence[float], b: Sequence[float]) -> bool:
    area = math.hypot(a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return area <= SINE * math.hypot(*a) * math.hypot(*b)
