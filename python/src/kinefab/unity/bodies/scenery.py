"""What of the ground no joint connects to: scenery, with which everything that moves collides."""

from __future__ import annotations

from collections.abc import Iterable

from ...model import NodeKind, Scene
from ...rigid import RigidGroups


def scenery(scene: Scene, groups: RigidGroups) -> list[bool]:
    """For each node whether it stands on the ground and neither a joint nor a constraint ties anything that moves to it.

    Unity lets nothing collide with the whole Rigidbody that a joint connects it to, so that only its own base may be part of that one.
    """
    partners = {groups.standing[node] for node in _named(scene, groups)}
    for i in range(len(scene.nodes) - 1, -1, -1):  # the base's Transform hangs on what stands above it
        above = scene.nodes[i].parent
        if above is not None and groups.standing[i] in partners and groups.standing[i] is not None:
            partners.add(groups.standing[above])
    apart: list[bool] = []
    for own, node in zip(groups.standing, scene.nodes):
        part_of_base = (  # what stands below a part in the tree is built onto it
            node.parent is not None
            and scene.nodes[node.parent].kind is NodeKind.PART
            and groups.is_ground(node.parent)
            and not apart[node.parent]
        )
        apart.append(own is not None and own not in partners and not part_of_base)
    return apart


def tops(scene: Scene, groups: RigidGroups, touched: Iterable[int]) -> list[int]:
    """Of the scenery the nodes with colliders, without those that one of them carries already.

    touched: the nodes whose objects have colliders.
    """
    apart, own = scenery(scene, groups), set(touched)
    carried: list[bool] = []
    found: list[int] = []
    for i, node in enumerate(scene.nodes):
        below = node.parent is not None and carried[node.parent] and apart[i]
        if apart[i] and not below and i in own:
            found.append(i)
        carried.append(below or i in found[-1:])
    return found


def _named(scene: Scene, groups: RigidGroups) -> set[int]:
    """Nodes on the ground that a joint or a constraint ties to something that moves."""
    pairs = [(joint.a, joint.b) for joint in scene.joints]
    pairs += [tuple(f.node for f in c.features) for c in scene.constraints if len(c.features) == 2]
    return {
        node
        for pair in pairs
        if any(node is not None and not groups.is_ground(node) for node in pair)
        for node in pair
        if node is not None and groups.is_ground(node)
    }
