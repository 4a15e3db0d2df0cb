"""Meshes mirrored into Unity's frame, each when it is asked for."""

from __future__ import annotations

from collections.abc import Sequence
from typing import overload

import numpy as np

from ... import model
from .. import frames
from ..scene import Mesh


def map_mesh(mesh: model.Mesh) -> Mesh:
    """One mesh, float32, clockwise from outside."""
    tangents = mesh.tangents
    if tangents is not None:
        tangents = np.column_stack([frames.direction(tangents[:, :3]), frames.handedness(tangents[:, 3])])
    return Mesh(
        mesh.name,
        frames.point(mesh.vertices).astype(np.float32),
        frames.winding(mesh.faces),
        None if mesh.normals is None else frames.direction(mesh.normals).astype(np.float32),
        tuple(np.asarray(uv, dtype=np.float32) for uv in mesh.uvs),
        None if tangents is None else tangents.astype(np.float32),
        None if mesh.colors is None else np.asarray(mesh.colors, dtype=np.float32),
        mesh.face_counts or (len(mesh.faces),),
    )


def unmapped_mesh(mesh: Mesh) -> model.Mesh:
    """The way back of ``map_mesh``."""
    tangents = mesh.tangents
    if tangents is not None:
        tangents = np.column_stack([frames.direction(tangents[:, :3]), frames.handedness(tangents[:, 3])])
    return model.Mesh(
        mesh.name,
        frames.point(mesh.vertices),
        frames.winding(mesh.triangles).astype(np.int64),
        None if mesh.normals is None else frames.direction(mesh.normals),
        tuple(np.asarray(uv, dtype=np.float64) for uv in mesh.uvs),
        tangents,
        None if mesh.colors is None else np.asarray(mesh.colors, dtype=np.float64),
        face_counts=mesh.submeshes,
    )


class MappedMeshes(Sequence[Mesh]):
    """The model's meshes, mapped one by one: a scene of gigabytes is not there twice."""

    def __init__(self, meshes: Sequence[model.Mesh]):
        self._meshes = meshes

    def __len__(self) -> int:
        return len(self._meshes)

    @overload
    def __getitem__(self, index: int) -> Mesh: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Mesh]: ...
    def __getitem__(self, index: int | slice) -> Mesh | Sequence[Mesh]:
        if isinstance(index, slice):
            return MappedMeshes(self._meshes[index])
        return map_mesh(self._meshes[index])

    def name(self, index: int) -> str:
        """Without mapping it."""
        return self._meshes[index].name

    def origin(self, index: int) -> str:
        """What it is in the source; without mapping it."""
        return self._meshes[index].origin

    def is_colored(self, index: int) -> bool:
        """Whether its vertices have colours; without mapping it."""
        return self._meshes[index].colors is not None

    def with_behind(self, meshes: Sequence[model.Mesh]) -> MappedMeshes:
        return MappedMeshes([*self._meshes, *meshes])


def with_meshes_behind(own: Sequence[Mesh], made: Sequence[model.Mesh]) -> Sequence[Mesh]:
    """Meshes of a scene, and others behind them."""
    return own.with_behind(made) if isinstance(own, MappedMeshes) else [*own, *map(map_mesh, made)]


def mesh_name(meshes: Sequence[Mesh], index: int) -> str:
    """Without mapping it, where the scene can tell."""
    return meshes.name(index) if isinstance(meshes, MappedMeshes) else meshes[index].name
