"""Which nodes move as one: what the source says, and what merging adds."""

from __future__ import annotations

from typing import Iterable

import numpy as np

from ..model import ConstraintKind, NodeKind, Scene


class Partition:
    """Disjoint sets of 0..n-1 (union by smallest member, so that labels do not depend on order)."""

    def __init__(self, n: int):
        self._parent = list(range(n))

    def find(self, i: int) -> int:
        while self._parent[i] != i:
            self._parent[i] = self._parent[self._parent[i]]
            i = self._parent[i]
        return i

    def join(self, i: int, j: int) -> None:
        i, j = self.find(i), self.find(j)
        if i != j:
            self._parent[max(i, j)] = min(i, j)

    def labels(self) -> np.ndarray:
        """Shape (n,): 0, 1, ... in order of each set's smallest member."""
        roots = np.array([self.find(i) for i in range(len(self._parent))])
        return np.unique(roots, return_inverse=True)[1].reshape(-1)


def document_root(scene: Scene) -> int | None:
    """The node that stands for the document itself: an assembly that is the only root."""
    roots = [i for i, n in enumerate(scene.nodes) if n.parent is None]
    if len(roots) == 1 and scene.nodes[roots[0]].kind is NodeKind.ASSEMBLY:
        return roots[0]
    return None


def stated_partition(scene: Scene) -> Partition:
    """Bodies as the source states them; body = node + 1, body 0 is ground.

    * The document's own assembly node is ground; its parts move.
    * Any other assembly that is not flexible is one rigid group with everything below it.
    * ``grounded`` fixes a node in its parent: in the world at the top, in a flexible subassembly below.
    """
    bodies = Partition(len(scene.nodes) + 1)
    root = document_root(scene)
    for i, node in enumerate(scene.nodes):
        if i == root:
            bodies.join(0, i + 1)
            continue
        parent = node.parent
        held = parent is not None and parent != root and scene.nodes[parent].kind is NodeKind.ASSEMBLY
        if held and not scene.nodes[parent].flexible:
            bodies.join(parent + 1, i + 1)
        elif node.grounded:
            bodies.join(parent + 1 if held else 0, i + 1)
    for constraint in scene.constraints:
        if constraint.kind is ConstraintKind.GROUND and not constraint.suppressed:
            for node in _nodes(constraint.features):
                bodies.join(0, node + 1)
    return bodies


def _nodes(features: Iterable) -> Iterable[int]:
    return (f.node for f in features if f.node is not None)
