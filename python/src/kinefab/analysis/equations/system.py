"""All equations of an assembly as arrays, and their residuals and Jacobians at any pose.

A body is whatever moves as one.  Its state is a displacement from the start pose: a point x of it is
at R (x - g) + g + u, with g a fixed point near the body's own geometry, so that lever arms stay short
in assemblies far from the origin.  Body 0 never moves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, cast

import numpy as np

from ...spatial import Array, BoolArray, IntArray, cross, skew
from .atoms import LENGTHS, USED, Atom, Valued, evaluate

IN_ONE_PLACE = 1e-5
"""Geometry within this fraction of the assembly's size, a few roundings of the export, is one point."""
DEFAULT_SHARE = 0.1
"""Length of a part whose geometry is in one place, as a fraction of the whole assembly's."""

_OF_ATOMS = ("kind", "weight", "body_a", "body_b", "p_a", "a", "k", "p_b", "b", "d")
"""Arrays of a ``System`` with an entry for each atom, ``row`` left out."""
_OF_ROWS = ("owner", "is_length", "row_length")
"""Those with an entry for each row."""


@dataclass(slots=True, eq=False)
class State:
    """Displacements of the bodies from the start pose.

    rotation: shape (n, 3, 3).  shift: shape (n, 3), metres, of the bodies' own points g.
    angle: shape (atoms,), radians, the last value of each ANG, so that a coupling counts whole turns; of other
    atoms nothing.  at_start: nothing is displaced, so that no geometry need be moved.
    """

    rotation: Array
    shift: Array
    angle: Array
    at_start: bool = False

    def copy(self) -> State:
        return State(self.rotation.copy(), self.shift.copy(), self.angle.copy())


