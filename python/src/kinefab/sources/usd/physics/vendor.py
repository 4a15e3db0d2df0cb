"""Attributes of vendors' schemas that the model has room for, by name: PhysX, Newton and MuJoCo need no plug-in here."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from ....model import Freedom, Passive
from ..values import Values
from .freedoms import Units


def passive_of(
    freedom: Freedom, prim: Any, turns: bool, instance: str, values: Values, units: Units
) -> Freedom:
    """The freedom with armature, friction, damping and greatest speed where a vendor's attributes state them.

    Newton and MuJoCo's converters count per degree, PhysX's joint friction is a force or a torque.
    """
    gain, force, coordinate = units.gain(turns), units.force(turns), units.coordinate(turns)
    inertia = force / 1.0 if turns else units.opened.frame.mass  # kg m^2, or kg
    if turns:
        inertia = units.opened.frame.mass * units.opened.frame.length**2

    def first(*names: str) -> float | None:
        for name in names:
            if values.authored(prim, name):
                return values.number(prim, name, 0.0, open_ended=True)
        return None

    axis = f"physxJointAxis:{instance}:"
    armature = first("newton:armature", axis + "armature", "physxJoint:armature", "mjc:armature")
    friction = first(
        "newton:friction",
        axis + "dynamicFrictionEffort",
        axis + "staticFrictionEffort",
        "physxJoint:jointFriction",
        "mjc:frictionloss",
    )
    damping = first("newton:damping", "mjc:damping")
    speed = first(
        "newton:velocityLimit",
        axis + "maxJointVelocity",
        "physxJoint:maxJointVelocity",
        "urdf:limit:velocity",
    )
    effort = first("newton:effortLimit", "urdf:limit:effort")
    stiffness, rest = first("mjc:stiffness"), first("mjc:springref")
    if all(v is None for v in (armature, friction, damping, speed, effort, stiffness)):
        return freedom
    passive = Passive(
        (stiffness or 0.0) * gain,
        (rest or 0.0) * coordinate,
        (damping or 0.0) * gain,
        (friction or 0.0) * force,
        (armature or 0.0) * inertia,
        math.inf if effort is None or effort <= 0.0 else effort * force,
        math.inf if speed is None or speed <= 0.0 or speed >= 1e6 else speed * coordinate,
    )
    return replace(freedom, passive=passive)
