"""Links of articulations as the joint components that leave the same freedoms: how pictures show them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..spatial import matrix_from_quaternion

LOCKED = {
    name: "Locked"
    for name in ("xMotion", "yMotion", "zMotion", "angularXMotion", "angularYMotion", "angularZMotion")
}


def joint_of_link(link: Mapping[str, Any], above: int) -> tuple[dict[str, Any], float]:
    """The component, on the link's object, and the middle of its slide from the pose in the file, metres.  above: the object of
    the link that it is held to."""
    axes = matrix_from_quaternion(np.array(link.get("anchorRotation", (0, 0, 0, 1)), dtype=float))
    kind, drive = link.get("jointType", "Fixed"), link.get("xDrive", {})
    low, high = (float(drive.get(end, 0.0)) for end in ("lowerLimit", "upperLimit"))
    found: dict[str, Any] = {
        "connectedBody": above,
        "anchor": link.get("anchorPosition", (0, 0, 0)),
        "axis": axes[:, 0].tolist(),
        "secondaryAxis": axes[:, 1].tolist(),
    }
    if kind == "Revolute":
        limited = link.get("twistLock") == "Limited"
        return {"type": "HingeJoint", "useLimits": limited, "limits": {"min": low, "max": high}, **found}, 0.0
    if kind == "Prismatic":
        limited = link.get("linearLock") == "Limited"
        slide = {"xMotion": "Limited" if limited else "Free", "linearLimit": {"limit": 0.5 * (high - low)}}
        return {"type": "ConfigurableJoint", **found, **LOCKED, **slide}, 0.5 * (low + high) if limited else 0.0
    if kind == "Spherical":
        turns = zip(("angularXMotion", "angularYMotion", "angularZMotion"), ("twistLock", "swingYLock", "swingZLock"))
        motions = {motion: link.get(lock, "Locked") for motion, lock in turns}
        ends = {"lowAngularXLimit": {"limit": -high}, "highAngularXLimit": {"limit": -low}}
        return {"type": "ConfigurableJoint", **found, **LOCKED, **motions, **ends}, 0.0
    return {"type": "FixedJoint", **found}, 0.0
