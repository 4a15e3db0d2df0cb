"""A bundle often states a joint and the constraints that make it; they are one statement, not two."""

from __future__ import annotations

import numpy as np

from ...diagnostics import Report
from ...model import Coupling, Joint
from ...spatial import BoolArray
from ..equations.scene_equations import Equations
from ..equations.system import System
from ..freedom.finite import misfits
from ..freedom.rank import WINDOW
from ..pairs.relations import (
    Pairs,
    batched_null_spaces,
    find_joints,
    pairs_of,
    relations_of,
    relative_rows,
)

BREAKS = 3.0 * WINDOW[1]
"""Misfit of a joint's finite motions, radians or fractions of the length, beyond which they break a constraint: less is
what two statements of one thing may differ by that count as the same in first order."""


def without_duplicates(system: System, equations: Equations, report: Report) -> tuple[System, dict[int, int]]:
    """Leave out the rows of constraints that an explicit joint of the same pair already says.

    A joint speaks for the constraints of its pair when together they remove no more than it does alone, and they stay
    true as it moves: at a dead centre they stop a motion that they do not take away.
    Where they remove more the two disagree; then both count, and the report says so, unless it is the joint's own coupling.
    Returns the system and, for each statement left out, the number of the joint that says it.
    """
    joint = np.array([isinstance(s, Joint) for s in equations.statements], dtype=bool)
    if not joint.any() or joint.all():
        return system, {}
    pairs = pairs_of(system)
    by_joint = joint[system.owner] & (pairs.row_pair >= 0)
    mixed = np.zeros(len(pairs), dtype=bool)
    mixed[pairs.row_pair[by_joint]] = True
    others = ~joint[system.owner] & (pairs.row_pair >= 0) & mixed[pairs.row_pair]
    if not others.any():
        return system, {}
    rows, _, _ = relative_rows(system, pairs, system.start())
    both = batched_null_spaces(rows, np.where(by_joint | others, pairs.row_pair, -1), len(pairs))[0]
    alone = batched_null_spaces(rows, np.where(by_joint, pairs.row_pair, -1), len(pairs))[0]
    stopped = _stopped(system, pairs, by_joint, others & (both == alone)[pairs.row_pair])
    left_out: dict[int, int] = {}
    kept = np.ones(system.rows, dtype=bool)
    for pair in np.unique(pairs.row_pair[others]):
        mine = pairs.row_pair == pair
        speaker = int(system.owner[mine & by_joint][0])
        doubles = np.unique(system.owner[mine & others])
        if int(pair) in stopped:
            continue
        if both[pair] == alone[pair]:
            kept &= ~(mine & others)
            left_out.update((int(i), speaker) for i in doubles)
        elif not all(
            isinstance(equations.statements[i], Coupling) for i in doubles
        ):  # those are to remove more
            names = ", ".join(equations.names(doubles))
            report.add(
                "JOINT_CONSTRAINTS_DISAGREE",
                equations.statements[speaker].where,
                joint=equations.statements[speaker].id,
                constraints=names,
                more=int(both[pair] - alone[pair]),
            )
    return system.select(kept), left_out


def _stopped(system: System, pairs: Pairs, by_joint: BoolArray, others: BoolArray) -> set[int]:
    """The pairs whose joint's motions break other rows of theirs.

    by_joint, others: shape (rows,), the rows of joints, and those that remove nothing beside them at the exported pose.
    """
    asked = np.unique(pairs.row_pair[others])
    joints = system.select(np.flatnonzero(by_joint & np.isin(pairs.row_pair, asked)))
    relations = relations_of(joints, pairs_of(joints), joints.start())
    find_joints(joints, relations, joints.residual(joints.start()))
    moving = [
        (p, r, r.joint) for p, r in zip(asked.tolist(), relations) if r.joint is not None and r.joint.dof
    ]
    number = np.full(len(pairs), -1)
    number[[p for p, _, _ in moving]] = np.arange(len(moving))
    rows = np.flatnonzero(others & (number[pairs.row_pair] >= 0))
    if not len(rows):
        return set()
    some, which = system.select(rows), number[pairs.row_pair[rows]]
    second, lengths = (np.array([getattr(r, name) for _, r, _ in moving]) for name in ("second", "length"))
    worst = misfits(some, second, which[some.row], [joint for _, _, joint in moving], lengths)
    return {p for (p, _, _), misfit in zip(moving, worst.tolist()) if misfit > BREAKS}
