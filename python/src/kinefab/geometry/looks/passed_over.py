"""Looks that a mesh file states and trimesh passes over: told, or, of STL, read here."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...spatial import IntArray

OF_COLLADA = {
    "colors of vertices": (re.compile(rb"""semantic\s*=\s*["']COLOR["']"""), "its materials alone are shown"),
    "textures of emission": (re.compile(rb"<emission\b[^>]*>\s*<texture\b"), "what glows is left out"),
}
"""What finds it in a file, and what becomes of it."""
TRANSPARENCY = re.compile(rb"<transparency\b[^>]*>\s*<float\b[^>]*>\s*([-+.0-9eE]+)")
OF_3MF = re.compile(rb"""\b(?:displaycolor|color)\s*=\s*["']#""")
MAGICS = b"COLOR="
"""What the head of an STL holds that states colours as Materialise Magics does; others do it as VisCAM."""
OWN = 0x8000
"""Bit of a triangle that has a colour of its own, by VisCAM; by Magics of one that has none."""


def tell_collada(path: Path, report: Report, where: str) -> None:
    content = path.read_bytes()
    for what, (found, detail) in OF_COLLADA.items():
        if found.search(content):
            report.dropped(what, "MESH_LOOK", where, what=what, path=path.name, detail=detail)
    shares = {float(share) for share in TRANSPARENCY.findall(content) if _is_number(share)}
    if any(0.0 < share < 1.0 for share in shares):  # by mistake many write 0 for what is seen whole
        what, detail = (
            "transparency",
            "programs do not agree on what it says, so its materials are seen whole",
        )
        report.dropped(what, "MESH_LOOK", where, what=what, path=path.name, detail=detail)


def tell_3mf(heads: Iterable[bytes], path: Path, report: Report, where: str) -> None:
    """heads: of its models."""
    if any(OF_3MF.search(head) for head in heads):
        detail = "they are not read, so its bodies have none"
        report.dropped("colors", "MESH_LOOK", where, what="colors", path=path.name, detail=detail)


def colors_of_stl(marks: IntArray, head: bytes) -> IntArray | None:
    """Of the triangles of a binary STL, sRGB RGBA of 0..255, shape (m, 4); None where it states none.

    marks: of each triangle the two bytes behind its corners, as one number.  head: the first 80 bytes.
    """
    magics = head.find(MAGICS)
    stated = (marks & OWN != 0) ^ (magics >= 0)
    if not stated.any() or magics < 0 and not stated.all():
        return None
    fives = np.stack([marks >> shift & 31 for shift in ((0, 5, 10) if magics >= 0 else (10, 5, 0))], axis=1)
    found = np.column_stack([(fives * 255 + 15) // 31, np.full(len(marks), 255)])
    if magics >= 0 and len(whole := head[magics + len(MAGICS) :][:4]) == 4:
        found[~stated] = list(whole)
    return found


def _is_number(text: bytes) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True
