"""Which joints span the assembly and which close its loops."""

from __future__ import annotations

import heapq
from dataclasses import dataclass, replace

import numpy as np

from ..model import RX, Constraint, Joint, JointKind, Motion
from ..spatial import Array
from .assembly import Assembly
from .jointing import Link, Links

ALIKE = 6
"""Digits of a distance, as a fraction of the assembly's length, by which two joints can be told apart."""


@dataclass(slots=True, eq=False)
class Tree:
    """A spanning tree of the joints.

    links: all of them, closures marked, in their own order.  parent: shape (bodies,), index into links of
    the joint that holds each body, -1 for roots.  order: bodies outwards.  closures: indices of the joints
    left over, one for each independent loop, by precedence.
    """

    links: list[Link]
    parent: np.ndarray
    order: list[int]
    closures: list[int]

    def loops_of(self, bodies: np.ndarray) -> int:
        inside = set(bodies.tolist())
        return sum(self.links[i].a in inside or self.links[i].b in inside for i in self.closures)


def spanning_tree(assembly: Assembly, links: Links) -> Tree:
    """Grow from ground (then from the first body of each floating island), best joints first.

    A joint that carries limits or a drive is wanted in the tree, where its coordinate is exact; so is one
    with few freedoms, which leaves the freest (ball before hinge) to close loops.  Among equals the tree
    stays shallow and follows what turns rather than what slides, since a crank drives and a slide follows.
    What is equal in all of that is told apart by ``_precedence``.
    """
    precedence = _precedence(assembly, links)
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
        heap: list[tuple] = []
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
            slides[body] = slides[from_] + (link.joint.freedoms[RX].motion is Motion.LOCKED)
            used.add(index)
            order.append(body)
            _offer(heap, links, near, body, depth, slides, used, precedence)
    closures = sorted((i for i in range(len(links.links)) if i not in used), key=precedence.__getitem__)
    marked = [
        replace_link(link, closure=i not in used) if (i not in used) != link.joint.closure else link
        for i, link in enumerate(links.links)
    ]
    return Tree(marked, parent, order, closures)


def _precedence(assembly: Assembly, links: Links) -> np.ndarray:
    """A number for each joint, smaller first, in which the order of the source has no part.

    Told apart by kind and by where the two bodies lie, which neither a new name nor another pose or unit
    changes; only mirror images of each other by name.
    """
    places = _places(assembly, links)
    known = places[~np.isnan(places[:, 0])]
    middle = known.mean(axis=0) if len(known) else np.zeros(3)
    base = middle if np.isnan(places[0, 0]) else places[0]
    apart = np.stack([np.linalg.norm(places - p, axis=1) for p in (base, middle)], axis=1)
    apart = np.round(np.nan_to_num(apart) / assembly.equations.length, ALIKE).tolist()
    keys = [
        (x.joint.kind.value, sorted((apart[x.a], apart[x.b])), sorted(x.joint.because), x.joint.id)
        for x in links.links
    ]
    number = np.empty(len(keys), dtype=np.int64)
    number[sorted(range(len(keys)), key=keys.__getitem__)] = np.arange(len(keys))
    return number


def _places(assembly: Assembly, links: Links) -> Array:
    """Shape (bodies, 3): mean of the parts' origins and constrained points of each body, NaN where it has none."""
    body = assembly.body
    owners = [int(b) for b in body[1:]]
    points = [pose.translation for pose in assembly.poses]
    owners += range(assembly.system.bodies, links.bodies)
    points += [node.pose.translation for node in links.nodes]
    for statement in assembly.equations.statements:
        if isinstance(statement, Constraint):
            sides = [(f.node, f.point) for f in statement.features]
        elif isinstance(statement, Joint):
            frames = (statement.a, statement.frame_a), (statement.b, statement.frame_b)
            sides = [(node, frame.translation) for node, frame in frames]
        else:
            continue
        for node, point in sides:
            owners.append(0 if node is None else int(body[node + 1]))
            points.append(point if node is None else assembly.poses[node].point(point))
    total, count = np.zeros((links.bodies, 3)), np.zeros(links.bodies)
    np.add.at(total, owners, np.array(points).reshape(-1, 3))
    np.add.at(count, owners, 1.0)
    return np.divide(total, count[:, None], out=np.full_like(total, np.nan), where=count[:, None] > 0)


def _offer(
    heap: list,
    links: Links,
    near: dict,
    body: int,
    depth: np.ndarray,
    slides: np.ndarray,
    used: set,
    precedence: np.ndarray,
) -> None:
    for i in near.get(body, []):
        if i in used:
            continue
        link = links.links[i]
        other = link.b if link.a == body else link.a
        free = [f for f in link.joint.freedoms if f.motion is not Motion.LOCKED]
        plain = not any(f.motion is Motion.LIMITED or f.drive is not None for f in free)
        dof = len(free) - (link.joint.kind is JointKind.SCREW)
        shallow = int(depth[body]) + 1, int(slides[body])
        heapq.heappush(heap, (plain, dof, *shallow, int(precedence[i]), i, other))


def replace_link(link: Link, **changes) -> Link:
    """The link with another joint, changed so."""
    return Link(link.a, link.b, replace(link.joint, **changes))
