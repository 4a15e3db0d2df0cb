"""Freedoms that move nothing else: a rod spinning between its two balls.

A motion is idle in which one body of a loop moves, or several that two joints hold between others and that move as one,
and after which no other body has moved.  The joints round them then leave them a twist in common.  What hangs on them and
is in no loop with them is one of the others; so is what a coupling would move.  A block's only freedom is what it does,
and not idle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from ...partition import Partition
from ...spatial import Array, cross
from ..assembly.assemble import Assembly
from ..assembly.cut_pairs import CutPairs, cut_pairs
from ..equations.solve import Solver
from ..equations.system import System
from ..freedom.first_order import block_freedoms, moved_to_one_point
from ..freedom.motion import finite_freedoms
from ..freedom.stacks import alike
from ..pairs.relations import Pairs, batched_null_spaces, pairs_of, relative_rows

ALONE = 1e-12
"""How far the cosine between two joints' twists, squared, may be from 1."""
SURE = 1e-6
"""Share of an exactly known motion up to which a block has no part in it."""
CURVED = 1e-2
"""The same where velocities are obstructed, since motions are known to a step's curvature there."""
CURVED_NOISE = 1e-3
"""What may be wrong in a twist that is taken from such a motion."""
NEW = 10.0
"""Times what may be wrong in a motion, beyond which what is left of it beside those already found makes another one of it."""
NEAR = 4e-6
"""Difference of two unit twists, along any direction, beyond which they are not shared up to ``ALONE``."""
ASLANT = np.array([0.37, 0.43, 0.29, 0.53, 0.41, 0.39])
"""A direction, about one long, that favours no twist, to sort them along."""
STILL = 1e-6
"""Rate of a coupling, beside the largest of its joints', that a twist does not change."""
MOST = 10_000
"""Pairs of joints compared at once, which bounds the memory."""


@dataclass(frozen=True, slots=True)
class IdleFreedom:
    """Freedoms of some nodes that move nothing else, such as a rod's spin."""

    nodes: tuple[int, ...]
    count: int


def idle_freedoms(assembly: Assembly) -> list[IdleFreedom]:
    """All of them, at the closed pose, the smallest sets of bodies first."""
    if not assembly.freedoms or not len(assembly.pairs):
        return []
    search = _search_of(assembly)
    search.know_all_as_one()
    found = list(search.singles())
    for edges in search.cuts.classes:
        for first, last in _sharing(edges, search.twists, search.tolerance(edges[0])):
            found += search.between(first, last)
    return found


