"""Joints of the compiled model: what each body hangs from, as the model's joints."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import (
    FREE,
    Drive,
    Freedom,
    Joint,
    JointKind,
    Motion,
    Passive,
    SphericalDrive,
    freedoms_of,
)
from ...spatial import Array, Pose, matrix_from_quaternion
from ..robots.actuation import bounded
from ..robots.rigid_links import Carrier
from ..robots.robot_frame import shape_placed
from .actuators import Driven
from .engine import Compiled
from .stacks import Axis, Step, steps_of

SAME = 1e-9
"""Radians by which a range may be off to be the same to either side of the exported pose."""


@dataclass(slots=True, eq=False)
class Made:
    """joints: of the scene so far.  coordinate: joint's id and freedom of each of MuJoCo's, by its id (hinges, slides)."""

    joints: list[Joint] = field(default_factory=list[Joint])
    coordinate: dict[int, tuple[str, int]] = field(default_factory=dict[int, tuple[str, int]])


def axes_of(compiled: Compiled, body: int) -> list[Axis]:
    """The body's joints from its parent outwards, none where it is free or fixed."""
    m, d, kinds = compiled.model, compiled.data, compiled.mujoco.mjtJoint
    words = {int(kinds.mjJNT_HINGE): "hinge", int(kinds.mjJNT_SLIDE): "slide", int(kinds.mjJNT_BALL): "ball"}
    found: list[Axis] = []
    first = int(m.body_jntadr[body])
    for j in range(first, first + int(m.body_jntnum[body])):
        kind = words.get(int(m.jnt_type[j]), "free")
        if kind == "free":
            return []
        at = int(m.jnt_qposadr[j])
        turn = _turn(d.qpos[at : at + 4]) if kind == "ball" else None
        zero, here = (0.0, 0.0) if kind == "ball" else (float(m.qpos0[at]), float(d.qpos[at]))
        limited = bool(m.jnt_limited[j])
        low, high = (float(v) for v in m.jnt_range[j])
        symmetric = abs(low + high - 2.0 * here) <= SAME
        axis = np.array(m.jnt_axis[j], dtype=np.float64)
        found.append(
            Axis(
                j,
                kind,
                np.array(m.jnt_pos[j]),
                axis / np.linalg.norm(axis),
                zero,
                here,
                symmetric,
                limited,
                turn,
            )
        )
    return found


def _turn(q: Any) -> Array:
    w, x, y, z = (float(v) for v in q)
    return matrix_from_quaternion(np.array([x, y, z, w]))


def is_free(compiled: Compiled, body: int) -> bool:
    m = compiled.model
    first, count = int(m.body_jntadr[body]), int(m.body_jntnum[body])
    return count == 1 and int(m.jnt_type[first]) == int(compiled.mujoco.mjtJoint.mjJNT_FREE)


def planned(compiled: Compiled, body: int) -> list[Step]:
    """The joints of a body as steps from its parent outwards, none where it is free or fixed."""
    return steps_of(axes_of(compiled, body))


def add_joint(
    made: Made,
    compiled: Compiled,
    step: Step,
    before: Pose,
    a: Carrier | None,
    b: Carrier,
    driven: Driven,
    report: Report,
) -> None:
    """before: the body's frame, nothing moved, in link a (in the world where it is None), MuJoCo's axes."""
    names = [compiled.joints[axis.index] for axis in step.axes]
    name = "+".join(names)
    where = compiled.where("joint", names[0])
    frame_a = shape_placed(before @ step.frame_a)
    if a is not None:
        frame_a = a.pose @ frame_a
    frame_b = b.pose @ shape_placed(step.frame_b)
    slerp, kind = None, step.kind
    if kind is JointKind.SPHERICAL and _never_turns(compiled, step.axes[0]):
        kind, freedoms = JointKind.FIXED, freedoms_of(JointKind.FIXED)
    elif kind is JointKind.SPHERICAL:
        freedoms, slerp = _ball(compiled, step.axes[0], name, where, report)
    elif kind is JointKind.FREE:
        turning, slerp = _ball(compiled, step.axes[-1], name, where, report)
        given = list(turning)
        for axis, index in zip(step.axes[:-1], step.freedoms):
            given[index] = _freedom(compiled, axis, driven, compiled.joints[axis.index], report)
            made.coordinate[axis.index] = (name, index)
        freedoms = tuple(given)
        if slerp is not None or any(f.drive is not None or f.passive is not None for f in freedoms):
            kind = JointKind.GENERAL
    else:
        given = list(freedoms_of(step.kind))
        if step.kind is JointKind.GENERAL:
            given = [Freedom()] * 6
        for axis, index in zip(step.axes, step.freedoms):
            label = compiled.joints[axis.index] if len(step.axes) > 1 else ""
            given[index] = _freedom(compiled, axis, driven, label, report)
            made.coordinate[axis.index] = (name, index)
        freedoms = tuple(given)
    made.joints.append(
        Joint(
            name,
            kind,
            None if a is None else a.node,
            b.node,
            frame_a,
            frame_b,
            freedoms,
            name=name,
            slerp=slerp,
            because=tuple(names),
            where=where,
            extras=_extras(step),
        )
    )


