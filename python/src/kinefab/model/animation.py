"""Motion that a source has recorded or keyed."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from ..spatial import Array


class Repeat(str, Enum):
    """What comes after a clip's end."""

    ONCE = "once"
    LOOP = "loop"
    PING_PONG = "ping_pong"


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """A node's pose in its parent's frame (the world's for a root) at each of the clip's times.

    node: index into ``Scene.nodes``.  translations: metres, shape (n, 3), or None where it does not move.
    rotations: unit quaternions (x, y, z, w), shape (n, 4), neighbours less than half a turn apart, or None.
    """

    node: int
    translations: Array | None = None
    rotations: Array | None = None


@dataclass(frozen=True, slots=True, eq=False)
class AnimationClip:
    """times: seconds, ascending, shape (n,).  Between them translations are linear, rotations along the great arc."""

    name: str
    times: Array
    tracks: tuple[Track, ...]
    repeat: Repeat = Repeat.ONCE
    where: str = ""
