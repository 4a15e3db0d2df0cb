"""Which joints span the assembly and which close its loops."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...model import RX, JointKind, Motion
from ...spatial import IntArray
from ..joints.links import Link, Links

_Offer = tuple[bool, bool, int, int, int, int, int, int]
"""What a joint is worth, least first; its index; the body that it would hold."""


@dataclass(eq=False)
class Tree:
    """A spanning tree of the joints.

    links: all of them, closures marked, in their own order.  parent: shape (bodies,), index into links of
    the joint that holds each body, -1 for roots.  order: bodies outwards.  closures: indices of the joints
    left over, one for each independent loop, by precedence.
    """

    links: list[Link]
    parent: IntArray
    order: list[int]
    closures: list[int]

    def way(self, a: int, b: int) -> list[int] | None:
        """Indices of the links that lead from body a to body b, or None where none do."""
        out: list[int] = []
        back: list[int] = []
        while a != b:  # the one further out along the tree cannot hold the other
            further = a if self._place[a] > self._place[b] else b
            index = int(self.parent[further])
            if index < 0:
                return None
            link = self.links[index]
            inwards = link.a if link.b == further else link.b
            if further == a:
                a = inwards
                out.append(index)
            else:
                b = inwards
                back.append(index)
        return out + back[::-1]

    def loop(self, closure: int) -> tuple[int | None, ...]:
        """The nodes that a closing joint closes a loop with, from its a to its b: see ``JointFinding.loop``."""
        link = self.links[closure]
        at, nodes = link.a, [link.joint.a]
        for index in self.way(link.a, link.b) or ():
            passed = self.links[index]
            at, node = (passed.b, passed.joint.b) if passed.a == at else (passed.a, passed.joint.a)
            nodes.append(node)
        return (*nodes[:-1], link.joint.b)

    @cached_property
    def _place(self) -> IntArray:
        """Each body's place in ``order``."""
        place = np.full(len(self.parent), -1)
        place[self.order] = np.arange(len(self.order))
        return place


def spanning_tree(links: Links) -> Tree:
    """Grow from ground (then from the first body of each floating island), best joints first.

    What the source says to close a loop does so if it can.
    A joint that carries limits or a drive is wanted in the tree, where its coordinate is exact; so is one
    with few freedoms, which leaves the freest (ball before hinge) to close loops.  Among equals the tree
    stays shallow and follows what turns rather than what slides, since a crank drives and a slide follows.
    What is equal in all of that comes by kind and in the links' own order, which is by place (``canonical``).
    """
    kinds = [link.joint.kind.value for link in links.links]
    precedence = np.empty(len(kinds), dtype=np.int64)
    precedence[sorted(range(len(kinds)), key=kinds.__getitem__)] = np.arange(len(kinds))
    near: dict[int, list[int]] = {}
    for i, link in enumerate(links.links):
        near.setdefault(link.a, []).append(i)
        near.setdefault(link.b, []).append(i)
    parent = np.full(links.bodies, -1)
    seen = np.zeros(links.bodies, dtype=bool)
    depth = np.zeros(links.bodies, dtype=np.int64)
    slides = np.zeros(links.bodies, dtype=np.int64)
    order: list[int] = []
    used: set[int] = set()
    for start in range(links.bodies):
        if seen[start] or (start > 0 and start not in near):
            continue
        seen[start] = True
        order.append(start)
        heap: list[_Offer] = []
        _offer(heap, links, near, start, depth, slides, used, precedence)
        while heap:
            *_, index, body = heapq.heappop(heap)
            if seen[body]:
                continue
            link = links.links[index]
            from_ = link.a if link.b == body else link.b
            seen[body] = True
            parent[body] = index
            depth[body] = depth[from_] + 1
            slides[body] = slides[from_] + (RX in link.joint.locked)
            used.add(index)
            order.append(body)
            _offer(heap, links, near, body, depth, slides, used, precedence)
    closures = sorted((i for i in range(len(links.links)) if i not in used), key=precedence.__getitem__)
    tree = Tree(list(links.links), parent, order, closures)
    for i, link in enumerate(links.links):
        if i not in used:
            tree.links[i] = link.found(closure=True, loop=tree.loop(i))
    return tree


def _offer(
    heap: list[_Offer],
    links: Links,
    near: dict[int, list[int]],
    body: int,
    depth: IntArray,
    slides: IntArray,
    used: set[int],
    precedence: IntArray,
) -> None:
    for i in near.get(body, []):
        if i in used:
            continue
        link = links.links[i]
        other = link.b if link.a == body else link.a
        free = [link.joint.freedoms[f] for f in link.joint.unlocked]
        plain = not any(f.motion is Motion.LIMITED or f.drive is not None for f in free)
        dof = len(free) - (link.joint.kind is JointKind.SCREW)
        shallow = int(depth[body]) + 1, int(slides[body])
        heapq.heappush(heap, (link.joint.closes, plain, dof, *shallow, int(precedence[i]), i, other))