@dataclass(slots=True, eq=False)
class System:
    """Equations sum(weight * atom) = 0, one for each row.

    kind, row, body_a, body_b: shape (atoms,).  p_a, a, k, p_b, b: shape (atoms, 3), WORLD at the start
    pose.  d, weight: shape (atoms,); the weight turns an atom's unit into the row's.
    owner: shape (rows,), the constraint a row belongs to.  is_length: shape (rows,), whether its
    residual is in metres (else radians or a cosine).  center: shape (bodies, 3), the points g.
    length: shape (bodies,), metres, the size of each body's surroundings; it balances lengths against
    angles in a body's twist (v / length, w).  row_length: shape (rows,), the same for residuals.
    axes: shape (3, 3), columns, WORLD: in these a direction is chosen where the geometry leaves it open, so
    that the choice moves with the assembly.
    """

    kind: IntArray
    row: IntArray
    weight: Array
    body_a: IntArray
    body_b: IntArray
    p_a: Array
    a: Array
    k: Array
    p_b: Array
    b: Array
    d: Array
    owner: IntArray
    is_length: BoolArray
    center: Array
    length: Array
    row_length: Array
    axes: Array = field(default_factory=lambda: np.eye(3))

    @property
    def rows(self) -> int:
        return len(self.owner)

    @property
    def bodies(self) -> int:
        return len(self.center)

    def start(self) -> State:
        n = self.bodies
        state = State(
            np.broadcast_to(np.eye(3), (n, 3, 3)).copy(), np.zeros((n, 3)), np.zeros(len(self.kind)), True
        )
        self.remember(state)
        return state

    def select(self, rows: IntArray | BoolArray) -> System:
        """The same bodies with some of the rows (a mask or sorted indices)."""
        chosen = np.zeros(self.rows, dtype=bool)
        chosen[rows] = True
        number = np.cumsum(chosen) - 1
        atoms = chosen[self.row]
        return replace(self, row=number[self.row[atoms]], **self._arrays_of(atoms, chosen))

    def part(self, atoms: IntArray, rows: IntArray, bodies: IntArray) -> System:
        """Some rows with all their atoms, and only their bodies, numbered from 1 on; all other bodies are at rest.

        atoms, rows, bodies: ascending."""
        number = np.zeros(self.bodies, dtype=np.int64)
        number[bodies] = np.arange(1, len(bodies) + 1)
        kept = np.concatenate([[0], bodies])
        ends = {"body_a": number[self.body_a[atoms]], "body_b": number[self.body_b[atoms]]}
        own = {"center": self.center[kept], "length": self.length[kept]}
        return replace(
            self, row=np.searchsorted(rows, self.row[atoms]), **self._arrays_of(atoms, rows) | ends | own
        )

    def _arrays_of(self, atoms: IntArray | BoolArray, rows: IntArray | BoolArray) -> dict[str, Any]:
        """Every array of some atoms and rows but ``row``, whose numbers are to be found anew."""
        return {f: getattr(self, f)[atoms] for f in _OF_ATOMS} | {f: getattr(self, f)[rows] for f in _OF_ROWS}

    def joining(self) -> BoolArray:
        """Rows that join different bodies (a mask); the others are inside one."""
        across = np.zeros(self.rows, dtype=bool)
        across[self.row[self.body_a != self.body_b]] = True
        return across

    def folded(self, rows: BoolArray) -> System:
        """Without those atoms of some rows (a mask) that are inside one body: what they come to at the start pose goes
        into another atom of the row, so that the row is between the bodies that are left.

        Rows wholly inside one body stay as they are.
        """
        inside = (self.body_a == self.body_b) & (rows & self.joining())[self.row]
        if not inside.any():
            return self
        value = self.weight * self.values(self.start())[0]
        constant = summed(self.row[inside], value[inside], self.rows)
        row, d = self.row[~inside], self.d[~inside].copy()
        folded, first = np.unique(row, return_index=True)
        d[first] -= constant[folded] / self.weight[~inside][first]
        return replace(self, row=row, **self._arrays_of(~inside, np.arange(self.rows)) | {"d": d})

    def relabel(self, body: IntArray) -> System:
        """Other body numbers: ``body[old]``.  Sizes and own points are to be set anew (``fit``)."""
        count = int(body.max()) + 1
        return replace(
            self,
            body_a=body[self.body_a],
            body_b=body[self.body_b],
            center=np.zeros((count, 3)),
            length=np.ones(count),
        )

    def fit(self, row_part: IntArray, body_part: IntArray, default: float) -> None:
        """Set own points, lengths and row lengths from the geometry at the start pose.

        row_part, body_part: the independent part that each row and body belongs to, -1 for none.
        default: metres, for parts whose geometry is all in one place.
        """
        pointed = np.isin(self.kind, LENGTHS)
        part = row_part[self.row]
        count = max(int(row_part.max(initial=-1)), int(body_part.max(initial=-1))) + 2
        sides = [(self.p_a, self.body_a), (self.p_b, self.body_b)]
        points, bodies = (np.concatenate([side[pointed] for side in own]) for own in zip(*sides))
        count_of = np.maximum(np.bincount(bodies, minlength=self.bodies), 1)
        for i in range(3):
            self.center[:, i] = summed(bodies, points[:, i], self.bodies) / count_of
        where = np.concatenate([part[pointed]] * 2) + 1
        low, high = np.full((count, 3), np.inf), np.full((count, 3), -np.inf)
        np.minimum.at(low, where, points)
        np.maximum.at(high, where, points)
        reach = 0.5 * np.linalg.norm(np.maximum(high - low, 0.0), axis=1)
        size = np.where(reach > IN_ONE_PLACE * default, reach, DEFAULT_SHARE * default)
        self.length = size[body_part + 1]
        self.row_length = size[row_part + 1]

    def current(
        self, state: State, atoms: IntArray, used: str = "p_a a k p_b b"
    ) -> tuple[Array, Array, Array, Array, Array]:
        """The geometry p_a, a, k, p_b, b of some atoms, WORLD, at a pose.

        used: names of those that are asked for; the others are given as they are at the start pose."""
        if state.at_start:
            geometry = self.p_a, self.a, self.k, self.p_b, self.b
            p_a, a, k, p_b, b = (own.take(atoms, axis=0) for own in geometry)
            return p_a, a, k, p_b, b
        sides = {"a": self.body_a.take(atoms), "b": self.body_b.take(atoms)}
        rotation = {end: state.rotation.take(body, axis=0) for end, body in sides.items()}

        def moved(name: str, end: str) -> Array:
            own: Array = getattr(self, name).take(atoms, axis=0)
            if name not in used.split():
                return own
            if name[0] != "p":
                return np.einsum("nij,nj->ni", rotation[end], own)
            body = sides[end]
            center = self.center.take(body, axis=0)
            arm = np.einsum("nij,nj->ni", rotation[end], own - center)
            return arm + center + state.shift.take(body, axis=0)

        return moved("p_a", "a"), moved("a", "a"), moved("k", "a"), moved("p_b", "b"), moved("b", "b")

    def values(self, state: State, kinds: tuple[Atom, ...] = tuple(Atom)) -> Valued:
        """Residuals and wrenches of every atom in its own unit."""
        m = len(self.kind)
        value, f, c, tau = np.zeros(m), np.zeros((m, 3)), np.zeros((m, 3)), np.zeros((m, 3))
        for kind in kinds:
            atoms = np.flatnonzero(self.kind == kind)
            if len(atoms):
                value[atoms], f[atoms], c[atoms], tau[atoms] = evaluate(
                    kind, *self.current(state, atoms, USED[kind]), self.d[atoms]
                )
                if kind is Atom.ANG:
                    last = state.angle[atoms] - self.d[atoms]
                    value[atoms] = last + np.remainder(value[atoms] - last + np.pi, math.tau) - np.pi
        return value, f, c, tau

    def remember(self, state: State) -> None:
        """Note the angles of this pose as the ones further motion is counted from."""
        state.angle = self.values(state, (Atom.ANG,))[0] + self.d

    def scale(self) -> Array:
        """Factor from each atom's unit to its row's scaled residual, shape (atoms,)."""
        return self.weight / np.where(self.is_length, self.row_length, 1.0)[self.row]

    def residual(self, state: State) -> Array:
        """Shape (rows,): lengths as fractions of ``row_length``, angles in radians."""
        return summed(self.row, self.scale() * self.values(state)[0], self.rows)

    def linearise(self, state: State) -> tuple[Array, Array, Array]:
        """Residual (rows,) and each atom's Jacobian blocks (atoms, 6) for bodies a and b.

        The blocks act on scaled twists (v / length, w) of the bodies about their own points g.
        """
        value, f, c, tau = self.values(state)
        s = self.scale()
        origin = self.center + state.shift

        def block(body: IntArray) -> Array:
            force = f * (s * self.length[body])[:, None]
            return np.concatenate([force, (cross(c - origin[body], f) + tau) * s[:, None]], axis=1)

        residual = summed(self.row, s * value, self.rows)
        return residual, -block(self.body_a), block(self.body_b)

    def sizes(self, *parts: Array) -> Array:
        """What each row would be if its atoms did not cancel each other, shape (rows,); 0 for a row of one atom.

        parts: what the atoms put into their rows, shape (atoms, k).
        """
        squares = np.sum([np.sum(part**2, axis=1) for part in parts], axis=0)
        many = np.bincount(self.row, minlength=self.rows) > 1
        return np.sqrt(summed(self.row, squares, self.rows)) * many

    def dense(self, state: State) -> tuple[Array, Array]:
        """Residual (rows,) and Jacobian on the scaled twists of all bodies but body 0, shape (rows, 6 (bodies - 1))."""
        residual, block_a, block_b = self.linearise(state)
        jacobian = np.zeros((self.rows, self.bodies, 6))
        np.add.at(jacobian, (self.row, self.body_a), block_a)
        np.add.at(jacobian, (self.row, self.body_b), block_b)
        return residual, jacobian[:, 1:].reshape(self.rows, 6 * (self.bodies - 1))

    def displacement(self, state: State) -> tuple[Array, Array]:
        """The bodies' displacements as x -> R x + t: rotations (bodies, 3, 3), translations (bodies, 3)."""
        return state.rotation, self.center + state.shift - np.einsum(
            "nij,nj->ni", state.rotation, self.center
        )

    def moved(self, state: State, body: IntArray, twist: Array) -> State:
        """The state after scaled twists (len(body), 6) of the bodies ``body``."""
        rotation, shift = state.rotation.copy(), state.shift.copy()
        shift[body] += twist[:, :3] * self.length[body, None]
        rotation[body] = exponential(twist[:, 3:]) @ rotation[body]
        return State(rotation, shift, state.angle)


