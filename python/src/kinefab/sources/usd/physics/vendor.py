"""Attributes of vendors' schemas that the model has room for, by name: PhysX, Newton and MuJoCo need no plug-in here."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from ....model import Freedom, Passive
from ..values import Values, identity
from .freedoms import Units


def passive_of(
    freedom: Freedom, prim: Any, turns: bool, instance: str, values: Values, units: Units
) -> Freedom:
    """The freedom with armature, friction, damping and greatest speed where a vendor's attributes state them.

    Newton counts per degree, MuJoCo per radian; PhysX's joint friction is a force or a torque.
    """
    gain, force, coordinate = units.gain(turns), units.force(turns), units.coordinate(turns)
    inertia = force if turns else units.opened.frame.mass  # kg m^2, or kg

    def first(*names: str) -> float | None:
        stated = [name for name in names if values.authored(prim, name)]  # the others say the same
        return values.number(prim, stated[0], 0.0, open_ended=True) if stated else None

    axis = f"physxJointAxis:{instance}:"
    armature = first("newton:armature", axis + "armature", "physxJoint:armature", "mjc:armature")
    friction = first(
        "newton:friction",
        axis + "dynamicFrictionEffort",
        axis + "staticFrictionEffort",
        "physxJoint:jointFriction",
        "mjc:frictionloss",
    )
    damping, damping_unit = first("newton:damping"), gain
    if damping is None:
        damping, damping_unit = first("mjc:damping"), units.mujoco_gain(turns)
    speed = first(
        "newton:velocityLimit",
        axis + "maxJointVelocity",
        "physxJoint:maxJointVelocity",
        "urdf:limit:velocity",
    )
    effort = first("newton:effortLimit", "urdf:limit:effort")
    if effort is None:
        effort = _bound(prim, values)
    stiffness = first("mjc:stiffness")
    rest = (first("mjc:springref") or 0.0) - (first("mjc:ref") or 0.0)
    if math.isinf(effort) and all(v is None for v in (armature, friction, damping, speed, stiffness)):
        return freedom
    passive = Passive(
        (stiffness or 0.0) * units.mujoco_gain(turns),
        rest * units.mujoco_coordinate(turns) if stiffness else 0.0,
        (damping or 0.0) * damping_unit,
        (friction or 0.0) * force,
        (armature or 0.0) * inertia,
        math.inf if effort <= 0.0 else effort * force,
        math.inf if speed is None or speed <= 0.0 or speed >= 1e6 else speed * coordinate,
    )
    return replace(freedom, passive=passive)


def limited(prim: Any, range_: str, word: str, values: Values) -> tuple[float, float]:
    """A range of MuJoCo's schemas, infinite where it is none.  range_, word: names of its attributes.

    ``auto`` is a range wherever one is stated.
    """
    low, high = (values.number(prim, f"{range_}:{end}", 0.0) for end in ("min", "max"))
    said = values.word(prim, word, "auto")
    if said == "true" or (said == "auto" and low < high):
        return low, high
    return -math.inf, math.inf


def _bound(prim: Any, values: Values) -> float:
    """The largest force of MuJoCo's actuators on a joint together."""
    low, high = limited(prim, "mjc:actuatorfrcrange", "mjc:actuatorfrclimited", values)
    if low != -high:
        values.report.approximated(
            f"largest force of joint {identity(prim)}", "USD_FEATURE_APPROXIMATED",
            values.opened.place(prim, "mjc:actuatorfrcrange:max"),
            detail=f"from {low:g} to {high:g} is not the same to both sides; the larger was taken",
        )  # fmt: skip
    return max(abs(low), abs(high))