def add_free(made: Made, compiled: Compiled, body: int, b: Carrier) -> None:
    """The joint of a body that floats, from the world to its carrier."""
    j = int(compiled.model.body_jntadr[body])
    name = compiled.joints[j]
    made.joints.append(
        Joint(
            name,
            JointKind.FREE,
            None,
            b.node,
            Pose(),
            b.pose,
            freedoms_of(JointKind.FREE),
            name=name,
            because=(name,),
            where=compiled.where("joint", name),
        )
    )


def _extras(step: Step) -> dict[str, object]:
    kinds = [axis.kind for axis in step.axes]
    return {"mjcf": {"type": kinds[0] if len(kinds) == 1 else kinds}}


def _freedom(compiled: Compiled, axis: Axis, driven: Driven, name: str, report: Report) -> Freedom:
    m, j = compiled.model, axis.index
    drive: Drive | None = driven.drives.get(j)
    # Beside a drive a motor's largest force is not that of the drive.
    effort = math.inf if drive is not None else driven.efforts.get(j, math.inf)
    passive = _passive(compiled, j, effort, report)
    drive = None if drive is None else bounded(drive, passive)
    low, high = (float(v) for v in m.jnt_range[j]) if m.jnt_limited[j] else (-math.inf, math.inf)
    limited = bool(m.jnt_limited[j])
    return Freedom(
        Motion.LIMITED if limited else FREE.motion,
        low,
        high,
        drive,
        passive=passive,
        at=axis.at,
        name=name,
    )


def _passive(compiled: Compiled, j: int, effort: float, report: Report) -> Passive | None:
    m = compiled.model
    dof, at = int(m.jnt_dofadr[j]), int(m.jnt_qposadr[j])
    stiffness = float(m.jnt_stiffness[j])
    name = compiled.joints[j]
    if bool(m.jnt_actfrclimited[j]):
        bounds = np.abs(m.jnt_actfrcrange[j])
        effort = min(effort, float(bounds.max()))
        if bounds.max() - bounds.min() > 1e-9:
            report.approximated(
                f"largest force of joint {name}", "MJCF_EFFORT_UNEVEN", compiled.where("joint", name),
                joint=name, range=" ".join(f"{float(v):g}" for v in m.jnt_actfrcrange[j]),
            )  # fmt: skip
    made = Passive(
        stiffness,
        float(m.qpos_spring[at]) if stiffness else 0.0,
        float(m.dof_damping[dof]),
        float(m.dof_frictionloss[dof]),
        float(m.dof_armature[dof]),
        effort,
    )
    bent = [
        f"{word} {np.array2string(np.asarray(values), precision=6)}"
        for word, values in (
            ("stiffness", getattr(m, "jnt_stiffnesspoly", np.zeros((m.njnt, 1)))[j]),
            ("damping", getattr(m, "dof_dampingpoly", np.zeros((m.nv, 1)))[dof]),
        )
        if np.any(values)
    ]
    if bent:
        report.approximated(
            f"spring and damper of joint {name}", "MJCF_NONLINEAR", compiled.where("joint", name),
            detail="; ".join(bent),
        )  # fmt: skip
    return None if made == Passive() else made


def _never_turns(compiled: Compiled, axis: Axis) -> bool:
    """Whether a ball's range is zero, as of a default class that limits hinges, and it stands there."""
    m = compiled.model
    held = bool(m.jnt_limited[axis.index]) and float(m.jnt_range[axis.index][1]) <= 0.0
    return held and axis.turn is not None and bool(np.abs(axis.turn - np.eye(3)).max() <= SAME)


def _ball(
    compiled: Compiled, axis: Axis, name: str, where: str, report: Report
) -> tuple[tuple[Freedom, ...], SphericalDrive | None]:
    m, j = compiled.model, axis.index
    passive = _passive(compiled, j, math.inf, report)
    freedom = Freedom(FREE.motion)
    if m.jnt_limited[j]:
        most = float(m.jnt_range[j][1])
        freedom = Freedom(Motion.LIMITED, -most, most)
        report.approximated(
            f"joint {name}", "MJCF_BALL_LIMIT", where, joint=name, degrees=f"{math.degrees(most):g}"
        )
    slerp = None
    if passive is not None and (passive.stiffness or passive.damping):
        at = int(m.jnt_qposadr[j])
        slerp = SphericalDrive(
            _turn(m.qpos_spring[at : at + 4]), np.zeros(3), passive.stiffness, passive.damping
        )
    if passive is not None:
        freedom = replace(freedom, passive=replace(passive, stiffness=0.0, damping=0.0, rest=0.0))
    return freedoms_of(JointKind.SPHERICAL, rx=freedom, ry=freedom, rz=freedom), slerp
