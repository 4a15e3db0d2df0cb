"""What each freedom of a joint may do, as LimitAPI, DriveAPI and vendors' attributes have it.

USD counts angles in degrees and angular gains per degree; everything else is SI, as the stage is in metres and kilograms.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

from ....model import MOTOR_DAMPING, RX, Drive, Freedom, Motion, Passive
from ..prims import Prim

DOFS = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")
"""USD's names of the freedoms TX..RZ."""
UNBOUNDED = 1e30
"""Degrees or metres, for the end that a range does not have: where the schema's infinity stands PhysX refuses the other end too, and
from 1e38 on a bound is none for it.  Kinefab's own reader takes it for none."""
AT_ZERO = 1e-9
"""Metres or radians that a coordinate may be off zero and be there: the rounding of a pose."""


def coordinate(value: float, turns: bool) -> float:
    """Metres, or degrees of radians."""
    return math.degrees(value) if turns else value


def bound(value: float, turns: bool) -> float:
    """An end of a range, metres or degrees of radians; a large number where there is none on that side."""
    return math.copysign(UNBOUNDED, value) if math.isinf(value) else coordinate(value, turns)


def gain(value: float, turns: bool) -> float:
    """A stiffness or damping per metre, or per degree of one per radian."""
    return math.radians(value) if turns else value


def write_limit_api(prim: Prim, index: int, freedom: Freedom) -> None:
    """A freedom of a generic joint: free without a limit, locked by a lower end above the upper."""
    if freedom.motion is Motion.FREE:
        return
    instance, turns = DOFS[index], index >= RX
    low, high = 1.0, -1.0
    if freedom.motion is Motion.LIMITED:
        low, high = bound(freedom.lower, turns), bound(freedom.upper, turns)
    prim.apply(f"PhysicsLimitAPI:{instance}")
    prim.numbers({f"limit:{instance}:physics:low": low, f"limit:{instance}:physics:high": high})


def write_soft_limit(prim: Prim, instance: str, freedom: Freedom, turns: bool) -> None:
    """The spring, damper and bounce of a limit, as PhysX's schema has them."""
    if freedom.motion is not Motion.LIMITED or not (
        freedom.stiffness or freedom.damping or freedom.restitution
    ):
        return
    prim.apply(f"PhysxLimitAPI:{instance}")
    values = {
        "stiffness": gain(freedom.stiffness, turns),
        "damping": gain(freedom.damping, turns),
        "restitution": freedom.restitution,
    }
    prim.numbers({f"physxLimit:{instance}:{name}": value for name, value in values.items() if value})


def write_drive(prim: Prim, instance: str, drive: Drive, turns: bool) -> None:
    """Of one freedom; a motor is the drive that its largest force bounds."""
    prim.apply(f"PhysicsDriveAPI:{instance}")
    prefix = f"drive:{instance}:physics:"
    if drive.acceleration:
        prim.attribute(f"{prefix}type", "Token", "acceleration", uniform=True)
    stiffness, damping = (0.0, MOTOR_DAMPING) if drive.motor else (drive.stiffness, drive.damping)
    values = {
        "stiffness": gain(stiffness, turns),
        "damping": gain(damping, turns),
        "targetPosition": 0.0 if drive.motor else coordinate(drive.target, turns),
        "targetVelocity": coordinate(drive.target_velocity, turns),
    }
    prim.numbers({prefix + name: value for name, value in values.items()})
    if math.isfinite(drive.max_force):
        prim.numbers({f"{prefix}maxForce": drive.max_force})


def write_passive(prim: Prim, passive: Passive, turns: bool, instance: str, typed: bool) -> None:
    """Friction, inertia and bounds of whatever drives a freedom, as Newton's and PhysX's schemas have them.

    typed: it is the joint's only freedom, of which Newton speaks.  PhysX speaks of each axis, and takes what it says in
    articulations only.
    """
    newton = {
        "armature": passive.armature,
        "friction": passive.friction,
        "damping": gain(passive.damping, turns),
        "effortLimit": passive.effort,
        "velocityLimit": coordinate(passive.speed, turns),
    }
    told = {name: value for name, value in newton.items() if value and math.isfinite(value)}
    if told and typed:
        prim.apply("NewtonJointAPI")
        prim.numbers({f"newton:{name}": value for name, value in told.items()})
    physx = {"armature": passive.armature, "maxJointVelocity": newton["velocityLimit"]}
    effort = {f"{kind}FrictionEffort": passive.friction for kind in ("static", "dynamic")}
    if typed:  # older releases know the joint's own alone
        _write_stated(prim, "PhysxJointAPI", "physxJoint", physx)
        _write_stated(prim, f"PhysxJointAxisAPI:{instance}", f"physxJointAxis:{instance}", effort)
    else:
        _write_stated(
            prim, f"PhysxJointAxisAPI:{instance}", f"physxJointAxis:{instance}", {**physx, **effort}
        )


def _write_stated(prim: Prim, schema: str, prefix: str, values: Mapping[str, float]) -> None:
    stated = {f"{prefix}:{name}": value for name, value in values.items() if value and math.isfinite(value)}
    if stated:
        prim.apply(schema)
        prim.numbers(stated)


def write_state(prim: Prim, instance: str, value: float, turns: bool) -> None:
    """Where a coordinate stands as exported, metres or radians: engines of reduced coordinates begin there."""
    if abs(value) > AT_ZERO:
        prim.apply(f"PhysicsJointStateAPI:{instance}")
        prim.numbers({f"state:{instance}:physics:position": coordinate(value, turns)})


def even(freedoms: Sequence[Freedom]) -> bool:
    """Whether two freedoms have the same hard range to both sides."""
    first = freedoms[0]
    alike = all((f.motion, f.lower, f.upper) == (first.motion, first.lower, first.upper) for f in freedoms)
    hard = not any(f.stiffness or f.damping or f.restitution for f in freedoms)
    return alike and hard and first.motion is Motion.LIMITED and first.lower == -first.upper
