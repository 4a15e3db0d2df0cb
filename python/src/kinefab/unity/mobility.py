"""What the analysis found, in Unity's frame."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any

from ..spatial import Array
from . import frames
from .scene import BodyFreedom, ClosureGap, Island, Mobility, Vector3
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
        ClosureGap(gap["position"], gap["angle"]),
        tuple(_island(island, object_of) for island in found["islands"]),
        _bodies(found["bodies"], object_of),
        idle=found["idle"],
    )


def _island(found: Mapping[str, Any], object_of: Sequence[int]) -> Island:
    nodes: Sequence[int] = found["nodes"]
    objects = tuple(object_of[node] for node in nodes)
    return Island(objects, found["mobility"], found["redundant"], found["loops"])


def _bodies(found: Sequence[Mapping[str, Any]], object_of: Sequence[int]) -> tuple[BodyFreedom, ...]:
    directions = _mapped((body["directions"] for body in found), frames.direction)
    axes = _mapped((body["axes"] for body in found), frames.axial)
    nodes: list[int] = [body["node"] for body in found]
    return tuple(
        BodyFreedom(object_of[node], len(free), len(turning), free, turning)
        for node, free, turning in zip(nodes, directions, axes)
    )


def _mapped(bodies: Iterable[Array], mirrored: Callable[[Array], Array]) -> Iterator[tuple[Vector3, ...]]:
    """Vectors of each body, shape (n, 3); bodies that are free alike, as many parts of a large scene are, share them."""
    known: dict[bytes, tuple[Vector3, ...]] = {}
    for vectors in bodies:
        key = vectors.tobytes()
        if key not in known:
            known[key] = vectors3(mirrored(vectors))
        yield known[key]
