"""Poses at which all rows are independent, beyond doubt.

There the poses make a smooth set, and each velocity is a motion.  Beside a singular pose the rows that repeat each other
in it are independent by little, less than the gap in which a rank is put asks for, and the motions curve within a trial
step: where a flat spherical linkage has one axis nearly in line, 1e-4 of the way's length.  How little is enough
Newton's method tells: a pose that misses the rows by r has one of the mechanism's near it where r is small beside the
square of the least singular value.  Where a velocity is obstructed, what closes the pose leaves r and that square alike.
"""

from __future__ import annotations

import numpy as np

from ...spatial import Array
from ..equations.solve import Solver
from ..equations.system import State
from .first_order import BlockFreedom

SURE = 1e-2
"""Share of the square of the least singular value that a pose may miss its rows by.  Newton's method converges from half of it,
over the curvature of the rows (Kantorovich 1948), which is a few."""


def independent_velocities(solver: Solver, freedom: BlockFreedom, state: State, open_: float) -> Array | None:
    """All velocities, orthonormal, shape (6 n, mobility), of a solver's only part where no row repeats others; None in doubt.

    open_: what the rows are kept to, which noise in them makes larger."""
    rows, width = len(freedom.rows), len(freedom.basis)
    if rows >= width:
        return None
    residual, jacobian = solver.system.dense(state)
    _, s, vt = np.linalg.svd(jacobian)
    if max(open_, float(np.abs(residual).max())) > SURE * float(s[-1]) ** 2:
        return None
    return vt[rows:].T
