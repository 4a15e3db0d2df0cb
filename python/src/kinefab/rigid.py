"""Rigid groups: which nodes move as one, and which of them stand on the ground."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from .model import Joint, JointKind, NodeKind, Scene
from .partition import Partition


@dataclass(frozen=True, slots=True)
class RigidGroups:
    """group_of: for each node its group's number, or None for a node that is no body (a flexible assembly, one of which
    nothing is there, or a suppressed node).  members: for each group its nodes in scene order.  grounded: for each group
    whether it is fixed to the world.  standing: for each node that stands on the ground what it is rigid with other than by the
    ground, as the lowest node of it; None for all others.
    """

    group_of: tuple[int | None, ...]
    members: tuple[tuple[int, ...], ...]
    grounded: tuple[bool, ...]
    standing: tuple[int | None, ...] = ()

    def is_ground(self, node: int | None) -> bool:
        """Whether a joint's side is the world, directly or through its group."""
        if node is None:
            return True
        group = self.group_of[node]
        return group is not None and self.grounded[group]

    def without_body(self, joint: Joint) -> int | None:
        """The first of a joint's nodes that is no body, None where both sides are one or the world."""
        return next((n for n in (joint.a, joint.b) if n is not None and self.group_of[n] is None), None)

    def together(self, a: int | None, b: int | None) -> bool:
        """Whether two sides of a joint can never move against each other."""
        if a is None or b is None or self.is_ground(a) or self.is_ground(b):
            return self.is_ground(a) and self.is_ground(b)
        return self.group_of[a] == self.group_of[b]


def is_kinematic(scene: Scene, moved_nodes: tuple[int, ...]) -> bool:
    """Whether one of a body's nodes is moved by scripts alone: then all of it is."""
    return any(scene.nodes[i].dynamics.kinematic for i in moved_nodes)


def is_dynamic(scene: Scene, groups: RigidGroups, node: int) -> bool:
    """Whether forces move a node's body."""
    group = groups.group_of[node]
    return group is not None and not groups.grounded[group] and not is_kinematic(scene, groups.members[group])


def dynamic_nodes(scene: Scene, groups: RigidGroups) -> list[bool]:
    """``is_dynamic`` of every node, with one look at each group: thousands of parts may be one."""
    moves = [not own and not is_kinematic(scene, nodes) for own, nodes in zip(groups.grounded, groups.members)]
    return [group is not None and moves[group] for group in groups.group_of]


def moves_nothing(joint: Joint, scene: Scene, groups: RigidGroups) -> bool:
    """Whether forces move neither side of a joint: what scripts move, or what stands."""
    return not any(side is not None and is_dynamic(scene, groups, side) for side in (joint.a, joint.b))


def active_nodes(scene: Scene) -> list[bool]:
    """For each node whether neither it nor an ancestor is suppressed."""
    active: list[bool] = []
    for node in scene.nodes:
        active.append(not node.suppressed and (node.parent is None or active[node.parent]))
    return active


def rigid_groups(scene: Scene, also_fixed: Iterable[tuple[int | None, int | None]] = ()) -> RigidGroups:
    """Group the scene's nodes by fixed joints, inflexible assemblies and the ground.

    also_fixed: further pairs of nodes that are fixed to each other (None: ground), as an analysis finds them; of two on the ground, also
    without it.
    """
    nodes, active = scene.nodes, active_nodes(scene)
    ground = len(nodes)
    together, apart = Partition(ground + 1), Partition(ground + 1)  # apart: as if there were no ground
    frozen = [False] * len(nodes)
    for i, node in enumerate(nodes):
        inherited = node.parent is not None and frozen[node.parent]
        frozen[i] = inherited or (node.kind is NodeKind.ASSEMBLY and not node.flexible)
        if active[i] and inherited and node.parent is not None:
            together.join(node.parent, i)
            apart.join(node.parent, i)
        if active[i] and node.grounded:
            together.join(i, ground)
    fixed = [(j.a, j.b) for j in scene.joints if is_rigid(j) and not is_between_led(j, scene)]
    for a, b in [*fixed, *also_fixed]:
        if (a is None or active[a]) and (b is None or active[b]):
            together.join(ground if a is None else a, ground if b is None else b)
            if a is not None and b is not None:
                apart.join(a, b)

    is_body = [
        active[i] and (node.kind is NodeKind.PART or frozen[i] or node.grounded)
        for i, node in enumerate(nodes)
    ]
    there = {together.find(ground)}
    there.update(together.find(i) for i, own in enumerate(_something(scene)) if own and is_body[i])
    numbers: dict[int, int] = {}
    group_of = tuple(
        numbers.setdefault(group, len(numbers)) if is_body[i] and group in there else None
        for i, group in enumerate(map(together.find, range(len(nodes))))
    )
    members: list[list[int]] = [[] for _ in numbers]
    for i, group in enumerate(group_of):
        if group is not None:
            members[group].append(i)
    grounded = [False] * len(numbers)
    if (group := numbers.get(together.find(ground))) is not None:
        grounded[group] = True
    standing = tuple(
        apart.find(i) if group is not None and grounded[group] else None for i, group in enumerate(group_of)
    )
    return RigidGroups(group_of, tuple(tuple(m) for m in members), tuple(grounded), standing)


def _something(scene: Scene) -> list[bool]:
    """For each node whether it is something by itself: a part, or an assembly that is drawn, weighed, led or joined.

    Others, such as those whose parts are all suppressed, are nothing that could fall.
    """
    joined = {n for joint in scene.joints for n in (joint.a, joint.b)}
    joined.update(feature.node for constraint in scene.constraints for feature in constraint.features)
    return [
        node.kind is NodeKind.PART
        or bool(node.bodies or node.colliders)
        or node.mass is not None
        or node.dynamics.kinematic
        or i in joined
        for i, node in enumerate(scene.nodes)
    ]


def is_between_led(joint: Joint, scene: Scene) -> bool:
    """Whether scripts alone move one side, and the other too, or it stands: such a joint holds nothing, however rigid it is."""
    sides = [scene.nodes[n] for n in (joint.a, joint.b) if n is not None]
    led = any(node.dynamics.kinematic for node in sides)
    return led and all(node.dynamics.kinematic or node.grounded for node in sides)


def is_rigid(joint: Joint) -> bool:
    """Whether a joint leaves no freedom at all and cannot break."""
    locked = joint.kind is JointKind.FIXED or not joint.unlocked
    return locked and joint.break_force == joint.break_torque == float("inf")
