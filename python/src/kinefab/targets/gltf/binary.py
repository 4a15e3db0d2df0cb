"""The binary half of a GLB: arrays as accessors of one buffer."""

from __future__ import annotations

import hashlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

FLOAT, UINT16, UINT32 = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_BUFFER = 34962, 34963
SHAPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}


class Binary:
    """Chunks of the buffer with the JSON that speaks of them; what is there already is not written again."""

    def __init__(self) -> None:
        self.chunks: list[bytes] = []
        self.length = 0
        self.views: list[dict[str, Any]] = []
        self.accessors: list[dict[str, Any]] = []
        self._known: dict[tuple[bytes, int, int | None], int] = {}

    def view(self, data: bytes, target: int | None = None) -> int:
        """Index of a buffer view of these bytes."""
        entry: dict[str, Any] = {"buffer": 0, "byteOffset": self.length, "byteLength": len(data)}
        if target is not None:
            entry["target"] = target
        self.views.append(entry)
        padded = data + bytes(-len(data) % 4)
        self.chunks.append(padded)
        self.length += len(padded)
        return len(self.views) - 1

    def floats(self, values: NDArray[Any], *, vertex: bool = True, bounded: bool = False) -> int:
        """Accessor of float32 values, shape (n,) or (n, k).  bounded: with least and greatest, as positions and times want."""
        array = np.ascontiguousarray(values, dtype="<f4")
        return self._accessor(array, FLOAT, ARRAY_BUFFER if vertex else None, bounded)

    def indices(self, faces: NDArray[Any], vertices: int) -> int:
        """Accessor of triangles, shape (m, 3)."""
        short = vertices <= 0xFFFF  # the greatest index is what restarts a primitive
        array = np.ascontiguousarray(faces.reshape(-1), dtype="<u2" if short else "<u4")
        return self._accessor(array, UINT16 if short else UINT32, ELEMENT_BUFFER, False)

    def _accessor(self, array: NDArray[Any], kind: int, target: int | None, bounded: bool) -> int:
        data = array.tobytes()
        key = (hashlib.sha256(data).digest(), kind * 10 + (array.shape[1] if array.ndim > 1 else 1), target)
        columns = array.reshape(len(array), -1)
        if key in self._known:  # of a mesh whose places are another's normals, say
            if bounded:
                self.accessors[self._known[key]] |= _bounds(columns)
            return self._known[key]
        entry: dict[str, Any] = {
            "bufferView": self.view(data, target),
            "componentType": kind,
            "count": len(array),
            "type": SHAPES[columns.shape[1]],
        }
        if bounded:
            entry |= _bounds(columns)
        self.accessors.append(entry)
        self._known[key] = len(self.accessors) - 1
        return self._known[key]


def _bounds(columns: NDArray[Any]) -> dict[str, Any]:
    return {"min": columns.min(axis=0).tolist(), "max": columns.max(axis=0).tolist()}
