"""First-order freedoms of every block: rank, and how each body may move against the block's root.

A small block's Jacobian goes to an SVD as it is, many blocks of one shape at a time.  A large block is
first written in the freedoms of a spanning tree, J_cut T y = 0: the bodies' six-vectors T y follow the
tree, only the rows outside it remain, and the matrix shrinks from 6 n columns to the tree's freedoms.  T has
orthonormal columns and the loops take few of them, so that a ring costs the square of its bodies, not the cube.
Where the loops are many, as in a grid of closed cells, ``few_velocities`` is asked first.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import cast

import numpy as np
from scipy.linalg.lapack import dgeqrf, dgeqrf_lwork, dormqr
from scipy.sparse import csr_matrix, diags

from ...partition import Partition
from ...spatial import Array, BoolArray, IntArray, cross, skew
from ..equations.solve import DENSE, Solver
from ..equations.system import State, System
from .inverse import few_velocities
from .rank import factored, normalised, rank_of
from .stacks import alike


NOISE_OVER_GAP = 10.0
MANY = 400
"""Freedoms of a tree, and rows beside it, from which on the rows are left sparse."""


@dataclass(slots=True, eq=False)
class BlockFreedom:
    """bodies: shape (n,), the block's root left out.  rows: number of rows.

    basis: scaled twists (v / length, w) of the bodies about their own points g against the root,
    shape (6 n, first order mobility), orthonormal columns.  gap: see ``rank``.
    """

    bodies: IntArray
    rows: IntArray
    rank: int
    gap: float
    basis: Array

    @property
    def mobility(self) -> int:
        return self.basis.shape[1]

    @property
    def noise(self) -> float:
        """What may be in a velocity without being in the motion, as a share of it: more than rounding where rows that repeat
        others do not quite."""
        return NOISE_OVER_GAP / self.gap

    def about_one_point(self, system: System) -> Array:
        """The same twists, all about the own point g of the first body, shape (n, 6, mobility).  system: the block's."""
        twists = self.basis.reshape(len(self.bodies), 6, -1)
        return moved_to_one_point(twists, self.bodies, system)


def moved_to_one_point(twists: Array, bodies: IntArray, system: System) -> Array:
    """Scaled twists (v / length, w) of a block's bodies, shape (n, 6, k), each about its own point g, about that of the first
    one.  system: in which the bodies of a block have one length."""
    arm = (system.center[bodies] - system.center[bodies[0]]) / system.length[bodies[0]]
    turned = np.swapaxes(cross(np.swapaxes(twists[:, 3:], 1, 2), arm[:, None]), 1, 2)
    return np.concatenate([twists[:, :3] - turned, twists[:, 3:]], axis=1)


def block_freedoms(solver: Solver, state: State) -> list[BlockFreedom]:
    """Every part of the solver's system, in the order of its part numbers."""
    found = freedoms_of(solver, state, np.ones(solver.parts, dtype=bool))
    return [found[part] for part in range(solver.parts)]


def freedoms_of(solver: Solver, state: State, parts: BoolArray) -> dict[int, BlockFreedom]:
    """As ``block_freedoms``, of some parts (a mask), by their numbers."""
    _, block_a, block_b = solver.system.linearise(state)
    sizes = solver.sizes(block_a, block_b)
    found: dict[int, BlockFreedom] = {}
    for group in solver.groups:
        asked = np.flatnonzero(parts[group.members])
        if not len(asked):
            continue
        width = 6 * group.bodies.shape[1]
        if width > DENSE:
            part = int(group.members[0])
            jacobian = solver.sparse_jacobian(group, block_a, block_b)
            rank, basis, gap = large_null_space(
                solver.system, state, group.bodies[0], group.atoms, jacobian, sizes[group.rows[0]]
            )
            found[part] = BlockFreedom(group.bodies[0], group.rows[0], rank, gap, basis)
            continue
        jacobians, rows = solver.jacobians(group, block_a, block_b)[asked], group.rows[asked]
        ranks, gaps, vt = factored(normalised(jacobians, sizes[rows]))
        for i, part in enumerate(group.members[asked].tolist()):
            bodies, rank = group.bodies[asked[i]], int(ranks[i])
            found[part] = BlockFreedom(bodies, rows[i], rank, float(gaps[i]), vt[i, rank:].T)
    return found