@dataclass(slots=True, eq=False)
class _Search:
    """bodies: of each node, bodies that nothing lets move against each other.  twists: orthonormal, shape (6, n), by which
    the two nodes of each edge may move against each other, all about one ``point``.  part: of each edge, of ``freedoms``.
    coupled: of each row over several pairs, by the nodes of each of its atoms, what a twist of the second adds to it, shape
    (6,).  left: freedoms of each block of joints that are not known to be idle.  known: motions found, by node, orthonormal, and what
    may be wrong in each; known_of: those in which a node moves.
    """

    assembly: Assembly
    bodies: list[list[int]]
    cuts: CutPairs
    twists: list[Array]
    part: list[int]
    coupled: list[list[tuple[int, int, Array]]]
    point: Array
    left: dict[int, int]
    known: list[tuple[dict[int, Array], float]] = field(default_factory=list[tuple[dict[int, Array], float]])
    known_of: dict[int, list[int]] = field(default_factory=dict[int, list[int]])

    def tolerance(self, edge: int) -> float:
        """``ALONE``, or what noise in an edge's part makes of it."""
        return max(ALONE, self.assembly.freedoms[self.part[edge]].noise ** 2)

    def know_all_as_one(self) -> None:
        """A motion of all that floats is no motion of some beside the others: what is known besides it is told apart by how it moves
        against them."""
        nodes_of: dict[int, set[int]] = {}
        for edge, block in enumerate(self.cuts.block):
            if block >= 0 and self._floats(self.cuts.edges[edge][0]):
                nodes_of.setdefault(block, set()).update(self.cuts.edges[edge])
        for nodes in nodes_of.values():
            for twist in np.eye(6) / np.sqrt(len(nodes)):
                for node in nodes:
                    self.known_of.setdefault(node, []).append(len(self.known))
                self.known.append(({node: twist for node in nodes}, 0.0))

    def singles(self) -> Iterator[IdleFreedom]:
        """Nodes by themselves.  A chain's end is in no loop; what floats hangs on none of its neighbours."""
        for node in range(1, len(self.bodies)):
            edges = self.cuts.edges_of[node]
            ways = edges if self._floats(node) else [self.cuts.parent[node]]
            up = next((edge for edge in ways if self.cuts.block[edge] >= 0), -1)
            if up >= 0:
                twists = self.twists[up]
                for edge in edges:
                    twists = _common(twists, self.twists[edge], self.tolerance(up))
                yield from self._alone([node], up, twists)

    def _floats(self, node: int) -> bool:
        """Whether nothing holds a node to the ground: which of its neighbours is the root tells nothing then."""
        return self.cuts.root[node] != 0

    def between(self, first: int, last: int) -> Iterator[IdleFreedom]:
        """What lies between two edges that cut a block, away from its root; of what floats what lies on the other side too."""
        cuts = self.cuts
        begin, end, after = cuts.lower(first), cuts.upper(last), cuts.lower(last)
        if not cuts.of_tree(last):
            end, after = after, end
        if begin == end or cuts.upper(first) == after or not self.left[cuts.block[first]]:
            return  # one node, or all that hangs on one
        inside, twists = self._side(begin, first, last)
        yield from self._alone(inside, first, twists)
        if self._floats(begin):
            outside, twists = self._side(cuts.upper(first), first, last)
            yield from self._alone(outside, first, twists)

    def _side(self, begin: int, first: int, last: int) -> tuple[list[int], Array]:
        """The nodes that two edges leave beside one, and the twists by which they move as one while all others stand still."""
        cuts, tolerance = self.cuts, self.tolerance(first)
        twists = _common(self.twists[first], self.twists[last], tolerance)
        nodes, seen = [begin], {begin}
        for node in nodes:
            if not twists.shape[1]:
                break
            for edge in cuts.edges_of[node]:
                other = cuts.other(edge, node)
                if cuts.block[edge] < 0 or cuts.block[edge] != cuts.block[first]:
                    twists = _common(twists, self.twists[edge], tolerance)
                elif edge not in (first, last) and other not in seen:
                    seen.add(other)
                    nodes.append(other)
        return nodes, twists

    def _alone(self, nodes: list[int], edge: int, twists: Array) -> Iterator[IdleFreedom]:
        """Of one set of nodes what is not known.  twists: what all the joints round them leave."""
        block = self.cuts.block[edge]
        twists = self._left_by_couplings(set(nodes), twists)
        if not twists.shape[1] or not self.left[block]:
            return
        bodies = sorted(body for node in nodes for body in self.bodies[node])
        # the joints may leave a twist to first order alone, as a slot across does
        going = _that_go_on(self.assembly, bodies, twists, self.point)
        noise = CURVED_NOISE if going.shape[1] < twists.shape[1] else float(np.sqrt(self.tolerance(edge)))
        count = sum(self._is_new(nodes, twist, noise) for twist in going.T)  # a ram's spin is that of its tube and its piston, if these turn
        if count:
            self.left[block] -= count
            yield IdleFreedom(tuple(sorted(n for body in bodies for n in self.assembly.nodes[body])), count)

    def _left_by_couplings(self, nodes: set[int], twists: Array) -> Array:
        """What couplings leave of twists of some nodes, as one, while all others stand still."""
        for atoms in self.coupled:
            moving = [((b in nodes) - (a in nodes)) * wrench for a, b, wrench in atoms]
            rates = np.sum(moving, axis=0) @ twists
            if np.linalg.norm(rates) > STILL * max(float(np.linalg.norm(wrench)) for wrench in moving):
                twists = twists @ np.linalg.svd(rates[None])[2][1:].T
        return twists

    def _is_new(self, nodes: list[int], twist: Array, noise: float) -> bool:
        """Whether more is left of a motion beside those known than may be wrong in it; then it is known from now on.

        What is wrong in the known ones is as much larger in it as little was left of them: the spins of two nuts on a screw of small
        lead differ by little, and are two."""
        motion = {node: twist / np.sqrt(len(nodes)) for node in nodes}
        for number in sorted({k for node in nodes for k in self.known_of.get(node, [])}):
            other, its_noise = self.known[number]
            along = sum(float(motion[node] @ own) for node, own in other.items() if node in motion)
            noise += abs(along) * its_noise
            for node, own in other.items():
                motion[node] = motion.get(node, 0.0) - along * own
        rest = float(np.sqrt(sum(float(own @ own) for own in motion.values())))
        if rest <= NEW * noise:
            return False
        for node in motion:
            self.known_of.setdefault(node, []).append(len(self.known))
        self.known.append(({node: own / rest for node, own in motion.items()}, noise / rest))
        return True


