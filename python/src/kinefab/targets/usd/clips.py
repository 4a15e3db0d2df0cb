"""Clips as time samples of the prims' transforms.

A stage has one line of time: clips stand on it one after another, a code apart, and the layer's own data say where each begins
and ends, what it is called and how it repeats.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import AnimationClip, Repeat, Scene, Track
from ...spatial import Array, Pose, matrix_from_quaternion, quaternion_from_matrix
from .bodies import Bodies
from .prims import Prim, quaternion64, vector3d

CODES = 60.0
"""Time codes a second."""
APART = 1.0
"""Time codes between the last key of a clip and the first of the next."""


@dataclass(frozen=True, slots=True, eq=False)
class _Placed:
    """A clip on the line of time.  tracks: by node.  codes: of its keys."""

    clip: AnimationClip
    tracks: dict[int, Track]
    codes: list[float]


class Clips:
    """moving: nodes whose prims have samples."""

    def __init__(self, scene: Scene, bodies: Bodies, report: Report, target: str):
        self._scene, self._bodies = scene, bodies
        self._placed: list[_Placed] = []
        for clip in scene.animations:
            if len(clip.times) and clip.tracks:
                self._placed.append(_Placed(clip, {t.node: t for t in clip.tracks}, self._codes(clip)))
        for clip in (placed.clip for placed in self._placed):
            feature = f"clip {clip.name}"
            if len(self._placed) > 1:
                report.approximated(feature, "TARGET_CLIP_IN_LINE", clip.where, clip=clip.name, target=target)
            elif clip.repeat is not Repeat.ONCE:
                report.field_dropped(feature, "repeat", target, clip.where)
        moved = {node for placed in self._placed for node in placed.tracks}
        self.moving = {i for i in range(len(scene.nodes)) if moved.intersection(self._chain(i))}

    def _codes(self, clip: AnimationClip) -> list[float]:
        codes = [float(t) * CODES for t in clip.times]
        if not self._placed:
            return codes
        start = self._placed[-1].codes[-1] + APART
        return [start + (code - codes[0]) for code in codes]

    def _chain(self, node: int) -> list[int]:
        """The node and those above it, up to the one below whose prim its own stands."""
        chain: list[int] = []
        at: int | None = node
        while at is not None and at != self._bodies.holder[node]:
            chain.append(at)
            at = self._scene.nodes[at].parent
        return chain

    def write(self, layer: Any, prims: Sequence[Prim]) -> None:
        if not self._placed or not self.moving:
            return
        for name in ("timeCodesPerSecond", "framesPerSecond"):
            layer.pseudoRoot.SetInfo(name, CODES)
        layer.pseudoRoot.SetInfo("startTimeCode", self._placed[0].codes[0])
        layer.pseudoRoot.SetInfo("endTimeCode", self._placed[-1].codes[-1])
        told = {
            f"clip{k}": {
                "name": placed.clip.name,
                "start": placed.codes[0],
                "end": placed.codes[-1],
                "seconds": float(placed.clip.times[0]),
                "repeat": placed.clip.repeat.value,
            }
            for k, placed in enumerate(self._placed)
        }
        layer.customLayerData = {**layer.customLayerData, "kinefab": {"clips": told}}
        for node in sorted(self.moving):
            self._write_samples(layer, prims[node], self._chain(node))

    def _write_samples(self, layer: Any, prim: Prim, chain: list[int]) -> None:
        places = prim.path.AppendProperty("xformOp:translate")
        turns = prim.path.AppendProperty("xformOp:orient")
        before: Array | None = None
        for placed in self._placed:
            for k, code in enumerate(placed.codes):
                pose = Pose()
                for node in reversed(chain):
                    pose = pose @ self._at(node, placed.tracks.get(node), k)
                turn = quaternion_from_matrix(pose.rotation)
                if before is not None and float(before @ turn) < 0.0:
                    turn = -turn
                before = turn
                layer.SetTimeSample(places, code, vector3d(pose.translation))
                layer.SetTimeSample(turns, code, quaternion64(turn))

    def _at(self, node: int, track: Track | None, key: int) -> Pose:
        """A node's pose in its parent's frame at a key."""
        scene = self._scene
        still = scene.pose(scene.nodes[node].parent).inverse() @ scene.nodes[node].pose
        if track is None:
            return still
        turn = still.rotation if track.rotations is None else matrix_from_quaternion(track.rotations[key])
        place = still.translation if track.translations is None else np.asarray(track.translations[key])
        return Pose(turn, place)
