"""The few velocities of a large block with many loops, by inverse iteration on its sparse rows.

Written in the freedoms of a spanning tree, the rows of a grid's loops are a dense matrix, and its singular values cost the
cube of the bodies.  What the rows leave, J y = 0, is found without it: a step of inverse iteration with J' J + mu shrinks a
direction of singular value s by s^2 + mu, so that those which the rows hold are gone after a few, and only the others' own
small matrix J Y is decomposed (Golub & Van Loan, *Matrix Computations*, 8.2).  The factor of a grid's matrix costs n^1.5.
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csr_matrix, identity
from scipy.sparse.linalg import splu

from ...spatial import Array
from .rank import WINDOW, rank_of

DAMPING = 1e-12
STEPS = 6
"""Each leaves of a held direction the square of what the border may be over its singular value."""
FIRST, MOST = 8, 128
"""Directions that are followed at first; they are doubled until some of them are held."""
SPARE = 4


def few_velocities(jacobian: csr_matrix) -> tuple[int, Array, float] | None:
    """Rank, orthonormal null space, shape (n, k), and gap of rows of unit length; None where it has more than ``MOST``
    velocities."""
    width = jacobian.shape[1]
    normal = (jacobian.T @ jacobian + DAMPING * identity(width)).tocsc()
    factor = splu(normal, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    draw = np.random.default_rng(37)
    basis = np.zeros((width, 0))
    count = FIRST
    while count <= min(MOST, width):
        basis = np.concatenate([basis, draw.standard_normal((width, count - basis.shape[1]))], axis=1)
        for _ in range(STEPS):
            basis = np.linalg.qr(factor.solve(np.linalg.qr(basis)[0]))[0]
        _, s, vt = np.linalg.svd(jacobian @ basis, full_matrices=False)
        held = int(np.sum(s > WINDOW[1]))
        if held >= SPARE:
            # beside a row of unit length, as its largest singular value is 1 or more
            rank, gap = rank_of(np.concatenate([[max(1.0, s[0])], s]))
            moving = basis @ vt[int(rank) - 1 :].T
            return width - moving.shape[1], moving, float(gap)
        count *= 2
    return None
