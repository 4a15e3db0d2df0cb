from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Collider:
    """What all colliders have.  material: index into ``UnityScene.physicsMaterials``, None for Unity's default.
    group: the source's collision group or layer, "" for none.  id: what the source calls it among those of its object."""

    isTrigger: bool = False
    enabled: bool = True
    material: int | None = None
    group: str = ""
    id: str = ""
