"""Writes ``NAME.kinefab`` and its buffer, as two files or as one, so that whoever reads, and whenever the writer is killed, there is
either the old pair or the new one.

As two files: the buffer's name holds its hash, so a new buffer never stands in an old one's place.  Both are written beside
their places (fsync), then the buffer is renamed, then the scene that names it, then old buffers go.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, BinaryIO, cast

import numpy as np

from .. import __version__, model
from ..diagnostics import KinefabError, Report, is_encodable
from ..replacing import beside, one_at_a_time, remove_leftovers, replacing, sync_directory
from ..spatial import bounds
from ..unity.container import write_container
from ..unity.counting import with_led_joints_on_light_bodies
from ..unity.links.tree import articulated
from ..unity.scene import BodyFreedom, Component, Coupling, GameObject, Joint, Mesh, Mobility, UnityScene
from ..unity.sums import with_one_term_each
from .content import Content
from .noun_entry import Noun, entry, needs_newer, unsaid
from .numbers import plain_value, significant, whole_numbers

FORMAT_VERSION = "1.0"
NEWER_VERSION = "1.1"
"""Of a scene that says what 1.0 has no field for, as the schema marks it (``since``), and of one with its buffer in one file."""
UINT16_VERTICES = 65535
"""Most vertices that Unity's 16-bit index format counts."""
HASH_DIGITS = 16
"""Hexadecimal digits of the buffer's SHA-256 in its name."""

Progress = Callable[[float], None]


class _Buffer:
    """Appends runs of values to a file, 4-byte aligned, and hashes what it writes."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self.hash = hashlib.sha256()
        self.length = 0

    def append(self, values: np.ndarray, dtype: str) -> dict[str, int]:
        """The accessor of ``values``, written little-endian and tightly packed as ``dtype``."""
        data = np.ascontiguousarray(values, dtype=np.dtype(dtype).newbyteorder("<")).data.cast("B")
        offset = self.length
        for piece in filter(len, (data, bytes(-len(data) % 4))):
            self._file.write(piece)
            self.hash.update(piece)
            self.length += len(piece)
        return {"buffer": 0, "offset": offset}


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the scene and, when there are meshes, its buffer beside it; returns both paths.

    The report gets what the format has no place for.  Raises OSError as the file system does; then the old files stand
    as they were.
    """
    report = content.report
    scene = _in_unity(content)
    _tell_losses(scene, report)
    _tell_mesh_losses(content.scene.meshes, report)
    content.refuse_losses()
    if unsafe := _unsafe(target.name):
        detail = f"its name {unsafe}, and the scene names its buffer after it"
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    binary = content.options.get("container") == "binary"
    buffer_path, head = None, _head(scene, binary)
    with one_at_a_time(target.parent), ExitStack() as stack:
        remove_leftovers(target, "bin", "scene")
        temporary = None
        if len(scene.meshes):
            file, temporary = stack.enter_context(beside(target, "bin"))
            buffer_path, buffer, meshes = _write_buffer(scene.meshes, target, file, content.progress)
            if binary:
                buffer_path = None
                del buffer["uri"]
            head |= {"buffers": [buffer], "meshes": meshes}
        with replacing(target, "scene") as file:
            pieces = (piece.encode("utf-8") for piece in canonical_json(head | _tail(scene, report)))
            if binary:
                held = None if temporary is None else stack.enter_context(open(temporary, "rb"))
                _write_in_one(target, file, pieces, held, report)
            else:
                for piece in pieces:
                    file.write(piece)
            # Last, so that what fails before leaves no buffer behind.
            if buffer_path is not None and temporary is not None:
                file.flush()
                os.fsync(file.fileno())
                os.replace(temporary, buffer_path)
                sync_directory(target.parent)
        sync_directory(target.parent)
        _remove_old_buffers(target, buffer_path)
    return (target,) if buffer_path is None else (target, buffer_path)


def _write_in_one(
    target: Path, file: BinaryIO, pieces: Iterable[bytes], buffer: BinaryIO | None, report: Report
) -> None:
    try:
        write_container(file, pieces, buffer)
    except OverflowError as error:
        detail = str(error)
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)]) from error


def _in_unity(content: Content) -> UnityScene:
    """In Unity's terms, as the format can say them; by links where that is asked for."""
    links = content.options.get("physics") == "articulation"
    scene = with_led_joints_on_light_bodies(with_one_term_each(content.unity(links), content.report))
    if not links:
        return scene
    return articulated(scene, {joint.id: joint for joint in content.scene.joints}, content.report)


