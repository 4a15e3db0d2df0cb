"""Splits an assembly where one body alone holds two sides together.

Blocks (biconnected components of the graph of bodies) do not influence each other's relative motion, so
mobility adds over them, and every body except a block's root belongs to exactly one block.  Written
against its block's root, an assembly falls into small independent systems (Hopcroft & Tarjan 1973).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ...spatial import Array, IntArray
from ..equations.system import System


@dataclass(slots=True, eq=False)
class Blocks:
    """The block-cut tree.

    block: shape (bodies,), the block in which a body is not the root; -1 for the roots of islands.
    root: shape (blocks,), the body a block hangs from.  order: bodies, every root before its block's.
    island: shape (bodies,), number of the connected part; island 0 holds body 0 (ground).
    island_root: shape (islands,), body that the island hangs from; body 0 or, floating, one of its own.
    """

    block: IntArray
    root: IntArray
    order: IntArray
    island: IntArray
    island_root: IntArray

    def members(self) -> list[IntArray]:
        """Bodies of each block without its root."""
        order = np.argsort(self.block, kind="stable")
        starts = np.searchsorted(self.block[order], np.arange(len(self.root) + 1))
        return [order[starts[i] : starts[i + 1]] for i in range(len(self.root))]

    def of_pair(self, a: int, b: int) -> int:
        """The block that two joined bodies are in: that in which the one further out is not the root."""
        inside = self.block[b] >= 0 and (self.block[a] == self.block[b] or self.root[self.block[b]] == a)
        return int(self.block[b] if inside else self.block[a])

    def of_edges(self, ends: IntArray) -> IntArray:
        """The block of each pair of joined bodies, shape (edges, 2) to (edges,)."""
        age = _block_age(self)[ends]
        return self.block[np.take_along_axis(ends, age.argmax(axis=1)[:, None], axis=1)[:, 0]]

    def generations(self) -> Iterator[IntArray]:
        """The bodies of all blocks, roots first: those that are equally many blocks from their island's root."""
        depth = np.zeros(len(self.block), dtype=np.int64)
        root, block = self.root.tolist(), self.block.tolist()
        for body in self.order.tolist():
            if block[body] >= 0:
                depth[body] = depth[root[block[body]]] + 1
        order = np.argsort(depth, kind="stable")
        starts = np.searchsorted(depth[order], np.arange(1, int(depth.max(initial=0)) + 2))
        for at, end in zip(starts.tolist(), starts[1:].tolist()):
            yield order[at:end]

    def carry(self, rotation: Array, translation: Array, bodies: Iterable[int]) -> None:
        """Turn displacements against each block's root into displacements, in place.

        bodies: those to do, roots first.  rotation, translation: of all bodies, shapes (bodies, 3, 3) and (bodies, 3).
        """
        for body in bodies:
            if self.block[body] >= 0:
                root = self.root[self.block[body]]
                translation[body] = rotation[root] @ translation[body] + translation[root]
                rotation[body] = rotation[root] @ rotation[body]


def edges_of(system: System) -> IntArray:
    """Pairs of bodies that share a row, each once, shape (edges, 2); all pairs of a wider row.  What a row counts from inside
    of one body stands still, and joins nothing."""
    low = np.minimum(system.body_a, system.body_b)
    high = np.maximum(system.body_a, system.body_b)
    across = low != high
    pairs = [np.stack([low, high], axis=1)[across]]
    many = np.flatnonzero(np.bincount(system.row, minlength=system.rows) > 1)
    if len(many):
        atoms = np.flatnonzero(np.isin(system.row, many) & across)
        by_row: dict[int, set[int]] = {}
        for atom in atoms:
            by_row.setdefault(int(system.row[atom]), set()).update((int(low[atom]), int(high[atom])))
        extra = [
            (i, j) for bodies in by_row.values() if len(bodies) > 2 for i in bodies for j in bodies if i < j
        ]
        if extra:
            pairs.append(np.array(extra))
    return np.unique(np.concatenate(pairs), axis=0)


def blocks_of(bodies: int, edges: IntArray) -> Blocks:
    """Depth-first search from ground, then from the first body of every floating island."""
    ends = np.concatenate([edges, edges[:, ::-1]])
    ends = ends[np.lexsort((ends[:, 1], ends[:, 0]))]
    starts: list[int] = np.searchsorted(ends[:, 0], np.arange(bodies + 1)).tolist()
    neighbours: list[int] = ends[:, 1].tolist()
    depth = [-1] * bodies
    low = [0] * bodies
    block = np.full(bodies, -1)
    island = np.zeros(bodies, dtype=np.int64)
    roots: list[int] = []
    island_roots: list[int] = []
    order: list[int] = []
    for begin in range(bodies):
        if depth[begin] >= 0:
            continue
        island_roots.append(begin)
        depth[begin] = low[begin] = 0
        island[begin] = len(island_roots) - 1
        open_bodies: list[int] = []
        path = [(begin, -1, starts[begin])]
        while path:
            body, parent, at = path[-1]
            if at < starts[body + 1]:
                path[-1] = (body, parent, at + 1)
                other = neighbours[at]
                if depth[other] < 0:
                    depth[other] = low[other] = depth[body] + 1
                    island[other] = len(island_roots) - 1
                    open_bodies.append(other)
                    path.append((other, body, starts[other]))
                elif other != parent:
                    low[body] = min(low[body], depth[other])
                continue
            path.pop()
            if parent < 0:
                continue
            low[parent] = min(low[parent], low[body])
            if low[body] >= depth[parent]:
                while True:
                    member = open_bodies.pop()
                    block[member] = len(roots)
                    if member == body:
                        break
                roots.append(parent)
    order = sorted(range(bodies), key=depth.__getitem__)
    return Blocks(block, np.array(roots, dtype=np.int64), np.array(order), island, np.array(island_roots))


def relative_system(system: System, blocks: Blocks) -> System:
    """The same rows with every block's root at rest as body 0; body numbers stay.  What a row that joins bodies counts from
    inside of one stands still, in whichever block."""
    still = (system.body_a == system.body_b) & system.joining()[system.row]
    low, high = (np.where(still, 0, body) for body in (system.body_a, system.body_b))
    # a row's block is that of its bodies which are not the root: the largest, since the root's is older
    age = _block_age(blocks)
    key = np.full(system.rows, -1)
    for body in (low, high):
        np.maximum.at(key, system.row, age[body])
    root = np.concatenate([_roots_by_age(blocks), [0]])[key][system.row]
    return replace(system, body_a=np.where(low == root, 0, low), body_b=np.where(high == root, 0, high))


def _block_age(blocks: Blocks) -> IntArray:
    """For each body a number of its block that grows away from the island's root."""
    rank = np.empty(len(blocks.root), dtype=np.int64)
    rank[_by_age(blocks)] = np.arange(len(blocks.root))
    return np.where(blocks.block >= 0, rank[blocks.block] if len(rank) else -1, -1)


def _by_age(blocks: Blocks) -> IntArray:
    position = np.empty(len(blocks.block), dtype=np.int64)
    position[blocks.order] = np.arange(len(blocks.order))
    return np.lexsort((np.arange(len(blocks.root)), position[blocks.root]))


def _roots_by_age(blocks: Blocks) -> IntArray:
    return blocks.root[_by_age(blocks)]
