from __future__ import annotations

from dataclasses import dataclass

from ..vectors import ZERO, Vector3
from .collider import Collider


@dataclass(frozen=True, slots=True)
class CapsuleCollider(Collider):
    """height: over both caps, metres.  direction: ``X``, ``Y`` or ``Z`` of the object's axes."""

    center: Vector3 = ZERO
    radius: float = 0.5
    height: float = 1.0
    direction: str = "Y"
