"""Freedoms that move nothing else: a rod spinning between its two balls."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...spatial import Array, IntArray
from ..assembly.assemble import Assembly
from ..equations.solve import Solver
from ..freedom.first_order import BlockFreedom, block_freedoms
from ..freedom.motion import finite_freedoms, walked
from ..freedom.rank import spans
from .tied import TiedPart, tied_parts

ALONE = 1e-12
"""Share of a motion, squared, that all other bodies may have in it; of a shared twist, that is not the other joint's."""
NEW = 1e-6
"""Length of a motion beside those already found from which it is another one."""
NEAR = 4e-6
"""Difference of two unit twists, along any direction, beyond which they are not shared up to ``ALONE``."""
ASLANT = np.array([0.37, 0.43, 0.29, 0.53, 0.41, 0.39])
"""A direction, about one long, that favours no twist, to sort them along."""
MOST = 10_000
"""Pairs of joints compared at once, which bounds the memory."""
MOVING = 1e-7
"""Share of a joint's largest singular value below which it has no further freedom in any motion."""


@dataclass(frozen=True, slots=True)
class IdleFreedom:
    """Freedoms of some nodes that move nothing else, such as a rod's spin."""

    nodes: tuple[int, ...]
    count: int


def idle_freedoms(assembly: Assembly) -> list[IdleFreedom]:
    """Freedoms of a single body, or of a leg of bodies between two others, that move nothing else: motions from the
    closed pose on while all others stand still; in a single loop, of bodies that turn in it as one."""
    neighbours: dict[int, set[int]] = {}
    low, high = assembly.system.body_a, assembly.system.body_b
    for i, j in set(zip(low.tolist(), high.tolist())):
        neighbours.setdefault(i, set()).add(j)
        neighbours.setdefault(j, set()).add(i)
    found: list[IdleFreedom] = []
    for part, (first, finite) in enumerate(zip(assembly.freedoms, assembly.finite)):
        if finite.mobility < 2 or len(first.bodies) < 2:
            continue
        for number, tied in enumerate(tied_parts(assembly, first)):
            for bodies, count in _idle_in(assembly, part, number, tied, neighbours):
                nodes = sorted(n for body in bodies for n in assembly.nodes[body])
                found.append(IdleFreedom(tuple(nodes), count))
    return found


def _idle_in(
    assembly: Assembly, part: int, number: int, tied: TiedPart, neighbours: dict[int, set[int]]
) -> list[tuple[list[int], int]]:
    """Bodies of one part that move alone, and in how many ways.  number: of the part among the block's."""
    freedom = tied.freedom
    if freedom.mobility < 2 or len(freedom.bodies) < 2:
        return []
    legs = _legs(freedom.bodies.tolist(), neighbours)
    if len(legs) > 1:
        # What moves by itself seems to from the first; whether it does is asked with all else held.
        rows = assembly.freedoms[part].rows
        counted = [(leg, _with_all_else_held(assembly, rows, leg)) for leg in legs if _alone(freedom, leg)]
        return [(leg, count) for leg, count in counted if count]
    moving = None if tied.coupled else _moving(assembly, part)
    if moving is None:
        return []  # a coupling between joints of the loop, or nothing to be told
    alone = tied_parts(assembly, moving)[number].freedom
    rows, ring = assembly.freedoms[part].rows, _ring(tied.root, neighbours, legs[0])
    found = _turning_in_a_loop(assembly, alone, ring)
    loop = {tied.root, *ring}
    for i, (bodies, count) in enumerate(found):
        if any(neighbours[body] - loop for body in bodies):  # what hangs on them may have to move along
            found[i] = bodies, min(count, _with_all_else_held(assembly, rows, bodies))
    return [(bodies, count) for bodies, count in found if count]


def _with_all_else_held(assembly: Assembly, of_block: IntArray, leg: list[int]) -> int:
    """Freedoms of finite motion that a leg's bodies have while all others stand still, those that hang on them too.

    of_block: the block's rows."""
    system, bodies = assembly.system, np.array(sorted(leg))
    across = system.body_a != system.body_b  # inside a body all stands still, though a coupling counts from it
    own = across & (np.isin(system.body_a, bodies) | np.isin(system.body_b, bodies))
    rows = np.unique(system.row[own])
    if len(leg) == 1:
        there = across & np.isin(system.row, np.intersect1d(rows, of_block))
        if len({*system.body_a[there].tolist(), *system.body_b[there].tolist()} - set(leg)) < 2:
            return 0  # the end of a chain
    solver = Solver(system.part(np.flatnonzero(np.isin(system.row, rows)), rows, bodies))
    start = solver.system.start()
    return sum(f.mobility for f in finite_freedoms(solver, block_freedoms(solver, start), start))


def _moving(assembly: Assembly, part: int) -> BlockFreedom | None:
    """A block's velocities that are motions, or None where they are not to be told from others.

    At a singular pose they are looked at some steps away, where no part seems to move alone that cannot.
    """
    first, finite = assembly.freedoms[part], assembly.finite[part]
    if finite.mobility == first.mobility:
        return first
    solver = Solver(assembly.solver.system.select(first.rows))
    away = block_freedoms(solver, walked(solver, 0, first, assembly.start))[0]
    return replace(away, rows=first.rows) if away.mobility == finite.mobility else None


