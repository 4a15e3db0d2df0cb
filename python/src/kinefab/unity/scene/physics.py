from __future__ import annotations

from dataclasses import dataclass

from .vectors import Vector3


@dataclass(frozen=True, slots=True)
class Physics:
    """Project settings; gravity: m/s^2, fixedTimestep: seconds."""

    gravity: Vector3 = (0.0, -9.81, 0.0)
    fixedTimestep: float = 0.02
    solverIterations: int = 6
    solverVelocityIterations: int = 1
    bounceThreshold: float = 2.0
    defaultMaxAngularSpeed: float = 7.0
