from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PhysicsMaterial:
    """frictionCombine, bounceCombine: ``Average``, ``Minimum``, ``Multiply`` or ``Maximum``."""

    name: str
    dynamicFriction: float = 0.6
    staticFriction: float = 0.6
    bounciness: float = 0.0
    frictionCombine: str = "Average"
    bounceCombine: str = "Average"
