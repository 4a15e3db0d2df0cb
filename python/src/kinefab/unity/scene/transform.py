from __future__ import annotations

from dataclasses import dataclass

from .vectors import IDENTITY, ONE, ZERO, Quaternion, Vector3


@dataclass(frozen=True, slots=True)
class Transform:
    """Of a GameObject against its parent (the world for a root)."""

    localPosition: Vector3 = ZERO
    localRotation: Quaternion = IDENTITY
    localScale: Vector3 = ONE
