"""What stands on the ground: bases, which joints tie something to, and scenery, with which everything that moves collides."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from ...model import NodeKind, Scene
from ...rigid import RigidGroups


@dataclass(frozen=True, slots=True)
class Standing:
    """holder: for each node the node whose own kinematic Rigidbody holds it on the ground; None for what moves, and for what the
    Rigidbody of the ground itself holds.
    bases: for each node that a joint ties to something that moves, the holders of all that is rigid with it other than by the ground.
    """

    holder: tuple[int | None, ...]
    bases: dict[int, tuple[int | None, ...]]


def find_standing(
    scene: Scene, groups: RigidGroups, parents: Sequence[int | None], touched: Collection[int]
) -> Standing:
    """Unity lets nothing collide with the whole Rigidbody that a joint connects it to, so each holds one base alone.

    One base is the ground's own: the largest that stands on nothing else, where nothing is joined to the world itself.
    parents: what each node's object stands below.  touched: the nodes that have colliders.
    """
    named, to_world = _named(scene, groups)
    partners = {groups.standing[node] for node in named}
    kept = set[int | None]() if to_world else _kept(groups, parents, partners)
    kept_nodes = [base is not None and base in kept for base in bases_of(scene, groups)]
    holder: list[int | None] = []
    for i, (own, node) in enumerate(zip(groups.standing, scene.nodes)):
        carried = None if node.parent is None else holder[node.parent]
        if own is None or kept_nodes[i] or not (named or to_world):
            holder.append(None)
        elif carried is not None and (own not in partners or own == groups.standing[carried]):
            holder.append(carried)
        else:
            holder.append(i if i in touched or i in named else None)
    held: dict[int | None, dict[int | None, None]] = {}
    for i, own in enumerate(groups.standing):
        if own in partners and (holder[i] is not None or kept_nodes[i]):
            held.setdefault(own, {})[holder[i]] = None
    return Standing(tuple(holder), {node: tuple(held[groups.standing[node]]) for node in named})


def bases_of(scene: Scene, groups: RigidGroups) -> list[int | None]:
    """For each node that stands what it is a part of, as the lowest node of that: what is rigid with it other than by the ground, and,
    unless a joint names that, the part below which it stands in the tree: it is built onto that."""
    partners = {groups.standing[node] for node in _named(scene, groups)[0]}
    found: list[int | None] = []
    for own, node in zip(groups.standing, scene.nodes):
        above = node.parent
        if own is not None and own not in partners and above is not None and scene.nodes[above].kind is NodeKind.PART:
            found.append(own if found[above] is None else found[above])
        else:
            found.append(own)
    return found


def _named(scene: Scene, groups: RigidGroups) -> tuple[set[int], bool]:
    """Nodes on the ground that joints tie to something that moves, or that it passes through, and whether one ties such a thing to the
    world itself."""
    found, to_world = set[int](), False
    for pair in scene.apart:
        found |= {own for own, other in ((pair.a, pair.b), (pair.b, pair.a)) if groups.is_ground(own) and not groups.is_ground(other)}
    for joint in scene.joints:
        for own, other in ((joint.a, joint.b), (joint.b, joint.a)):
            if groups.is_ground(own) and not groups.is_ground(other):
                to_world |= own is None
                found |= set() if own is None else {own}
    return found, to_world


def _kept(
    groups: RigidGroups, parents: Sequence[int | None], partners: Collection[int | None]
) -> set[int | None]:
    """The base that the ground holds, by what it is rigid with; none where all stand on something else that would then be part of it."""
    size: dict[int | None, int] = {}
    on_others: set[int | None] = set()
    for own, parent in zip(groups.standing, parents):
        size[own] = size.get(own, 0) + 1
        above = None if parent is None else groups.standing[parent]
        if above is not None and above != own:
            on_others.add(own)
    alone = [own for own in partners if own not in on_others]
    largest = min(alone, key=lambda own: (-size[own], -1 if own is None else own), default=None)
    return set() if largest is None else {largest}
