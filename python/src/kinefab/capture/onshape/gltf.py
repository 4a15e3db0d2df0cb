"""A part as Onshape exports it to glTF 2.0, binary or JSON with its buffers in it: triangles, normals, and the paint of each face.

Nothing but the triangles is taken (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html); a face of the part may be a primitive
of its own, so those of one paint are put together.  What the file needs that is not read here makes it unreadable, not wrong.
"""

from __future__ import annotations

import base64
import json
import struct
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from ...geometry.looks.gltf_document import MAGIC, Json, accessor_values
from ...spatial import Array, IntArray

JSON_CHUNK, BINARY_CHUNK = 0x4E4F534A, 0x004E4942
TRIANGLES = 4
"""Modes below are points and lines, those above strips and fans."""
FLOAT = 5126
NAMING = frozenset({"name", "extras", "extensions", "generator", "copyright"})
WHITE = (1.0, 1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class Paint:
    """How faces look.  color: red green blue alpha as the file states it.  metallic, roughness: None where it states none."""

    color: tuple[float, ...]
    metallic: float | None = None
    roughness: float | None = None


@dataclass(slots=True, eq=False)
class Shape:
    """Triangles in the file's axes and unit.

    points (n, 3), normals (n, 3) or None, faces (m, 3).  runs: how many faces have which paint, None where the file states none.
    """

    points: Array
    normals: Array | None
    faces: IntArray
    runs: list[tuple[int, Paint | None]]


def read_gltf(content: bytes) -> Shape:
    """The triangles of a file.  Raises ValueError, KeyError, IndexError, TypeError or struct.error where it cannot be read."""
    try:
        document, binary = _opened(content)
    except RecursionError:
        raise ValueError("it is nested without end") from None
    if needed := document.get("extensionsRequired"):
        raise ValueError(f"it needs {needed!r:.80}")
    buffers = [_buffer(entry, binary) for entry in document.get("buffers", [])]
    points: list[Array] = []
    normals: list[Array | None] = []
    by_paint: dict[Paint | None, list[IntArray]] = {}
    count = 0
    for matrix, mesh in _placed(document):
        volume = float(np.linalg.det(matrix[:3, :3]))
        if not abs(volume) > 0.0:
            raise ValueError("a node of it is flat")
        for primitive in document["meshes"][mesh]["primitives"]:
            mode = primitive.get("mode", TRIANGLES)
            if mode < TRIANGLES:
                continue
            if mode > TRIANGLES:
                raise ValueError("it holds strips or fans of triangles")
            named = primitive["attributes"]
            own = _numbers(document, buffers, named["POSITION"], "VEC3")
            normal = _numbers(document, buffers, named["NORMAL"], "VEC3") if "NORMAL" in named else None
            faces = _faces(document, buffers, primitive.get("indices"), len(own))
            points.append(own @ matrix[:3, :3].T + matrix[:3, 3])
            normals.append(None if normal is None else _turned(normal, matrix[:3, :3], len(own)))
            paint = _paint(document, primitive.get("material"))
            by_paint.setdefault(paint, []).append((faces[:, ::-1] if volume < 0.0 else faces) + count)
            count += len(own)
    if not by_paint:
        raise ValueError("it holds no triangles")
    whole = [entry for entry in normals if entry is not None]
    return Shape(
        np.concatenate(points),
        np.concatenate(whole) if len(whole) == len(normals) else None,
        np.concatenate([faces for listed in by_paint.values() for faces in listed]),
        [(sum(map(len, listed)), paint) for paint, listed in by_paint.items()],
    )


def nameless(content: bytes) -> bytes:
    """The same file with nothing in it that somebody named; nothing of one that cannot be opened."""
    try:
        document, binary = _opened(content)
        kept: Json = {key: _unnamed(value) for key, value in document.items() if key not in NAMING}
    except (ValueError, KeyError, TypeError, AttributeError, struct.error, RecursionError):
        return b""
    text = json.dumps(kept).encode("ascii")
    if content[:4] != MAGIC:
        return text
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), JSON_CHUNK) + text
    chunks += struct.pack("<II", len(binary), BINARY_CHUNK) + binary
    return MAGIC + struct.pack("<II", 2, 12 + len(chunks)) + chunks


def _unnamed(value: Any) -> Any:
    if isinstance(value, dict):
        held = cast(Json, value)
        return {key: _unnamed(entry) for key, entry in held.items() if key not in NAMING}
    return [_unnamed(entry) for entry in cast("list[Any]", value)] if isinstance(value, list) else value


