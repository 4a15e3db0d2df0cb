"""Writes ``NAME.kinefab`` and its buffer, as two files or as one, so that whoever reads, and whenever the writer is killed, there is
either the old pair or the new one.

As two files: the buffer's name holds its hash, so a new buffer never stands in an old one's place.  Both are written beside
their places (fsync), then the buffer is renamed, then the scene that names it, then old buffers go.
"""

from __future__ import annotations

import json
import os
import re
import unicodedata
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any, BinaryIO, cast

from .. import __version__, model
from ..diagnostics import KinefabError, Report, is_encodable
from ..replacing import beside, one_at_a_time, remove_leftovers, replacing, sync_directory
from ..unity.back.extras import put_extras
from ..unity.back.source import WrittenScene
from ..unity.container import write_container
from ..unity.definitions import UV_SETS
from ..unity.counting import with_led_joints_on_light_bodies
from ..unity.joints.passive import withdraw_stated
from ..unity.links.tree import articulated
from ..unity.scene import BodyFreedom, Component, Coupling, GameObject, Joint, Mobility, UnityScene
from ..unity.switched_off import without_switched_off
from .content import Content
from .noun_entry import Noun, entry, needs_newer, newer_keys, unsaid
from .numbers import plain_value, significant, whole_numbers
from .scene_buffer import SceneBuffer, mesh_entry
from .scene_looks import Looks
from .tangents import normal_mapped, with_tangents

FORMAT_VERSION = "1.0"
NEWER_VERSION = "1.1"
"""Of a scene that says what 1.0 has no field for, as the schema marks it (``since``), and of one with its buffer in one file."""
HASH_DIGITS = 16
"""Hexadecimal digits of the buffer's SHA-256 in its name."""

Progress = Callable[[float], None]


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the scene and, when there are meshes, its buffer beside it; returns both paths.

    The report gets what the format has no place for.  Raises OSError as the file system does; then the old files stand
    as they were.
    """
    report = content.report
    scene = _in_unity(content)
    _tell_losses(scene, report)
    _tell_mesh_losses(content.scene.meshes, report)
    looks = Looks(report)
    looks.add(scene.materials)
    content.refuse_losses()
    if unsafe := _unsafe(target.name):
        detail = f"its name {unsafe}, and the scene names its buffer after it"
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=target, detail=detail)])
    binary = content.options.get("container") == "binary"
    buffer_path, numbers = None, dict[str, Any]()
    with one_at_a_time(target.parent), ExitStack() as stack:
        remove_leftovers(target, "bin", "scene")
        temporary = None
        if len(scene.meshes) or looks.images:
            file, temporary = stack.enter_context(beside(target, "bin"))
            buffer_path, numbers = _write_buffer(scene, looks, target, file, content.progress)
            if binary:
                buffer_path = None
                del numbers["buffers"][0]["uri"]
        document = _document(scene, looks, numbers, report)
        if isinstance(content.scene, WrittenScene) and scene is content.scene.written:
            for way, extras in content.scene.extras_at.items():
                put_extras(document, way, whole_numbers(extras))
        with replacing(target, "scene") as file:
            pieces = (piece.encode("utf-8") for piece in canonical_json(document))
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
    scene = content.unity(links)
    if links:
        scene = without_switched_off(scene, "an articulation", content.report)
    scene = with_led_joints_on_light_bodies(scene)
    if not links:
        for joint in content.scene.joints:  # a scene has fields for what no joint of Unity's has
            withdraw_stated(joint, content.report)
        return scene
    return articulated(scene, content.scene, content.groups, content.report)


def _document(scene: UnityScene, looks: Looks, numbers: dict[str, Any], report: Report) -> dict[str, Any]:
    """The whole of it, in the file's order.  numbers: the entries of what lies in the buffer."""
    head: dict[str, Any] = {
        "format": "kinefab.scene",
        "version": NEWER_VERSION if _is_newer(scene, looks, numbers) else FORMAT_VERSION,
        "generator": {"name": "kinefab", "version": __version__},
    }
    head |= {key: value for key in ("source", "physics") if (value := entry(getattr(scene, key)))}
    return head | numbers | _tail(scene, looks, report)


def _is_newer(scene: UnityScene, looks: Looks, numbers: dict[str, Any]) -> bool:
    """Whether something in it format 1.0 has no word for."""
    lists = {"mesh": numbers.get("meshes", ()), "material": looks.materials}
    return (
        bool(scene.physicsMaterials or looks.images or scene.ignoredCollisions)
        or needs_newer(scene.source)
        or any(len(coupling.terms) > 1 for coupling in scene.couplings)
        or any("uri" not in buffer for buffer in numbers.get("buffers", ()))
        or any(newer_keys(definition) & entry.keys() for definition, entries in lists.items() for entry in entries)
        or any(needs_newer(entry) or any(map(needs_newer, entry.components)) for entry in scene.gameObjects)
    )


def _tail(scene: UnityScene, looks: Looks, report: Report) -> dict[str, Any]:
    """Everything after the meshes, in the file's order."""
    tail: dict[str, Any] = {
        "materials": looks.materials,
        "physicsMaterials": [entry(material) for material in scene.physicsMaterials],
        "gameObjects": _game_objects(scene.gameObjects),
        "couplings": [_coupling(coupling) for coupling in scene.couplings],
        "ignoredCollisions": [entry(pair) for pair in scene.ignoredCollisions],
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
    """``q_b = ratio * q_a + offset``, or with several terms ``q_b = sum of ratio * q + offset``."""
    found: dict[str, Any] = {"id": coupling.id, "kind": coupling.kind}
    driven = entry(coupling.coordinate)
    if len(coupling.terms) == 1:
        (term,) = coupling.terms
        found |= {"a": entry(term.coordinate), "b": driven, "ratio": significant(term.ratio)}
    else:
        found |= {"b": driven, "terms": [entry(term) for term in coupling.terms]}
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
        if len(mesh.uvs) > len(UV_SETS):
            report.field_dropped(f"mesh {mesh.name}", f"uv sets behind the first {len(UV_SETS)}", ".kinefab")


def _unsafe(name: str) -> str:
    """What stands in a file name that no scene may name, as the reader would refuse it; "" where nothing does."""
    if not is_encodable(name):
        return "is not UTF-8"
    if any(unicodedata.category(character) == "Cc" for character in name):
        return "holds a control character"
    return next((f"holds {character!r}" for character in ":\\" if character in name), "")


def _write_buffer(
    scene: UnityScene, looks: Looks, target: Path, file: BinaryIO, progress: Progress
) -> tuple[Path, dict[str, Any]]:
    """Write meshes and images; the path that is meant for them, and their entries in the scene with the buffer's."""
    buffer, bumpy = SceneBuffer(file), normal_mapped(scene)
    meshes: list[dict[str, Any]] = []
    for i, mesh in enumerate(scene.meshes):
        meshes.append(mesh_entry(with_tangents(mesh) if i in bumpy else mesh, buffer))
        progress((i + 1) / len(scene.meshes))
    images = [
        image | {"data": buffer.append_bytes(data), "byteLength": len(data)} for image, data in looks.images
    ]
    file.flush()
    os.fsync(file.fileno())
    if os.name == "nt":  # which renames no open file
        file.close()
    digest = buffer.hash.hexdigest()
    path = target.with_name(f"{target.name}.{digest[:HASH_DIGITS]}.bin")
    stated = {"uri": path.name, "byteLength": buffer.length, "sha256": digest}
    found = {"buffers": [stated], "meshes": meshes, "images": images}
    return path, {key: value for key, value in found.items() if value}


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
