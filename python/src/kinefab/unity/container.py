"""One file for a scene and its buffer: a header, a chunk of text and a chunk of numbers, as a GLB has them.

Little-endian: "KFAB", the container's version, the file's length; then each chunk's length, a multiple of four, its kind, its data.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import BinaryIO

MAGIC = b"KFAB"
"""First bytes of a scene in one file; no JSON text begins so."""
VERSION = 1
JSON, BUFFER = b"JSON", b"BIN\0"
MOST_BYTES = 2**32 - 1
"""Of a file: its length is written in 32 bits."""
PIECE = 1 << 20

_HEADER, _CHUNK = struct.Struct("<4sII"), struct.Struct("<I4s")


class Damaged(ValueError):
    """Why a container cannot be read."""


class OtherVersion(Damaged):
    """It is of a version that is not known here."""

    def __init__(self, version: int):
        super().__init__(f"its container has version {version}, not {VERSION}")
        self.version = version


def is_container(content: bytes) -> bool:
    """Whether a file is one, by its first bytes."""
    return content[: len(MAGIC)] == MAGIC


def chunks_of(content: bytes) -> tuple[memoryview, memoryview | None]:
    """The text and the buffer with its padding, None where there is none; both are views.  Raises Damaged."""
    if len(content) < _HEADER.size:
        raise Damaged("its container ends in the header")
    _, version, length = _HEADER.unpack_from(content)
    if version != VERSION:
        raise OtherVersion(version)
    if length != len(content):
        raise Damaged(f"its container states {length} bytes and has {len(content)}")
    found: dict[bytes, memoryview] = {}
    whole, at = memoryview(content), _HEADER.size
    while at < length:
        if length - at < _CHUNK.size:
            raise Damaged("its container ends in the head of a chunk")
        size, kind = _CHUNK.unpack_from(content, at)
        at += _CHUNK.size
        if size % 4 or size > length - at:
            raise Damaged(f"a chunk of its container has {size} bytes, and {length - at} are left")
        if not found and kind != JSON:
            raise Damaged("the first chunk of its container is no JSON")
        if kind in found:
            raise Damaged("its container has a chunk twice")
        if kind in (JSON, BUFFER):  # others are a later version's, to be stepped over
            found[kind] = whole[at : at + size]
        at += size
    if JSON not in found:
        raise Damaged("its container holds nothing")
    return found[JSON], found.get(BUFFER)


def write_container(file: BinaryIO, pieces: Iterable[bytes], buffer: BinaryIO | None) -> None:
    """Write a container to a file that can be sought in.  pieces: of the text.  buffer: read from where it stands.

    Raises OverflowError where it would be longer than its header can say.
    """
    file.write(_HEADER.pack(MAGIC, VERSION, 0))
    length = _HEADER.size + _write_chunk(file, _HEADER.size, JSON, pieces, b" ")
    if buffer is not None:
        length += _write_chunk(file, length, BUFFER, iter(lambda: buffer.read(PIECE), b""), b"\0")
    file.seek(0)
    file.write(_HEADER.pack(MAGIC, VERSION, length))
    file.seek(length)


def _write_chunk(file: BinaryIO, start: int, kind: bytes, pieces: Iterable[bytes], filler: bytes) -> int:
    """Its length with its head."""
    file.write(_CHUNK.pack(0, kind))
    size = 0
    for piece in pieces:
        file.write(piece)
        size += len(piece)
    file.write(filler * (-size % 4))
    size += -size % 4
    if start + _CHUNK.size + size > MOST_BYTES:
        raise OverflowError(f"it would have more than {MOST_BYTES} bytes, which one file cannot; write it as text")
    file.seek(start)
    file.write(_CHUNK.pack(size, kind))
    file.seek(start + _CHUNK.size + size)
    return _CHUNK.size + size