def _alone(freedom: BlockFreedom, leg: list[int]) -> int:
    """How many of the motions are the leg's own."""
    place = {int(b): k for k, b in enumerate(freedom.bodies)}
    own = np.concatenate([freedom.basis[6 * place[b] : 6 * place[b] + 6] for b in leg])
    # columns are orthonormal: what is wholly in the leg's rows has nothing left for all others
    return int(np.sum(np.linalg.svd(own, compute_uv=False) ** 2 > 1.0 - _share(freedom)))


def _share(freedom: BlockFreedom) -> float:
    """``ALONE``, or what noise makes of it."""
    return max(ALONE, freedom.noise**2)


def _turning_in_a_loop(
    assembly: Assembly, freedom: BlockFreedom, ring: list[int]
) -> list[tuple[list[int], int]]:
    """Neighbouring bodies of one closed loop that move as one and alone: the joints at their two ends share a twist.

    ring: the bodies in the loop's order, its root left out.
    """
    still = np.zeros((6, freedom.mobility))
    of_body = dict(zip(freedom.bodies.tolist(), freedom.about_one_point(assembly.relative)))
    twists = [still, *(of_body[body] for body in ring), still]
    alone = _share(freedom)
    cut = max(MOVING, freedom.noise)
    joints = spans([after - before for before, after in zip(twists, twists[1:])], cut)
    found: list[tuple[list[int], int]] = []
    known = np.zeros((6 * len(ring), 0))
    for first, last in _sharing(joints, alone):
        size = last - first
        if size == len(ring):
            continue  # all of the loop
        u, s, _ = np.linalg.svd(joints[first].T @ joints[last])
        shared = joints[first] @ u[:, : int(np.sum(s**2 > 1.0 - alone))]
        motions = np.zeros((len(ring), 6, shared.shape[1]))
        motions[first:last] = shared / np.sqrt(size)
        new = motions.reshape(len(known), -1)
        # a ram's spin is that of its tube and of its piston, if these turn
        new = new - known @ (known.T @ new)
        u, s, _ = np.linalg.svd(new, full_matrices=False)
        if count := int(np.sum(s > NEW)):
            known = np.concatenate([known, u[:, :count]], axis=1)
            found.append((ring[first:last], count))
        if known.shape[1] >= freedom.mobility:
            break  # there are no others
    return found


def _sharing(joints: list[Array], alone: float) -> list[tuple[int, int]]:
    """Numbers of the joints that share a twist with each other, the nearest neighbours first.

    joints: orthonormal twists of each, shape (6, n).  alone: see ``_share``.  Hinges, of which a loop may have hundreds, share theirs only where
    it is the same, so they are sorted by it; the few joints with more freedoms are compared with all.
    """
    pairs: list[tuple[int, int]] = []
    plain = [i for i, own in enumerate(joints) if own.shape[1] == 1]
    key = np.abs(np.array([joints[i][:, 0] for i in plain]).reshape(-1, 6) @ ASLANT)
    order: list[int] = np.argsort(key, kind="stable").tolist()
    for at, here in enumerate(order):
        for there in order[at + 1 :]:
            if key[there] - key[here] > NEAR * np.sqrt(alone / ALONE):
                break
            pairs.append((plain[here], plain[there]))
    for i, own in enumerate(joints):
        if own.shape[1] > 1:
            pairs += [
                (i, j) for j, other in enumerate(joints) if other.shape[1] == 1 or other.shape[1] and j > i
            ]
    ordered = sorted((min(pair), max(pair)) for pair in pairs)
    sizes: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for i, j in ordered:
        sizes.setdefault((joints[i].shape[1], joints[j].shape[1]), []).append((i, j))
    shared: list[tuple[int, int]] = []
    for alike in sizes.values():
        for at in range(0, len(alike), MOST):
            some = alike[at : at + MOST]
            a, b = (np.array([joints[pair[end]] for pair in some]) for end in (0, 1))
            largest = np.linalg.svd(np.swapaxes(a, 1, 2) @ b, compute_uv=False)[:, 0]
            shared += [pair for pair, s in zip(some, largest.tolist()) if s**2 > 1.0 - alone]
    return sorted(shared, key=lambda pair: (pair[1] - pair[0], pair[0]))


def _ring(root: int, neighbours: dict[int, set[int]], bodies: list[int]) -> list[int]:
    """The bodies in the order in which their loop joins them, from the root and back; empty where they make none."""
    inside, before = set(bodies), root
    ring: list[int] = []
    body = min(neighbours[root] & inside, default=root)
    while body != root and len(ring) < len(bodies):
        ring.append(body)
        before, body = body, next((n for n in sorted(neighbours[body]) if n != before), root)
    return ring if body == root and len(ring) == len(bodies) else []


def _legs(bodies: list[int], neighbours: dict[int, set[int]]) -> list[list[int]]:
    """Chains of bodies with two neighbours each, as long as they go; other bodies by themselves."""
    inside = set(bodies)
    seen: set[int] = set()
    legs: list[list[int]] = []
    for body in bodies:
        if body in seen:
            continue
        leg = [body]
        seen.add(body)
        if len(neighbours[body]) == 2:
            for start in sorted(neighbours[body]):
                following = start
                while following in inside and following not in seen and len(neighbours[following]) == 2:
                    seen.add(following)
                    leg.append(following)
                    following = next((n for n in sorted(neighbours[following]) if n not in seen), -1)
        legs.append(leg)
    return legs
