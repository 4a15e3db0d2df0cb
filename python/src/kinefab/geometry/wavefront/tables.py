"""The lines of an OBJ as tables: a pass of numpy over hundreds of megabytes, where a look at each line takes minutes."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...spatial import Array, BoolArray, IntArray

AT_ONCE = 2**14
"""Lines that are looked at together: what a processor keeps at hand."""
BLOCK = 2**20
"""Bytes in which line ends are looked for together."""
MOST_NUMBER = np.iinfo(np.int32).max
SPACE, LINE_END, SLASH = b" \n/"


class Lines:
    """The lines of a text that begins and ends with a line end, found by what they begin with.

    starts: of each line, where the line end before it is, shape (n,); one more for the text's end.
    """

    def __init__(self, text: bytes):
        self.text = text
        codes = np.frombuffer(text, np.uint8)
        self.starts: IntArray = np.concatenate(
            [
                np.flatnonzero(codes[start : start + BLOCK] == LINE_END) + start
                for start in range(0, len(codes), BLOCK)
            ]
        )
        begin = self.starts[:-1] + 1
        self._begin = np.zeros(len(begin), dtype=np.int32)  # the first three letters
        for k in range(3):
            self._begin <<= 8
            self._begin |= codes.take(begin + k, mode="clip")

    def of(self, word: bytes) -> bytes:
        """The lines that begin with a word of one or two letters and a space, each with the line end before it."""
        return self._joined(self.which(word + b" "))

    def parts_of(self, word: bytes) -> Iterator[bytes]:
        """The same, as many as are looked at together."""
        which = self.which(word + b" ")
        return (self._joined(which[k : k + AT_ONCE]) for k in range(0, len(which), AT_ONCE))

    def which(self, letters: bytes) -> IntArray:
        """The numbers of the lines that begin with one to three letters."""
        return np.flatnonzero(self._begin >> 8 * (3 - len(letters)) == int.from_bytes(letters, "big"))

    def _joined(self, which: IntArray) -> bytes:
        if not len(which):
            return b""
        breaks = np.flatnonzero(np.diff(which) != 1)
        first = which[np.concatenate([[0], breaks + 1])]
        last = which[np.concatenate([breaks, [-1]])]
        spans = zip(self.starts[first].tolist(), self.starts[last + 1].tolist())
        return b"".join([self.text[start:stop] for start, stop in spans])


@dataclass(frozen=True, slots=True, eq=False)
class Faces:
    """Polygons as fans of triangles.

    corners: the numbers that each corner of a triangle names, counted from 1, shape (t, 3, k).  triangles: how many each
    line gives, shape (lines,).  named: what the k are: 0 of a vertex, 1 of texture coordinates, 2 of a normal.
    """

    corners: IntArray
    triangles: NDArray[np.int32]
    named: tuple[int, ...]

    def of(self, noun: int) -> IntArray | None:
        """What the corners name of one of the three, shape (t, 3); None where they name none."""
        return self.corners[..., self.named.index(noun)] if noun in self.named else None


def numbers_of(lines: Lines, word: bytes) -> Array | None:
    """The numbers behind a word in each of its lines, shape (lines, numbers); None where not all have as many, or one is none."""
    found: list[Array] = []
    for part in lines.parts_of(word):
        words, before = _words(part)
        heads = words[before == LINE_END]
        values, count = _values(part, heads, len(word), np.float64), len(heads)
        if values is None or len(before) % count or len(values) != len(before) - count:
            return None
        if not (before.reshape(count, -1)[:, 0] == LINE_END).all():
            return None
        found.append(values.reshape(count, -1))
        if found[-1].shape[1] != found[0].shape[1]:
            return None
    return np.concatenate(found) if found else None


def faces_of(lines: Lines) -> Faces | None:
    """The faces; None where the corners do not all name the same, one counts from the end, or one is none."""
    corners: list[NDArray[np.int32]] = []
    sides: list[NDArray[np.int32]] = []
    named: set[tuple[int, ...]] = set()
    for part in lines.parts_of(b"f"):
        words, before = _words(part)
        heads, first = np.flatnonzero(before == LINE_END), np.flatnonzero(before == SPACE)
        values = _values(part, words[heads], 1, np.int64)
        if values is None or len(values) != len(before) - len(heads):
            return None
        if values.min(initial=1) < 1 or values.max(initial=1) > MOST_NUMBER:
            return None
        each = len(values) // max(1, len(first))
        doubled = part.count(b"//")
        if not 1 <= each <= 3 or each * len(first) != len(values) or doubled not in (0, len(first)):
            return None
        if (doubled and each != 2) or (np.delete(before, heads)[::each] != SPACE).any():
            return None
        named.add((0, 2) if doubled else tuple(range(each)))
        corners.append(values.reshape(-1, each).astype(np.int32))
        sides.append(np.diff(np.searchsorted(first, heads), append=len(first)).astype(np.int32))
    if len(named) > 1:
        return None
    if not named:
        return Faces(np.zeros((0, 3, 1), dtype=np.int64), np.zeros(0, dtype=np.int32), (0,))
    whole = np.concatenate(corners, dtype=np.int64)
    corners.clear()
    fans, triangles = _fans(whole, np.concatenate(sides))
    return Faces(fans, triangles, named.pop())


def _words(part: bytes) -> tuple[IntArray, np.ndarray]:
    """Where the words and numbers of lines begin, and the letter before each; a stroke parts them as a space does."""
    codes = np.frombuffer(part, np.uint8)
    inked: BoolArray = (codes > SPACE) & (codes != SLASH)
    before = np.flatnonzero(inked[1:] & ~inked[:-1])
    return before + 1, codes[before]


def _values(part: bytes, heads: IntArray, letters: int, kind: type[np.generic]) -> np.ndarray | None:
    """The numbers of lines in a row; None where one is none.  heads: where the lines' first words are, of so many letters."""
    codes = np.frombuffer(part, np.uint8).copy()
    for k in range(letters):
        codes[heads + k] = SPACE
    codes[codes == SLASH] = SPACE
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", DeprecationWarning)
            return np.fromstring(codes.tobytes(), kind, sep=" ")
    except (ValueError, DeprecationWarning):  # it could not be read to its end
        return None


def _fans(corners: IntArray, sides: NDArray[np.int32]) -> tuple[IntArray, NDArray[np.int32]]:
    """Polygons cut into triangles from their first corners, shape (t, 3, k), and how many each gives.

    corners: of one after another, shape (n, k).  sides: of each.
    """
    triangles = np.maximum(sides - 2, 0)
    if (sides == 3).all():
        return corners.reshape(-1, 3, corners.shape[1]), triangles
    first = np.repeat(np.cumsum(sides) - sides, triangles)
    further = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return corners[np.stack([first, first + further + 1, first + further + 2], axis=1)], triangles
