"""Bodies that something which they collide with comes near: in their hollows it may stand."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ...model import Collider, ColliderKind, Mesh, Scene
from ...options import Ground
from ...rigid import RigidGroups
from ...spatial import Array, Pose
from .nearness import DIRECTIONS, close_pairs, extents, placed_extents

_GROUND = -1
_CORNERS: Array = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)


def meshes_near_others(
    scene: Scene, groups: RigidGroups, ground: Ground, hulls: Mapping[int, Mesh]
) -> frozenset[int]:
    """The meshes of which a body is near a shape that it may collide with, at the exported pose.

    A joint keeps its two groups from colliding, unless it lets them; the ground only where it is a body.
    hulls: by mesh, what stands for it.
    """
    shapes = _Shapes()
    for i, node in enumerate(scene.nodes):
        group = groups.group_of[i]
        if group is None:
            continue
        owner = _GROUND if groups.grounded[group] else group
        if node.colliders is None:
            for body in node.bodies:
                if body.mesh is not None:
                    shapes.add_mesh(owner, body.mesh, node.pose @ body.pose, body.scale)
        for collider in node.colliders or ():
            if collider.mesh is not None:
                shapes.add_mesh(owner, collider.mesh, node.pose @ collider.pose, collider.scale)
            else:
                shapes.add_points(owner, node.pose.point(_corners(collider)))
    low, high = shapes.extents({m: hulls.get(m, scene.meshes[m]).vertices for m in shapes.placed})
    owners, meshes = shapes.owners, shapes.meshes
    joined = [
        {_owner(groups, joint.a), _owner(groups, joint.b)} for joint in scene.joints if not joint.collide
    ]
    apart = {frozenset(pair) for pair in joined if ground is Ground.BODY or _GROUND not in pair}
    found: set[int | None] = set()
    pairs: list[list[int]] = close_pairs(low, high).tolist()
    for a, b in pairs:
        if owners[a] != owners[b] and frozenset((owners[a], owners[b])) not in apart:
            found |= {meshes[a], meshes[b]}
    return frozenset(mesh for mesh in found if mesh is not None)


class _Shapes:
    """What stands in the world.  owners: of each shape who moves it.  meshes: of each its mesh, None of a shape without one.
    placed: by mesh the shapes that are made of it, each with what takes the mesh into the world."""

    def __init__(self) -> None:
        self.owners: list[int] = []
        self.meshes: list[int | None] = []
        self.placed: dict[int, list[tuple[int, Array, Array]]] = {}
        self._points: list[tuple[int, Array]] = []

    def add_mesh(self, owner: int, mesh: int, stands: Pose, scale: tuple[float, float, float]) -> None:
        place = (len(self.owners), stands.rotation * scale, stands.translation)
        self.placed.setdefault(mesh, []).append(place)
        self.owners.append(owner)
        self.meshes.append(mesh)

    def add_points(self, owner: int, points: Array) -> None:
        self._points.append((len(self.owners), points))
        self.owners.append(owner)
        self.meshes.append(None)

    def extents(self, vertices: Mapping[int, Array]) -> tuple[Array, Array]:
        """Of every shape, each of shape (n, 13).  vertices: of each mesh that is placed."""
        low, high = (np.empty((len(self.owners), len(DIRECTIONS))) for _ in range(2))
        for mesh, places in self.placed.items():
            numbers, linear, translations = zip(*places)
            at = list(numbers)
            low[at], high[at] = placed_extents(vertices[mesh], np.array(linear), np.array(translations))
        for number, points in self._points:
            low[number], high[number] = extents(points)
        return low, high


def _owner(groups: RigidGroups, node: int | None) -> int | None:
    return _GROUND if groups.is_ground(node) or node is None else groups.group_of[node]


def _corners(collider: Collider) -> Array:
    """Of a box about a collider without mesh, in its node's frame, shape (8, 3)."""
    half = np.array(collider.size) * 0.5 if collider.kind is ColliderKind.BOX else np.full(3, collider.radius)
    if collider.kind in (ColliderKind.CAPSULE, ColliderKind.CYLINDER):
        half = half + [0.0, 0.0, 0.5 * collider.length]
    return collider.pose.point(_CORNERS * half)
