"""Colliders that Unity would push apart at the start: of different bodies, overlapping, and not kept from colliding."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..diagnostics import Report
from ..geometry.contact.depth import Depths, Solid, is_available
from ..geometry.contact.nearness import close_pairs
from ..geometry.primitives import box, sphere
from ..spatial import Array, IntArray, bounds, matrix_from_quaternion
from .scene import BoxCollider, CapsuleCollider, Joint, MeshCollider, Rigidbody, SphereCollider, UnityScene

CONTACT_OFFSET = 0.01
"""Metres: Unity's default, within which touching shapes are held apart softly."""
SHARE = 0.02
"""Of the smaller shape's size: the depth that counts for shapes that are small against the contact offset."""
MOST_PAIRS = 20_000
"""Pairs of close shapes that are looked at."""
MOST_TRIANGLES = 100_000
"""Of a mesh that is not convex; finer ones take minutes to prepare."""

_Collider = BoxCollider | SphereCollider | CapsuleCollider | MeshCollider


@dataclass(frozen=True, slots=True, eq=False)
class _Placed:
    """A collider in the world.  body: index of the object whose Rigidbody moves it, None for a static one."""

    owner: int
    body: int | None
    solid: Solid
    low: Array
    high: Array


def check_overlaps(scene: UnityScene, report: Report) -> None:
    """Tell which pairs of objects overlap, each once with its greatest depth, the deepest first."""
    moved = _bodies(scene)
    dynamic = {
        i
        for i, entry in enumerate(scene.gameObjects)
        for c in entry.components
        if isinstance(c, Rigidbody) and not c.isKinematic
    }
    placed = _placed(scene, moved) if dynamic else []
    joined = _joined(scene, moved)
    free = [
        (first, second)
        for first, second in _close(placed)
        if first.body != second.body
        and dynamic & {first.body, second.body}
        and frozenset((first.body, second.body)) not in joined
    ]
    if not free:
        return
    if not is_available():
        report.add("OVERLAPS_NOT_CHECKED", detail="the Python package coal is not installed")
        return
    if len(free) > MOST_PAIRS:
        report.add("OVERLAPS_NOT_CHECKED", detail=f"more than {MOST_PAIRS} pairs of shapes are close")
    depths, found = Depths(), dict[tuple[int, int], float]()
    fine: set[int] = set()
    for first, second in free[:MOST_PAIRS]:
        if max(len(first.solid.faces), len(second.solid.faces)) > MOST_TRIANGLES:
            fine.add(max(first, second, key=lambda p: len(p.solid.faces)).owner)
            continue
        depth = depths.between(first.solid, second.solid)
        if depth > _tolerated(first, second):
            pair = (first.owner, second.owner)
            found[pair] = max(depth, found.get(pair, 0.0))
    for owner in sorted(fine):
        detail = f"{scene.gameObjects[owner].id} has more than {MOST_TRIANGLES} triangles"
        report.add("OVERLAPS_NOT_CHECKED", detail=detail)
    for (a, b), depth in sorted(found.items(), key=lambda entry: (-round(entry[1], 9), entry[0])):
        ids = (scene.gameObjects[a].id, scene.gameObjects[b].id)
        report.add("COLLIDERS_OVERLAP", a=ids[0], b=ids[1], depth=f"{depth:.3g}")


def _bodies(scene: UnityScene) -> list[int | None]:
    """For each object the one whose Rigidbody moves it."""
    found: list[int | None] = []
    for i, entry in enumerate(scene.gameObjects):
        own = any(isinstance(c, Rigidbody) for c in entry.components)
        found.append(i if own else None if entry.parent is None else found[entry.parent])
    return found


def _joined(scene: UnityScene, moved: list[int | None]) -> set[frozenset[int | None]]:
    """Pairs of Rigidbodies that a joint keeps from colliding; Unity does so for no static collider."""
    return {
        frozenset((moved[i], moved[c.connectedBody]))
        for i, entry in enumerate(scene.gameObjects)
        for c in entry.components
        if isinstance(c, Joint) and c.connectedBody is not None and not c.enableCollision
    }


def _placed(scene: UnityScene, moved: list[int | None]) -> list[_Placed]:
    world: list[tuple[Array, Array]] = []  # linear part and translation of each object
    active: list[bool] = []
    found: list[_Placed] = []
    shapes: dict[int, tuple[Array, IntArray]] = {}  # of meshes, many of which stand in several places
    for i, entry in enumerate(scene.gameObjects):
        t = entry.transform
        linear = matrix_from_quaternion(np.array(t.localRotation)) * np.array(t.localScale)
        position = np.array(t.localPosition)
        above = (np.eye(3), np.zeros(3)) if entry.parent is None else world[entry.parent]
        world.append((above[0] @ linear, above[0] @ position + above[1]))
        active.append(entry.active and (entry.parent is None or active[entry.parent]))
        for component in entry.components:
            if not isinstance(component, _Collider) or not active[i]:
                continue
            if not component.enabled or component.isTrigger or _is_nothing(component):
                continue
            vertices, faces, convex = _shape(scene, component, shapes)
            points = vertices @ world[i][0].T + world[i][1]
            solid = Solid(points, faces, convex)
            found.append(_Placed(i, moved[i], solid, *bounds(points)))
    return found


def _is_nothing(collider: _Collider) -> bool:
    """Whether a shape has no extent at all, as a target will say."""
    if isinstance(collider, MeshCollider):
        return False
    return max(collider.size) <= 0.0 if isinstance(collider, BoxCollider) else collider.radius <= 0.0


def _shape(
    scene: UnityScene, collider: _Collider, shapes: dict[int, tuple[Array, IntArray]]
) -> tuple[Array, IntArray, bool]:
    """Vertices in the object's frame, triangles, and whether the shape is convex.  shapes: gets those of meshes."""
    if isinstance(collider, MeshCollider):
        if collider.mesh not in shapes:
            mesh = scene.meshes[collider.mesh]
            own = (np.asarray(mesh.vertices, np.float64), np.asarray(mesh.triangles, np.int64))
            shapes[collider.mesh] = own
        return *shapes[collider.mesh], collider.convex
    center = np.array(collider.center)
    if isinstance(collider, BoxCollider):
        made = box(collider.size)
        return made.vertices + center, made.faces, True
    made = sphere(collider.radius)
    vertices = made.vertices
    if isinstance(collider, CapsuleCollider):
        axis = np.eye(3)["XYZ".index(str(collider.direction))]
        half = max(0.0, 0.5 * collider.height - collider.radius)
        vertices = vertices + half * np.sign(np.round(vertices @ axis, 12))[:, None] * axis
    return vertices + center, made.faces, True


def _tolerated(first: _Placed, second: _Placed) -> float:
    """The depth, metres, up to which two shapes may stand in each other."""
    size = min(float((p.high - p.low).max()) for p in (first, second))
    return min(CONTACT_OFFSET, SHARE * size)


def _close(placed: list[_Placed]) -> list[tuple[_Placed, _Placed]]:
    """Pairs whose boxes overlap by more than is tolerated."""
    if not placed:
        return []
    near = close_pairs(np.array([p.low for p in placed]), np.array([p.high for p in placed]))
    numbers: list[list[int]] = near.tolist()
    pairs = [(placed[i], placed[j]) for i, j in numbers]
    return [(a, b) for a, b in pairs if _box_depth(a, b) > _tolerated(a, b)]


def _box_depth(first: _Placed, second: _Placed) -> float:
    """Metres that one box must move to be free of the other; what stands in a box moves no further."""
    return float(np.minimum(first.high - second.low, second.high - first.low).min())
