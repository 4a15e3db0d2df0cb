from __future__ import annotations

from dataclasses import dataclass

from ..vectors import Quaternion, Vector3


@dataclass(frozen=True, slots=True)
class Track:
    """Local position and rotation of a GameObject at each of the clip's times; () where it has none."""

    gameObject: int
    localPosition: tuple[Vector3, ...] = ()
    localRotation: tuple[Quaternion, ...] = ()


@dataclass(frozen=True, slots=True)
class AnimationClip:
    """times: seconds, rising.  wrapMode: ``Once``, ``Loop`` or ``PingPong``."""

    name: str
    times: tuple[float, ...]
    wrapMode: str = "Once"
    tracks: tuple[Track, ...] = ()