def _search_of(assembly: Assembly) -> _Search:
    """The graph of an assembly's bodies.  Those that only a joint which may break keeps apart are one node."""
    length = assembly.equations.length
    system, label = assembly.system, np.arange(assembly.system.bodies)
    while True:
        pairs = pairs_of(system)
        twists, point = _twists_of(system, pairs, length)
        if all(own.shape[1] for own in twists):
            break
        partition = Partition(system.bodies)
        for i, own in enumerate(twists):
            if not own.shape[1]:
                partition.join(int(pairs.first[i]), int(pairs.second[i]))
        labels = partition.labels()
        label, system = labels[label], replace(system.relabel(labels), length=np.full(system.bodies, length))
    numbers, rows = np.unique(pairs.row_pair, return_index=True)
    bodies: list[list[int]] = [[] for _ in range(system.bodies)]
    for body, node in enumerate(label.tolist()):
        bodies[node].append(body)
    cuts = cut_pairs(system.bodies, list(zip(pairs.first.tolist(), pairs.second.tolist())))
    part = assembly.solver.row_part[rows[numbers >= 0]].tolist()
    coupled = _coupled(system, pairs, point, length)
    return _Search(assembly, bodies, cuts, twists, part, coupled, point, _freedoms_of_blocks(assembly, bodies, cuts, part))


def _freedoms_of_blocks(
    assembly: Assembly, bodies: list[list[int]], cuts: CutPairs, part: list[int]
) -> dict[int, int]:
    """What each block of joints can do in itself, 0 where that is but one motion.  Couplings close no loop: a part of the
    system may hold several blocks, and what hangs on them."""
    edges_of: dict[int, list[int]] = {}
    for edge, block in enumerate(cuts.block):
        if block >= 0:
            edges_of.setdefault(block, []).append(edge)
    found: dict[int, int] = {}
    for block, edges in edges_of.items():
        freedom, finite = assembly.freedoms[part[edges[0]]], assembly.finite[part[edges[0]]]
        nodes = sorted({node for edge in edges for node in cuts.edges[edge]})
        count = finite.mobility
        if count > 1 and len(nodes) <= len(freedom.bodies):  # else it is the part
            place = {body: i for i, body in enumerate(freedom.bodies.tolist())}
            turned = finite.tangent.reshape(len(place), 6, -1)
            twists = moved_to_one_point(turned, freedom.bodies, assembly.relative)
            at_rest = np.zeros((1, 6, count))
            own = np.concatenate([twists, at_rest])[[place.get(bodies[node][0], -1) for node in nodes]]
            # beside a steep rack a motion that is known exactly may be a small share of all that move
            some = CURVED if finite.singular else max(SURE, freedom.noise)
            count = int(np.linalg.matrix_rank((own - own[:1]).reshape(-1, count), tol=some))
        found[block] = count if count > 1 else 0
    return found


def _coupled(system: System, pairs: Pairs, point: Array, length: float) -> list[list[tuple[int, int, Array]]]:
    """The rows over several pairs, see ``_Search``."""
    atoms = np.flatnonzero((pairs.row_pair[system.row] == -1) & (system.body_a != system.body_b))
    _, f, c, tau = system.values(system.start())
    lever = c[atoms] - point
    moment = cross(lever, f[atoms]) + tau[atoms]
    wrench = system.weight[atoms, None] * np.concatenate([f[atoms] * length, moment], axis=1)
    by_row: dict[int, list[tuple[int, int, Array]]] = {}
    ends = zip(system.body_a[atoms].tolist(), system.body_b[atoms].tolist(), wrench)
    for row, atom in zip(system.row[atoms].tolist(), ends):
        by_row.setdefault(row, []).append(atom)
    return list(by_row.values())