def _head(scene: UnityScene, binary: bool = False) -> dict[str, Any]:
    """Everything before the meshes, in the file's order."""
    head: dict[str, Any] = {
        "format": "kinefab.scene",
        "version": NEWER_VERSION if binary or _is_newer(scene) else FORMAT_VERSION,
        "generator": {"name": "kinefab", "version": __version__},
    }
    return head | {key: value for key in ("source", "physics") if (value := entry(getattr(scene, key)))}


def _is_newer(scene: UnityScene) -> bool:
    """Whether something in it format 1.0 has no word for."""
    return any(needs_newer(entry) or any(map(needs_newer, entry.components)) for entry in scene.gameObjects)


def _tail(scene: UnityScene, report: Report) -> dict[str, Any]:
    """Everything after the meshes, in the file's order."""
    tail: dict[str, Any] = {
        "materials": [entry(material) for material in scene.materials],
        "gameObjects": _game_objects(scene.gameObjects),
        "couplings": [_coupling(coupling) for coupling in scene.couplings],
        "animations": [entry(clip) for clip in scene.animations],
        "constraints": [entry(constraint) for constraint in scene.constraints],
        "analysis": None if scene.analysis is None else _analysis(scene.analysis),
        "report": report_entries(report),
        "extras": whole_numbers(scene.extras),
    }
    return {key: value for key, value in tail.items() if value or key == "gameObjects"}


def _game_objects(objects: Iterable[GameObject]) -> list[dict[str, Any]]:
    """Copies of a part have equal components, which share one entry."""
    known: dict[Component, dict[str, Any]] = {}

    def component(own: Component) -> dict[str, Any]:
        if isinstance(own, Joint):  # one of a kind
            return entry(own)
        if own not in known:
            known[own] = entry(own)
        return known[own]

    return [entry(game_object, component) for game_object in objects]


def _analysis(found: Mobility) -> dict[str, Any]:
    """Bodies that are free alike share the lists of their vectors."""
    known: dict[object, dict[str, Any]] = {}

    def item(own: Any) -> dict[str, Any]:
        if not isinstance(own, BodyFreedom):
            return entry(own)
        freedom = (own.directions, own.axes)
        if freedom not in known:
            known[freedom] = entry(own)
        return known[freedom] | {"gameObject": own.gameObject}

    return entry(found, item)


def _coupling(coupling: Coupling) -> dict[str, Any]:
    """``q_b = ratio * q_a + offset``."""
    (term,) = coupling.terms
    found = {
        "id": coupling.id,
        "kind": coupling.kind,
        "a": entry(term.coordinate),
        "b": entry(coupling.coordinate),
        "ratio": significant(term.ratio),
    }
    return found | ({"offset": offset} if (offset := plain_value(coupling.offset)) != 0 else {})


def report_entries(report: Report) -> list[dict[str, Any]]:
    """The loss report as the scene format holds it."""
    entries: list[dict[str, Any]] = []
    for o in report.outcomes:
        told = {"feature": o.feature, "outcome": o.outcome.value}
        if o.code:
            told |= {"severity": o.severity.value, "code": o.code, "message": o.message}
        if o.where:
            told["source"] = o.where
        entries.append(told)
    return entries


def _tell_losses(scene: UnityScene, report: Report) -> None:
    """What the nouns hold and the format has no field for."""

    def told(kind: str, name: str, noun: Noun) -> None:
        for field, usual in unsaid(type(noun)).items():
            if getattr(noun, field) != usual:
                report.field_dropped(f"{kind} {name}", field, ".kinefab")

    for material in scene.materials:
        told("material", material.name, material)
    for game_object in scene.gameObjects:
        told("object", game_object.id, game_object)
        for component in game_object.components:
            if not isinstance(component, Joint):
                told(f"{type(component).__name__} of", game_object.id, component)


def _tell_mesh_losses(meshes: Sequence[model.Mesh], report: Report) -> None:
    """Of the model's meshes, as Unity's are made one by one when they are written."""
    for mesh in meshes:
        lost = {"colors": mesh.colors is not None, "tangents": mesh.tangents is not None}
        for name, there in (lost | {"uv sets behind the first": len(mesh.uvs) > 1}).items():
            if there:
                report.field_dropped(f"mesh {mesh.name}", name, ".kinefab")


