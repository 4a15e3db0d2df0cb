"""Constraints that tie one motion to another: screw, gear, belt, rack and linear coupling."""

from __future__ import annotations

import math

from ...model import Constraint, ConstraintKind
from .atoms import Atom
from .features import need_directions
from .rows import Rows, Side

COUPLED = frozenset((ConstraintKind.GEAR, ConstraintKind.BELT, ConstraintKind.RACK, ConstraintKind.LINEAR))
"""Constraints that keep two motions in step and join nothing else: they become couplings."""


def screw(rows: Rows, c: Constraint, a: Side, b: Side, *, context: object) -> None:
    """A cylindrical pair whose slide follows its turn: ``value`` metres a turn, counted from the exported pose."""
    need_directions(a, b)
    rows.parallel(a, b)
    rows.on_line(a, b)
    # C = z - lead/(2 pi) theta - const: one axial translation per turn, counted from the exported pose
    row = rows.row(True)
    slide(rows, row, a, b, 1.0)
    spin(rows, row, a, b, -c.value / math.tau)


def slide(rows: Rows, row: slice, a: Side, b: Side, weight: float) -> None:
    """weight * (translation of b along a's direction since the exported pose), added to a row."""
    rows.atom(
        row, Atom.PIP, a.body, b.body, p_a=a.p, dir_a=a.z, p_b=b.p, d=float(a.z @ (b.p - a.p)), weight=weight
    )


def spin(rows: Rows, row: slice, a: Side, b: Side, weight: float) -> None:
    """weight * (rotation of b about a's direction since the exported pose), added to a row."""
    rows.atom(row, Atom.ANG, a.body, b.body, dir_a=a.x, k=a.z, p_b=b.p, dir_b=a.x, d=0.0, weight=weight)


def coupled(
    rows: Rows, c: Constraint, a: Side, b: Side, carrier: Side | None = None, *, context: object
) -> None:
    """q_b = value * q_a, counted from the exported pose; the axes are carried by ``carrier`` (ground)."""
    need_directions(a, b)
    body = carrier.body if carrier is not None else 0
    turning = {
        ConstraintKind.GEAR: (spin, spin),
        ConstraintKind.BELT: (spin, spin),
        ConstraintKind.RACK: (spin, slide),
        ConstraintKind.LINEAR: (slide, slide),
    }[c.kind]
    row = rows.row(turning[1] is slide)
    for coordinate, side, weight in ((turning[0], a, -c.value), (turning[1], b, 1.0)):
        fixed = Side(body, side.p, side.z, side.x, side.y)
        coordinate(rows, row, fixed, side, weight)
