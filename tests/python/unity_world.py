"""Where the objects of a scene stand in Unity's world."""

from __future__ import annotations

import numpy as np
from kinefab.spatial import matrix_from_quaternion
from kinefab.unity.scene import UnityScene


def world_of(scene: UnityScene) -> list[tuple[np.ndarray, np.ndarray]]:
    """Of each object the map of its own points: a matrix, shape (3, 3), scales in it, and a place, shape (3,)."""
    found: list[tuple[np.ndarray, np.ndarray]] = []
    for entry in scene.gameObjects:
        t = entry.transform
        own = matrix_from_quaternion(np.array(t.localRotation)) * np.array(t.localScale)
        linear, place = (np.eye(3), np.zeros(3)) if entry.parent is None else found[entry.parent]
        found.append((linear @ own, linear @ np.array(t.localPosition) + place))
    return found
