"""Which parts hang together by joints, ground left out, and what each such island can do."""

from __future__ import annotations

from dataclasses import dataclass, field

from ...model import Coupling, Joint
from ...partition import Partition
from ..assembly.assemble import Assembly
from ..joints.links import Link
from ..loops.spanning import Tree

GROUND = 0
"""The body that never moves."""


@dataclass(slots=True)
class Island:
    """Rigid groups that hang together by joints, ground left out.

    nodes: in scene order.  floating: nothing joins it to ground, six of its freedoms are its own.
    loops: of the joints that are exported.  slack: how many of these a joint closes that removes nothing, such as a rope.
    """

    floating: bool
    nodes: list[int] = field(default_factory=list[int])
    mobility: int = 0
    first_order: int = 0
    rows: int = 0
    redundant: int = 0
    loops: int = 0
    slack: int = 0


def islands_of(
    assembly: Assembly, tree: Tree, links: list[Link], aside: list[Joint], couplings: list[Coupling]
) -> list[Island]:
    """Connected by joints without ground: on ground, every branch from it is an island of its own.

    links: the joints as they are exported; one that removes nothing closes no loop, unless a coupling counts from it.
    aside: those that remove nothing in the source; one with an end or a drive joins its two sides all the same, as Unity
    needs a joint for it: a rope from one arm to another makes one island of both, with a loop.
    """
    ropes = [_bodies(assembly, joint) for joint in aside if any(f.acts for f in joint.freedoms)]
    part = _held_together(assembly, tree, {body for pair in ropes for body in pair})
    floating = {int(root) for root in assembly.blocks.island_root[1:]}
    together, hanging = Partition(len(part)), Partition(len(part))
    for own in set(part) - floating:
        hanging.join(GROUND, own)
    slack: list[int] = []
    for a, b in ((part[a], part[b]) for a, b in ropes if a != b):
        if not hanging.join(a, b):
            slack.append(max(a, b))
        if GROUND not in (a, b):
            together.join(a, b)
    found = {key: Island(hanging.find(key) != GROUND) for key in {together.find(own) for own in part}}
    of_body = [found[together.find(own)] for own in part]
    _count_loops(of_body, links, slack, couplings)
    _count_freedoms(of_body, assembly, set(part) & floating)
    bodies: list[int] = assembly.body[1:].tolist()
    for node, body in enumerate(bodies):
        of_body[body].nodes.append(node)
    moving = [island for key, island in found.items() if key != GROUND and island.nodes]
    return sorted(moving, key=lambda island: island.nodes[0])


def _count_loops(
    of_body: list[Island], links: list[Link], slack: list[int], couplings: list[Coupling]
) -> None:
    """slack: for each rope that closes a loop a body of its island."""
    counted = {id for c in couplings for id in c.joints}
    for link in links:
        # where the loop holds all of it, Unity has a joint only between two bodies, which must not collide
        written = link.joint.locked or link.joint.id in counted or (link.finding.freed and link.a and link.b)
        if link.finding.closure and written:
            of_body[link.b if of_body[link.a] is of_body[GROUND] else link.a].loops += 1
    for body in slack:
        of_body[body].loops += 1
        of_body[body].slack += 1


def _count_freedoms(of_body: list[Island], assembly: Assembly, floating: set[int]) -> None:
    """floating: a body of each part that no row holds to the ground, whose six freedoms are no block's."""
    for body in floating:
        of_body[body].mobility += 6
        of_body[body].first_order += 6
    for first, finite in zip(assembly.freedoms, assembly.finite):
        own = of_body[int(first.bodies[0])]
        own.mobility += finite.mobility
        own.first_order += first.mobility
        own.rows += len(first.rows)
        own.redundant += len(first.rows) - first.rank


def _held_together(assembly: Assembly, tree: Tree, roped: set[int]) -> list[int]:
    """For each body the lowest of those that rows hold to it without ground; ``GROUND`` for what stands on it and for
    bodies that nothing joins, unless they are among those roped."""
    branch = [GROUND] * len(tree.parent)
    for body in tree.order:
        link = None if tree.parent[body] < 0 else tree.links[int(tree.parent[body])]
        inwards = GROUND if link is None else link.a if link.b == body else link.b
        branch[body] = body if inwards == GROUND else branch[inwards]
    for body in roped:
        branch[body] = branch[body] or body
    together = Partition(len(branch))
    ties = [(tree.links[i].a, tree.links[i].b) for i in tree.closures]
    ties += [(int(f.bodies[0]), int(b)) for f in assembly.freedoms for b in f.bodies[1:]]
    for a, b in ties:
        if GROUND not in (branch[a], branch[b]):
            together.join(branch[a], branch[b])
    return [together.find(own) for own in branch]


def _bodies(assembly: Assembly, joint: Joint) -> tuple[int, int]:
    return assembly.body_of(joint.a), assembly.body_of(joint.b)
