"""Writes ``NAME.kinefab`` and its buffer so that whoever reads, and whenever the writer is killed, there is
either the old pair or the new one.

The buffer's name holds its hash, so a new buffer never stands in an old one's place.  Both are written beside
their places (fsync), then the buffer is renamed, then the scene that names it, then old buffers go.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO, Callable, Iterator

import numpy as np

from ..model import Mesh
from ..replacing import beside, replacing
from . import frames
from .document import Document
from .numbers import rounded

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
        data = memoryview(np.ascontiguousarray(values, dtype=np.dtype(dtype).newbyteorder("<"))).cast("B")
        offset = self.length
        for piece in (data, bytes(-len(data) % 4)):
            self._file.write(piece)
            self.hash.update(piece)
            self.length += len(piece)
        return {"buffer": 0, "offset": offset}


def write_scene(document: Document, target: Path, progress: Progress = lambda fraction: None) -> Path | None:
    """Write ``target`` and, when there are meshes, its buffer beside it; returns the buffer's path.

    Raises OSError as the file system does; then the old files stand as they were.
    """
    target, content = Path(target), dict(document.head)
    temporary, buffer_path = beside(target, "bin"), None
    with _one_at_a_time(target.parent):
        try:
            if document.meshes:
                buffer_path, entry, meshes = _write_buffer(document.meshes, target, temporary, progress)
                content |= {"buffers": [entry], "meshes": meshes}
            with replacing(target, "scene") as file:
                file.write(canonical_json(content | document.tail).encode("utf-8"))
                if buffer_path is not None:  # last, so that what fails before leaves no buffer behind
                    file.flush()
                    os.fsync(file.fileno())
                    os.replace(temporary, buffer_path)
                    _sync_directory(target.parent)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
        _sync_directory(target.parent)
        _remove_old_buffers(target, buffer_path)
    return buffer_path


def _write_buffer(
    meshes: list[Mesh], target: Path, temporary: Path, progress: Progress
) -> tuple[Path, dict[str, Any], list[Any]]:
    """Write the meshes to ``temporary``; the path that is meant for it, its entry in the scene and the meshes'."""
    entries = []
    with open(temporary, "wb") as file:
        buffer = _Buffer(file)
        for i, mesh in enumerate(meshes):
            entries.append(_mesh_entry(mesh, buffer))
            progress((i + 1) / len(meshes))
        file.flush()
        os.fsync(file.fileno())
    digest = buffer.hash.hexdigest()
    path = target.with_name(f"{target.name}.{digest[:HASH_DIGITS]}.bin")
    return path, {"uri": path.name, "byteLength": buffer.length, "sha256": digest}, entries


def _mesh_entry(mesh: Mesh, buffer: _Buffer) -> dict[str, Any]:
    """One mesh mirrored into the buffer, and its entry in the scene."""
    count = len(mesh.vertices)
    positions = frames.point(mesh.vertices).astype(np.float32)
    low, high = (v.astype(np.float64) for v in (positions.min(axis=0), positions.max(axis=0)))
    short = count <= UINT16_VERTICES
    entry: dict[str, Any] = {
        "name": mesh.name,
        "vertexCount": count,
        "bounds": rounded({"center": 0.5 * (low + high), "extents": 0.5 * (high - low)}),
        "positions": buffer.append(positions, "f4"),
    }
    if mesh.normals is not None:
        entry["normals"] = buffer.append(frames.direction(mesh.normals), "f4")
    if mesh.uv is not None:
        entry["uv"] = buffer.append(mesh.uv, "f4")
    entry["indexFormat"] = "uint16" if short else "uint32"
    entry["indices"] = buffer.append(frames.winding(mesh.faces), "u2" if short else "u4")
    counts = mesh.face_counts or (len(mesh.faces),)
    starts = np.cumsum([0, *counts])[:-1]
    entry["submeshes"] = [
        {"indexStart": 3 * int(s), "indexCount": 3 * int(n)} for s, n in zip(starts, counts)
    ]
    return entry


def canonical_json(content: dict[str, Any]) -> str:
    """The document with one line for each entry of a list and for each component; keys keep their order.

    Floats are written in their shortest form that reads back the same; NaN and Infinity raise ValueError.
    """

    def flat(value: Any) -> str:
        return json.dumps(value, ensure_ascii=False, allow_nan=False, separators=(", ", ": "))

    def block(lines: list[str], indent: str) -> str:
        return "[\n" + ",\n".join(indent + line for line in lines) + "\n" + indent[:-2] + "]"

    def game_object(entry: dict[str, Any]) -> str:
        fields = [f"{flat(k)}: {flat(v)}" for k, v in entry.items() if k != "components"]
        if components := entry.get("components"):
            fields.append('"components": ' + block([flat(c) for c in components], "      "))
        return "{" + ", ".join(fields) + "}"

    lines = []
    for key, value in content.items():
        if isinstance(value, list) and value:
            entries = [game_object(v) if key == "gameObjects" else flat(v) for v in value]
            lines.append(f"  {flat(key)}: " + block(entries, "    "))
        else:
            lines.append(f"  {flat(key)}: {flat(value)}")
    return "{\n" + ",\n".join(lines) + "\n}\n"


@contextmanager
def _one_at_a_time(folder: Path) -> Iterator[None]:
    """Wait for other exports into the folder: two to one target would remove each other's buffers.

    The lock is the folder's own, so it leaves no file and ends with its process.  Windows cannot open a folder
    and some network file systems cannot lock one; there the exports are on their own.
    """
    if os.name == "nt":
        yield
        return
    import fcntl

    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def _sync_directory(folder: Path) -> None:
    """Make the renames last through a power cut, where the system can open a folder (not on Windows)."""
    if os.name == "nt":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _remove_old_buffers(target: Path, keep: Path | None) -> None:
    pattern = re.compile(re.escape(target.name) + rf"\.[0-9a-f]{{{HASH_DIGITS}}}\.bin")
    for path in target.parent.iterdir():
        if path != keep and pattern.fullmatch(path.name):
            path.unlink(missing_ok=True)
