"""The paper's way: the freedoms listed for a part become one joint to the ground that leaves just those."""

from __future__ import annotations

import numpy as np

from ...diagnostics import Report
from ...model import FREE, LOCKED, DofRecord, Joint, Scene, kind_of
from ...rigid import RigidGroups
from ...spatial import Array, Pose, cross, frame_from_axes

PARALLEL = 1e-6
"""Sine of the angle up to which two directions of a record count as one."""


def joints_of_dof_records(scene: Scene, groups: RigidGroups, report: Report) -> list[Joint]:
    """A joint for each record whose part neither a joint nor a constraint of the scene is on.

    Where there are joints or constraints they say how the part moves, and the record is what the analysis is
    checked against: as a joint to the ground it would lock what moves about an instantaneous pole.
    """
    held = {groups.group_of[n] for j in scene.joints for n in (j.a, j.b) if n is not None}
    active = (c for c in scene.constraints if not c.suppressed)
    held |= {groups.group_of[f.node] for c in active for f in c.features if f.node is not None}
    joints: list[Joint] = []
    for record in scene.dof_records:
        node = scene.nodes[record.node]
        feature = f"freedoms of {node.id}"
        group = groups.group_of[record.node]
        nothing = group is None and not node.flexible  # an assembly of which no part is there
        if groups.is_ground(record.node) or node.suppressed or nothing:
            continue
        if group is None:
            detail = "a flexible assembly is no body of its own"
            report.dropped(feature, "DOF_RECORD_INEXPRESSIBLE", record.where, node=node.id, detail=detail)
            continue
        if group in held:
            report.kept(feature, record.where)
            continue
        placed = _frame_and_freedoms(record)
        if isinstance(placed, str):
            report.dropped(feature, "DOF_RECORD_INEXPRESSIBLE", record.where, node=node.id, detail=placed)
            continue
        axes, free = placed
        center = node.pose.translation if record.center is None else record.center
        world = Pose(axes, center)
        freedoms = tuple(FREE if i in free else LOCKED for i in range(6))
        frame_b = node.pose.inverse() @ world
        joints.append(
            Joint(
                f"dof:{node.id}",
                kind_of(free),
                None,
                record.node,
                world,
                frame_b,
                freedoms,
                because=(feature,),
                where=record.where,
            )
        )
    return joints


def _frame_and_freedoms(record: DofRecord) -> tuple[Array, tuple[int, ...]] | str:
    """World axes of a joint frame, columns X Y Z, and the freedoms it leaves; or what is in the way."""
    slides, turns = _span(record.translations), _span(record.rotations)
    # What fixes the frame: the one direction that is singled out, if there is one.
    turn_axis, slide_axis = _singled_out(turns), _singled_out(slides)
    if turn_axis is None or slide_axis is None:
        main = slide_axis if turn_axis is None else turn_axis
        axes = np.eye(3) if main is None else frame_from_axes(main)
    elif np.linalg.norm(cross(turn_axis, slide_axis)) < PARALLEL:
        axes = frame_from_axes(turn_axis)
    elif abs(turn_axis @ slide_axis) < PARALLEL:
        axes = frame_from_axes(turn_axis, slide_axis)
    else:
        return "its slides stand askew to its rotations"
    free = tuple(i for i in range(3) if _lies_in(axes[:, i], slides))
    about = tuple(3 + i for i in range(3) if _lies_in(axes[:, i], turns))
    # Two rotations are a cross joint: its middle body turns about one axis, the part about the other.
    if len(turns) == 2:
        return "two rotations are no motion of their own"
    return axes, free + about


def _singled_out(span: Array) -> Array | None:
    """The direction that a span of directions, rows, singles out: itself, or the one across it; None where none."""
    return span[0] if len(span) == 1 else cross(span[0], span[1]) if len(span) == 2 else None


def _span(directions: Array) -> Array:
    """Independent unit directions that span the given ones, shape (k, 3)."""
    given = np.asarray(directions, dtype=np.float64).reshape(-1, 3)
    if len(given) == 0:
        return given
    if len(given) == 1:
        return given / np.linalg.norm(given)
    _, sizes, rows = np.linalg.svd(given)
    return rows[: int((sizes > PARALLEL * sizes[0]).sum())]


def _lies_in(axis: Array, span: Array) -> bool:
    return bool(np.linalg.norm(axis - span.T @ (span @ axis)) < 10.0 * PARALLEL)
