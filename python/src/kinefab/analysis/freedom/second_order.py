"""Which velocities of a pose the rows' second derivatives leave.

A motion with the velocity v and the acceleration a keeps the rows to second order where J a + h(v, v) = 0, h the rows'
curvature: so what h(v, v) has beside all that accelerations make has to vanish.  That is a few quadratic forms in the
velocities' weights alone, however many bodies move, and what no motion has fails it before a step is taken (Connelly &
Whiteley 1996, *Second-order rigidity and prestress stability for tensegrity frameworks*).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import csr_matrix, identity
from scipy.sparse.linalg import splu

from ...spatial import Array
from ..equations.solve import Solver
from ..equations.system import State
from .first_order import BlockFreedom

STEP = 1e-4
"""Of the steps that the rows' curvature is taken by."""
STRAIGHT = 1e-6
"""What of it is their rounding and their own curvature."""
DAMPING, REFINEMENTS = 1e-12, 2
"""What accelerations make of the rows is taken out so many times, with this damping."""
SOLVED = 1e-10
"""What the forms are to come to: a weight that stands in one by its square alone comes to the root of it."""
KNOWN = 1e-7
"""What they may come to: a pose that is closed to 1e-14 lies by the root of that beside the motions, where velocities are obstructed,
and so do the forms."""
ITERATIONS = 60
FIRST_DAMPING, LEAST_DAMPING, MOST_DAMPING, DAMPING_FACTOR = 1e-3, 1e-14, 1e6, 10.0
LEAST_LENGTH = 1e-6
"""What has to be left of a start beside others."""
SPARE = 16
"""Starts tried one after another that lead nowhere, as many do where branches are many: then there is nothing more."""


@dataclass(slots=True, eq=False)
class SecondOrder:
    """velocities: orthonormal, shape (6 n, f).  forms: shape (m, f, f), symmetric, which vanish where second order leaves a
    velocity; none where it leaves all."""

    velocities: Array
    forms: Array

    def basis(self, draw: np.random.Generator) -> Array:
        """Orthonormal velocities that second order leaves, found one by one, each beside those before it, shape (6 n, k).  Where one
        branch of motions passes through the pose, its motions are among what they span."""
        count = self.velocities.shape[1]
        if not len(self.forms):
            return self.velocities
        known, missed = np.zeros((count, 0)), 0
        while missed < SPARE and known.shape[1] < count:
            weights = _vanishing(self.forms, draw.standard_normal(count), known)
            missed = missed + 1 if weights is None else 0
            if weights is not None:
                known = np.column_stack([known, weights])
        return self.velocities @ known

    def one(self, draw: np.random.Generator) -> Array:
        """A velocity that second order leaves, its largest entry 1, shape (6 n,); zero where there is none."""
        count = self.velocities.shape[1]
        for _ in range(SPARE if count else 0):
            weights = _vanishing(self.forms, draw.standard_normal(count), np.zeros((count, 0)))
            if weights is not None:
                velocity: Array = self.velocities @ weights
                return velocity / np.abs(velocity).max()
        return np.zeros(len(self.velocities))


def second_order(solver: Solver, freedom: BlockFreedom, state: State) -> SecondOrder:
    """Of a block's velocities at a closed state.  solver: of the block alone."""
    basis, count = freedom.basis, freedom.mobility
    if not count or len(freedom.rows) <= freedom.rank:
        return SecondOrder(basis, np.zeros((0, count, count)))
    jacobian = _jacobian(solver, state)
    curved = np.zeros((jacobian.shape[0], count, count))
    for i in range(count):
        twist = STEP * basis[:, i].reshape(-1, 6)
        there, back = (_jacobian(solver, solver.system.moved(state, freedom.bodies, way)) for way in (twist, -twist))
        curved[:, i] = (there - back) @ basis / (2.0 * STEP)
    flat = (0.5 * (curved + np.swapaxes(curved, 1, 2))).reshape(len(curved), -1)
    factors = splu((jacobian.T @ jacobian + DAMPING * identity(jacobian.shape[1])).tocsc())
    for _ in range(REFINEMENTS):
        flat = flat - jacobian @ factors.solve(jacobian.T @ flat)
    flat = flat[np.abs(flat).max(axis=1) > STRAIGHT]
    # as few forms as tell the same
    values, mixtures = np.linalg.eigh(flat @ flat.T)
    return SecondOrder(basis, (mixtures[:, values > STRAIGHT**2].T @ flat).reshape(-1, count, count))


def _jacobian(solver: Solver, state: State) -> csr_matrix:
    """Of a solver's only part, shape (rows, 6 n)."""
    _, block_a, block_b = solver.system.linearise(state)
    return solver.sparse_jacobian(solver.groups[0], block_a, block_b)


def _vanishing(forms: Array, start: Array, beside: Array) -> Array | None:
    """Weights of length 1 near a start, at right angles to orthonormal others, shape (f, k), at which all forms vanish, by
    Levenberg and Marquardt's method; None where that leads to none."""
    weights = _normalised(start, beside)
    if weights is None or not len(forms):
        return weights
    slopes = forms @ weights
    values, damping = slopes @ weights, FIRST_DAMPING
    for _ in range(ITERATIONS):
        if damping >= MOST_DAMPING or np.abs(values).max() <= SOLVED:
            break
        others = np.column_stack([beside, weights])
        along = 2.0 * (slopes - (slopes @ others) @ others.T)
        normal = along.T @ along + damping * np.eye(len(weights))
        there = _normalised(weights - np.linalg.solve(normal, along.T @ values), beside)
        if there is not None:
            its_slopes = forms @ there
            now = its_slopes @ there
            if now @ now < values @ values:
                weights, slopes, values = there, its_slopes, now
                damping = max(LEAST_DAMPING, damping / DAMPING_FACTOR)
                continue
        damping *= DAMPING_FACTOR
    return weights if np.abs(values).max() <= KNOWN else None


def _normalised(weights: Array, beside: Array) -> Array | None:
    """Of length 1, without what they have along others; None where nothing is left."""
    left = weights - beside @ (beside.T @ weights)
    length = np.linalg.norm(left)
    return left / length if length > LEAST_LENGTH * np.linalg.norm(weights) else None
