"""Every pair of bodies: which twists its constraints leave, and which joint that is."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...spatial import Array, BoolArray, IntArray, cross
from ..equations.atoms import LENGTHS
from ..equations.system import IN_ONE_PLACE, State, System
from ..freedom.finite import EXACT, Candidate, misfits
from ..freedom.rank import SURE_GAP, factored, normalised
from ..freedom.stacks import alike
from ..freedom.twists import TwistSpace, twist_spaces
from .candidates import Geometry, candidates

SLACK = 20.0
"""A candidate may miss by this many times the misfit that the exported pose already has ..."""
MOST_SLACK = 1e-4
"""... up to here, as a fraction of the characteristic length."""
MOST = 64
"""Points or directions of one pair looked at."""


@dataclass(slots=True, eq=False)
class Pairs:
    """The pairs of bodies that rows join, in the order of (first, second), first < second.

    row_pair: shape (rows,), the row's pair, -1 where it joins more than two bodies, -2 inside one body.
    atom_pair: shape (atoms,), that of its row, -2 where the atom itself is inside one body.
    """

    first: IntArray
    second: IntArray
    row_pair: IntArray
    atom_pair: IntArray

    def __len__(self) -> int:
        return len(self.first)


@dataclass(slots=True, eq=False)
class Relation:
    """What the constraints of one pair leave.

    owners: the statements that the rows belong to, each once, ascending.
    rows, rank: of the pair alone, first order.  basis: scaled twists (v / length, w) of the second body
    against the first about ``origin``, columns, orthonormal, shape (6, 6 - rank).
    joint: the one joint with exactly these motions, or None.  misfit: of the best candidate, as a fraction
    of length.  gap: see ``rank``.  finite: freedoms of finite motion (less than 6 - rank where the
    pose is singular).  missed: of a joint that is only the nearest one, see ``JointFinding.misfit``.
    """

    first: int
    second: int
    rows: IntArray
    owners: list[int]
    rank: int
    gap: float
    origin: Array
    length: float
    basis: Array
    finite: int
    space: TwistSpace
    geometry: Geometry
    joint: Candidate | None = None
    misfit: float = np.inf
    tried: list[Candidate] = field(default_factory=list[Candidate])
    missed: tuple[float, float] = (0.0, 0.0)

    @property
    def sure(self) -> bool:
        return self.gap >= SURE_GAP


def pairs_of(system: System) -> Pairs:
    """Group the rows by the pair of bodies they join."""
    low = np.minimum(system.body_a, system.body_b)
    high = np.maximum(system.body_a, system.body_b)
    n = system.bodies
    key = low * n + high
    inside = low == high
    key[inside] = -2
    row_key = np.full(system.rows, -3, dtype=np.int64)
    np.maximum.at(row_key, system.row, key)
    mixed = np.zeros(system.rows, dtype=bool)
    # a coordinate inside one body stands still: a coupling with it is of the other one's pair
    np.logical_or.at(mixed, system.row, (row_key[system.row] != key) & ~inside)
    row_key[mixed] = -1
    keys = np.unique(row_key[row_key >= 0])
    row_pair = np.where(row_key >= 0, np.searchsorted(keys, row_key), row_key)
    return Pairs(keys // n, keys % n, row_pair, np.where(inside, -2, row_pair[system.row]))


def relative_rows(system: System, pairs: Pairs, state: State) -> tuple[Array, Array, Array]:
    """Normalised rows of each pair as scaled wrenches on the second body's twist, about the pair's own middle.

    Returns (rows (m, 6), origin (pairs, 3), length (pairs,)) with zero rows for rows of no pair.
    """
    _, f, c, tau = system.values(state)
    used = pairs.atom_pair >= 0
    p = pairs.atom_pair[used]
    pointed = np.isin(system.kind[used], LENGTHS)
    count = np.bincount(p[pointed], minlength=len(pairs))
    p_a, _, _, p_b, _ = system.current(state, np.flatnonzero(used), "p_a p_b")
    middle = 0.5 * (p_a + p_b)
    origin = np.zeros((len(pairs), 3))
    for i in range(3):
        origin[:, i] = np.bincount(p[pointed], middle[pointed, i], minlength=len(pairs)) / np.maximum(
            count, 1
        )
    reach = np.zeros(len(pairs))
    for points in (p_a, p_b):
        np.maximum.at(reach, p[pointed], np.linalg.norm(points[pointed] - origin[p[pointed]], axis=1))
    whole = system.length[pairs.second]
    length = np.where(reach > IN_ONE_PLACE * whole, reach, whole)
    second = np.append(pairs.second, [-1, -1])[pairs.atom_pair]
    sign = np.where(system.body_b == second, 1.0, -1.0)
    scale = (system.weight * sign)[used, None]
    lever = c[used] - origin[p]
    wrench = np.zeros((len(used), 6))
    wrench[used, :3] = f[used] * scale
    wrench[used, 3:] = (cross(lever, f[used]) + tau[used]) * scale / length[p][:, None]
    rows = np.zeros((system.rows, 6))
    np.add.at(rows, system.row[used], wrench[used])
    return normalised(rows, system.sizes(wrench)), origin, length


def batched_null_spaces(
    rows: Array, row_pair: IntArray, count: int
) -> tuple[IntArray, Array, Array, IntArray, IntArray]:
    """Rank (count,), gap (count,) and V' (count, 6, 6) of each pair's rows; the null space is V'[rank:].

    Also the rows of pairs, pair by pair, and where each pair's start among them, shape (count + 1,).
    """
    used = np.flatnonzero(row_pair >= 0)
    used = used[np.argsort(row_pair[used], kind="stable")]
    sizes = np.bincount(row_pair[used], minlength=count)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    rank, gap, vt = np.zeros(count, dtype=np.int64), np.zeros(count), np.zeros((count, 6, 6))
    height = np.maximum(6, 2 ** np.ceil(np.log2(np.maximum(sizes, 1))).astype(int))
    pair_of = row_pair[used]
    place = np.arange(len(used)) - starts[pair_of]
    for h in np.unique(height):
        group = np.flatnonzero(height == h)
        number = np.full(count, -1)
        number[group] = np.arange(len(group))
        mine = number[pair_of] >= 0
        block = np.zeros((len(group), h, 6))
        block[number[pair_of[mine]], place[mine]] = rows[used[mine]]
        rank[group], gap[group], vt[group] = factored(block)
    return rank, gap, vt, used, starts


def relations_of(system: System, pairs: Pairs, state: State) -> list[Relation]:
    """Every pair's twists, not yet its joint."""
    if not len(pairs):
        return []
    rows, origin, length = relative_rows(system, pairs, state)
    rank, gap, vt, order, starts = batched_null_spaces(rows, pairs.row_pair, len(pairs))
    bases = [vt[i, r:].T for i, r in enumerate(rank)]
    spaces = twist_spaces(bases, origin, length, system.axes)
    geometries = _geometries(system, pairs, length)
    owner = system.owner[order]
    return [
        Relation(first, second, order[at:end], sorted(set(owner[at:end].tolist())), *own)
        for first, second, at, end, *own in zip(
            pairs.first.tolist(),
            pairs.second.tolist(),
            starts.tolist(),
            starts[1:].tolist(),
            rank.tolist(),
            gap.tolist(),
            origin,
            length.tolist(),
            bases,
            (6 - rank).tolist(),
            spaces,
            geometries,
        )
    ]