def _opened(content: bytes) -> tuple[Json, bytes]:
    """The document, and the binary part of a file that has one."""
    if content[:4] != MAGIC:
        found: Any = json.loads(content.decode("utf-8"))
        if not isinstance(found, dict) or "asset" not in found:
            raise ValueError("no glTF")
        return cast(Json, found), b""
    at, text, binary = 12, b"", b""
    while at + 8 <= len(content):
        size, kind = struct.unpack_from("<II", content, at)
        chunk = content[at + 8 : at + 8 + size]
        if len(chunk) != size:
            raise ValueError("it is cut off")
        text, binary = (chunk if kind == JSON_CHUNK else text), (chunk if kind == BINARY_CHUNK else binary)
        at += 8 + size
    return json.loads(text.decode("utf-8")), binary


def _buffer(entry: Json, binary: bytes) -> bytes:
    address = entry.get("uri")
    if address is None:
        return binary
    head, comma, data = str(address).partition(",")
    if not (comma and head.startswith("data:") and head.endswith(";base64")):
        raise ValueError("a buffer of it lies elsewhere")
    return base64.b64decode(data, validate=True)


def _placed(document: Json) -> list[tuple[Array, int]]:
    """Every mesh of the scene with its 4 x 4 matrix.  Raises ValueError where nodes are no trees."""
    scenes, nodes = document.get("scenes", []), document.get("nodes", [])
    roots = scenes[document.get("scene", 0)].get("nodes", []) if scenes else range(len(nodes))
    open_nodes, seen = [(np.eye(4), node) for node in roots], set[int]()
    found: list[tuple[Array, int]] = []
    while open_nodes:
        above, number = open_nodes.pop()
        if number in seen:
            raise ValueError("a node of it stands twice in its tree")
        seen.add(number)
        node = nodes[number]
        matrix = above @ _matrix(node)
        if "mesh" in node:
            found.append((matrix, node["mesh"]))
        open_nodes += [(matrix, child) for child in reversed(node.get("children", []))]
    return found


def _matrix(node: Json) -> Array:
    if "matrix" in node:
        return np.array(node["matrix"], dtype=float).reshape(4, 4).T
    x, y, z, w = (float(v) for v in node.get("rotation", (0.0, 0.0, 0.0, 1.0)))
    turn = np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ])  # fmt: skip
    found = np.eye(4)
    found[:3, :3] = turn * np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=float)
    found[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return found


def _numbers(document: Json, buffers: list[bytes], index: int, wanted: str) -> Array:
    """The vectors of an accessor.  wanted: its type; all are floats."""
    entry = document["accessors"][index]
    if entry["type"] != wanted or entry["componentType"] != FLOAT:
        raise ValueError(f"an accessor is no {wanted} of floats")
    values = _values(document, buffers, entry)
    if not np.isfinite(values).all():
        raise ValueError(f"an accessor of type {wanted} has what is no number")
    return values.astype(float)


def _values(document: Json, buffers: list[bytes], entry: Json) -> Array:
    """The numbers of an accessor as they stand, (count, width).  Raises ValueError or TypeError beyond its buffer."""
    if "sparse" in entry or "bufferView" not in entry:
        raise ValueError("an accessor without plain numbers")
    return accessor_values(document, entry, buffers.__getitem__)


def _faces(document: Json, buffers: list[bytes], index: int | None, count: int) -> IntArray:
    """Corners of each triangle, counted among ``count`` vertices."""
    if index is None:
        corners = np.arange(count)
    else:
        entry = document["accessors"][index]
        if entry["type"] != "SCALAR" or entry["componentType"] == FLOAT:
            raise ValueError("indices that are no numbers of vertices")
        corners = _values(document, buffers, entry).astype(np.int64).reshape(-1)
    if len(corners) and not 0 <= int(corners.min()) <= int(corners.max()) < count:
        raise ValueError("a triangle names a corner that is not there")
    return corners.reshape(-1, 3)


def _turned(normals: Array, linear: Array, count: int) -> Array:
    """Normals go by the inverse transpose.  Raises ValueError where there are not as many as points."""
    if len(normals) != count:
        raise ValueError("not as many normals as points")
    turned = normals @ np.linalg.inv(linear)
    return turned / np.maximum(np.linalg.norm(turned, axis=1, keepdims=True), np.finfo(float).tiny)


def _paint(document: Json, index: int | None) -> Paint | None:
    if index is None:
        return None
    stated = document["materials"][index].get("pbrMetallicRoughness", {})
    color = tuple(float(v) for v in stated.get("baseColorFactor", WHITE))
    if len(color) != len(WHITE):
        raise ValueError("a colour without four numbers")
    metallic, roughness = (stated.get(key) for key in ("metallicFactor", "roughnessFactor"))
    return Paint(color, *(None if v is None else min(1.0, max(0.0, float(v))) for v in (metallic, roughness)))
