"""What the analysis found, in Unity's frame."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from . import frames
from .scene import BodyFreedom, ClosureGap, Island, Mobility
from .scene.vectors import vectors3


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
        tuple(_island(island, object_of) for island in found["islands"]),
        tuple(_body(body, object_of) for body in found["bodies"]),
    )


def _island(found: Mapping[str, Any], object_of: Sequence[int]) -> Island:
    nodes: Sequence[int] = found["nodes"]
    objects = tuple(object_of[node] for node in nodes)
    return Island(objects, found["mobility"], found["redundant"], found["loops"])


def _body(found: Mapping[str, Any], object_of: Sequence[int]) -> BodyFreedom:
    node: int = found["node"]
    directions, axes = frames.direction(found["directions"]), frames.axial(found["axes"])
    return BodyFreedom(object_of[node], len(directions), len(axes), vectors3(directions), vectors3(axes))
