"""Analytic Jacobians against central differences."""

from __future__ import annotations

import numpy as np
from kinefab.analysis.equations.scene_equations import equations_of
from kinefab.diagnostics import Report


def check_derivative(scene, rng):
    """The rows' Jacobian at a pose near the scene's, where the constraints need not hold."""
    system = equations_of(scene, Report()).system
    system.length[:] = 0.7
    system.row_length[:] = 0.3
    bodies = np.arange(1, system.bodies)
    state = system.moved(system.start(), bodies, 0.05 * rng.standard_normal((len(bodies), 6)))
    _, block_a, block_b = system.linearise(state)
    jacobian = np.zeros((system.rows, system.bodies, 6))
    np.add.at(jacobian, (system.row, system.body_a), block_a)
    np.add.at(jacobian, (system.row, system.body_b), block_b)
    step = 1e-6
    for body in bodies:
        for i in range(6):
            twist = np.zeros((1, 6))
            twist[0, i] = step
            one = np.array([body])
            difference = system.residual(system.moved(state, one, twist)) - system.residual(
                system.moved(state, one, -twist)
            )
            assert np.abs(difference / (2 * step) - jacobian[:, body, i]).max() < 1e-7
