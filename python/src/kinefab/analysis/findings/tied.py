"""What a block holds that only couplings tie together: its loops, and the joints that couplings keep in step.

A coupling joins the bodies of both its joints, and with them what lies between: the shoulder of an arm whose elbow a belt
drives from the base.  The shoulder itself is tied to nothing, so what the rest can do is asked with the shoulder held.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ...spatial import Array, IntArray
from ..assembly.assemble import Assembly
from ..assembly.blocks import Blocks, blocks_of
from ..freedom.first_order import BlockFreedom

HELD = 1e-6
"""Singular value of the held joints' motions, of scaled twists, up to which a motion leaves all of them still."""


@dataclass(frozen=True, slots=True, eq=False)
class TiedPart:
    """freedom: motions with all else in the block held, of the part's own bodies.  root: the body that the part hangs
    from.  coupled: whether a coupling ties it."""

    freedom: BlockFreedom
    root: int
    coupled: bool


def tied_parts(assembly: Assembly, freedom: BlockFreedom) -> list[TiedPart]:
    """The parts of a block.  freedom: of the whole block, against its root."""
    root = int(assembly.blocks.root[assembly.blocks.block[freedom.bodies[0]]])
    pairs, system = assembly.pairs, assembly.system
    own = pairs.row_pair[freedom.rows]
    wide: list[int] = freedom.rows[own < 0].tolist()
    whole = [TiedPart(freedom, root, bool(wide))]
    if not wide:
        return whole
    bodies = [root, *freedom.bodies.tolist()]
    place = {body: i for i, body in enumerate(bodies)}
    numbers = np.unique(own[own >= 0])
    ends = [
        (place[a], place[b]) for a, b in zip(pairs.first[numbers].tolist(), pairs.second[numbers].tolist())
    ]
    if not ends:
        return whole
    edges = np.array(ends)
    inner = blocks_of(len(bodies), edges)
    block_of: dict[tuple[int, int], int] = {
        (min(edge), max(edge)): block for edge, block in zip(ends, inner.of_edges(edges).tolist())
    }
    ties: list[list[int]] = []
    for row in wide:
        atoms = np.flatnonzero(system.row == row)
        joined = {
            (min(place[a], place[b]), max(place[a], place[b]))
            for a, b in zip(system.body_a[atoms].tolist(), system.body_b[atoms].tolist())
            if a != b
        }
        if not joined <= block_of.keys():
            return whole  # it measures two bodies that nothing else joins
        ties.append([block_of[edge] for edge in joined])
    if inner.island.any():
        return whole  # a body that a coupling alone holds
    group = _merged(len(inner.root), ties)
    if len(set(group)) == 1:
        return whole
    coupled = {group[blocks[0]] for blocks in ties}
    parts: list[TiedPart] = []
    for number in sorted(set(group)):
        members = [i for i, block in enumerate(inner.block.tolist()) if block >= 0 and group[block] == number]
        held = [edge for edge, block in block_of.items() if group[block] != number]
        hangs = bodies[_root_of(inner, [i for i, g in enumerate(group) if g == number])]
        alone = _with_held(assembly, freedom, members, held)
        parts.append(TiedPart(alone, hangs, number in coupled))
    return parts


def _merged(count: int, ties: list[list[int]]) -> list[int]:
    """For each of ``count`` blocks the smallest one that couplings tie it to."""
    group = list(range(count))
    for tie in ties:
        joined = {group[block] for block in tie}
        group = [min(joined) if g in joined else g for g in group]
    return group


def _root_of(inner: Blocks, blocks: Iterable[int]) -> int:
    """The body, of all that these blocks hang from, which is nearest to the root of all."""
    order: list[int] = inner.order.tolist()
    return min((int(inner.root[block]) for block in blocks), key=order.index)


def _with_held(
    assembly: Assembly, freedom: BlockFreedom, members: list[int], held: list[tuple[int, int]]
) -> BlockFreedom:
    """Motions of some bodies while joints stand still.  members, held: the root is 0, the block's bodies count from 1."""
    twists = np.concatenate([np.zeros((1, 6, freedom.mobility)), freedom.about_one_point(assembly.relative)])
    basis: Array = freedom.basis
    if held:
        still = np.concatenate([twists[b] - twists[a] for a, b in held])
        _, s, vt = np.linalg.svd(np.linalg.qr(still, mode="r"))
        basis = basis @ vt[int(np.sum(s > HELD)) :].T
    rows: IntArray = np.array([6 * (k - 1) + i for k in members for i in range(6)])
    own_basis, _ = np.linalg.qr(basis[rows])
    return replace(freedom, bodies=freedom.bodies[np.array(members) - 1], basis=own_basis)
