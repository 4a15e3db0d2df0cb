from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True, slots=True)
class Collider:
    """What all colliders have.  material: index into ``UnityScene.physicsMaterials``, None for Unity's default.
    group: the source's collision group or layer, "" for none.  id: what the source calls it among those of its object."""

    isTrigger: bool = False
    enabled: bool = True
    material: int | None = None
    group: str = ""
    id: str = ""
    extras: Mapping[str, object] = field(default_factory=dict[str, object], compare=False, hash=False)


CHOSEN = "chosen"
"""Of the extras of a collider that the source does not state: the word of the choice by which it was made of the body's mesh."""
