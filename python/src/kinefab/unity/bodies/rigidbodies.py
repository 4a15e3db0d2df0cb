"""Which GameObjects get a Rigidbody: one for each rigid group, on the node that holds just this group."""

from __future__ import annotations

import heapq
from dataclasses import dataclass

import numpy as np

from ...diagnostics import Report
from ...geometry.mass import combined, moved, principal
from ...model import Dynamics, MassProperties, Node, NodeKind, Scene
from ...rigid import RigidGroups, is_kinematic
from ...spatial import quaternion_from_matrix
from .. import frames
from ..scene import Rigidbody
from ..scene.vectors import quaternion4, vector3

UNITY_ANGULAR_DAMPING = 0.05
"""1/s: a Rigidbody's before anyone sets it."""
UNITY_DEFAULT = MassProperties(1.0, np.zeros(3), np.eye(3))
"""A Rigidbody's mass and inertia before anyone sets them: 1 kg and 1 kg m^2."""


@dataclass(frozen=True, slots=True, eq=False)
class Rigidbodies:
    """carrier_of: for each node the node whose Rigidbody moves it, or None (ground, or no body).
    carriers: every node that gets a Rigidbody, with the nodes it moves, in scene order.
    fixed: pairs (own, connected) of carriers that a FixedJoint holds together.
    """

    carrier_of: tuple[int | None, ...]
    carriers: dict[int, tuple[int, ...]]
    fixed: tuple[tuple[int, int], ...]


def place_rigidbodies(scene: Scene, groups: RigidGroups) -> Rigidbodies:
    """One Rigidbody at the node whose subtree is exactly the group; else one for each member that has mass,
    and FixedJoints to the first of them."""
    carrier_of: list[int | None] = [None] * len(scene.nodes)
    carriers: dict[int, tuple[int, ...]] = {}
    fixed: list[tuple[int, int]] = []
    subtree = _subtree_bodies(scene, groups)
    for group, members in enumerate(groups.members):
        if groups.grounded[group]:
            continue
        parts = [i for i in members if scene.nodes[i].kind is NodeKind.PART] or list(members)
        top = _common_ancestor(scene, members)
        if top is not None and subtree[top] != len(members):
            top = None
        if len(parts) == 1 and (top is None or len(members) == 1):
            top = parts[0]
        if top is not None:
            carriers[top] = members
            for i in members:
                carrier_of[i] = top
            continue
        for i in parts:
            carriers[i] = (i,)
            carrier_of[i] = i
            if i != parts[0]:
                fixed.append((i, parts[0]))
        for i in members:
            if carrier_of[i] is None:
                carrier_of[i] = parts[0]
    return Rigidbodies(tuple(carrier_of), dict(sorted(carriers.items())), tuple(fixed))


def held_below(scene: Scene, groups: RigidGroups, placed: Rigidbodies) -> list[int]:
    """Grounded nodes in the tree below a moving body, which would move with it, without those that stand below one of them."""
    found: list[int] = []
    moved: list[bool] = []
    for i, node in enumerate(scene.nodes):
        below = node.parent is not None and moved[node.parent]
        held = below and groups.is_ground(i)
        if held:
            found.append(i)
        moved.append(i in placed.carriers or (below and not held))
    return found


def parents_beside(scene: Scene, groups: RigidGroups, placed: Rigidbodies) -> list[int | None]:
    """What each node stands below: a grounded one below a moving body is carried along with that body's Transform, so it stands
    below the first node above all bodies that its parent is in.  One that a clip moves stays, as its track counts from its parent."""
    parents = [node.parent for node in scene.nodes]
    animated = {track.node for clip in scene.animations for track in clip.tracks}
    for held in held_below(scene, groups, placed):
        if held in animated:
            continue
        above = parents[held]
        node = above
        while node is not None:
            if node in placed.carriers:
                above = scene.nodes[node].parent
            node = scene.nodes[node].parent
        parents[held] = above
    return parents


def carried_along(
    scene: Scene, placed: Rigidbodies, parents: list[int | None]
) -> tuple[list[int | None], list[int]]:
    """What each node stands below, where what is welded to a body that scripts or clips move stands below that one and goes with it;
    and the nodes for which that cannot be, as they stand before it in the scene or above it.

    Unity moves kinematic bodies by their Transforms alone, whatever joint holds them together.
    """
    parents, left = list(parents), list[int]()
    animated = {track.node for clip in scene.animations for track in clip.tracks}
    groups: dict[int, list[int]] = {}
    for own, connected in placed.fixed:
        groups.setdefault(connected, [connected]).append(own)
    for members in groups.values():
        led = [i for i in members if any(scene.nodes[n].dynamics.kinematic for n in placed.carriers[i])]
        if not led:
            continue
        leader = next((i for i in led if i in animated), led[0])
        for own in members:
            if own in led or own in animated:
                continue
            if own < leader:
                left.append(own)
            else:
                parents[own] = leader
    return parents, left


