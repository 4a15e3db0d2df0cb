from __future__ import annotations

from dataclasses import dataclass, field

from .vectors import Vector3


@dataclass(frozen=True, slots=True)
class Island:
    gameObjects: tuple[int, ...]
    mobility: int
    redundant: int | None = None
    loops: int | None = None


@dataclass(frozen=True, slots=True)
class BodyFreedom:
    """directions: free translations against the world; axes: free rotations; unit vectors, in the world."""

    gameObject: int
    translations: int
    rotations: int
    directions: tuple[Vector3, ...] = ()
    axes: tuple[Vector3, ...] = ()


@dataclass(frozen=True, slots=True)
class ClosureGap:
    """By how much the constraints are not met at the exported pose: metres and degrees."""

    position: float = 0.0
    angle: float = 0.0


@dataclass(frozen=True, slots=True)
class Mobility:
    """What the analysis found; see ``analysis.findings.result.Analysis``.  A scene of another program may state its mobility alone.

    idle: None where a rope, or a joint that holds nothing, closes a loop, see ``analysis.findings.summary.scene_entry``.
    """

    mobility: int
    firstOrderMobility: int | None = None
    redundant: int | None = None
    idle: int | None = field(default=None, kw_only=True)
    closureGap: ClosureGap | None = None
    islands: tuple[Island, ...] = ()
    bodies: tuple[BodyFreedom, ...] = ()
