"""Which nodes move as one: what the source says, and what merging adds."""

from __future__ import annotations

from ...model import ConstraintKind, Scene
from ...partition import Partition
from ...rigid import RigidGroups, rigid_groups
from ...spatial import IntArray


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
