from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from .vectors import ZERO, Vector3


@dataclass(frozen=True, slots=True)
class Feature:
    """Geometry on an object (None: the world), in its frame, metres and degrees; see ``model.Feature``."""

    kind: str
    gameObject: int | None = None
    point: Vector3 = ZERO
    direction: Vector3 | None = None
    secondary: Vector3 | None = None
    radius: float = 0.0
    halfAngle: float = 0.0


@dataclass(frozen=True, slots=True)
class Constraint:
    """A geometric constraint as the CAD stated it, in Unity's frame; metres and degrees; see ``model.Constraint``."""

    id: str
    kind: str
    features: tuple[Feature, ...]
    name: str = ""
    rawKind: str = ""
    value: float | None = None
    lower: float | None = None
    upper: float | None = None
    sense: str = "either"
    side: str = "either"
    lockRotation: bool = False
    suppressed: bool = False
    reading: Mapping[str, str] = field(default_factory=dict[str, str])
