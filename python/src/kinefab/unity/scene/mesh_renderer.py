from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class MeshRenderer:
    """materials: indices into ``UnityScene.materials``, one for each submesh."""

    enabled: bool = True
    materials: tuple[int, ...] = ()
