"""Which bodies pass through each other."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Apart:
    """Two nodes whose bodies do not collide with each other, whatever joints there are.

    a, b: indices into ``Scene.nodes``.  reason: the source's rule, as ``contact exclude``.  where: place in the source.
    """

    a: int
    b: int
    reason: str
    where: str = ""
