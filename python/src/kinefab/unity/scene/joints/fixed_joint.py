from __future__ import annotations

from dataclasses import dataclass

from .joint import Joint


@dataclass(frozen=True, slots=True)
class FixedJoint(Joint):
    """Holds two bodies as they stand at the start."""
