"""Motions of a mechanism whose repeated rows do not quite repeat each other.

A four-bar with axes that are 1e-6 rad off is locked by the letter of its equations, and no one means that.  Its rows
repeat each other up to a small singular value: moved along its velocities, and brought back onto the rows that count, it
may miss the others by that value times the way.  Where a velocity is obstructed, as at a dead centre, it misses them by
the way's square.
"""

from __future__ import annotations

import numpy as np

from ..equations.system import System
from .first_order import BlockFreedom

WAY = 5e-2
"""Length of a trial step, radians or fractions of the length."""
ALLOWED = 8.0
"""Times the noise that the repeated rows may be missed by: it grows along the way, and is spread over the rows."""
CHORDS = 8
"""Steps back onto the rows; each shrinks what is left by about ``WAY``."""
LARGEST = 1_200
"""Unknowns of a block beyond which its singular values are not taken."""


def noise_of(system: System, rank: int) -> float:
    """Largest singular value that does not count, of a block alone at its start pose; 0 of one too large."""
    if 6 * (system.bodies - 1) > LARGEST:
        return 0.0
    s = np.linalg.svd(system.dense(system.start())[1], compute_uv=False)
    return float(s[rank]) if rank < len(s) else 0.0


def moves_up_to_noise(system: System, freedom: BlockFreedom) -> bool:
    """Whether all velocities of a block are motions that keep its rows as well as these repeat each other.

    system: of the block alone, its bodies numbered from 1 on.  freedom: of the block, at the start pose.
    """
    if 6 * (system.bodies - 1) > LARGEST:
        return False
    start = system.start()
    residual, jacobian = system.dense(start)
    u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    rank, bodies = freedom.rank, np.arange(1, system.bodies)
    noise = s[rank] if rank < len(s) else 0.0
    allowed = ALLOWED * (np.abs(residual).max() + noise * WAY)
    draw = np.random.default_rng(17)
    for _ in range(2):
        way = freedom.basis @ draw.standard_normal(freedom.mobility)
        twist = WAY * way / np.abs(way).max()
        for _ in range(CHORDS):
            state = system.moved(start, bodies, twist.reshape(-1, 6))
            left = system.residual(state)
            twist = twist - vt[:rank].T @ (u[:, :rank].T @ left / s[:rank])
        if np.abs(system.residual(system.moved(start, bodies, twist.reshape(-1, 6)))).max() > allowed:
            return False
    return True
