"""What bodies can do together, with the joints between them: twists carried along a tree of the joints, then the loops.

A column a freedom instead of six a body, and rows for the joints that close loops only.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

import numpy as np

from ...spatial import Array
from .edge import Edge
from .freedom import Scale, null_space


def motions_of(members: Sequence[int], edges: Sequence[Edge]) -> Array:
    """Twists of all members, in order, the first one still, about the first edge's centre; shape (6 n, k), orthonormal."""
    base = edges[0].scale
    tree, loops = _tree(members, edges)
    size = sum(6 if edge is None else edge.space.shape[1] for edge, _, _ in tree)
    index = {body: i for i, body in enumerate(members)}
    twists = np.zeros((len(members), 6, size))
    column = 0
    for edge, known, new in tree:
        if edge is None:  # hung on nothing: it goes as it likes
            own = np.eye(6)
        else:
            twists[index[new]] = twists[index[known]]
            own = np.linalg.solve(shift_of(edge.scale, base), edge.space)
            own = own if new == edge.pair[1] else -own
        twists[index[new], :, column : column + own.shape[1]] = own
        column += own.shape[1]
    rows = [_held(edge, base) @ (twists[index[edge.pair[1]]] - twists[index[edge.pair[0]]]) for edge in loops]
    moving = twists.reshape(6 * len(members), size)
    if size and rows:
        moving = moving @ null_space(np.concatenate(rows))
    return np.linalg.qr(moving)[0] if moving.shape[1] else moving


def held_rows(members: list[int], edge: Edge, base: Scale) -> Array:
    """What an edge holds, as rows on the twists of all members about ``base``."""
    moved = _held(edge, base)
    block = np.zeros((len(moved), 6 * len(members)))
    a, b = (6 * members.index(body) for body in edge.pair)
    block[:, b : b + 6], block[:, a : a + 6] = moved, -moved
    return block


def _tree(
    members: Sequence[int], edges: Sequence[Edge]
) -> tuple[list[tuple[Edge | None, int, int]], list[Edge]]:
    """Edges that lead on, each with the body it starts from and the new one, breadth first; and those that close loops."""
    at: defaultdict[int, list[Edge]] = defaultdict(list)
    for edge in edges:
        for body in edge.pair:
            at[body].append(edge)
    reached, used = {members[0]}, set[int]()
    tree: list[tuple[Edge | None, int, int]] = []
    for start in members:
        if start not in reached:
            reached.add(start)
            tree.append((None, start, start))
        front = [start]
        for body in front:
            for edge in at[body]:
                other = edge.pair[1] if edge.pair[0] == body else edge.pair[0]
                if other not in reached:
                    reached.add(other)
                    used.add(id(edge))
                    tree.append((edge, body, other))
                    front.append(other)
    return tree, [edge for edge in edges if id(edge) not in used]


def _held(edge: Edge, base: Scale) -> Array:
    """What an edge holds, as rows on a twist about ``base``."""
    held = null_space(edge.space.T).T if edge.space.shape[1] else np.eye(6)
    return held @ shift_of(edge.scale, base)


def shift_of(own: Scale, base: Scale) -> Array:
    """What takes a twist about ``base`` to one about ``own``: v' = v + w x (c' - c), w' = w L'/L."""
    offset = own.center - base.center
    x, y, z = offset / base.length
    matrix = np.eye(6)
    # w x d = -[d]x w
    matrix[:3, 3:] = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
    matrix[3:, 3:] *= own.length / base.length
    return matrix
