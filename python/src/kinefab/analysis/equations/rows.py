"""Builds the arrays of a ``System`` one equation at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model import FeatureKind
from ...spatial import Array
from .atoms import LENGTHS, Atom
from .system import System

NOWHERE = np.zeros(3)


@dataclass(frozen=True, slots=True, eq=False)
class Side:
    """One side of a constraint: a feature in the WORLD at the start pose.

    body: number of its body.  p: point, metres.  z: direction, or zeros where the feature has none.
    x, y: complete z to a right-handed frame; the feature's own where it states a secondary direction.
    framed: x is the source's own, not a choice of ours.
    """

    body: int
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

    axes: see ``System.axes``.
    """

    def __init__(self, axes: Array | None = None) -> None:
        self.axes = np.eye(3) if axes is None else axes
        self.owner = 0
        self._owners: list[int] = []
        self._is_length: list[bool] = []
        self._numbers: list[
            tuple[Atom, int, float, int, int, float]
        ] = []  # kind, row, weight, body_a, body_b, d
        self._vectors: list[tuple[Array, ...]] = []  # p_a, a, k, p_b, b

    def row(self, is_length: bool) -> int:
        self._owners.append(self.owner)
        self._is_length.append(is_length)
        return len(self._owners) - 1

    def atom(
        self,
        row: int,
        kind: Atom,
        a: int,
        b: int,
        *,
        p_a: Array = NOWHERE,
        dir_a: Array = NOWHERE,
        k: Array = NOWHERE,
        p_b: Array = NOWHERE,
        dir_b: Array = NOWHERE,
        d: float = 0.0,
        weight: float = 1.0,
    ) -> None:
        self._numbers.append((kind, row, weight, a, b, d))
        self._vectors.append((p_a, dir_a, k, p_b, dir_b))

    def plane(self, a: Side, normal: Array, b: Side, d: float = 0.0) -> None:
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
        """Everything collected, for bodies 0..bodies-1 (body 0: ground)."""
        count = len(self._numbers)
        numbers = np.array(self._numbers, dtype=float).reshape(count, 6).T
        vectors = np.array(self._vectors, dtype=float).reshape(count, 5, 3)
        kind, row, body_a, body_b = (numbers[i].astype(np.int64) for i in (0, 1, 3, 4))
        return System(
            kind=kind,
            row=row,
            weight=numbers[2],
            body_a=body_a,
            body_b=body_b,
            **{
                name: np.ascontiguousarray(vectors[:, i])
                for i, name in enumerate(("p_a", "a", "k", "p_b", "b"))
            },
            d=numbers[5],
            owner=np.array(self._owners, dtype=np.int64),
            is_length=np.array(self._is_length, dtype=bool),
            center=np.zeros((bodies, 3)),
            length=np.ones(bodies),
            row_length=np.ones(len(self._owners)),
            axes=self.axes,
        )


def has_direction(kind: FeatureKind) -> bool:
    return kind not in (FeatureKind.POINT, FeatureKind.SPHERE, FeatureKind.BODY)


def is_length(kind: Atom) -> bool:
    return kind in LENGTHS
