"""Which nodes move as one: what the source says, and what merging adds."""

from __future__ import annotations

import numpy as np

from ...model import ConstraintKind, Scene
from ...rigid import RigidGroups, rigid_groups
from ...spatial import IntArray


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

    def labels(self) -> IntArray:
        """Shape (n,): 0, 1, ... in order of each set's smallest member."""
        roots = np.array([self.find(i) for i in range(len(self._parent))])
        return np.unique(roots, return_inverse=True)[1].reshape(-1)


def stated_bodies(scene: Scene) -> tuple[IntArray, RigidGroups]:
    """Body of each node as the source states it, shape (nodes + 1,): entry 0 is ground, body 0.

    Flexible assemblies are no bodies: the geometry of the document's own assembly stands on the ground,
    that of one further down is a body of its own, held by nothing; without a statement about it, it is none.
    """
    fixed = [
        (None, f.node)
        for c in scene.constraints
        if c.kind is ConstraintKind.GROUND and not c.suppressed
        for f in c.features
        if f.node is not None
    ]
    groups = rigid_groups(scene, fixed)
    named = {f.node for c in scene.constraints for f in c.features} | {
        n for j in scene.joints for n in (j.a, j.b)
    }
    bodies = Partition(len(scene.nodes) + 1)
    for i, node in enumerate(scene.nodes):
        group = groups.group_of[i]
        if groups.is_ground(i) or group is None and (node.parent is None or i not in named):
            bodies.join(0, i + 1)
        elif group is not None:
            bodies.join(groups.members[group][0] + 1, i + 1)
    return bodies.labels(), groups
