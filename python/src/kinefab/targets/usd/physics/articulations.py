"""Which joints make the trees of reduced coordinates, which close loops, and where each tree begins.

A tree takes hinges, slides, balls and fixed joints that do not break, between bodies that forces move; every other joint is
told to stand outside (``excludeFromArticulation``), as is one that closes a loop.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ....partition import Partition
from ..prims import Prim


@dataclass(frozen=True, slots=True, eq=False)
class Edge:
    """A joint between two bodies (None: the world).  fits: an articulation can have it.  closing: the analysis closes a
    loop with it, so that it is taken last.  exchanges: it can be written from its other body too."""

    a: int | None
    b: int | None
    prim: Prim
    fits: bool = True
    closing: bool = False
    exchanges: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Trees:
    """first: by the path of each joint that is in a tree, the first body of that tree.
    inward: paths of those whose second body is nearer to the root than the first."""

    first: dict[Any, int]
    inward: frozenset[Any]


def mark_articulations(
    edges: Sequence[Edge], kinematic: Callable[[int], bool], prim_of: Callable[[int], Prim], base: Prim | None
) -> Trees:
    """Exclude what is in no tree, and apply the root API: to the joint ``base`` that fixes the ground's body to the world,
    for each tree that hangs on the world by another joint or on nothing to its first body."""
    numbers = {body: i for i, body in enumerate({side: None for edge in edges for side in (edge.a, edge.b)})}
    together = Partition(len(numbers))
    taken: list[Edge] = []
    for edge in sorted(edges, key=lambda e: e.closing):
        bound = any(body is not None and kinematic(body) for body in (edge.a, edge.b))
        if not edge.fits or bound or not together.join(numbers[edge.a], numbers[edge.b]):
            edge.prim.attribute("physics:excludeFromArticulation", "Bool", True, uniform=True)
            continue
        taken.append(edge)
    tree_of, inward = _mark_roots(taken, prim_of, base)
    ends = ((edge.prim.path, edge.b if edge.a is None else edge.a) for edge in taken)
    return Trees({path: tree_of[body] for path, body in ends if body is not None}, frozenset(inward))


def _mark_roots(
    taken: Sequence[Edge], prim_of: Callable[[int], Prim], base: Prim | None
) -> tuple[dict[int, int], set[Any]]:
    """taken: edges of a forest, in which the world is a leaf of each of its trees.  Returns the first body of each one's tree,
    and the paths of joints that were gone along from b to a."""
    joints_of: dict[int, list[Edge]] = {}
    hung: list[int] = []
    inward: set[Any] = set()
    for edge in taken:
        for body, other in ((edge.a, edge.b), (edge.b, edge.a)):
            if body is not None:
                joints_of.setdefault(body, [])
                if other is None:
                    hung.append(body)
                else:
                    joints_of[body].append(edge)
        if edge.b is None:
            inward.add(edge.prim.path)
    seen: dict[int, int] = {}
    fixed = {edge.b for edge in taken if edge.prim is base}
    for start in [*hung, *sorted(joints_of)]:
        if start in seen:
            continue
        tree, waiting = 0, [start]
        seen[start] = start
        while waiting:
            tree += 1
            here = waiting.pop()
            for edge in joints_of[here]:
                there = edge.b if edge.a == here else edge.a
                if there is None or there in seen:
                    continue
                if edge.b == here:
                    inward.add(edge.prim.path)
                seen[there] = start
                waiting.append(there)
        if start in fixed:
            if tree > 1 and base is not None:
                base.apply("PhysicsArticulationRootAPI")
        elif tree > 1 or start in hung:
            prim_of(start).apply("PhysicsArticulationRootAPI")
    return seen, inward
