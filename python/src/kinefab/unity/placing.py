"""Where GameObjects stand against those above them, as Unity's Transforms."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..model import Body, Scene
from ..spatial import Pose, quaternion_from_rows
from . import frames
from .scene import ONE, GameObject, Transform, Vector3
from .scene.vectors import vector3, vectors3


def transform_of(local: Pose, scale: Vector3 = ONE) -> Transform:
    """local: in the frame of the object above."""
    placed = frames.pose(local)
    return Transform(vector3(placed.translation), quaternion_from_rows(placed.rotation.tolist()), scale)


def at_home(body: Body) -> bool:
    """Whether a body's mesh lies in its node's own frame."""
    unmoved = not body.pose.translation.any() and bool((body.pose.rotation == np.eye(3)).all())
    return unmoved and body.scale == ONE


def with_all_below(objects: Sequence[GameObject], index: int) -> set[int]:
    """An object and all that stand below it."""
    found = {index}
    for number, entry in enumerate(objects):
        if entry.parent in found:
            found.add(number)
    return found


def local_transforms(scene: Scene, parents: Sequence[int | None]) -> list[Transform]:
    """Of each node against what it stands below, the world's nodes in one stack.  parents: nodes, None for the world."""
    poses = [node.pose for node in scene.nodes]
    rotations = np.array([pose.rotation for pose in poses]).reshape(-1, 3, 3)
    places = np.array([pose.translation for pose in poses]).reshape(-1, 3, 1)
    above = [(i, parent) for i, parent in enumerate(parents) if parent is not None]
    if above:
        below, parents = map(list, zip(*above))
        back = rotations[parents].transpose(0, 2, 1)
        moved = back @ places[below] - back @ places[parents]
        rotations[below], places[below] = back @ rotations[below], moved
    turned = frames.rotation(rotations).tolist()
    return [
        Transform(place, quaternion_from_rows(rows))
        for place, rows in zip(vectors3(frames.point(places[:, :, 0])), turned)
    ]
