from __future__ import annotations

from dataclasses import dataclass

from ..vectors import ONE, ZERO, Vector3
from .collider import Collider


@dataclass(frozen=True, slots=True)
class BoxCollider(Collider):
    """center, size: in the object's frame, metres; size: full extents."""

    center: Vector3 = ZERO
    size: Vector3 = ONE
