"""The joint of a written link of an articulation, as the model has it: the way back of ``links.motions``."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from ...model import FREE, LOCKED, MOTOR_DAMPING, RX, TX, Drive, Freedom, Motion, Passive
from ...spatial import Array, frame_from_axes, matrix_from_quaternion
from .. import frames

Entry = Mapping[str, Any]

LINK = "ArticulationBody"
_LOCKS = ("twistLock", "swingYLock", "swingZLock")
_DRIVES = ("xDrive", "yDrive", "zDrive")


def link_basis(link: Entry) -> Array:
    """Axes of its joint in the link's own frame, shape (3, 3), on which its coordinates keep their signs."""
    axes = matrix_from_quaternion(np.array(link.get("anchorRotation", (0, 0, 0, 1)), dtype=np.float64))
    if link.get("jointType") == "Prismatic":
        return frame_from_axes(frames.direction(axes[:, 0]))
    return frames.axial(axes.T).T


def link_freedoms(link: Entry) -> tuple[Freedom, ...]:
    """Of the link against the one above it."""
    kind = link.get("jointType", "Fixed")
    found = [LOCKED] * 6
    if kind == "Prismatic":
        found[TX] = _freedom(link, "linearLock", "xDrive", 1.0, lone=True)
    elif kind == "Revolute":
        found[RX] = _freedom(link, "twistLock", "xDrive", math.radians(1.0), lone=True)
    elif kind == "Spherical":
        for i, (lock, drive) in enumerate(zip(_LOCKS, _DRIVES)):
            found[RX + i] = _freedom(link, lock, drive, math.radians(1.0), lone=False)
    return tuple(found)


def _freedom(link: Entry, lock: str, name: str, unit: float, lone: bool) -> Freedom:
    """lone: of a joint with this one axis, which moves freely where it is locked, as in Unity."""
    drive: Entry = link.get(name, {})
    word = link.get(lock, "Locked")
    if word == "Locked" and not lone:
        return LOCKED
    found = FREE
    if word == "Limited":
        low, high = (unit * float(drive.get(end, 0.0)) for end in ("lowerLimit", "upperLimit"))
        found = Freedom(Motion.LIMITED, min(low, high), max(low, high))
    if (speed := link.get("maxJointVelocity")) is not None:
        found = replace(found, passive=Passive(speed=float(speed)))
    return replace(found, drive=_drive(drive, unit))


def _drive(drive: Entry, unit: float) -> Drive | None:
    kind = drive.get("driveType", "Force")
    stiffness, damping = float(drive.get("stiffness", 0.0)), float(drive.get("damping", 0.0))
    most = float(drive.get("forceLimit", math.inf))
    aim, speed = unit * float(drive.get("target", 0.0)), unit * float(drive.get("targetVelocity", 0.0))
    if kind == "Velocity":
        return Drive(target_velocity=speed, max_force=most, motor=True)
    if kind == "Target":  # as stiff as the solver can
        return Drive(aim, 0.0, MOTOR_DAMPING, MOTOR_DAMPING, most)
    if not (stiffness or damping):
        return None
    return Drive(aim if stiffness else 0.0, speed, stiffness, damping, most, kind == "Acceleration")