def large_null_space(
    system: System, state: State, bodies: IntArray, atoms: IntArray, jacobian: csr_matrix, sizes: Array
) -> tuple[int, Array, float]:
    """Rank, orthonormal null space and gap of one block's sparse Jacobian, shape (R, 6 n).

    bodies: shape (n,), the block's.  atoms: the system's atoms in the block.  sizes: shape (R,), see ``normalised``.
    """
    rows, width = jacobian.shape
    size = np.maximum(np.sqrt(np.asarray(jacobian.multiply(jacobian).sum(axis=1)).ravel()), sizes)
    factor: Array = np.divide(1.0, size, out=np.zeros_like(size), where=size > 0.0)
    jacobian = csr_matrix(diags(factor) @ jacobian)
    tree, tree_rows = _spanning_tree(system, bodies, atoms, jacobian, sizes * factor)
    freedoms = sum(free.shape[1] for _, _, free in tree)
    if min(rows - len(tree_rows), freedoms) > MANY:
        found = few_velocities(jacobian)
        if found is not None:
            return found
    point = (system.center + state.shift)[bodies] / system.length[bodies, None]
    free = tree_motions(tree, point)
    loops = jacobian[np.setdiff1d(np.arange(rows), tree_rows)] @ free
    if not len(loops):
        return width - free.shape[1], free, np.inf
    if len(loops) > free.shape[1]:
        loops = np.linalg.qr(loops, mode="r")
    _, s, vt = np.linalg.svd(loops, full_matrices=False)
    # beside the tree's rows, of length 1: where all of the loops repeat these, the largest singular value is a rounding too
    rank, gap = rank_of(np.concatenate([[max(1.0, s.max(initial=0.0))], s]))
    held = int(rank) - 1
    if len(s) == free.shape[1] and 2 * held > len(s):  # all directions are there, and fewer are left than go
        moving = free @ vt[held:].T
    else:
        moving = _without(free, vt[:held])
    return width - moving.shape[1], moving, float(gap)


def tree_motions(tree: list[tuple[int, int, Array]], point: Array) -> Array:
    """Orthonormal twists (v / length, w) of all bodies, shape (6 n, freedoms), that the joints of a tree allow.

    tree: see ``_spanning_tree``.  point: shape (n, 3), where each body's v is, as fractions of the length.
    For the freedoms S of a joint and the articulated inertia A of all that hangs on its body, with masses and inertias
    of 1: what stands still before the joint moves behind it by Z = S (S' A S)^(-1/2), and what moves before it carries
    on by Phi = (1 - S (S' A S)^(-1) S' A) X, X the change of point.  Such motions are orthonormal as they stand: the
    square root of the mass matrix of a tree (Rodriguez, Jain & Kreutz-Delgado 1992, *Spatial operator algebra for
    multibody system dynamics*; Featherstone 2008, ch. 7), without a decomposition of a matrix as large as the tree.
    """
    inertia = np.broadcast_to(np.eye(6), (len(point), 6, 6)).copy()
    passed: list[Array] = []
    begun: list[Array] = []
    for parent, body, free in reversed(tree):
        behind = inertia[body]
        root = cast(Array, np.linalg.cholesky(free.T @ behind @ free))
        start = cast(Array, np.linalg.solve(root, free.T)).T
        passing = np.eye(6) - start @ (start.T @ behind)
        if parent >= 0:
            passing[:, 3:] -= passing[:, :3] @ skew(point[body] - point[parent])
            inertia[parent] += passing.T @ behind @ passing
        passed.append(passing)
        begun.append(start)
    carried = np.zeros((len(point), 6, sum(free.shape[1] for _, _, free in tree)))
    at = 0
    for (parent, body, free), passing, start in zip(tree, reversed(passed), reversed(begun)):
        end = at + free.shape[1]
        if parent >= 0:
            carried[body, :, :at] = passing @ carried[parent, :, :at]
        carried[body, :, at:end] = start
        at = end
    return carried.reshape(6 * len(point), at)


def _without(basis: Array, rows: Array) -> Array:
    """An orthonormal basis, shape (m, n), without the directions in it that orthonormal rows (r, n) stand for.

    The reflections that turn the rows into the first r axes take n r steps for each row of the basis, not n^2.
    """
    if not len(rows):
        return basis
    work = int(dgeqrf_lwork(rows.shape[1], len(rows))[0])
    reflections, scales, _, _ = dgeqrf(rows.T, work)
    work = int(dormqr("L", "T", reflections, scales, basis.T, -1)[1][0])
    turned = dormqr("L", "T", reflections, scales, basis.T, work)[0]
    return turned[len(rows) :].T


