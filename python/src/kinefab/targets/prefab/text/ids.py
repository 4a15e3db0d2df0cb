"""Numbers by which Unity finds an object again: made from what the object is in the source, never from its order."""

from __future__ import annotations

import hashlib

_P1, _P2, _P3 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9
_P4, _P5 = 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5
_MASK = (1 << 64) - 1
_POSITIVE = (1 << 63) - 1


def xxh64(data: bytes) -> int:
    """xxHash64 with seed 0, unsigned (Yann Collet, github.com/Cyan4973/xxHash): the hash of Unity's own importers."""
    length, at = len(data), 0
    if length >= 32:
        lanes = [(_P1 + _P2) & _MASK, _P2, 0, -_P1 & _MASK]
        while at <= length - 32:
            for i in range(4):
                lanes[i] = _round(lanes[i], int.from_bytes(data[at : at + 8], "little"))
                at += 8
        found = sum(_turned(lane, by) for lane, by in zip(lanes, (1, 7, 12, 18))) & _MASK
        for lane in lanes:
            found = ((found ^ _round(0, lane)) * _P1 + _P4) & _MASK
    else:
        found = _P5
    found = (found + length) & _MASK
    while at <= length - 8:
        found ^= _round(0, int.from_bytes(data[at : at + 8], "little"))
        found = (_turned(found, 27) * _P1 + _P4) & _MASK
        at += 8
    if at <= length - 4:
        found ^= int.from_bytes(data[at : at + 4], "little") * _P1 & _MASK
        found = (_turned(found, 23) * _P2 + _P3) & _MASK
        at += 4
    for byte in data[at:]:
        found = _turned(found ^ (byte * _P5 & _MASK), 11) * _P1 & _MASK
    found = (found ^ (found >> 33)) * _P2 & _MASK
    found = (found ^ (found >> 29)) * _P3 & _MASK
    return found ^ (found >> 32)


def _round(lane: int, word: int) -> int:
    return _turned((lane + word * _P2) & _MASK, 31) * _P1 & _MASK


def _turned(value: int, by: int) -> int:
    return (value << by | value >> (64 - by)) & _MASK


def imported_id(kind: str, identifier: str) -> int:
    """The fileID that Unity gives an object of an imported file, signed: ``Type:Mesh->meshes/lever0``."""
    found = xxh64(f"Type:{kind}->{identifier}0".encode())
    return found - (1 << 64) if found > _POSITIVE else found


class FileIds:
    """fileIDs of a prefab's objects: positive, each once."""

    def __init__(self) -> None:
        self._taken: set[int] = set()
        self._counts: dict[tuple[str, str], int] = {}

    def new(self, kind: str, identity: str) -> int:
        """kind: Unity's class.  identity: what the object is in the source; one that comes again gets a number behind it."""
        count = self._counts.get((kind, identity), 0) + 1  # sixteen convex pieces are the same to the source
        while True:
            told = identity if count == 1 else f"{identity}#{count}"
            found = xxh64(f"Kinefab:{kind}->{told}".encode("utf-8", "surrogatepass")) & _POSITIVE
            if found and found not in self._taken:
                self._taken.add(found)
                self._counts[kind, identity] = count
                return found
            count += 1


def guid(*identity: str) -> str:
    """32 hexadecimal digits for a file.  identity: the export's name, the kind of the file, what it is in the source."""
    return hashlib.md5(
        "\0".join(("Kinefab", *identity)).encode("utf-8", "surrogatepass"), usedforsecurity=False
    ).hexdigest()
