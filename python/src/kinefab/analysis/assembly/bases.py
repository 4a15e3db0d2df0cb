"""Which parts on the ground are built together: held to each other by what the source says of the two, not by the ground alone."""

from __future__ import annotations

import numpy as np

from ...partition import Partition
from .assemble import Assembly, merged_rigid_pairs


def built_together(assembly: Assembly) -> tuple[tuple[int, int], ...]:
    """Pairs of nodes that constraints and joints between parts on the ground leave no freedom against each other, as if there were no
    ground: of each such base its first node with each other one."""
    standing = assembly.body == 0
    standing[0] = False  # the ground itself builds nothing together
    if standing.sum() < 2:
        return ()
    whole = assembly.equations.system
    between = np.ones(whole.rows, dtype=bool)
    between[whole.row[~(standing[whole.body_a] & standing[whole.body_b])]] = False
    if not between.any():
        return ()
    stated = Partition(len(standing))
    for node, base in enumerate(assembly.stated.standing):
        if base is not None:
            stated.join(node + 1, base + 1)
    body = stated.labels()
    system = whole.select(between).relabel(body)
    body, _ = merged_rigid_pairs(
        body, system.select(system.joining()), assembly.breakable, assembly.mirrored, assembly.equations.length
    )
    first: dict[int, int] = {}
    nodes = np.flatnonzero(standing) - 1
    pairs = [(first.setdefault(int(body[node + 1]), node), node) for node in nodes.tolist()]
    return tuple(pair for pair in pairs if pair[0] != pair[1])
