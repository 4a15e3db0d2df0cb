"""Colliders where they stand in the world: what of an object's shapes can touch anything, and how far each reaches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...geometry.contact.depth import Solid
from ...geometry.contact.nearness import placed_extents
from ...geometry.primitives import box, sphere
from ...spatial import Array, IntArray, matrices_from_quaternions
from ..scene import BoxCollider, CapsuleCollider, GameObject, MeshCollider, SphereCollider, UnityScene

_Collider = BoxCollider | SphereCollider | CapsuleCollider | MeshCollider
_Shape = tuple[Array, IntArray]
"""Vertices in the object's frame, and triangles."""


@dataclass(slots=True, eq=False)
class PlacedColliders:
    """All that are switched on.  owners: of each its object.  low, high: of each, metres, shape (n, 3)."""

    owners: list[int]
    low: Array
    high: Array
    _convex: list[bool]
    _shapes: list[_Shape]
    _linear: Array
    _positions: Array
    _solids: dict[int, Solid] = field(default_factory=dict[int, Solid])

    def solid(self, number: int) -> Solid:
        """One of them, as a shape in the world; the same object each time."""
        if number not in self._solids:
            (vertices, faces), owner = self._shapes[number], self.owners[number]
            points = vertices @ self._linear[owner].T + self._positions[owner]
            self._solids[number] = Solid(points, faces, self._convex[number])
        return self._solids[number]

    def triangles(self, number: int) -> int:
        return len(self._shapes[number][1])


def placed_colliders(scene: UnityScene) -> PlacedColliders:
    """Those of a scene, in the order of its objects and their components."""
    linear, positions = _in_world(scene.gameObjects)
    active: list[bool] = []
    owners: list[int] = []
    convex: list[bool] = []
    alike: dict[int | _Collider, list[int]] = {}  # one shape stands in many places
    for i, entry in enumerate(scene.gameObjects):
        active.append(entry.active and (entry.parent is None or active[entry.parent]))
        for component in entry.components if active[i] else ():
            if not isinstance(component, _Collider) or not component.enabled or component.isTrigger:
                continue
            if not _is_nothing(component):
                is_mesh = isinstance(component, MeshCollider)
                alike.setdefault(component.mesh if is_mesh else component, []).append(len(owners))
                owners.append(i)
                convex.append(component.convex if is_mesh else True)
    low, high = np.empty((len(owners), 3)), np.empty((len(owners), 3))
    shapes: list[_Shape] = [(np.zeros((0, 3)), np.zeros((0, 3), dtype=np.int64))] * len(owners)
    for key, members in alike.items():
        shape = _shape(scene, key)
        at = [owners[k] for k in members]
        low[members], high[members] = placed_extents(shape[0], linear[at], positions[at], np.eye(3))
        for k in members:
            shapes[k] = shape
    return PlacedColliders(owners, low, high, convex, shapes, linear, positions)


def _in_world(objects: Sequence[GameObject]) -> tuple[Array, Array]:
    """Linear part and translation of each object, shapes (n, 3, 3) and (n, 3)."""
    transforms = [entry.transform for entry in objects]
    turns, scales, positions = (
        np.array([getattr(t, name) for t in transforms], dtype=np.float64)
        for name in ("localRotation", "localScale", "localPosition")
    )
    linear = matrices_from_quaternions(turns) * scales[:, None, :]
    levels: list[tuple[list[int], list[int]]] = []  # below the roots, each with the objects above
    depth: list[int] = []
    for i, entry in enumerate(objects):
        if entry.parent is None:
            depth.append(0)
            continue
        depth.append(depth[entry.parent] + 1)
        if depth[i] > len(levels):
            levels.append(([], []))
        own, above = levels[depth[i] - 1]
        own.append(i)
        above.append(entry.parent)
    for level, above in levels:
        positions[level] = (linear[above] @ positions[level][:, :, None])[:, :, 0] + positions[above]
        linear[level] = linear[above] @ linear[level]
    return linear, positions


def _is_nothing(collider: _Collider) -> bool:
    """Whether a shape has no extent at all, as a target will say."""
    if isinstance(collider, MeshCollider):
        return False
    return max(collider.size) <= 0.0 if isinstance(collider, BoxCollider) else collider.radius <= 0.0


def _shape(scene: UnityScene, shape: int | _Collider) -> _Shape:
    """shape: a mesh of the scene, or a collider that is none."""
    if isinstance(shape, int):
        mesh = scene.meshes[shape]
        return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.triangles, np.int64)
    assert not isinstance(shape, MeshCollider)
    center = np.array(shape.center)
    if isinstance(shape, BoxCollider):
        made = box(shape.size)
        return made.vertices + center, made.faces
    made = sphere(shape.radius)
    vertices = made.vertices
    if isinstance(shape, CapsuleCollider):
        axis = np.eye(3)["XYZ".index(str(shape.direction))]
        half = max(0.0, 0.5 * shape.height - shape.radius)
        vertices = vertices + half * np.sign(np.round(vertices @ axis, 12))[:, None] * axis
    return vertices + center, made.faces
