"""Bodies that have no mesh, as bars between their joints: of a mechanism without geometry there is else nothing to see."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..spatial import Array
from .freedoms import BODIES, link_above, world_placements, world_points

COLOURS = ("#8d99a8", "#7fa7c9", "#c9a67f", "#8fbf9a", "#b79ac4")
"""Of the bars of one body and the next."""
JOINTS = ("HingeJoint", "ConfigurableJoint", "FixedJoint")

Bar = tuple[int, str, Array]
"""The body's object, a colour, and the ends in its own frame without its scale, shape (2, 3), metres."""


def bars(objects: Sequence[Mapping[str, Any]]) -> list[Bar]:
    """Between the two joints of a body, or from the middle of several to each; objects: of a parsed ``.kinefab``.

    What is kinematic stands still, or is led by a script: it is no bar.
    """
    placements = world_placements(objects)
    free, drawn = _bodies(objects)
    points: dict[int, list[Array]] = {}
    for index, item in enumerate(objects):
        for component in item.get("components", ()):
            linked = link_above(objects, index) if component["type"] == "ArticulationBody" else None
            if linked is not None:
                at = world_points(component.get("anchorPosition", (0, 0, 0)), placements[index])
                for body in (index, linked):
                    points.setdefault(body, []).append(at)
            if component["type"] not in JOINTS or not component.get("enabled", True):
                continue
            at = world_points(component.get("anchor", (0, 0, 0)), placements[index])
            points.setdefault(index, []).append(at)
            other: int | None = component.get("connectedBody")
            if other is not None:
                given = component.get("connectedAnchor")
                points.setdefault(other, []).append(
                    at if given is None else world_points(given, placements[other])
                )
    found: list[Bar] = []
    for number, index in enumerate(i for i in sorted(points) if i in free and i not in drawn):
        ends = np.array(points[index])
        turn, place, _ = placements[index]
        middle = ends.mean(axis=0) if len(ends) > 2 else ends[0]
        for end in ends if len(ends) > 2 else ends[1:]:
            found.append((index, COLOURS[number % len(COLOURS)], (np.array([middle, end]) - place) @ turn))
    return found


def _bodies(objects: Sequence[Mapping[str, Any]]) -> tuple[set[int], set[int]]:
    """The bodies that forces move, and those of which a mesh is seen; by their objects."""
    body_of: list[int | None] = []
    free: set[int] = set()
    drawn: set[int] = set()
    for index, item in enumerate(objects):
        components = {c["type"]: c for c in item.get("components", ())}
        parent: int | None = item.get("parent")
        above = None if parent is None else body_of[parent]
        own = next((components[kind] for kind in BODIES if kind in components), None)
        body_of.append(above if own is None else index)
        if own is not None and not (own.get("isKinematic", False) or own.get("immovable", False)):
            free.add(index)
        body = body_of[index]
        if body is not None and "MeshFilter" in components and item.get("active", True):
            drawn.add(body)
    return free, drawn