def _spanning_tree(
    system: System, bodies: IntArray, atoms: IntArray, jacobian: csr_matrix, sizes: Array
) -> tuple[list[tuple[int, int, Array]], IntArray]:
    """(parent, body, null space of the joining rows on the body) outwards from the root (parent -1).

    sizes: see ``normalised``.
    Pairs with the fewest freedoms come first, so that the tree has few unknowns.  Also returns the rows
    that the tree takes up.
    """
    row_ends, pairs, rows_of = _joined(system, bodies, atoms, jacobian.shape[0])
    ranks, spaces = _left_free(jacobian, row_ends, pairs, rows_of, sizes)
    near = _forest(pairs, ranks, len(bodies))
    tree: list[tuple[int, int, Array]] = []
    taken: list[IntArray] = []
    queue, seen = [-1], {-1}
    for body in queue:
        for p in near.get(body, []):
            other = int(pairs[p, 0] + pairs[p, 1] - body)
            if other not in seen:
                seen.add(other)
                queue.append(other)
                tree.append((body, other, spaces[p, other]))
                taken.append(rows_of[p])
    for body in set(range(len(bodies))) - seen:  # joined by rows over three or more bodies only
        tree.append((-1, body, np.eye(6)))
    return tree, np.concatenate(taken) if taken else np.zeros(0, dtype=np.int64)


def _joined(
    system: System, bodies: IntArray, atoms: IntArray, rows: int
) -> tuple[IntArray, IntArray, list[IntArray]]:
    """The two bodies of each row, shape (rows, 2), places in ``bodies`` or -1; the pairs that some rows join by
    themselves, shape (pairs, 2); and the rows of each pair.  rows: how many there are."""
    local = np.full(system.bodies, -1)
    local[bodies] = np.arange(len(bodies))
    number = np.unique(system.row[atoms], return_inverse=True)[1].reshape(-1)
    ends = np.sort(np.stack([local[system.body_a[atoms]], local[system.body_b[atoms]]], axis=1), axis=1)
    row_ends = np.zeros((rows, 2), dtype=np.int64)
    row_ends[number] = ends
    mixed = np.zeros(rows, dtype=bool)
    np.logical_or.at(mixed, number, np.any(row_ends[number] != ends, axis=1))
    plain = np.flatnonzero(~mixed)
    pairs, which = np.unique(row_ends[plain], axis=0, return_inverse=True)
    order = np.argsort(which.reshape(-1), kind="stable")
    starts = np.searchsorted(which.reshape(-1)[order], np.arange(len(pairs) + 1))
    return row_ends, pairs, [plain[order[starts[p] : starts[p + 1]]] for p in range(len(pairs))]


def _left_free(
    jacobian: csr_matrix, row_ends: IntArray, pairs: IntArray, rows_of: list[IntArray], sizes: Array
) -> tuple[IntArray, dict[tuple[int, int], Array]]:
    """The rank of each pair's rows, and by pair and body what they leave free on that body, columns."""
    entries = jacobian.tocoo()
    body, column = np.divmod(entries.col, 6)
    on_ends = np.zeros((2, jacobian.shape[0], 6))
    for end in (0, 1):
        own = body == row_ends[entries.row, end]
        on_ends[end, entries.row[own], column[own]] = entries.data[own]
    ranks = np.zeros(len(pairs), dtype=np.int64)
    spaces: dict[tuple[int, int], Array] = {}
    for _, group in alike(map(len, rows_of)):
        members: list[int] = group.tolist()
        rows = np.array([rows_of[p] for p in members])
        rank, _, vt = factored(normalised(on_ends[:, rows], sizes[rows]))
        ranks[group] = rank[1]
        for end in (0, 1):
            for n, p in enumerate(members):
                spaces[p, int(pairs[p, end])] = vt[end, n, rank[end, n] :].T
    return ranks, spaces


def _forest(pairs: IntArray, ranks: IntArray, count: int) -> dict[int, list[int]]:
    """For each body the pairs by which it hangs in the trees, the pairs of the highest rank taken first."""
    forest = Partition(count + 1)
    near: dict[int, list[int]] = {}
    for p in np.argsort(-ranks, kind="stable"):
        i, j = int(pairs[p, 0]), int(pairs[p, 1])
        if forest.find(i + 1) != forest.find(j + 1):
            forest.join(i + 1, j + 1)
            near.setdefault(i, []).append(int(p))
            near.setdefault(j, []).append(int(p))
    return near
