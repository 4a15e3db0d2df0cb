"""A written scene in Unity's own terms, as whatever wrote it had them: a target that writes these gives the same again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, cast, overload

import numpy as np

from ...diagnostics import Report
from ..definitions import UV_SETS, Noun
from ..scene import (
    AnimationClip,
    Component,
    Constraint,
    Coupling,
    CouplingTerm,
    GameObject,
    IgnoredCollision,
    JointCoordinate,
    Mesh,
    Mobility,
    Physics,
    PhysicsMaterial,
    Source,
    Transform,
    UnityScene,
)
from .looks import material
from .nouns import COMPONENTS, component, noun, tell, told
from .terms import terms_of

Entry = Mapping[str, Any]
_WIDTHS = {"uint16": "<u2", "uint32": "<u4"}


class WrittenMeshes(Sequence[Mesh]):
    """The meshes of a scene file, each made when it is asked for; their numbers stay in the buffers."""

    def __init__(self, entries: Sequence[Entry], buffers: Sequence[bytes]):
        self._entries, self._buffers = entries, buffers

    def __len__(self) -> int:
        return len(self._entries)

    @overload
    def __getitem__(self, index: int) -> Mesh: ...
    @overload
    def __getitem__(self, index: slice) -> Sequence[Mesh]: ...
    def __getitem__(self, index: int | slice) -> Mesh | Sequence[Mesh]:
        if isinstance(index, slice):
            return WrittenMeshes(self._entries[index], self._buffers)
        return _mesh(self._entries[index], self._buffers)


def _mesh(entry: Entry, buffers: Sequence[bytes]) -> Mesh:
    count = int(entry["vertexCount"])
    submeshes = tuple(int(part["indexCount"]) // 3 for part in entry["submeshes"])
    indices = _values(entry["indices"], buffers, _WIDTHS[entry["indexFormat"]], 3 * sum(submeshes))

    def floats(name: str, width: int) -> Any:
        place = entry.get(name)
        return None if place is None else _values(place, buffers, "<f4", width * count).reshape(-1, width)

    # Unity reads zeros from a set that is not there; those behind it keep their numbers.
    uvs = [floats(name, 2) for name in UV_SETS]
    while uvs and uvs[-1] is None:
        uvs.pop()
    return Mesh(
        str(entry["name"]),
        floats("positions", 3),
        indices.reshape(-1, 3),
        floats("normals", 3),
        tuple(np.zeros((count, 2), "<f4") if uv is None else uv for uv in uvs),
        floats("tangents", 4),
        floats("colors", 4),
        submeshes,
    )


def _values(place: Entry, buffers: Sequence[bytes], kind: str, count: int) -> Any:
    return np.frombuffer(buffers[int(place["buffer"])], kind, count, int(place["offset"]))


def unity_scene(document: Entry, buffers: Sequence[bytes], report: Report) -> UnityScene:
    """The nouns of a parsed scene file, see ``scene_file``.  The report gets what stands in it that no noun holds.

    Raises LookupError, TypeError or ValueError where it is no sound scene.
    """
    objects = [_game_object(entry, report) for entry in document["gameObjects"]]
    analysis = document.get("analysis")
    return UnityScene(
        source=told(Source, document.get("source", {}), "source", report),
        physics=told(Physics, document.get("physics", {}), "physics", report),
        gameObjects=tuple(objects),
        meshes=WrittenMeshes(document.get("meshes", ()), buffers),
        materials=tuple(
            material(entry, document.get("images", ()), buffers, report) for entry in document.get("materials", ())
        ),
        physicsMaterials=tuple(
            told(PhysicsMaterial, entry, f"physics material {entry['name']}", report)
            for entry in document.get("physicsMaterials", ())
        ),
        couplings=tuple(_coupling(i, entry) for i, entry in enumerate(document.get("couplings", ()))),
        ignoredCollisions=tuple(
            told(IgnoredCollision, entry, "pair that does not collide", report) for entry in document.get("ignoredCollisions", ())
        ),
        animations=tuple(noun(AnimationClip, entry) for entry in document.get("animations", ())),
        constraints=tuple(noun(Constraint, entry) for entry in document.get("constraints", ())),
        analysis=None if analysis is None else noun(Mobility, analysis),
        extras=document.get("extras", {}),
    )


def _game_object(entry: Entry, report: Report) -> GameObject:
    own = str(entry["id"])
    components: list[Component] = []
    for each in entry.get("components", ()):
        tell(COMPONENTS[each["type"]], each, f"{each['type']} of {own}", report)
        components.append(cast(Component, component(each)))
    bare = {key: value for key, value in entry.items() if key not in ("components", "transform")}
    tell(GameObject, bare, f"object {own}", report)
    tell(Transform, entry.get("transform", {}), f"place of {own}", report)
    transform = noun(Transform, entry.get("transform", {}))
    return replace(noun(GameObject, bare), transform=transform, components=tuple(components))


def _coupling(index: int, entry: Entry) -> Coupling:
    terms = tuple(CouplingTerm(noun(JointCoordinate, end), ratio) for end, ratio in terms_of(entry))
    id = str(entry.get("id", f"coupling:{index}"))
    driven = noun(JointCoordinate, entry["b"])
    return Coupling(id, entry["kind"], driven, terms, float(entry.get("offset", 0.0)))
