"""The pairs of edges without which a block of a graph falls in two.

Such edges come in classes, each of which lies on one circle that any two of its edges cut.  Of a depth-first search each
edge back to an ancestor takes a random number and each tree edge the sum (XOR) of those that go round it: edges with equal
numbers are a class (Pritchard & Thurimella 2011, *Fast computation of small cuts via cycle space sampling*).
"""

from __future__ import annotations

import random
from dataclasses import dataclass


@dataclass(slots=True, eq=False)
class CutPairs:
    """edges: the two nodes of each, no two alike.  edges_of: those of each node.  depth: of each node in the search's tree.
    parent: for each node the edge that leads to its root, -1 for a root.  root: of each node.  block: for each edge a number that its block
    has alone, -1 for one that is on no circle.

    classes: edges of which any two cut a block, from the root outwards, and then back to it: what lies between two of
    them does not hang on the root.
    """

    edges: list[tuple[int, int]]
    edges_of: list[list[int]]
    depth: list[int]
    parent: list[int]
    root: list[int]
    block: list[int]
    classes: list[list[int]]

    def upper(self, edge: int) -> int:
        """The end of an edge that is nearer to the root along the tree."""
        return min(self.edges[edge], key=self.depth.__getitem__)

    def lower(self, edge: int) -> int:
        """The other end."""
        return max(self.edges[edge], key=self.depth.__getitem__)

    def other(self, edge: int, node: int) -> int:
        """The end of an edge that is not this one."""
        a, b = self.edges[edge]
        return b if a == node else a

    def of_tree(self, edge: int) -> bool:
        """Whether an edge is of the search's tree, not one back to an ancestor."""
        return self.parent[self.lower(edge)] == edge


def cut_pairs(nodes: int, edges: list[tuple[int, int]]) -> CutPairs:
    """Of a graph; node 0 is the root of what hangs together with it."""
    edges_of: list[list[int]] = [[] for _ in range(nodes)]
    for edge, ends in enumerate(edges):
        for node in ends:
            edges_of[node].append(edge)
    found = CutPairs(edges, edges_of, [-1] * nodes, [-1] * nodes, list(range(nodes)), [-1] * len(edges), [])
    label = [0] * len(edges)
    draw = random.Random(1)
    for root in range(nodes):
        if found.depth[root] < 0:
            _search(found, root, label, draw)
    by_label: dict[int, list[int]] = {}
    for edge, block in enumerate(found.block):
        if block >= 0:
            by_label.setdefault(label[edge], []).append(edge)
    for members in by_label.values():
        if len(members) > 1:
            members.sort(key=lambda edge: (not found.of_tree(edge), found.depth[found.lower(edge)]))
            found.classes.append(members)
    return found


def _search(found: CutPairs, root: int, label: list[int], draw: random.Random) -> None:
    """Depth first, from one root.  label: of each edge, filled in."""
    depth, parent = found.depth, found.parent
    low, around = {root: 0}, {root: 0}
    depth[root] = 0
    open_edges: list[int] = []
    path = [(root, 0)]
    while path:
        node, at = path.pop()
        if at < len(found.edges_of[node]):
            path.append((node, at + 1))
            edge = found.edges_of[node][at]
            other = found.other(edge, node)
            if depth[other] < 0:
                open_edges.append(edge)
                parent[other], depth[other], found.root[other] = edge, depth[node] + 1, root
                low[other], around[other] = depth[other], 0
                path.append((other, 0))
            elif edge != parent[node] and depth[other] < depth[node]:
                open_edges.append(edge)
                label[edge] = draw.getrandbits(64)
                around[node] ^= label[edge]
                around[other] ^= label[edge]
                low[node] = min(low[node], depth[other])
        elif parent[node] >= 0:
            up = parent[node]
            above = found.other(up, node)
            label[up] = around[node]
            around[above] ^= around[node]
            low[above] = min(low[above], low[node])
            if low[node] >= depth[above]:
                first = _place(open_edges, up)
                for member in open_edges[first:]:
                    found.block[member] = up if len(open_edges) - first > 1 else -1
                del open_edges[first:]


def _place(stack: list[int], edge: int) -> int:
    """Where an edge stands, looked for from the end."""
    at = len(stack) - 1
    while stack[at] != edge:
        at -= 1
    return at
