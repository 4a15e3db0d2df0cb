"""Animation clips mirrored into Unity's frame."""

from __future__ import annotations

from collections.abc import Sequence

from ...model import AnimationClip, Repeat
from .. import frames
from ..scene import AnimationClip as UnityClip
from ..scene import Track
from ..scene.vectors import quaternion4, vector3

WRAP = {Repeat.ONCE: "Once", Repeat.LOOP: "Loop", Repeat.PING_PONG: "PingPong"}


def map_clip(clip: AnimationClip, object_of: Sequence[int]) -> UnityClip:
    """object_of: for each node its GameObject, whose parent is the object of the node's parent."""
    tracks = tuple(
        Track(
            object_of[track.node],
            () if track.translations is None else tuple(map(vector3, frames.point(track.translations))),
            () if track.rotations is None else tuple(map(quaternion4, frames.quaternion(track.rotations))),
        )
        for track in clip.tracks
    )
    return UnityClip(clip.name, tuple(clip.times.tolist()), WRAP[clip.repeat], tracks)
