"""How large a scene is, and which ends of a slide are in sight of it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..spatial import Array
from .freedoms import world_placements

IN_SIGHT = 20.0
"""Times a scene's span: a slide's end beyond that is no end to who looks on.  A slide limited on one side has its other end
100 m away in Unity, and robots without limits often state a thousand metres: no slider can be used over these."""
NO_SPAN = 0.2
"""Metres, of a scene that is one point."""


def span_of(document: Mapping[str, Any]) -> float:
    """The longest side of the box about origins, anchors of joints and meshes at the exported pose, metres."""
    objects: Sequence[Mapping[str, Any]] = document["gameObjects"]
    meshes: Sequence[Mapping[str, Any]] = document.get("meshes", ())
    points: list[Array] = []
    for entry, (rotation, position, scale) in zip(objects, world_placements(objects)):
        points.append(position)
        turn = rotation * scale
        for component in entry.get("components", ()):
            if (anchor := component.get("anchor", component.get("anchorPosition"))) is not None:
                points.append(position + turn @ np.array(anchor, dtype=float))
            elif component["type"] == "MeshFilter" and component.get("mesh") is not None:
                bounds = meshes[int(component["mesh"])].get("bounds", {})
                middle = position + turn @ np.array(bounds.get("center", (0, 0, 0)), dtype=float)
                half: Array = np.abs(turn) @ np.array(bounds.get("extents", (0, 0, 0)), dtype=float)
                points += [middle - half, middle + half]
    span = float(np.ptp(np.array(points), axis=0).max()) if points else 0.0
    return span if span > 1e-6 else NO_SPAN


def ends_in_sight(value: float, lower: float, upper: float, span: float) -> tuple[float, float]:
    """A slide's limits, endless where they are beyond what can be looked at.  value: where it stands; all in metres."""
    far = IN_SIGHT * span
    return lower if value - lower <= far else -math.inf, upper if upper - value <= far else math.inf
