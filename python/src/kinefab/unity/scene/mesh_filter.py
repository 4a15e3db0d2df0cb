from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MeshFilter:
    """mesh: index into ``UnityScene.meshes``."""

    mesh: int
