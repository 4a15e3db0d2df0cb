"""Numbers by which Unity finds an object again: made from what the object is in the source, never from its order."""

from __future__ import annotations

import hashlib
from collections import defaultdict
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

Words = NDArray[np.uint64]

_P1, _P2, _P3, _P4, _P5 = (
    np.uint64(prime)
    for prime in (
        0x9E3779B185EBCA87,
        0xC2B2AE3D27D4EB4F,
        0x165667B19E3779F9,
        0x85EBCA77C2B2AE63,
        0x27D4EB2F165667C5,
    )
)
_STARTS = (0x60EA27EEADC0B5D6, 0xC2B2AE3D27D4EB4F, 0, 0x61C8864E7A143579)
"""Of the four lanes: P1 + P2, P2, 0 and -P1."""
_POSITIVE = (1 << 63) - 1


def xxh64(data: bytes) -> int:
    """xxHash64 with seed 0, unsigned (Yann Collet, github.com/Cyan4973/xxHash): the hash of Unity's own importers."""
    return xxh64_each([data])[0]


def xxh64_each(texts: Sequence[bytes]) -> list[int]:
    """The hash of each, those of one length at once."""
    alike: dict[int, list[int]] = defaultdict(list)
    for i, data in enumerate(texts):
        alike[len(data)].append(i)
    found = [0] * len(texts)
    for length, members in alike.items():
        joined = np.frombuffer(b"".join([texts[i] for i in members]), dtype=np.uint8)
        for i, value in zip(members, _hashed(joined.reshape(len(members), length)).tolist()):
            found[i] = value
    return found


def _hashed(rows: NDArray[np.uint8]) -> Words:
    """Of texts of one length, shape (n, length); products and sums wrap at 64 bits."""
    count, length = rows.shape
    at = 0
    found = np.full(count, _P5)
    if length >= 32:
        lanes = [np.full(count, start, dtype=np.uint64) for start in _STARTS]
        while at <= length - 32:
            for i in range(4):
                lanes[i] = _round(lanes[i], _words(rows, at, 8))
                at += 8
        found = np.zeros(count, dtype=np.uint64)
        for lane, by in zip(lanes, (1, 7, 12, 18)):
            found += _turned(lane, by)
        for lane in lanes:
            found = (found ^ _round(np.zeros_like(lane), lane)) * _P1 + _P4
    found = found + np.uint64(length)
    while at <= length - 8:
        found ^= _round(np.zeros_like(found), _words(rows, at, 8))
        found = _turned(found, 27) * _P1 + _P4
        at += 8
    if at <= length - 4:
        found ^= _words(rows, at, 4) * _P1
        found = _turned(found, 23) * _P2 + _P3
        at += 4
    for byte in range(at, length):
        found = _turned(found ^ (rows[:, byte].astype(np.uint64) * _P5), 11) * _P1
    found = (found ^ (found >> np.uint64(33))) * _P2
    found = (found ^ (found >> np.uint64(29))) * _P3
    return found ^ (found >> np.uint64(32))


def _words(rows: NDArray[np.uint8], at: int, size: int) -> Words:
    """Little-endian words that begin at a byte, shape (n,).  size: bytes of each, 4 or 8."""
    return np.ascontiguousarray(rows[:, at : at + size]).view(f"<u{size}")[:, 0].astype(np.uint64)


def _round(lane: Words, word: Words) -> Words:
    return _turned(lane + word * _P2, 31) * _P1


def _turned(value: Words, by: int) -> Words:
    return value << np.uint64(by) | value >> np.uint64(64 - by)


class FileIds:
    """fileIDs of a prefab's objects: positive, each once."""

    def __init__(self) -> None:
        self._taken: set[int] = set()
        self._counts: dict[tuple[str, str], int] = {}

    def new(self, kind: str, identity: str) -> int:
        """kind: Unity's class.  identity: what the object is in the source; one that comes again gets a number behind it."""
        return self.each([(kind, identity)])[0]

    def each(self, objects: Sequence[tuple[str, str]]) -> list[int]:
        """Those of many objects, each (kind, identity), in this order."""
        counts, told = self._counts, list[bytes]()
        for known in objects:
            # Sixteen convex pieces are the same to the source.
            count = counts[known] = counts.get(known, 0) + 1
            told.append(_told(*known, count))
        return [self._free(known, value & _POSITIVE) for known, value in zip(objects, xxh64_each(told))]

    def _free(self, known: tuple[str, str], found: int) -> int:
        while not found or found in self._taken:
            count = self._counts[known] = self._counts[known] + 1
            found = xxh64(_told(*known, count)) & _POSITIVE
        self._taken.add(found)
        return found


def _told(kind: str, identity: str, count: int) -> bytes:
    tail = "" if count == 1 else f"#{count}"
    return f"Kinefab:{kind}->{identity}{tail}".encode("utf-8", "surrogatepass")


def guid(*identity: str) -> str:
    """32 hexadecimal digits for a file.  identity: the export's name, the kind of the file, what it is in the source."""
    return hashlib.md5(
        "\0".join(("Kinefab", *identity)).encode("utf-8", "surrogatepass"), usedforsecurity=False
    ).hexdigest()
