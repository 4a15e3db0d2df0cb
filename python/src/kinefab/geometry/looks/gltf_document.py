"""The JSON of a glTF file, looked at before trimesh reads what it asks for."""

from __future__ import annotations

import json
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import Any, cast

import numpy as np

from ..references import MOST_BYTES, UnsafeReference

MAGIC = b"glTF"
GLB_HEAD = 20
"""Bytes before the JSON of a GLB: magic, version, length, then length and type of its first chunk."""
TYPES = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
"""What an accessor's numbers are, as numpy has them."""
COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
COMPRESSIONS = {"KHR_draco_mesh_compression": "DracoPy", "EXT_meshopt_compression": ""}
"""Extensions that keep vertices in a form of their own, and the Python package by which trimesh reads it; without it there are
zeros in their place."""

Json = dict[str, Any]


def gltf_document(path: Path) -> Json:
    """The JSON of a .gltf or .glb file.

    Raises ValueError where it is none or needs what nothing here reads, UnsafeReference where it fills more memory than it may.
    """
    with open(path, "rb") as file:
        head = file.read(GLB_HEAD)
        binary = head.startswith(MAGIC)
        text = file.read(int.from_bytes(head[12:16], "little")) if binary else head + file.read()
    document: object = json.loads(text.decode("utf-8-sig"))
    if not isinstance(document, dict):
        raise ValueError("its JSON is no object")
    found = cast(Json, document)
    _demand_readable(found)
    _demand_honest_accessors(found)
    return found


def accessor_values(document: Json, entry: Json, buffer: Callable[[int], bytes]) -> np.ndarray[Any, Any]:
    """The numbers of an accessor that has a bufferView, as they stand, shape (count, width).

    entry: the accessor.  buffer: the bytes of one by its number.  Raises ValueError or TypeError beyond its buffer, and as
    lists and dicts do where the document does not fit together.
    """
    view: Json = document["bufferViews"][entry["bufferView"]]
    kind: np.dtype[Any] = np.dtype(TYPES[entry["componentType"]])
    width, count = COMPONENTS[entry["type"]], int(entry["count"])
    step = view.get("byteStride") or kind.itemsize * width
    start, length = view.get("byteOffset", 0), view["byteLength"]
    if start < 0 or length < 0 or count < 0:
        raise ValueError("a negative size")
    held = buffer(int(view.get("buffer", 0)))[start : start + length]
    return np.ndarray((count, width), kind, held, entry.get("byteOffset", 0), (step, kind.itemsize))


def _demand_readable(document: Json) -> None:
    required = document.get("extensionsRequired")
    for extension, package in COMPRESSIONS.items():
        if isinstance(required, list) and extension in required and not (package and find_spec(package)):
            missing = f", and the Python package {package} is not installed" if package else ""
            raise ValueError(f"it is compressed by {extension}{missing}; export it without")


def _demand_honest_accessors(document: Json) -> None:
    """Accessors without a buffer are zeros: they take nothing in the file and any amount of memory."""
    try:
        zeros = sum(
            4 * entry["count"] * COMPONENTS[entry["type"]]
            for entry in document["accessors"]
            if "bufferView" not in entry
        )
        if zeros > MOST_BYTES:
            raise UnsafeReference(
                f"it holds {zeros} bytes of zeros without a buffer; at most {MOST_BYTES} are read"
            )
    except (LookupError, TypeError):
        return  # whoever reads it says what is wrong with it