def _twists_of(system: System, pairs: Pairs, length: float) -> tuple[list[Array], Array]:
    """Of each pair orthonormal twists (v / length, w) that its rows leave, all about one point, shape (6, n); and this point."""
    rows, origin, own_length = relative_rows(system, pairs, system.start())
    rank, _, vt, _, _ = batched_null_spaces(rows, pairs.row_pair, len(pairs))
    left = vt.copy()
    # Where joints that may break hold all bodies together no pair is left.
    point: Array = origin.mean(axis=0) if len(pairs) else np.zeros(3)
    arm = point - origin
    left[:, :, :3] = (vt[:, :, :3] * own_length[:, None, None] + cross(vt[:, :, 3:], arm[:, None])) / length
    twists = [left[i, r:].T for i, r in enumerate(rank.tolist())]
    for _, alike_ones in alike(own.shape for own in twists):
        members: list[int] = alike_ones.tolist()
        for i, own in zip(members, np.linalg.qr(np.array([twists[i] for i in members]))[0]):
            twists[i] = own
    return twists, point


def _common(a: Array, b: Array, tolerance: float) -> Array:
    """What of one span, shape (6, n), lies in another one too."""
    if not a.shape[1]:
        return a
    _, s, vt = np.linalg.svd(b.T @ a)
    return a @ vt[: int(np.sum(s**2 > 1.0 - tolerance))].T


def _that_go_on(assembly: Assembly, bodies: list[int], twists: Array, point: Array) -> Array:
    """What of the twists by which bodies move as one is a finite motion of theirs, as one, while all others stand still, those that
    hang on them too.

    twists: see ``_Search``, about ``point``.
    """
    label = np.zeros(assembly.system.bodies, dtype=np.int64)
    label[bodies] = 1
    one = assembly.system.relabel(label)
    rows = np.unique(one.row[one.body_a != one.body_b])  # what a coupling counts from inside of them stands still
    own = one.part(np.flatnonzero(np.isin(one.row, rows)), rows, np.array([1]))
    solver = Solver.fitted(own, assembly.equations.length)
    start = own.start()
    finite = finite_freedoms(solver, block_freedoms(solver, start), start)[0]
    if not 0 < finite.mobility < twists.shape[1]:
        return twists[:, : finite.mobility]
    velocity, turning = finite.tangent[:3].T * own.length[1], finite.tangent[3:].T
    moved = (velocity + cross(turning, point - own.center[1])) / assembly.equations.length
    tangent = np.linalg.qr(np.concatenate([moved, turning], axis=1).T)[0]
    return twists @ np.linalg.svd(twists.T @ tangent)[0][:, : finite.mobility]


def _sharing(edges: list[int], twists: list[Array], tolerance: float) -> list[tuple[int, int]]:
    """Pairs of a class of edges that share a twist, the nearest first.

    Hinges, of which a loop may have hundreds, share theirs only where it is the same, so they are sorted by it; the few
    joints with more freedoms are compared with all.
    """
    joints = [twists[edge] for edge in edges]
    pairs: list[tuple[int, int]] = []
    plain = [i for i, own in enumerate(joints) if own.shape[1] == 1]
    key = np.abs(np.array([joints[i][:, 0] for i in plain]).reshape(-1, 6) @ ASLANT)
    order: list[int] = np.argsort(key, kind="stable").tolist()
    for at, here in enumerate(order):
        for there in order[at + 1 :]:
            if key[there] - key[here] > NEAR * np.sqrt(tolerance / ALONE):
                break
            pairs.append((plain[here], plain[there]))
    for i, own in enumerate(joints):
        if own.shape[1] > 1:
            pairs += [(i, j) for j, other in enumerate(joints) if other.shape[1] == 1 or j > i]
    ordered = sorted((min(pair), max(pair)) for pair in pairs)
    sizes: dict[tuple[int, int], list[tuple[int, int]]] = {}
    for i, j in ordered:
        sizes.setdefault((joints[i].shape[1], joints[j].shape[1]), []).append((i, j))
    shared: list[tuple[int, int]] = []
    for same in sizes.values():
        for at in range(0, len(same), MOST):
            some = same[at : at + MOST]
            a, b = (np.array([joints[pair[end]] for pair in some]) for end in (0, 1))
            largest = np.linalg.svd(np.swapaxes(a, 1, 2) @ b, compute_uv=False)[:, 0]
            shared += [pair for pair, s in zip(some, largest.tolist()) if s**2 > 1.0 - tolerance]
    nearest = sorted(shared, key=lambda pair: (pair[1] - pair[0], pair[0]))
    return [(edges[i], edges[j]) for i, j in nearest]
