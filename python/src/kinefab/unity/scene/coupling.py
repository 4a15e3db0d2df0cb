from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class JointCoordinate:
    """gameObject, component: index of the object and of the joint among its components.
    coordinate: ``angle`` of a hinge; ``x`` .. ``z``, ``angularX`` .. ``angularZ`` of a ConfigurableJoint."""

    gameObject: int
    component: int
    coordinate: str


@dataclass(frozen=True, slots=True)
class CouplingTerm:
    """ratio: of the driven coordinate's unit to this one's (metres, degrees)."""

    coordinate: JointCoordinate
    ratio: float


@dataclass(frozen=True, slots=True)
class Coupling:
    """``q = sum of ratio * q_term + offset``, metres and degrees.  kind: ``gear``, ``belt``, ``rack``, ``screw``, ``linear``."""

    id: str
    kind: str
    coordinate: JointCoordinate
    terms: tuple[CouplingTerm, ...]
    offset: float = 0.0
