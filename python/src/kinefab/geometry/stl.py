"""Whether an STL file is whole: trimesh takes a binary one that is cut short for text without triangles."""

from __future__ import annotations

import struct
from pathlib import Path

HEAD = 84
"""Bytes before the first triangle of a binary file: 80 of any kind, then the count of triangles."""
TRIANGLE = 50
LAST = 1 << 16
"""Bytes of its start and its end that are looked at."""
INSIDE = (b"solid", b"facet", b"outer", b"vertex", b"endloop", b"endfacet")


def demand_whole_stl(path: Path) -> None:
    """Raise ValueError, with the place where it ends, for a file that is cut short or whose count is not that of its bytes."""
    size = path.stat().st_size
    with path.open("rb") as stream:
        head = stream.read(HEAD)
        start = stream.read(LAST)
        stream.seek(max(0, size - LAST))
        end = stream.read()
    if b"\0" not in head + start:
        _demand_end(end, size)
        return
    if size < HEAD:
        raise ValueError(f"it ends at byte {size}, inside the {HEAD} bytes of its head")
    (count,) = struct.unpack_from("<I", head, 80)
    whole = HEAD + TRIANGLE * count
    if size < whole:
        raise ValueError(f"it ends at byte {size} of {whole}, those of the {count} triangles that its head counts")
    if size > whole:
        raise ValueError(
            f"its head counts {count} triangles, which end at byte {whole}; the file goes on to byte {size}"
        )


def _demand_end(end: bytes, size: int) -> None:
    """Of a text: a solid that is begun is ended.  end: the last bytes, of a text of ``size``."""
    closed, begun = -1, -1
    for number, line in enumerate(end.lower().splitlines()):
        word = line.split(maxsplit=1)[:1]
        if word == [b"endsolid"]:
            closed = number
        elif word and word[0] in INSIDE:
            begun = number
    if begun > closed:
        raise ValueError(f"it ends at byte {size}, before the line 'endsolid'")
