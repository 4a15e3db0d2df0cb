from __future__ import annotations

from dataclasses import dataclass

from ..vectors import ZERO, Vector3
from .collider import Collider


@dataclass(frozen=True, slots=True)
class SphereCollider(Collider):
    """center, radius: in the object's frame, metres."""

    center: Vector3 = ZERO
    radius: float = 0.5
