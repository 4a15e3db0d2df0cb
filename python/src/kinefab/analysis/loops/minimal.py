"""Loop-closing joints with only their independent rows.

Every row of a closing joint that the rest of the loop implies makes an iterative solver fight itself.  A
planar four-bar's last hinge needs two of its five: the two in the plane.  Here the rows of a closing joint
are chosen, in its own frame, so that their span over the tree's freedoms is that of all its rows: the row
space, hence the null space and every body's freedoms, stay the same, and not only at the exported pose.
Either no motion of the tree can ever violate a row that is left out (out of the plane of a planar loop), or
poses along the motion decide, and what no basis of rows holds at all of them keeps more rows than a basis.
A walk along the mechanism with only the kept rows then checks that the left-out ones stay satisfied.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ...diagnostics import Report
from ...model import RX, Freedom, Joint, Motion, Scene, kind_of
from ...spatial import Array, IntArray, Pose
from ..assembly.assemble import Assembly
from ..assembly.blocks import relative_system
from ..equations.rows import Rows
from ..equations.scene_equations import frame_side, joint_rows
from ..equations.solve import Solver
from ..equations.system import State, System
from ..freedom.first_order import block_freedoms
from ..freedom.motion import stepped
from ..freedom.travel import poses_along
from ..joints.links import Link
from .openings import NONE, Block, BlockTree, Likeness, Openings, moved_by, openings, tree_twists
from .spanning import Tree

HELD = 0.1
"""Share that the kept rows must see, at every pose, of any way in which the tree lets a closing joint open."""
CLEAR = 0.9
"""A choice of rows must be this much better conditioned to win over an earlier one."""
WALK = 0.05
"""Radians or fractions of the length, of the walk that proves the choice."""
IMPLIED = 1e-8
"""Scaled residual of the left-out rows up to which the walk proves that nothing moves by them."""

ITS_OWN = "the other joints of the loop"
AND_OTHERS = f"{ITS_OWN}, with those of the loops that meet it,"
"""What holds the rows that are left out."""


@dataclass(frozen=True, slots=True)
class _Choice:
    """rows: the locked freedoms of a closing joint that stay.  repeated: how many of them, at each pose other ones,
    the others imply.  alone: the joints of its own loop imply what is left out, no other closing joint is needed."""

    rows: tuple[int, ...]
    repeated: int
    alone: bool = True


def minimal_closures(assembly: Assembly, tree: Tree, scene: Scene, report: Report) -> list[Link]:
    """The links with their closing joints reduced.  scene: with middle bodies, at the closed pose."""
    links = list(tree.links)
    if not tree.closures:
        return links
    frames = _world_frames(links, scene)
    chosen = _chosen(assembly, tree, frames)
    reduced: dict[int, Link] = {}
    for i, choice in chosen.items():
        joint = links[i].joint
        if len(choice.rows) < len(joint.locked):
            whole = links[i].found(freed=tuple(n for n in joint.locked if n not in choice.rows))
            reduced[i] = whole.changed(
                freedoms=_freed(joint, choice.rows),
                kind=kind_of(tuple(n for n in range(6) if n not in choice.rows)),
            )
    refused = _refused(assembly, links, reduced, frames)
    mobility = sum(f.mobility for f in assembly.finite) + 6 * assembly.floating
    for i, choice in chosen.items():
        joint = links[i].joint
        kept, freed = len(choice.rows), len(joint.locked) - len(choice.rows)
        if i in refused:
            report.add("CLOSURE_KEPT_WHOLE", joint.where, joint=joint.id, freed=freed)
            continue
        if i in reduced:
            links[i] = reduced[i]
            report.add(
                "CLOSURE_ROWS_FREED", joint.where, joint=joint.id, rows=kept + freed, kept=kept, mobility=mobility,
                freed=", ".join(map(joint.freedom_name, links[i].finding.freed)),
                loop=links[i].finding.loop_names(scene), holders=ITS_OWN if choice.alone else AND_OTHERS,
            )  # fmt: skip
        if choice.repeated:
            report.add(
                "CLOSURE_ROWS_REPEATED", joint.where, joint=joint.id, kept=kept, repeated=choice.repeated
            )
    return links


def _freed(joint: Joint, rows: tuple[int, ...]) -> tuple[Freedom, ...]:
    left = [i for i in joint.locked if i not in rows]
    return tuple(replace(f, motion=Motion.FREE) if i in left else f for i, f in enumerate(joint.freedoms))


def _blocks(assembly: Assembly, tree: Tree) -> list[Block]:
    """Closures by the block they are in; blocks at a singular pose keep their joints whole."""
    found: dict[int, Block] = {}
    system = assembly.system
    singular = {
        int(assembly.blocks.block[f.bodies[0]])
        for f, l in zip(assembly.freedoms, assembly.finite)
        if l.singular
    }
    age = np.full(len(tree.parent), -1)
    age[: system.bodies] = assembly.blocks.block
    position = {body: i for i, body in enumerate(assembly.blocks.order.tolist())}
    for body in range(system.bodies, len(tree.parent)):  # a middle body is in the block of its neighbours
        ends = [l.a if l.b == body else l.b for l in tree.links if body in (l.a, l.b)]
        age[body] = age[max(ends, key=lambda e: position.get(e, 0))]
    for i in tree.closures:
        link = tree.links[i]
        later = max((link.a, link.b), key=lambda body: position.get(body, len(position)))
        block = int(age[later])
        if block not in singular:
            found.setdefault(block, Block([], [])).closures.append(i)
    for body in tree.order:
        if age[body] in found:
            found[int(age[body])].bodies.append(body)
    return list(found.values())


def _chosen(assembly: Assembly, tree: Tree, frames: tuple[Array, Array]) -> dict[int, _Choice]:
    """The choice for each closure of a block that is not singular."""
    found: dict[int, _Choice] = {}
    doubtful: dict[Likeness, tuple[list[BlockTree], list[Openings]]] = {}
    blocks = [BlockTree(block, tree, frames) for block in _blocks(assembly, tree)]
    twists = tree_twists(blocks)
    here = [pose for pose in openings(twists) if pose is not None]  # there is one of every exported pose
    freed: list[tuple[int, Array, Array]] = []
    for n, block in enumerate(blocks):
        chosen = _choose(block, [here[n]])
        found |= chosen
        for (rows, twist), choice, link in zip(twists[n], chosen.values(), block.closing):
            left = [k for k, i in enumerate(link.joint.locked) if i not in choice.rows]
            if left:
                freed.append((n, rows[left], twist))
    moved = moved_by([rows for _, rows, _ in freed], [twist for *_, twist in freed])
    for n in dict.fromkeys(n for (n, *_), rows in zip(freed, moved) if rows.any()):
        doubtful.setdefault(blocks[n].likeness(), ([], [here[n]]))[0].append(blocks[n])
    _travel(assembly, tree, frames, [(alike[0], poses) for alike, poses in doubtful.values()])
    for alike, poses in doubtful.values():
        for block in alike:
            found |= _choose(block, poses)
    return found


def _choose(block: BlockTree, poses: list[Openings]) -> dict[int, _Choice]:
    found: dict[int, _Choice] = {}
    for k, (i, link) in enumerate(zip(block.block.closures, block.closing)):
        locked = link.joint.locked
        choice = _fewest(locked, [pose.span[k] for pose in poses])
        own = poses[0].rows[k]
        kept = own[[n for n, row in enumerate(locked) if row in choice.rows]]
        found[i] = replace(choice, alone=_rank(kept) == _rank(own))
    return found


def _rank(rows: Array) -> int:
    return int(np.linalg.matrix_rank(rows, tol=NONE)) if rows.size else 0


def _fewest(locked: tuple[int, ...], spans: list[Array]) -> _Choice:
    """The fewest rows that see every opening at every pose, of as many those that see it best at its worst."""
    ranks = {span.shape[1] for span in spans}
    by_rank = [np.array([span for span in spans if span.shape[1] == rank]) for rank in sorted(ranks - {0})]
    for count in range(max(ranks), len(locked)):
        best, worth = locked, 0.0
        picks = np.array(list(combinations(range(len(locked)), count)), dtype=np.int64)
        seen = np.ones(len(picks))
        for some in by_rank:
            seen = np.minimum(seen, np.linalg.svd(some[:, picks], compute_uv=False)[..., -1].min(axis=0))
        offered: list[list[int]] = picks.tolist()
        for pick, sight in zip(offered, seen.tolist()):
            names = tuple(locked[p] for p in pick)
            if sight > worth / CLEAR and _expressible(names):
                best, worth = names, sight
        if worth > HELD:
            return _Choice(best, count - max(ranks))
    return _Choice(locked, len(locked) - max(ranks))


def _expressible(locked: tuple[int, ...]) -> bool:
    """A lone locked twist is homokinetic in PhysX, which is not what its row says."""
    return tuple(i for i in locked if i >= RX) != (RX,)


def _travel(
    assembly: Assembly,
    tree: Tree,
    world: tuple[Array, Array],
    doubtful: list[tuple[BlockTree, list[Openings]]],
) -> None:
    """Add what the blocks come to at poses along their motions."""
    if not doubtful:
        return
    bodies = len(tree.parent)
    blocks = assembly.blocks_with([(l.a, l.b) for l in tree.links], bodies)
    indices = [i for block, _ in doubtful for i in block.indices]
    system = relative_system(_system({i: tree.links[i] for i in indices}, world, bodies), blocks)
    solver = Solver.fitted(system, assembly.equations.length)
    frames = np.broadcast_to(np.eye(3), (bodies, 3, 3)).copy()
    parts: list[IntArray] = []
    for block, _ in doubtful:
        for (body, _), rotation in zip(block.held, block.rotation):
            frames[body] = rotation[0]
        parts.append(np.unique(solver.part[block.block.bodies]))
    moving = {body for block, _ in doubtful for body in block.block.bodies}
    order = [body for body in blocks.order.tolist() if body in moving]
    for state, there in poses_along(solver, frames):
        come = [n for n, own in enumerate(parts) if there[own[own >= 0]].any()]
        rotation, translation = (values.copy() for values in system.displacement(state))
        blocks.carry(rotation, translation, order)
        twists = tree_twists([doubtful[n][0] for n in come], rotation, translation)
        for n, found in zip(come, openings(twists, [doubtful[n][1][0] for n in come])):
            if found is not None:
                doubtful[n][1].append(found)


def _refused(
    assembly: Assembly, links: list[Link], reduced: dict[int, Link], frames: tuple[Array, Array]
) -> set[int]:
    """Closures without which a walk along the mechanism violates what they stood for."""
    if not reduced:
        return set()
    ends = [(link.a, link.b) for link in links]
    bodies = max(map(max, ends)) + 1
    blocks = assembly.blocks_with(ends, bodies)
    of_link = blocks.of_edges(np.array(ends))
    own = np.flatnonzero(np.isin(of_link, of_link[list(reduced)])).tolist()
    kept = relative_system(_system({i: reduced.get(i, links[i]) for i in own}, frames, bodies), blocks)
    whole = relative_system(_system({i: links[i] for i in own}, frames, bodies), blocks)
    solver, check = (Solver.fitted(system, assembly.equations.length) for system in (kept, whole))
    whole.center, whole.length = kept.center, kept.length
    start = kept.start()
    state = stepped(solver, block_freedoms(solver, start), start, WALK, np.random.default_rng(23))
    start = whole.start()
    residual = np.abs(whole.residual(State(state.rotation, state.shift, start.angle)))
    bad = residual > np.maximum(IMPLIED, 100.0 * np.abs(whole.residual(start)))
    parts = set(check.row_part[bad].tolist())
    owners, first = np.unique(whole.owner, return_index=True)
    part_of = dict(zip(owners.tolist(), check.row_part[first].tolist()))
    return {i for i in reduced if part_of.get(i) in parts}


def _world_frames(links: list[Link], scene: Scene) -> tuple[Array, Array]:
    """Each joint's frames on a and on b, WORLD: rotations (links, 2, 3, 3) and places (links, 2, 3), metres."""
    poses = [Pose(), *(node.pose for node in scene.nodes)]
    node = np.array([[0 if n is None else n + 1 for n in (l.joint.a, l.joint.b)] for l in links])
    inner = [frame for l in links for frame in (l.joint.frame_a, l.joint.frame_b)]
    turn = np.array([pose.rotation for pose in poses])[node]
    rotation = turn @ np.array([frame.rotation for frame in inner]).reshape(-1, 2, 3, 3)
    place = turn @ np.array([frame.translation for frame in inner]).reshape(-1, 2, 3, 1)
    return rotation, place[..., 0] + np.array([pose.translation for pose in poses])[node]


def _system(links: dict[int, Link], frames: tuple[Array, Array], bodies: int) -> System:
    """The equations of some joints themselves, by their links' numbers (the rows' owners), between links' bodies."""
    rows = Rows()
    for i, link in links.items():
        rows.owner = i
        ends = zip((link.a, link.b), frames[0][i], frames[1][i])
        joint_rows(rows, link.joint, *(frame_side(body, rotation, place) for body, rotation, place in ends))
    return rows.system(bodies)
