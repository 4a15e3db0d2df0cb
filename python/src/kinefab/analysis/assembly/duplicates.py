"""A bundle often states a joint and the constraints that make it; they are one statement, not two."""

from __future__ import annotations

import numpy as np

from ...diagnostics import Report
from ...model import Coupling, Joint
from ..equations.scene_equations import Equations
from ..equations.system import System
from ..pairs.relations import batched_null_spaces, pairs_of, relative_rows


def without_duplicates(system: System, equations: Equations, report: Report) -> tuple[System, dict[int, int]]:
    """Leave out the rows of constraints that an explicit joint of the same pair already says.

    A joint speaks for the constraints of its pair when together they remove no more than it does alone.
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
    left_out: dict[int, int] = {}
    kept = np.ones(system.rows, dtype=bool)
    for pair in np.unique(pairs.row_pair[others]):
        mine = pairs.row_pair == pair
        speaker = int(system.owner[mine & by_joint][0])
        doubles = np.unique(system.owner[mine & others])
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
