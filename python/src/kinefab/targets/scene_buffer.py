"""What a scene file keeps in its buffer: the numbers of meshes, and image files byte for byte."""

from __future__ import annotations

import hashlib
from typing import Any, BinaryIO

import numpy as np

from ..spatial import bounds
from ..unity.definitions import UV_SETS
from ..unity.scene import Mesh
from .numbers import plain_value

UINT16_VERTICES = 65535
"""Most vertices that Unity's 16-bit index format counts."""


class SceneBuffer:
    """Appends runs of values to a file, 4-byte aligned, and hashes what it writes."""

    def __init__(self, file: BinaryIO):
        self._file = file
        self.hash = hashlib.sha256()
        self.length = 0

    def append(self, values: np.ndarray, dtype: str) -> dict[str, int]:
        """The accessor of ``values``, written little-endian and tightly packed as ``dtype``."""
        packed = np.ascontiguousarray(values, dtype=np.dtype(dtype).newbyteorder("<"))
        return self.append_bytes(packed.reshape(-1).view(np.uint8).data)  # of no values too, whose shape has a zero

    def append_bytes(self, data: bytes | memoryview) -> dict[str, int]:
        """Where they begin."""
        offset = self.length
        for piece in filter(len, (data, bytes(-len(data) % 4))):
            self._file.write(piece)
            self.hash.update(piece)
            self.length += len(piece)
        return {"buffer": 0, "offset": offset}


def mesh_entry(mesh: Mesh, buffer: SceneBuffer) -> dict[str, Any]:
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
    numbers = {"normals": mesh.normals, **dict(zip(UV_SETS, mesh.uvs)), "tangents": mesh.tangents, "colors": mesh.colors}
    for name, values in numbers.items():
        if values is not None:
            found[name] = buffer.append(values, "f4")
    found["indexFormat"] = "uint16" if short else "uint32"
    found["indices"] = buffer.append(mesh.triangles, "u2" if short else "u4")
    starts = np.cumsum([0, *mesh.submeshes])[:-1]
    found["submeshes"] = [
        {"indexStart": 3 * int(s), "indexCount": 3 * int(n)} for s, n in zip(starts, mesh.submeshes)
    ]
    return found
