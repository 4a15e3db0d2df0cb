from __future__ import annotations

from dataclasses import dataclass, field

from .vectors import Vector3


@dataclass(frozen=True, slots=True)
class Island:
    gameObjects: tuple[int, ...]
    mobility: int
    redundant: int
    loops: int


@dataclass(frozen=True, slots=True)
class BodyFreedom:
    """directions: free translations against the world; axes: free rotations; unit vectors, in the world."""

    gameObject: int
    translations: int
    rotations: int
    directions: tuple[Vector3, ...]
    axes: tuple[Vector3, ...]


@dataclass(frozen=True, slots=True)
class ClosureGap:
    """By how much the constraints are not met at the exported pose: metres and degrees."""

    position: float
    angle: float


@dataclass(frozen=True, slots=True)
class Mobility:
    """What the analysis found; see ``analysis.findings.result.Analysis``.

    idle: None where a rope, or a joint that holds nothing, closes a loop, see ``analysis.findings.summary.scene_entry``.
    """

    mobility: int
    firstOrderMobility: int
    redundant: int
    idle: int | None = field(default=None, kw_only=True)
    closureGap: ClosureGap
    islands: tuple[Island, ...]
    bodies: tuple[BodyFreedom, ...]
