"""A mate that was found: a constraint, how sure it is, and the faces that say so."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from ..model import ConstraintKind, FeatureKind
from ..spatial import Array

AUTO = 0.5
"""Confidence from which on ``--mates auto`` uses a mate."""


@dataclass(frozen=True, slots=True, eq=False)
class MateSide:
    """node: of the scene.  point, direction, secondary: WORLD, metres.  faces: "body/number" of the node."""

    node: int
    kind: FeatureKind
    point: Array
    direction: Array | None = None
    secondary: Array | None = None
    radius: float = 0.0
    faces: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class Mate:
    """number: from 1, in the file and in the pictures.  joint: the pair that it leaves, in words.  value: see
    ``model.Constraint``.  reason: what was seen.  confidence: 0..1."""

    number: int
    kind: ConstraintKind
    sides: tuple[MateSide, ...]
    joint: str
    reason: str
    confidence: float
    value: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Mates:
    """ground: the node that stands still, None where there are no parts.  loose: nodes that no mate holds."""

    mates: Sequence[Mate]
    ground: int | None
    ground_reason: str = ""
    loose: tuple[int, ...] = ()
