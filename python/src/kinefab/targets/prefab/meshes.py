"""What is asked of a scene's meshes before they are written: without mapping one for it, where the scene can tell."""

from __future__ import annotations

from collections.abc import Sequence

from ...unity.assets.meshes import MappedMeshes
from ...unity.scene import Mesh


def mesh_origin(meshes: Sequence[Mesh], index: int) -> str:
    """What it is in the source, whoever uses it; "" where nobody says."""
    return meshes.origin(index) if isinstance(meshes, MappedMeshes) else ""


def is_colored(meshes: Sequence[Mesh], index: int) -> bool:
    """Whether its vertices have colours."""
    if isinstance(meshes, MappedMeshes):
        return meshes.is_colored(index)
    return meshes[index].colors is not None
