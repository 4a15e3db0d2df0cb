"""Moves bodies onto their constraints: Gauss-Newton with minimum-norm steps.

Minimum norm makes redundant and under-constrained systems ordinary: repeated rows do no harm, free
directions stay where they are, and the pose found is the nearest one.  Independent parts of a system are
solved apart: small ones densely, many at a time; large ones by a damped sparse factorisation
(Levenberg-Marquardt with a damping that only makes the normal matrix definite).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.linalg.lapack import dgelsy, dgelsy_lwork
from scipy.sparse import coo_matrix, csr_matrix, identity
from scipy.sparse.csgraph import connected_components
from scipy.sparse.linalg import splu

from ...spatial import Array, BoolArray, IntArray
from .system import State, System, repeated, summed

CLOSED = 1e-13
"""Scaled residual at which a pose is closed."""
LARGEST_STEP = 0.3
"""Radians, or fractions of the characteristic length, one iteration may move a body."""
ITERATIONS = 60
STALLED = 0.9
"""A part whose residual shrinks by less than this factor three times running has met its floor."""
CUT = 1e-8
"""Singular values below this fraction of the largest take no part in a step."""
CURVATURE = 4.0
"""Of rows: most that a residual is beside its linearisation, over the square of the step; two unit lengths and angles make 1 or 2."""
FINE_CUT = 1e-10
"""The same of a cautious step: the fourth power of the way x leaves a singular value of x cubed."""
NOISE_BESIDE = 10.0
"""Times what rows are off by that repeat others, but not quite, up to which they hold nothing."""
LEAST_OBSTRUCTING = 1e-4
"""Singular value that the row which obstructs a velocity has grown to along the shortest step that tells."""
FEW = 72
"""Largest number of unknowns for which a cautious step, which takes singular values, is worth its time."""
DENSE = 180
"""Largest number of unknowns solved densely."""
DAMPING = 1e-14


@dataclass(slots=True, eq=False)
class _Group:
    """Parts of a system that have the same shape: members (m,) with R rows and n bodies each."""

    members: IntArray
    rows: IntArray  # (m, R) row numbers
    bodies: IntArray  # (m, n) body numbers
    atoms: IntArray  # atoms of all members
    index_a: IntArray  # (atoms, 6) where their blocks go in (m, R, 6 n), flat; the end for a fixed body
    index_b: IntArray


class Solver:
    """The independent parts of a system, ready to be solved many times.

    part: shape (bodies,), the part a body belongs to, -1 for body 0 and for bodies without rows.
    cautious: closes poses by ``cautious_step``, where the parts are small.
    noise: largest singular value of rows that repeat others, but not quite: axes that a CAD program left 1e-7 rad off would lock at
    other poses what moves here, so cautious steps do not follow them.
    """

    def __init__(self, system: System, *, cautious: bool = False, noise: float = 0.0):
        self.system = system
        self.cautious = cautious
        self.noise = noise
        self._copies: dict[int, Solver] = {}
        n = system.bodies
        # What a row counts from inside of one body stands still, and ties that body to nothing.
        self._still = (system.body_a == system.body_b) & system.joining()[system.row]
        a, b = (np.where(self._still, 0, body) for body in (system.body_a, system.body_b))
        first = np.zeros(system.rows, dtype=np.int64)
        np.maximum.at(first, system.row, np.maximum(a, b))
        ends = [(a, b)] + [(first[system.row], x) for x in (a, b)]
        i, j = (np.concatenate(x) for x in zip(*ends))
        real = (i > 0) & (j > 0) & (i != j)
        graph = csr_matrix((np.ones(real.sum()), (i[real], j[real])), shape=(n, n))
        label = connected_components(graph, directed=False)[1]
        self.row_part = np.full(system.rows, -1)
        self.row_part[system.row] = label[first[system.row]]
        self.row_part[first == 0] = -1
        used = np.unique(self.row_part[self.row_part >= 0])
        number = np.full(n, -1)
        number[used] = np.arange(len(used))
        self.row_part = np.where(self.row_part >= 0, number[self.row_part], -1)
        self.part = np.where(np.arange(n) > 0, number[label], -1)
        self.parts = len(used)
        self.groups = self._grouped()

    @classmethod
    def fitted(cls, system: System, length: float) -> Solver:
        """Sets the system's own points and lengths too.  length: see ``System.fit``."""
        solver = cls(system)
        system.fit(solver.row_part, solver.part, length)
        return solver

    def _grouped(self) -> list[_Group]:
        s, n = self.system, self.parts
        if not n:
            return []
        row_count = np.bincount(self.row_part[self.row_part >= 0], minlength=n)
        body_count = np.bincount(self.part[self.part >= 0], minlength=n)
        local_row, row_order, row_start = _positions(self.row_part, row_count)
        local_body, body_order, body_start = _positions(self.part, body_count)
        shape = np.stack([row_count, body_count], axis=1)
        groups: list[_Group] = []
        for shape_rows, shape_bodies in np.unique(shape, axis=0):
            members = np.flatnonzero((row_count == shape_rows) & (body_count == shape_bodies))
            if 6 * shape_bodies > DENSE:
                lots = [members[i : i + 1] for i in range(len(members))]
            else:
                lots = [members]
            for lot in lots:
                place = np.full(n + 1, -1)
                place[lot] = np.arange(len(lot))
                atoms = np.flatnonzero(place[self.row_part[s.row]] >= 0)
                width = 6 * shape_bodies
                base = (place[self.row_part[s.row[atoms]]] * shape_rows + local_row[s.row[atoms]]) * width
                end = len(lot) * shape_rows * width

                def index(
                    body: IntArray, base: IntArray = base, end: int = end, still: BoolArray = self._still[atoms]
                ) -> IntArray:
                    moving = ((self.part[body] >= 0) & ~still)[:, None]
                    flat = (base + 6 * local_body[body])[:, None] + np.arange(6)
                    return np.where(moving, flat, end)

                groups.append(
                    _Group(
                        lot,
                        row_order[row_start[lot][:, None] + np.arange(shape_rows)],
                        body_order[body_start[lot][:, None] + np.arange(shape_bodies)],
                        atoms,
                        index(s.body_a[atoms]),
                        index(s.body_b[atoms]),
                    )
                )
        return groups

    def alone(self, part: int) -> System:
        """One part's rows and bodies by themselves, the bodies numbered from 1 on."""
        order, starts = self._atoms
        atoms = np.sort(order[starts[part] : starts[part + 1]])
        group, at = self._place[part]
        return self.system.part(atoms, group.rows[at], group.bodies[at])

    @property
    def cut(self) -> float:
        """Singular value up to which rows hold nothing that a cautious step has to keep."""
        return min(NOISE_BESIDE * self.noise, LEAST_OBSTRUCTING)

    def copies(self, count: int) -> Solver:
        """Of the system side by side with itself, ``count`` times, see ``repeated``: every part is there so many times."""
        if count not in self._copies:
            self._copies[count] = Solver(repeated(self.system, count), cautious=self.cautious, noise=self.noise)
        return self._copies[count]

    @cached_property
    def _atoms(self) -> tuple[IntArray, IntArray]:
        """The atoms in the order of their parts, and where each part starts there."""
        part = self.row_part[self.system.row]
        order = np.argsort(part, kind="stable")
        return order, np.searchsorted(part[order], np.arange(self.parts + 1))

    @cached_property
    def _place(self) -> dict[int, tuple[_Group, int]]:
        """The group that each part is in, and where."""
        return {int(part): (group, at) for group in self.groups for at, part in enumerate(group.members)}

    def jacobians(self, group: _Group, block_a: Array, block_b: Array) -> Array:
        """Dense Jacobians of a group's members, shape (m, R, 6 n)."""
        m, r = group.rows.shape
        size = m * r * 6 * group.bodies.shape[1]
        index = np.concatenate([group.index_a.ravel(), group.index_b.ravel()])
        values = np.concatenate([block_a[group.atoms].ravel(), block_b[group.atoms].ravel()])
        return summed(index, values, size + 1)[:size].reshape(m, r, -1)

    def sparse_jacobian(self, group: _Group, block_a: Array, block_b: Array) -> csr_matrix:
        """Sparse Jacobian of a group of one member, shape (R, 6 n)."""
        width = 6 * group.bodies.shape[1]
        index = np.concatenate([group.index_a.ravel(), group.index_b.ravel()])
        values = np.concatenate([block_a[group.atoms].ravel(), block_b[group.atoms].ravel()])
        kept = index < group.rows.shape[1] * width
        index, values = index[kept], values[kept]
        return coo_matrix(
            (values, (index // width, index % width)), shape=(group.rows.shape[1], width)
        ).tocsr()

    def sizes(self, block_a: Array, block_b: Array) -> Array:
        """See ``System.sizes``: of the rows of ``jacobians``, shape (rows,)."""
        s = self.system
        across = s.body_a != s.body_b
        moving_a, moving_b = ((across & (self.part[body] >= 0))[:, None] for body in (s.body_a, s.body_b))
        return s.sizes(block_a * moving_a, block_b * moving_b)

    def worst(self, residual: Array) -> Array:
        """Largest residual of each part, shape (parts,)."""
        worst = np.zeros(self.parts)
        kept = self.row_part >= 0
        np.maximum.at(worst, self.row_part[kept], np.abs(residual[kept]))
        return worst

    def project(
        self,
        state: State,
        active: BoolArray | None = None,
        target: Array | float = CLOSED,
        iterations: int = ITERATIONS,
    ) -> tuple[State, Array]:
        """The nearest pose that satisfies the rows, and each part's residual there, shape (parts,).

        active: mask of the parts to solve.  target: residual (of each part) that is good enough.
        A part that cannot be closed keeps the best pose found; its residual says so.
        """
        system = self.system
        residual, block_a, block_b = system.linearise(state)
        worst = self.worst(residual)
        open_ = worst > target if active is None else active & (worst > target)
        slow = np.zeros(self.parts, dtype=int)
        damp = np.ones(self.parts)
        for _ in range(iterations):
            if not open_.any():
                break
            bodies, twists, short = self._steps(open_, residual, block_a, block_b, damp)
            trial = system.moved(state, bodies, twists)
            values = system.linearise(trial)
            now = self.worst(values[0])
            worse = open_ & (now > 2.0 * worst) & (damp > 1e-3)
            if self.cautious and worse.any():
                # what a step along the weak rows bends, the strong ones make up for, as far as they can
                longest = CURVATURE * np.bincount(self.part[bodies], (twists**2).sum(axis=1), self.parts)
                bodies, twists, _ = self._steps(worse, *values, np.ones(self.parts), longest)
                trial = system.moved(trial, bodies, twists)
                values = system.linearise(trial)
                now = self.worst(values[0])
                worse &= now > 2.0 * worst
            if worse.any():
                # halve the step of those parts and leave them where they are; the others go on
                back = np.flatnonzero(np.isin(self.part, np.flatnonzero(worse)))
                trial.rotation[back], trial.shift[back] = state.rotation[back], state.shift[back]
                damp[worse] *= 0.5
                values = system.linearise(trial)
                now = self.worst(values[0])
            damp[~worse] = np.minimum(1.0, damp[~worse] * 2.0)
            # A step cut short comes nearer by what it was cut to, however far the part still is from its floor.
            slow = np.where((now > STALLED * worst) & ~(short & (now < worst)), slow + 1, 0)
            state, worst = trial, now
            residual, block_a, block_b = values
            open_ = open_ & (worst > target) & (slow < 3 + 8 * (damp < 1.0))
        return state, worst

    def _steps(
        self, open_: BoolArray, residual: Array, block_a: Array, block_b: Array, damp: Array, longest: Array | None = None
    ) -> tuple[IntArray, Array, BoolArray]:
        """Bodies and their twists, and the parts, shape (parts,), whose step was cut to the largest.

        longest: of each part's cautious step, see there."""
        bodies: list[IntArray] = []
        twists: list[Array] = []
        short = np.zeros(self.parts, dtype=bool)
        for group in self.groups:
            take = open_[group.members]
            if not take.any():
                continue
            if 6 * group.bodies.shape[1] > DENSE:
                jacobian = self.sparse_jacobian(group, block_a, block_b)
                normal = (jacobian.T @ jacobian + DAMPING * identity(jacobian.shape[1])).tocsc()
                step = -splu(normal).solve(jacobian.T @ residual[group.rows[0]])[None]
            else:
                jacobian = self.jacobians(group, block_a, block_b)[take]
                # a steep coupling's row would hide what the others tell beside it
                size = np.maximum(1.0, np.linalg.norm(jacobian, axis=2))
                unit, errors = jacobian / size[..., None], residual[group.rows[take]] / size
                most = None if longest is None else longest[group.members[take]]
                if self.cautious and jacobian.shape[2] <= FEW:
                    step = -cautious_step(unit, errors, most, self.cut)
                else:
                    step = -minimum_norm(unit, errors)
            step = step.reshape(len(step), -1, 6) * damp[group.members[take]][:, None, None]
            largest = np.abs(step).max(axis=(1, 2), initial=0.0)
            step *= np.minimum(1.0, LARGEST_STEP / np.maximum(largest, 1e-300))[:, None, None]
            short[group.members[take]] = largest > LARGEST_STEP
            bodies.append(group.bodies[take].ravel())
            twists.append(step.reshape(-1, 6))
        return np.concatenate(bodies), np.concatenate(twists), short


def minimum_norm(jacobian: Array, residual: Array) -> Array:
    """Least-squares solutions of least norm of J y = r, shapes (m, R, n), (m, R) to (m, n).

    A complete orthogonal factorisation finds the rank as well as singular values do, several times faster where
    there is more than one body; thousands of single bodies cost less as one stack.  LAPACK is called directly, since
    what scipy's ``lstsq`` does around a call takes as long as one of these small problems.
    """
    count, height, width = jacobian.shape
    if width > 6:
        solutions = np.zeros((count, max(height, width)))
        solutions[:, :height] = residual
        work = int(dgelsy_lwork(height, width, 1, CUT)[0])
        for i, matrix in enumerate(jacobian):
            pivots = np.zeros(width, dtype=np.int32)
            solutions[i] = dgelsy(matrix, solutions[i], pivots, CUT, work)[1]
        return solutions[:, :width]
    u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    kept = s > CUT * s[:, :1]
    inverse = np.divide(1.0, s, out=np.zeros_like(s), where=kept)
    return np.einsum("mkn,mk->mn", vt, inverse * np.einsum("mrk,mr->mk", u, residual))


def cautious_step(jacobian: Array, residual: Array, longest: Array | None = None, cut: float = 0.0) -> Array:
    """As ``minimum_norm``, but only as long as it has to be for the residual to become what the step's own curvature may leave.

    longest: shape (m,), that each may be; it ends before the direction that makes it longer.  cut: singular value up to which a
    direction takes no part.

    The weakest rows ask for the longest steps, and nothing of them is known before the others are closed: where o o = 0 and
    o s = 0, a step that obeyed both would halve the motion s each time that it halves o.
    """
    u, s, vt = np.linalg.svd(jacobian, full_matrices=False)
    along = np.einsum("mrk,mr->mk", u, residual) * (s > np.maximum(cut, FINE_CUT * s[:, :1]))
    shares = np.divide(along, s, out=np.zeros_like(s), where=along != 0.0)
    left = np.cumsum(along[:, ::-1] ** 2, axis=1)[:, ::-1]  # before each direction, from the strongest on
    length = np.cumsum(shares**2, axis=1)
    kept = left > (CURVATURE * np.concatenate([np.zeros((len(s), 1)), length[:, :-1]], axis=1)) ** 2
    if longest is not None:
        kept &= length <= longest[:, None] ** 2
    return np.einsum("mkn,mk->mn", vt, shares * kept)


def _positions(part: IntArray, count: IntArray) -> tuple[IntArray, IntArray, IntArray]:
    """Place of each item in its part, the items in order of part, and where each part starts there."""
    order = np.argsort(part, kind="stable")
    order = order[np.searchsorted(part[order], 0) :]
    start = np.concatenate([[0], np.cumsum(count)[:-1]])
    local = np.zeros(len(part), dtype=np.int64)
    local[order] = np.arange(len(order)) - np.repeat(start, count)
    return local, order, start
