from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class IgnoredCollision:
    """Objects whose bodies pass through each other by a rule of the source.  reason: the rule; "" where it is not told."""

    a: int
    b: int
    reason: str = ""
