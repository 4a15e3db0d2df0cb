"""gzip of what is mostly hexadecimal, in blocks that are packed side by side.

Blocks have a fixed size and know nothing of each other, so that the bytes are the same for any number of threads; together they are
one member, which every reader of gzip takes.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from typing import BinaryIO

BLOCK = 1 << 20
"""Bytes of a block; what stands before it is not searched for repeats, which costs less than a hundredth."""
SAMPLE = 1 << 13
"""Bytes from a block's middle by which it is chosen how the block is packed."""
WORTH = 0.9
"""Of the size without a search for repeats: what the search has to reach to be worth its time, which is three times as long."""
LEVEL = 1
"""Of zlib: text of assets shrinks to within a twentieth of what the default level reaches, in half the time."""
MOST_THREADS = 4
_FLAG_NAME, _UNKNOWN_SYSTEM = 8, 255


class GzipStream:
    """Bytes that are appended, packed into ``out``; to be ended by ``finish``.  As a context it lets go of its threads.

    name: of the file within, in Latin-1, as gzip has it.  No time is said.  size: bytes that were appended.
    """

    def __init__(self, out: BinaryIO, name: str):
        self._out = out
        self._waiting = bytearray()
        self._crc, self.size = 0, 0
        self._threads = min(MOST_THREADS, os.cpu_count() or 1)
        self._pool: ThreadPoolExecutor | None = None
        self._packed: deque[Future[bytes]] = deque()
        out.write(struct.pack("<BBBBIBB", 0x1F, 0x8B, zlib.DEFLATED, _FLAG_NAME, 0, 4, _UNKNOWN_SYSTEM))
        out.write(name.encode("latin-1") + b"\0")

    def __enter__(self) -> GzipStream:
        return self

    def __exit__(self, *_: object) -> None:
        if self._pool is not None:
            self._pool.shutdown(cancel_futures=True)

    def write(self, data: bytes) -> None:
        """Append bytes; whole blocks are packed in threads."""
        self._crc = zlib.crc32(data, self._crc)
        self.size += len(data)
        self._waiting += data
        start = 0
        while len(self._waiting) - start >= BLOCK:
            self._hand_out(bytes(memoryview(self._waiting)[start : start + BLOCK]))
            start += BLOCK
        del self._waiting[:start]

    def finish(self) -> None:
        """Write what is left, and the end of the member."""
        while self._packed:
            self._out.write(self._packed.popleft().result())
        self._out.write(_packed(bytes(self._waiting), zlib.Z_FINISH))
        self._out.write(struct.pack("<II", self._crc, self.size & 0xFFFFFFFF))

    def _hand_out(self, block: bytes) -> None:
        if self._pool is None:
            self._pool = ThreadPoolExecutor(self._threads)
        while len(self._packed) > 2 * self._threads:
            self._out.write(self._packed.popleft().result())
        self._packed.append(self._pool.submit(_packed, block))


def _packed(block: bytes, end: int = zlib.Z_FULL_FLUSH) -> bytes:
    """Whole bytes of a deflated stream, which the next block's can follow."""
    middle = max(0, (len(block) - SAMPLE) // 2)
    sample = block[middle : middle + SAMPLE]
    searched, plain = (len(_deflated(sample, how, zlib.Z_FINISH)) for how in (_SEARCHED, _PLAIN))
    return _deflated(block, _SEARCHED if searched < WORTH * plain else _PLAIN, end)


_SEARCHED, _PLAIN = zlib.Z_DEFAULT_STRATEGY, zlib.Z_RLE


def _deflated(data: bytes, strategy: int, end: int) -> bytes:
    packer = zlib.compressobj(LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS, zlib.DEF_MEM_LEVEL, strategy)
    return packer.compress(data) + packer.flush(end)