def _geometries(system: System, pairs: Pairs, length: Array) -> list[Geometry]:
    """Each pair's points and directions; the system must stand at its start pose.

    Where no atom of a pair has points, those of all its atoms are taken.
    """
    atoms_of = np.argsort(pairs.atom_pair, kind="stable")
    starts = np.searchsorted(pairs.atom_pair[atoms_of], np.arange(len(pairs) + 1))
    pointed = np.isin(system.kind, LENGTHS)
    found: dict[int, Geometry] = {}
    for count, group in alike(np.diff(starts).tolist()):
        atoms = atoms_of[starts[group, None] + np.arange(count)]
        a_first = (system.body_a[atoms] == pairs.first[group, None])[..., None]
        on_a = np.stack([system.a[atoms], system.k[atoms]], axis=2)
        on_b = np.stack([system.b[atoms], np.zeros(atoms.shape + (3,))], axis=2)
        sides: list[list[Array]] = []
        for here in (np.where(a_first[..., None], on_a, on_b), np.where(a_first[..., None], on_b, on_a)):
            here = here.reshape(len(group), -1, 3)
            sides.append(_distinct(here, np.linalg.norm(here, axis=2) > 0.5, np.full(len(group), 1e-6)))
        p_a, p_b = system.p_a[atoms], system.p_b[atoms]
        on_second, on_first = np.where(a_first, p_b, p_a), np.where(a_first, p_a, p_b)
        points = np.concatenate([on_second, on_first], axis=1)
        placed = pointed[atoms] | ~pointed[atoms].any(axis=1, keepdims=True)
        points = _distinct(points, np.tile(placed, 2), 1e-6 * length[group])
        for i, own, first, second in zip(group.tolist(), points, *sides):
            found[i] = Geometry(own, first, second, system.axes)
    return [found[i] for i in range(len(pairs))]


