"""Which bodies pass through each other."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Apart:
    """Two nodes whose bodies do not collide with each other, whatever joints there are.

    a, b: indices into ``Scene.nodes``.  reason: the source's rule, as ``contact exclude``.  where: place in the source.
    stated: whether the source says it by itself; else it follows from its joints.
    """

    a: int
    b: int
    reason: str
    where: str = ""
    stated: bool = True
