"""A clip as time samples of the prims' transforms."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import AnimationClip, Repeat, Scene, Track
from ...spatial import Array, Pose, matrix_from_quaternion, quaternion_from_matrix
from .bodies import Bodies
from .prims import Prim, quaternion64, vector3d

CODES = 60.0
"""Time codes a second."""


class Clips:
    """moving: nodes whose prims have samples.  A stage has one line of time, so the first clip is on it."""

    def __init__(self, scene: Scene, bodies: Bodies, report: Report, target: str):
        self._scene, self._bodies = scene, bodies
        self._clip = scene.animations[0] if scene.animations else None
        self._tracks: dict[int, Track] = {}
        if self._clip is not None:
            self._tracks = {track.node: track for track in self._clip.tracks}
        for clip in scene.animations[1:]:
            report.dropped(
                f"clip {clip.name}", "TARGET_FIELD_DROPPED", clip.where, field="a further clip", target=target
            )
        if self._clip is not None and self._clip.repeat is not Repeat.ONCE:
            report.dropped(
                f"clip {self._clip.name}",
                "TARGET_FIELD_DROPPED",
                self._clip.where,
                field="repeat",
                target=target,
            )
        self.moving = {
            i
            for i in range(len(scene.nodes))
            if self._tracks and any(n in self._tracks for n in self._chain(i))
        }

    def _chain(self, node: int) -> list[int]:
        """The node and those above it, up to the one below whose prim its own stands."""
        chain: list[int] = []
        at: int | None = node
        while at is not None and at != self._bodies.holder[node]:
            chain.append(at)
            at = self._scene.nodes[at].parent
        return chain

    def write(self, layer: Any, prims: list[Prim]) -> None:
        clip = self._clip
        if clip is None or not self.moving or not len(clip.times):
            return
        codes = [float(t) * CODES for t in clip.times]
        for name in ("timeCodesPerSecond", "framesPerSecond"):
            layer.pseudoRoot.SetInfo(name, CODES)
        layer.pseudoRoot.SetInfo("startTimeCode", codes[0])
        layer.pseudoRoot.SetInfo("endTimeCode", codes[-1])
        for node in sorted(self.moving):
            self._write_samples(layer, prims[node], self._chain(node), clip, codes)

    def _write_samples(
        self, layer: Any, prim: Prim, chain: list[int], clip: AnimationClip, codes: list[float]
    ) -> None:
        places = prim.path.AppendProperty("xformOp:translate")
        turns = prim.path.AppendProperty("xformOp:orient")
        before: Array | None = None
        for k, code in enumerate(codes):
            pose = Pose()
            for node in reversed(chain):
                pose = pose @ self._at(node, k)
            turn = quaternion_from_matrix(pose.rotation)
            if before is not None and float(before @ turn) < 0.0:
                turn = -turn
            before = turn
            layer.SetTimeSample(places, code, vector3d(pose.translation))
            layer.SetTimeSample(turns, code, quaternion64(turn))

    def _at(self, node: int, key: int) -> Pose:
        """A node's pose in its parent's frame at a key."""
        scene, track = self._scene, self._tracks.get(node)
        still = scene.pose(scene.nodes[node].parent).inverse() @ scene.nodes[node].pose
        if track is None:
            return still
        turn = still.rotation if track.rotations is None else matrix_from_quaternion(track.rotations[key])
        place = still.translation if track.translations is None else np.asarray(track.translations[key])
        return Pose(turn, place)
