"""Clips as glTF animations."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from ...diagnostics import Report
from ...model import Repeat, Scene
from ..numbers import rising
from .binary import Binary


def animations(scene: Scene, node_of: Sequence[int], binary: Binary, report: Report) -> list[dict[str, Any]]:
    """The document's.  node_of: for each node of the model its glTF node."""
    found: list[dict[str, Any]] = []
    for clip in scene.animations:
        samplers: list[dict[str, Any]] = []
        channels: list[dict[str, Any]] = []
        times = binary.floats(rising(clip.times), vertex=False, bounded=True)
        for track in clip.tracks:
            for path, values in (("translation", track.translations), ("rotation", track.rotations)):
                if values is None:
                    continue
                output = binary.floats(values, vertex=False)
                samplers.append({"input": times, "output": output, "interpolation": "LINEAR"})
                goal = {"node": node_of[track.node], "path": path}
                channels.append({"sampler": len(samplers) - 1, "target": goal})
        if channels:
            found.append({"name": clip.name, "samplers": samplers, "channels": channels})
        if clip.repeat is not Repeat.ONCE:
            report.field_dropped(f"clip {clip.name}", "repeat", ".glb", clip.where)
    return found
