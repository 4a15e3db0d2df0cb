"""Points and lines at a distance from each other."""

from __future__ import annotations

import math

import numpy as np

from ...spatial import cross
from .atoms import Atom
from .rows import Rows, Side

PARALLEL_SINE = 1e-3
"""Below this sine two directions of the exported pose count as meant to be parallel."""


def apart(rows: Rows, a: Side, b: Side, d: float) -> None:
    """Two points d metres apart: one row, or three where d is zero."""
    if d == 0.0:
        rows.point(a, b)
    else:
        rows.atom(rows.row(True), Atom.DIST, a.body, b.body, p_a=a.p, p_b=b.p, d=d)


def off_line(rows: Rows, line: Side, point: Side, d: float) -> None:
    """A point d metres off a line: one row, or two where d is zero."""
    if d == 0.0:
        rows.on_line(line, point)
    else:
        rows.atom(rows.row(True), Atom.PLD, line.body, point.body, p_a=line.p, dir_a=line.z, p_b=point.p, d=d)


def lines_apart(rows: Rows, a: Side, b: Side, d: float, reading: str | None) -> None:
    """Two lines d metres apart.  reading: "parallel" (they are held parallel too) or "skew" (the common normal alone);
    None: as they stand now."""
    normal = cross(a.z, b.z)
    if reading is None:
        reading = "parallel" if np.linalg.norm(normal) < PARALLEL_SINE else "skew"
    if reading == "parallel":
        rows.parallel(a, b)
        off_line(rows, a, b, d)
    else:
        measured = float(normal @ (b.p - a.p))
        rows.atom(
            rows.row(True),
            Atom.LLD,
            a.body,
            b.body,
            p_a=a.p,
            dir_a=a.z,
            p_b=b.p,
            dir_b=b.z,
            d=math.copysign(d, measured),
        )
