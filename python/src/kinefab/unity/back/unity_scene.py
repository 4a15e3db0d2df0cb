"""A written scene in Unity's own terms, as whatever wrote it had them: a target that writes these gives the same again."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, cast, overload

import numpy as np

from ...diagnostics import Report
from ...model import AlphaMode
from ..definitions import Noun
from ..scene import (
    AnimationClip,
    Component,
    Constraint,
    Coupling,
    CouplingTerm,
    GameObject,
    JointCoordinate,
    Material,
    Mesh,
    Mobility,
    Physics,
    Source,
    Transform,
    UnityScene,
)
from .demanded import demand_sound
from .nouns import COMPONENTS, component, noun, unheld

Entry = Mapping[str, Any]
TARGET = "what reads a .kinefab"
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
    if len(indices) and int(indices.max()) >= count:
        raise ValueError("an index past the last vertex")
    normals, uv = entry.get("normals"), entry.get("uv")
    return Mesh(
        str(entry["name"]),
        _values(entry["positions"], buffers, "<f4", 3 * count).reshape(-1, 3),
        indices.reshape(-1, 3),
        None if normals is None else _values(normals, buffers, "<f4", 3 * count).reshape(-1, 3),
        () if uv is None else (_values(uv, buffers, "<f4", 2 * count).reshape(-1, 2),),
        submeshes=submeshes,
    )


def _values(place: Entry, buffers: Sequence[bytes], kind: str, count: int) -> Any:
    offset = int(place["offset"])
    if offset < 0:
        raise ValueError("an accessor before its buffer")
    return np.frombuffer(buffers[int(place["buffer"])], kind, count, offset)


def unity_scene(document: Entry, buffers: Sequence[bytes], report: Report) -> UnityScene:
    """The nouns of a parsed scene file, see ``scene_file``.  The report gets what stands in it that no noun holds.

    Raises LookupError, TypeError or ValueError where it is no sound scene.
    """
    objects = [_game_object(entry, report) for entry in document["gameObjects"]]
    analysis = document.get("analysis")
    found = UnityScene(
        source=_told(Source, document.get("source", {}), "source", report),
        physics=_told(Physics, document.get("physics", {}), "physics", report),
        gameObjects=tuple(objects),
        meshes=WrittenMeshes(document.get("meshes", ()), buffers),
        materials=tuple(_material(entry, report) for entry in document.get("materials", ())),
        couplings=tuple(_coupling(i, entry) for i, entry in enumerate(document.get("couplings", ()))),
        animations=tuple(noun(AnimationClip, entry) for entry in document.get("animations", ())),
        constraints=tuple(noun(Constraint, entry) for entry in document.get("constraints", ())),
        analysis=None if analysis is None else noun(Mobility, analysis),
        extras=document.get("extras", {}),
    )
    demand_sound(found)
    return found


def _told(kind: Any, entry: Entry, name: str, report: Report) -> Any:
    _tell(kind, entry, name, report)
    return noun(kind, entry)


def _tell(kind: type[Noun], entry: Entry, name: str, report: Report) -> None:
    for field in unheld(kind, entry):
        report.field_dropped(name, field, TARGET)


def _game_object(entry: Entry, report: Report) -> GameObject:
    own = str(entry["id"])
    components: list[Component] = []
    for each in entry.get("components", ()):
        _tell(COMPONENTS[each["type"]], each, f"{each['type']} of {own}", report)
        components.append(cast(Component, component(each)))
    bare = {key: value for key, value in entry.items() if key not in ("components", "transform")}
    _tell(GameObject, bare, f"object {own}", report)
    _tell(Transform, entry.get("transform", {}), f"place of {own}", report)
    transform = noun(Transform, entry.get("transform", {}))
    return replace(noun(GameObject, bare), transform=transform, components=tuple(components))


def _material(entry: Entry, report: Report) -> Material:
    """One of a file that states no mode of its alpha is seen through where it is not whole, as it was when it was written."""
    found: Material = _told(Material, entry, f"material {entry['name']}", report)
    if "alphaMode" in entry or found.color[3] >= 1.0:
        return found
    return noun(Material, {**entry, "alphaMode": AlphaMode.BLEND.value})


def _coupling(index: int, entry: Entry) -> Coupling:
    driven, driver = (noun(JointCoordinate, entry[end]) for end in "ba")
    term = CouplingTerm(driver, float(entry["ratio"]))
    return Coupling(
        str(entry.get("id", f"coupling:{index}")), entry["kind"], driven, (term,), float(entry.get("offset", 0.0))
    )  # fmt: skip