def summed(group: IntArray, values: Array, count: int) -> Array:
    """The sums of the values of each group, shape (count,)."""
    return cast(Array, np.bincount(group, values, minlength=count))  # numpy's stubs know counts only


def joined(first: System, second: System) -> System:
    """The rows of both, over the bodies of the first; owners of the second count on from the first's."""
    second = replace(second, owner=second.owner + int(first.owner.max(initial=-1)) + 1)
    arrays = {f: np.concatenate([getattr(first, f), getattr(second, f)]) for f in (*_OF_ATOMS, *_OF_ROWS)}
    return replace(first, row=np.concatenate([first.row, second.row + first.rows]), **arrays)


def repeated(system: System, times: int) -> System:
    """The system side by side with itself: rows, atoms and bodies (body 0 once) of each copy after those of the last."""
    n = system.bodies - 1
    copy = np.repeat(np.arange(times), len(system.kind))
    tiled = {
        f: np.tile(getattr(system, f), (times,) + (1,) * (getattr(system, f).ndim - 1))
        for f in (*_OF_ATOMS, *_OF_ROWS)
    }
    ends = {f: np.where(tiled[f] > 0, tiled[f] + n * copy, 0) for f in ("body_a", "body_b")}
    sizes = {
        f: np.concatenate([(of := getattr(system, f))[:1], np.tile(of[1:], (times,) + (1,) * (of.ndim - 1))])
        for f in ("center", "length")
    }
    return replace(system, row=np.tile(system.row, times) + system.rows * copy, **tiled | ends | sizes)


def repeated_state(state: State, times: int) -> State:
    """The same pose of every copy that ``repeated`` makes."""

    def tiled(values: Array) -> Array:
        return np.concatenate([values[:1], *[values[1:]] * times])

    return State(tiled(state.rotation), tiled(state.shift), np.tile(state.angle, times))


def exponential(w: Array) -> Array:
    """Rotation matrices of rotation vectors, shape (..., 3) to (..., 3, 3) (Rodrigues)."""
    angle = np.sqrt(np.einsum("...i,...i->...", w, w))
    k = skew(w)
    s = np.sinc(angle / np.pi)[..., None, None]
    half = np.sinc(angle / math.tau)[..., None, None]
    return np.eye(3) + s * k + 0.5 * half * half * (k @ k)
