"""Builds the arrays of a ``System``, one equation at a time or a stack of alike ones at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model import FeatureKind
from ...spatial import Array, IntArray
from .atoms import Atom
from .system import System

NOWHERE = np.zeros(3)


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """One side of a constraint: a feature in the WORLD at the start pose.

    body: number of its body.  p: point, metres.  z: direction, or zeros where the feature has none.
    x, y: complete z to a right-handed frame; the feature's own where it states a secondary direction.
    framed: x is the source's own, not a choice of ours.
    Of a stack of constraints: body has shape (n,), p, x, y, z have (n, 3), and the rest is the same for all.
    """

    body: int | IntArray
    p: Array
    z: Array
    x: Array
    y: Array
    kind: FeatureKind = FeatureKind.POINT
    radius: float = 0.0
    half_angle: float = 0.0
    framed: bool = False


class Rows:
    """Collects equations; ``owner`` is the number of the statement that the next ones belong to.

    Where it is an array of n numbers, each equation is n of them, one of each statement: numpy's cost of a call is
    then paid once for all constraints of a kind.  ``system`` brings them into the order of the statements.
    axes: see ``System.axes``.
    """

    def __init__(self, axes: Array | None = None) -> None:
        self.axes = np.eye(3) if axes is None else axes
        self.owner: int | IntArray = 0
        self._count = 0
        self._rows: list[tuple[slice, int | IntArray, bool]] = []  # rows, owner, is_length
        self._numbers: list[
            tuple[slice, Atom, float, int | IntArray, int | IntArray, float | Array]
        ] = []  # rows, kind, weight, body_a, body_b, d
        self._vectors: list[tuple[Array, ...]] = []  # p_a, a, k, p_b, b

    def row(self, is_length: bool) -> slice:
        """The number of a new row, as a slice: of a stack, those of one new row each."""
        first = self._count
        self._count += self.owner.size if isinstance(self.owner, np.ndarray) else 1
        row = slice(first, self._count)
        self._rows.append((row, self.owner, is_length))
        return row

    def atom(
        self,
        row: slice,
        kind: Atom,
        a: int | IntArray,
        b: int | IntArray,
        *,
        p_a: Array = NOWHERE,
        dir_a: Array = NOWHERE,
        k: Array = NOWHERE,
        p_b: Array = NOWHERE,
        dir_b: Array = NOWHERE,
        d: float | Array = 0.0,
        weight: float = 1.0,
    ) -> None:
        """Add ``weight`` times an atom between bodies a and b to a row; the arguments are the atom's own, WORLD at the
        start pose, metres."""
        self._numbers.append((row, kind, weight, a, b, d))
        self._vectors.append((p_a, dir_a, k, p_b, dir_b))

    def plane(self, a: Side, normal: Array, b: Side, d: float | Array = 0.0) -> None:
        """Point of b at height d over the plane of a with this normal."""
        self.atom(self.row(True), Atom.PIP, a.body, b.body, p_a=a.p, dir_a=normal, p_b=b.p, d=d)

    def point(self, a: Side, b: Side) -> None:
        """Point of b on the point of a."""
        for axis in self.axes.T:
            self.plane(a, axis, b)

    def on_line(self, a: Side, b: Side) -> None:
        """Point of b on the line of a."""
        self.plane(a, a.x, b)
        self.plane(a, a.y, b)

    def dot(self, a: Side, along_a: Array, b: Side, along_b: Array, d: float = 0.0) -> None:
        """A row of its own: the cosine between a direction on each side, both unit, is d."""
        self.atom(
            self.row(False), Atom.DOT, a.body, b.body, p_a=a.p, dir_a=along_a, p_b=b.p, dir_b=along_b, d=d
        )

    def parallel(self, a: Side, b: Side) -> None:
        """The directions of a and b parallel, either way round."""
        self.dot(a, a.x, b, b.z)
        self.dot(a, a.y, b, b.z)

    def angle(self, a: Side, along_a: Array, about: Array, b: Side, along_b: Array, d: float) -> None:
        """Angle from a direction of a to one of b about an axis of a, radians."""
        row = self.row(False)
        self.atom(row, Atom.ANG, a.body, b.body, p_a=a.p, dir_a=along_a, k=about, p_b=b.p, dir_b=along_b, d=d)

    def system(self, bodies: int) -> System:
        """Everything collected, for bodies 0..bodies-1 (body 0: ground), rows and their atoms by owner."""
        owner = np.empty(self._count, dtype=np.int64)
        is_length = np.empty(self._count, dtype=bool)
        for rows, own, lengths in self._rows:
            owner[rows], is_length[rows] = own, lengths
        count = sum(rows.stop - rows.start for rows, *_ in self._numbers)
        kind, row, body_a, body_b = np.empty((4, count), dtype=np.int64)
        weight, d = np.empty((2, count))
        vectors = np.empty((5, count, 3))
        at = 0
        for (rows, *numbers), own in zip(self._numbers, self._vectors):
            here = slice(at, at + rows.stop - rows.start)
            row[here] = np.arange(rows.start, rows.stop)
            kind[here], weight[here], body_a[here], body_b[here], d[here] = numbers
            for of_all, vector in zip(vectors, own):
                of_all[here] = vector
            at = here.stop
        order = np.argsort(owner, kind="stable")
        number = np.empty_like(order)
        number[order] = np.arange(len(order))
        atoms = np.argsort(number[row], kind="stable")
        p_a, a, k, p_b, b = vectors[:, atoms]
        return System(
            kind=kind[atoms],
            row=number[row[atoms]],
            weight=weight[atoms],
            body_a=body_a[atoms],
            body_b=body_b[atoms],
            p_a=p_a,
            a=a,
            k=k,
            p_b=p_b,
            b=b,
            d=d[atoms],
            owner=owner[order],
            is_length=is_length[order],
            center=np.zeros((bodies, 3)),
            length=np.ones(bodies),
            row_length=np.ones(len(owner)),
            axes=self.axes,
        )


def has_direction(kind: FeatureKind) -> bool:
    return kind not in (FeatureKind.POINT, FeatureKind.SPHERE, FeatureKind.BODY)
