"""Numbers of the page as one compressed run of bytes, with references into it."""

from __future__ import annotations

import base64
import zlib
from typing import Any

import numpy as np

Reference = dict[str, Any]


class Blob:
    """Appends arrays, 8-byte aligned, little-endian."""

    def __init__(self) -> None:
        self._pieces: list[bytes] = []
        self._length = 0

    def add(self, values: Any, kind: str) -> Reference:
        """Where the values stand: ``t`` (f4, f8, u2, u4 or i4), ``o``, the offset in bytes, and ``n``, their number."""
        array = np.ascontiguousarray(values, dtype=np.dtype(kind).newbyteorder("<")).ravel()
        reference = {"t": kind, "o": self._length, "n": int(array.size)}
        data = array.tobytes()
        self._pieces.append(data + bytes(-len(data) % 8))
        self._length += len(self._pieces[-1])
        return reference

    def text(self) -> str:
        """Everything added: zlib, then base64."""
        return base64.b64encode(zlib.compress(b"".join(self._pieces), 6)).decode("ascii")
