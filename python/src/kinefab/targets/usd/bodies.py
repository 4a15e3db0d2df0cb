"""Which nodes are rigid bodies of the stage, and below which prim each node stands.

UsdPhysics wants no body within a body: what moves by itself, or stands still below something that moves, is taken out of
the body above it.  A grounded part that a joint names is a body too, fixed to the world, so that a robot's base is a link.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...model import Joint, Scene
from ...rigid import RigidGroups, is_dynamic, is_kinematic
from ...unity.bodies.rigidbodies import Rigidbodies, place_rigidbodies


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """moving: what forces or scripts move, with its members.  grounded: nodes of the ground that are bodies, the first of
    them the base.  holder: for each node the node below whose prim its own stands, None for the top.
    inside: for each node the body that its prim is part of, None for none.
    """

    scene: Scene
    groups: RigidGroups
    moving: Rigidbodies
    grounded: tuple[int, ...]
    holder: tuple[int | None, ...]
    inside: tuple[int | None, ...]

    @property
    def base(self) -> int | None:
        """The body of the ground that hangs on the world, as all others of the ground hang on it."""
        return self.grounded[0] if self.grounded else None

    def carrier(self, node: int | None) -> int | None:
        """The body that a joint's side belongs to; None for the world."""
        if node is None:
            return None
        return self.inside[node] if self.groups.is_ground(node) else self.moving.carrier_of[node]

    def stand_in(self, coupled: bool) -> int | None:
        """The body that a joint hangs on whose side is the world itself: a single base where couplings count by the joint, as engines
        couple within one articulation.  It stays scenery to that joint: the two collide.  None for the world."""
        return self.base if coupled and len(self.grounded) == 1 else None

    def dynamic(self, node: int) -> bool:
        """Whether forces move a node's body; also of an assembly that only carries what moves."""
        members = self.moving.carriers.get(node)
        if members is not None:
            return not is_kinematic(self.scene, members)
        return is_dynamic(self.scene, self.groups, node)

    def taken_out(self, node: int) -> bool:
        """Whether a node stands beside the body that is above it in the source."""
        return self.holder[node] != self.scene.nodes[node].parent


def find_bodies(scene: Scene, groups: RigidGroups, joints: list[Joint]) -> Bodies:
    """joints: those that are written."""
    moving = place_rigidbodies(scene, groups)
    named = {n for joint in joints for n in (joint.a, joint.b) if n is not None and groups.is_ground(n)}
    partners = {groups.standing[n] for n in named}
    count = len(scene.nodes)
    holder: list[int | None] = [None] * count
    inside: list[int | None] = [None] * count
    grounded: dict[int, None] = {}
    for i, node in enumerate(scene.nodes):
        own = i if i in moving.carriers else moving.carrier_of[i]
        parent = node.parent
        still = own is None and groups.group_of[i] is not None
        above = None if parent is None else inside[parent]
        another = groups.standing[i] in partners and (above is None or groups.standing[i] != groups.standing[above])
        if still and above in grounded and not another:
            own = above  # a part of what the ground holds
        elif i in named:
            grounded[i] = None
            own = i
        while parent is not None and inside[parent] is not None and (inside[parent] != own or own == i):
            parent = holder[parent]
        holder[i] = parent
        inside[i] = own if own == i else (None if parent is None else inside[parent])
    return Bodies(scene, groups, moving, tuple(grounded), tuple(holder), tuple(inside))
