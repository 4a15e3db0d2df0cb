"""Which pairs of nodes a target is to keep from colliding, and which it is not, whatever groups they are in."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import cast

from ..diagnostics import Report
from ..model import Node, Scene, ignored_groups
from ..rigid import RigidGroups, is_dynamic
from ..unity.bodies.rigidbodies import place_rigidbodies
from ..unity.bodies.standing import bases_of


def ignored_pairs(scene: Scene) -> tuple[list[tuple[int, int]], list[str]]:
    """Pairs of nodes, and in words those of which a side is no node.

    They are ``Scene.apart``; a script's own scene may state them by id too, as ``ignoreCollision`` of its extras.
    """
    stated = scene.extras.get("ignoreCollision")
    of_node = {node.id: i for i, node in enumerate(scene.nodes)}
    found: list[tuple[int, int]] = [(pair.a, pair.b) for pair in scene.apart]
    known = {frozenset(pair) for pair in found}
    unknown: list[str] = []
    for pair in cast("list[object]", stated) if isinstance(stated, list) else []:
        ids = [str(id) for id in cast("list[object]", pair)] if isinstance(pair, list) else []
        numbers = [of_node[id] for id in ids if id in of_node]
        if len(ids) == 2 and len(numbers) == 2:
            if frozenset(numbers) not in known:
                known.add(frozenset(numbers))
                found.append((numbers[0], numbers[1]))
        else:
            unknown.append(" and ".join(ids))
    return found, unknown


def base_pairs(scene: Scene, groups: RigidGroups) -> list[tuple[int, int]]:
    """What moves, with each further part of the base that a joint has it on: the node that carries the one, and the other.

    The part that the joint names, and what stands below that, is the joint's own affair.
    """
    carrier_of = place_rigidbodies(scene, groups).carrier_of
    bases = bases_of(scene, groups)
    parts: dict[int | None, list[int]] = {}
    for i, own in enumerate(bases):
        parts.setdefault(own, []).append(i)
    found: dict[tuple[int, int], None] = {}
    named = {side for joint in scene.joints for side in (joint.a, joint.b)}
    for joint in scene.joints:
        for mover, base in ((joint.a, joint.b), (joint.b, joint.a)):
            if joint.collide or base is None or mover is None or not groups.is_ground(base):
                continue
            own = carrier_of[mover]
            if own is not None and is_dynamic(scene, groups, own):
                others = [part for part in parts[bases[base]] if not _is_below(scene, groups, named, part, base)]
                found |= dict.fromkeys((own, part) for part in others if _touches(scene.nodes[part]))
    return list(found)


def carried_with(scene: Scene, groups: RigidGroups, bases: Sequence[int | None], node: int) -> list[int]:
    """A node and those above it that move with it.  bases: see ``bases_of``."""
    own = groups.group_of[node], bases[node]
    found: list[int] = []
    at: int | None = node
    while at is not None and (groups.group_of[at], bases[at]) == own:
        found.append(at)
        at = scene.nodes[at].parent
    return found


def _touches(node: Node) -> bool:
    """Whether a node may have colliders of its own."""
    if node.colliders is not None:
        return bool(node.colliders)
    return any(body.mesh is not None for body in node.bodies)


def _is_below(scene: Scene, groups: RigidGroups, named: Collection[int | None], node: int, top: int) -> bool:
    """Whether a part is of one body with what stands above it: with nothing between that moves or that joints name."""
    at: int | None = node
    while at is not None and at != top and groups.is_ground(at) and at not in named:
        at = scene.nodes[at].parent
    return at == top


def tell_colliding(scene: Scene, report: Report, target: str) -> None:
    """Tell the pairs that collide in the source though their groups do not: the target's groups have no exception."""
    groups = [{collider.group for collider in node.colliders or ()} for node in scene.nodes]
    for pair in scene.colliding:
        ignored = ignored_groups(groups[pair.a] | groups[pair.b], scene.extras)
        if any(ignored[group] & groups[pair.b] for group in groups[pair.a]):
            told = {"field": "what collides in spite of its groups", "target": target}
            report.dropped(pair.reason, "TARGET_FIELD_DROPPED", pair.where, **told)