def body_mass(scene: Scene, carrier: int, moved_nodes: tuple[int, ...], report: Report) -> MassProperties:
    """Of everything a carrier moves, in the carrier's frame."""
    own = scene.nodes[carrier]
    if own.mass is not None and (own.kind is NodeKind.ASSEMBLY or moved_nodes == (carrier,)):
        known = [own.mass]
    else:
        to_carrier = own.pose.inverse()
        counted, weightless = _weighed(scene, moved_nodes)
        known = [moved(mass, to_carrier @ node.pose) for node, mass in counted]
        for node in weightless if known else ():
            report.add("MASS_LEFT_OUT", node.where, node=node.id, carrier=own.id)
    if not known:
        report.approximated(f"mass {own.id}", "MASS_UNKNOWN", own.where, node=own.id)
    return combined(known) if known else UNITY_DEFAULT


def map_rigidbody(scene: Scene, carrier: int, moved_nodes: tuple[int, ...], report: Report) -> Rigidbody:
    """Mass, centre of mass and principal inertia of everything a carrier moves, in the carrier's frame."""
    own, total = scene.nodes[carrier], body_mass(scene, carrier, moved_nodes, report)
    moments, axes = principal(total.inertia)
    dynamics = body_dynamics(scene, carrier, moved_nodes)
    if dynamics.velocity is not None or dynamics.angular_velocity is not None:
        report.dropped(f"velocity {own.id}", "BODY_VELOCITY_DROPPED", own.where, node=own.id)
    damping = (dynamics.linear_damping, dynamics.angular_damping)
    return Rigidbody(
        mass=total.mass,
        linearDamping=0.0 if damping[0] is None else damping[0],
        angularDamping=UNITY_ANGULAR_DAMPING if damping[1] is None else damping[1],
        centerOfMass=vector3(frames.point(total.center)),
        inertiaTensor=vector3(moments),
        inertiaTensorRotation=quaternion4(frames.quaternion(quaternion_from_matrix(axes))),
        useGravity=dynamics.gravity,
        isKinematic=dynamics.kinematic,
        maxAngularVelocity=dynamics.max_angular_velocity,
    )


def body_dynamics(scene: Scene, carrier: int, moved_nodes: tuple[int, ...]) -> Dynamics:
    """What the body's nodes say of how it moves: the carrier first, then whoever says something."""
    if moved_nodes == (carrier,):
        return scene.nodes[carrier].dynamics
    stated = [scene.nodes[i].dynamics for i in (carrier, *moved_nodes)]

    def first(name: str):
        return next((value for d in stated if (value := getattr(d, name)) is not None), None)

    return Dynamics(
        kinematic=is_kinematic(scene, moved_nodes),
        gravity=all(d.gravity for d in stated),
        linear_damping=first("linear_damping"),
        angular_damping=first("angular_damping"),
        velocity=first("velocity"),
        angular_velocity=first("angular_velocity"),
        max_angular_velocity=first("max_angular_velocity"),
    )


def _weighed(scene: Scene, indices: tuple[int, ...]) -> tuple[list[tuple[Node, MassProperties]], list[Node]]:
    """Of some nodes those whose masses add up, each with its own, and the parts that have none.

    What stands below an assembly with a mass of its own is in neither: its mass is already that assembly's.
    """
    whole = {
        i for i in indices if scene.nodes[i].kind is NodeKind.ASSEMBLY and scene.nodes[i].mass is not None
    }
    below = _below(scene, indices, whole) if whole else set[int]()
    outer = [scene.nodes[i] for i in indices if i not in below]
    weightless = [node for node in outer if node.mass is None and node.kind is NodeKind.PART]
    return [(node, node.mass) for node in outer if node.mass is not None], weightless


def _subtree_bodies(scene: Scene, groups: RigidGroups) -> list[int]:
    """For each node how many bodies its subtree holds, itself included."""
    counts = [0 if group is None else 1 for group in groups.group_of]
    for i in range(len(scene.nodes) - 1, -1, -1):
        parent = scene.nodes[i].parent
        if parent is not None:
            counts[parent] += counts[i]
    return counts


def _common_ancestor(scene: Scene, members: tuple[int, ...]) -> int | None:
    """The deepest node whose subtree holds all members; a member counts as its own ancestor."""
    # A heap; parents stand before their children, so the last node climbs.
    waiting = sorted(-i for i in members)
    seen = set(members)
    while len(seen) > 1:
        node = -heapq.heappop(waiting)
        seen.remove(node)
        parent = scene.nodes[node].parent
        if parent is None:
            return None
        if parent not in seen:
            seen.add(parent)
            heapq.heappush(waiting, -parent)
    return seen.pop()


def _below(scene: Scene, nodes: tuple[int, ...], tops: set[int]) -> set[int]:
    """Those of the nodes, and of their ancestors, that stand below one of ``tops``."""
    first, below, above = min(tops), set[int](), set[int]()
    for node in nodes:
        line: list[int] = []
        at: int | None = node
        while at is not None and at > first and at not in below and at not in above:
            line.append(at)
            at = scene.nodes[at].parent
            if at in tops:
                break
        (below if at in tops or at in below else above).update(line)
    return below