def _unsafe(name: str) -> str:
    """What stands in a file name that no scene may name, as the reader would refuse it; "" where nothing does."""
    if not is_encodable(name):
        return "is not UTF-8"
    if any(unicodedata.category(character) == "Cc" for character in name):
        return "holds a control character"
    return next((f"holds {character!r}" for character in ":\\" if character in name), "")


def _write_buffer(
    meshes: Sequence[Mesh], target: Path, file: BinaryIO, progress: Progress
) -> tuple[Path, dict[str, Any], list[Any]]:
    """Write the meshes; the path that is meant for them, the buffer's entry in the scene and the meshes'."""
    entries: list[dict[str, Any]] = []
    buffer = _Buffer(file)
    for i, mesh in enumerate(meshes):
        entries.append(_mesh_entry(mesh, buffer))
        progress((i + 1) / len(meshes))
    file.flush()
    os.fsync(file.fileno())
    if os.name == "nt":  # which renames no open file
        file.close()
    digest = buffer.hash.hexdigest()
    path = target.with_name(f"{target.name}.{digest[:HASH_DIGITS]}.bin")
    return path, {"uri": path.name, "byteLength": buffer.length, "sha256": digest}, entries


def _mesh_entry(mesh: Mesh, buffer: _Buffer) -> dict[str, Any]:
    """One mesh in the buffer, and its entry in the scene."""
    count = len(mesh.vertices)
    low, high = bounds(np.asarray(mesh.vertices, dtype=np.float64))
    short = count <= UINT16_VERTICES
    found: dict[str, Any] = {
        "name": mesh.name,
        "vertexCount": count,
        "bounds": plain_value(
            {"center": (0.5 * (low + high)).tolist(), "extents": (0.5 * (high - low)).tolist()}
        ),
        "positions": buffer.append(mesh.vertices, "f4"),
    }
    if mesh.normals is not None:
        found["normals"] = buffer.append(mesh.normals, "f4")
    if mesh.uvs:
        found["uv"] = buffer.append(mesh.uvs[0], "f4")
    found["indexFormat"] = "uint16" if short else "uint32"
    found["indices"] = buffer.append(mesh.triangles, "u2" if short else "u4")
    starts = np.cumsum([0, *mesh.submeshes])[:-1]
    found["submeshes"] = [
        {"indexStart": 3 * int(s), "indexCount": 3 * int(n)} for s, n in zip(starts, mesh.submeshes)
    ]
    return found


def canonical_json(content: dict[str, Any]) -> Iterator[str]:
    """The document piece by piece (the text of a large scene is never there as a whole), with one line for each entry of
    a list and for each component; keys keep their order.

    Floats are written in their shortest form that reads back the same; NaN and Infinity raise ValueError.
    """
    flat = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(", ", ": ")).encode
    texts: dict[int, str] = {}  # of components, by identity: many objects share one

    def component(entry: dict[str, Any]) -> str:
        if id(entry) not in texts:
            texts[id(entry)] = flat(entry)
        return texts[id(entry)]

    def game_object(entry: dict[str, Any]) -> str:
        if not (components := entry.get("components")):
            return flat({k: v for k, v in entry.items() if k != "components"})
        lines = ",\n      ".join(component(c) for c in components)
        keys = list(entry)
        place = keys.index("components")
        head, rest = (flat({k: entry[k] for k in part}) for part in (keys[:place], keys[place + 1 :]))
        more = f", {rest[1:-1]}" if place + 1 < len(keys) else ""
        return f'{head[:-1]}, "components": [\n      {lines}\n    ]{more}}}'

    before = "{\n"
    for key, value in content.items():
        if isinstance(value, list) and value:
            one = game_object if key == "gameObjects" else flat
            opening = f"{before}  {flat(key)}: [\n    "
            for entry in cast(list[Any], value):
                yield opening + one(entry)
                opening = ",\n    "
            yield "\n  ]"
        else:
            yield f"{before}  {flat(key)}: {flat(value)}"
        before = ",\n"
    yield "\n}\n" if content else "{\n\n}\n"


def _remove_old_buffers(target: Path, keep: Path | None) -> None:
    pattern = re.compile(re.escape(target.name) + rf"\.[0-9a-f]{{{HASH_DIGITS}}}\.bin")
    for path in target.parent.iterdir():
        if path != keep and pattern.fullmatch(path.name):
            path.unlink(missing_ok=True)
