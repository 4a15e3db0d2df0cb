"""Bodies that something which they collide with comes near: in their hollows it may stand."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...model import Collider, ColliderKind, Mesh, Scene
from ...options import Ground
from ...rigid import RigidGroups
from ...spatial import Array, Pose
from .nearness import close_pairs, extents

_GROUND = -1
_CORNERS: Array = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)


def meshes_near_others(
    scene: Scene, groups: RigidGroups, ground: Ground, hulls: Mapping[int, Mesh]
) -> frozenset[int]:
    """The meshes of which a body is near a shape that it may collide with, at the exported pose.

    A joint keeps its two groups from colliding, unless it lets them; the ground only where it is a body.
    hulls: by mesh, what stands for it.
    """
    owners: list[int] = []
    meshes: list[int | None] = []
    low: list[Array] = []
    high: list[Array] = []
    for i, node in enumerate(scene.nodes):
        group = groups.group_of[i]
        if group is None:
            continue
        owner = _GROUND if groups.grounded[group] else group
        shapes: list[tuple[int | None, Array]] = []
        if node.colliders is None:
            for body in node.bodies:
                if body.mesh is not None:
                    points = hulls.get(body.mesh, scene.meshes[body.mesh]).vertices * body.scale
                    shapes.append((body.mesh, body.pose.point(points)))
        for collider in node.colliders or ():
            shapes.append((None, _corners(collider, scene)))
        for mesh, points in shapes:
            lowest, highest = extents(node.pose.point(points))
            owners.append(owner)
            meshes.append(mesh)
            low.append(lowest)
            high.append(highest)
    if not owners:
        return frozenset()
    joined = [
        {_owner(groups, joint.a), _owner(groups, joint.b)} for joint in scene.joints if not joint.collide
    ]
    apart = {frozenset(pair) for pair in joined if ground is Ground.BODY or _GROUND not in pair}
    found: set[int | None] = set()
    pairs: list[list[int]] = close_pairs(np.array(low), np.array(high)).tolist()
    for a, b in pairs:
        if owners[a] != owners[b] and frozenset((owners[a], owners[b])) not in apart:
            found |= {meshes[a], meshes[b]}
    return frozenset(mesh for mesh in found if mesh is not None)


def _owner(groups: RigidGroups, node: int | None) -> int | None:
    return _GROUND if groups.is_ground(node) or node is None else groups.group_of[node]


def _corners(collider: Collider, scene: Scene) -> Array:
    """Of a box about a collider that the source states, in its node's frame, shape (8, 3)."""
    if collider.mesh is not None:
        vertices = scene.meshes[collider.mesh].vertices * collider.scale
        low, high = vertices.min(axis=0), vertices.max(axis=0)
        return _placed(collider.pose, 0.5 * (low + high), 0.5 * (high - low))
    half = np.array(collider.size) * 0.5 if collider.kind is ColliderKind.BOX else np.full(3, collider.radius)
    if collider.kind in (ColliderKind.CAPSULE, ColliderKind.CYLINDER):
        half = half + [0.0, 0.0, 0.5 * collider.length]
    return _placed(collider.pose, np.zeros(3), half)


def _placed(pose: Pose, middle: Array, half: Array) -> Array:
    return pose.point(middle + _CORNERS * half)
