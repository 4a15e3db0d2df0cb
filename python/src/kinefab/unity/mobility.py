"""What the analysis found, in Unity's frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import frames
from .scene import BodyFreedom, ClosureGap, Island, Mobility
from .scene.vectors import vector3


def map_mobility(found: Mapping[str, Any], object_of: Sequence[int]) -> Mobility:
    """found: by node number and in the right-handed frame, as ``analysis.findings.summary.scene_entry`` gives it.
    object_of: for each node the index of its GameObject.
    """
    gap = found["closureGap"]
    return Mobility(
        found["mobility"],
        found["firstOrderMobility"],
        found["redundant"],
        found["idle"],
        ClosureGap(gap["position"], gap["angle"]),
        tuple(
            Island(
                tuple(object_of[node] for node in island["nodes"]),
                island["mobility"],
                island["redundant"],
                island["loops"],
            )
            for island in found["islands"]
        ),
        tuple(
            BodyFreedom(
                object_of[body["node"]],
                len(body["directions"]),
                len(body["axes"]),
                tuple(vector3(frames.direction(v)) for v in body["directions"]),
                tuple(vector3(frames.axial(v)) for v in body["axes"]),
            )
            for body in found["bodies"]
        ),
    )