def _distinct(vectors: Array, taken: BoolArray, tolerance: Array) -> list[Array]:
    """Of each stack of vectors, shape (n, m, 3), the first ``MOST`` that are taken (a mask), without those near an
    earlier one; tolerance: shape (n,)."""
    most = min(MOST, int(taken.sum(axis=1).max(initial=0)))
    first = np.argsort(~taken, axis=1, kind="stable")[:, :most]
    vectors, taken = (
        np.take_along_axis(vectors, first[..., None], axis=1),
        np.take_along_axis(taken, first, axis=1),
    )
    near = np.tril(np.broadcast_to(taken[:, None], taken.shape + taken.shape[1:]), -1)
    for x in np.moveaxis(vectors, 2, 0):
        near &= np.abs(x[:, :, None] - x[:, None]) <= tolerance[:, None, None]
    fresh = taken & ~near.any(axis=2)
    ends: list[int] = np.cumsum(fresh.sum(axis=1)).tolist()
    kept = vectors[fresh]
    return [kept[at:end] for at, end in zip([0, *ends], ends)]


def find_joints(system: System, relations: list[Relation], residual: Array) -> None:
    """Give each relation the first candidate whose finite motions keep all its rows.

    relations: any of the system's pairs, in any order.  residual: of the start pose, shape (rows,), scaled by
    ``system.length``.
    """
    tested = {
        i: candidates(r.space, r.geometry, r.length) for i, r in enumerate(relations) if r.joint is None
    }
    while True:
        offers = {i: offer for i, own in tested.items() if (offer := next(own, None)) is not None}
        if not offers:
            return
        worst = _try(system, [relations[i] for i in offers], list(offers.values()))
        for (i, offer), misfit in zip(offers.items(), worst.tolist()):
            relation = relations[i]
            if misfit < relation.misfit:
                relation.misfit = misfit
                relation.tried.append(offer)
            scaled = np.abs(residual[relation.rows]).max(initial=0.0)
            allowed = max(EXACT, min(SLACK * scaled, MOST_SLACK))
            if misfit <= allowed and offer.dof == relation.finite:
                relation.joint = offer
        tested = {i: tested[i] for i in offers if relations[i].joint is None}


def _try(system: System, relations: list[Relation], offers: list[Candidate]) -> Array:
    """Misfit of each relation's offer, shape (relations,)."""
    worst = np.zeros(len(relations))
    number = np.full(system.rows, -1)
    for at in range(0, len(relations), 1000):  # bounds the memory of the samples
        part = relations[at : at + 1000]
        for i, relation in enumerate(part):
            number[relation.rows] = i
        rows = np.sort(np.concatenate([relation.rows for relation in part]))
        sub = system.select(rows)
        second = np.array([relation.second for relation in part])
        lengths = np.array([relation.length for relation in part])
        worst[at : at + 1000] = misfits(sub, second, number[rows][sub.row], offers[at : at + 1000], lengths)
    return worst
