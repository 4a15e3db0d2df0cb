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

from ..diagnostics import Report
from ..model import FREE, FREEDOM_NAMES, LOCKED, RX, Joint, Motion, Scene, kind_of
from ..spatial import Array
from .assembly import Assembly
from .blocks import Blocks, relative_system
from .equations import joint_rows, joint_sides
from .freedom import block_freedoms
from .loops import Link, Tree, replace_link
from .openings import NONE, Block, BlockTree, Openings, locked_of, moved_by, openings
from .rows import Rows
from .solve import Solver
from .system import State, System
from .travel import poses_along

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
    chosen = _chosen(assembly, tree, scene)
    reduced = {}
    for i, choice in chosen.items():
        joint = links[i].joint
        if len(choice.rows) < len(locked_of(joint)):
            reduced[i] = replace_link(
                links[i],
                freedoms=_freed(joint, choice.rows),
                kind=kind_of(tuple(n for n in range(6) if n not in choice.rows)),
                freed=tuple(n for n in locked_of(joint) if n not in choice.rows),
            )
    refused = _refused(assembly, links, reduced, scene)
    mobility = sum(f.mobility for f in assembly.finite) + 6 * assembly.floating
    for i, choice in chosen.items():
        joint = links[i].joint
        kept, freed = len(choice.rows), len(locked_of(joint)) - len(choice.rows)
        if i in refused:
            report.add("CLOSURE_KEPT_WHOLE", joint.where, joint=joint.id, freed=freed)
            continue
        if i in reduced:
            links[i] = reduced[i]
            report.add(
                "CLOSURE_ROWS_FREED", joint.where, joint=joint.id, rows=kept + freed, kept=kept, mobility=mobility,
                freed=", ".join(FREEDOM_NAMES[n] for n in links[i].joint.freed),
                loop=scene.loop(joint), holders=ITS_OWN if choice.alone else AND_OTHERS,
            )  # fmt: skip
        if choice.repeated:
            report.add("CLOSURE_ROWS_REPEATED", joint.where, joint=joint.id, kept=kept, repeated=choice.repeated)
    return links


def _freed(joint: Joint, rows: tuple[int, ...]):
    return tuple(
        LOCKED if i in rows else (f if f.motion is not Motion.LOCKED else FREE)
        for i, f in enumerate(joint.freedoms)
    )


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


def _chosen(assembly: Assembly, tree: Tree, scene: Scene) -> dict[int, _Choice]:
    """The choice for each closure of a block that is not singular."""
    found: dict[int, _Choice] = {}
    doubtful: dict[tuple, tuple[list[BlockTree], list[Openings]]] = {}
    for block in (BlockTree(block, tree, scene) for block in _blocks(assembly, tree)):
        twists = block.twists()
        here = openings(twists)
        chosen = _choose(block, [here])
        found |= chosen
        for (rows, twist), choice, link in zip(twists, chosen.values(), block.closing):
            freed = [n for n, i in enumerate(locked_of(link.joint)) if i not in choice.rows]
            if freed and moved_by(rows[freed], twist).any():
                doubtful.setdefault(block.likeness(), ([], [here]))[0].append(block)
                break
    _travel(assembly, tree, scene, [(alike[0], poses) for alike, poses in doubtful.values()])
    for alike, poses in doubtful.values():
        for block in alike:
            found |= _choose(block, poses)
    return found


def _choose(block: BlockTree, poses: list[Openings]) -> dict[int, _Choice]:
    found = {}
    for k, (i, link) in enumerate(zip(block.block.closures, block.closing)):
        locked = locked_of(link.joint)
        choice = _fewest(locked, [pose.span[k] for pose in poses])
        own = poses[0].rows[k]
        kept = own[[n for n, row in enumerate(locked) if row in choice.rows]]
        found[i] = replace(choice, alone=_rank(kept) == _rank(own))
    return found


def _rank(rows: Array) -> int:
    return int(np.linalg.matrix_rank(rows, tol=NONE)) if rows.size else 0


def _fewest(locked: list[int], spans: list[Array]) -> _Choice:
    """The fewest rows that see every opening at every pose, of as many those that see it best at its worst."""
    ranks = {span.shape[1] for span in spans}
    by_rank = [np.array([span for span in spans if span.shape[1] == rank]) for rank in sorted(ranks - {0})]
    for count in range(max(ranks), len(locked)):
        best, worth = tuple(locked), 0.0
        for pick in combinations(range(len(locked)), count):
            names = tuple(locked[p] for p in pick)
            if not _expressible(names):
                continue
            seen = [np.linalg.svd(some[:, list(pick)], compute_uv=False)[:, -1].min() for some in by_rank]
            if min(seen, default=1.0) > worth / CLEAR:
                best, worth = names, float(min(seen, default=1.0))
        if worth > HELD:
            return _Choice(best, count - max(ranks))
    return _Choice(tuple(locked), len(locked) - max(ranks))


def _expressible(locked: tuple[int, ...]) -> bool:
    """A lone locked twist is homokinetic in PhysX, which is not what its row says."""
    return tuple(i for i in locked if i >= RX) != (RX,)


def _travel(
    assembly: Assembly, tree: Tree, scene: Scene, doubtful: list[tuple[BlockTree, list[Openings]]]
) -> None:
    """Add what the blocks come to at poses along their motions."""
    if not doubtful:
        return
    bodies = len(tree.parent)
    blocks = assembly.blocks_with([(l.a, l.b) for l in tree.links], bodies)
    links = [l for block, _ in doubtful for l in [*(l for _, l in block.held), *block.closing]]
    system = relative_system(_system(links, scene, bodies), blocks)
    solver = Solver(system)
    system.fit(solver.row_part, solver.part, assembly.equations.length)
    frames = np.broadcast_to(np.eye(3), (bodies, 3, 3)).copy()
    parts = []
    for block, _ in doubtful:
        for (body, _), (a, _) in zip(block.held, block.frames):
            frames[body] = a.rotation
        parts.append(np.unique(solver.part[block.block.bodies]))
    moving = {body for block, _ in doubtful for body in block.block.bodies}
    order = [body for body in blocks.order.tolist() if body in moving]
    for state, there in poses_along(solver, frames):
        rotation, translation = _in_world(system, state, blocks, order)
        for (block, poses), own in zip(doubtful, parts):
            if there[own[own >= 0]].any():
                found = openings(block.twists(rotation, translation), poses[0])
                if found is not None:
                    poses.append(found)


def _in_world(system: System, state: State, blocks: Blocks, order: list[int]) -> tuple[Array, Array]:
    """Displacements of all bodies from a state in which every block moves against its root."""
    rotation, translation = (values.copy() for values in system.displacement(state))
    for body in order:
        if blocks.block[body] >= 0:
            root = blocks.root[blocks.block[body]]
            translation[body] = rotation[root] @ translation[body] + translation[root]
            rotation[body] = rotation[root] @ rotation[body]
    return rotation, translation


def _refused(assembly: Assembly, links: list[Link], reduced: dict[int, Link], scene: Scene) -> set[int]:
    """Closures without which a walk along the mechanism violates what they stood for."""
    if not reduced:
        return set()
    bodies = max(max(l.a, l.b) for l in links) + 1
    kept, whole = (
        _system([reduced.get(i, l) if fewer else l for i, l in enumerate(links)], scene, bodies)
        for fewer in (True, False)
    )
    blocks = assembly.blocks_with([(l.a, l.b) for l in links], bodies)
    kept, whole = relative_system(kept, blocks), relative_system(whole, blocks)
    solver, check = Solver(kept), Solver(whole)
    kept.fit(solver.row_part, solver.part, assembly.equations.length)
    whole.fit(check.row_part, check.part, assembly.equations.length)
    whole.center, whole.length = kept.center, kept.length
    state = _walked(solver, kept.start())
    angle = whole.start().angle
    residual = np.abs(whole.residual(State(state.rotation, state.shift, angle)))
    floor = np.abs(whole.residual(whole.start()))
    bad = residual > np.maximum(IMPLIED, 100.0 * floor)
    parts = set(check.row_part[bad].tolist())
    rows_of = {i: check.row_part[np.flatnonzero(whole.owner == i)[:1]] for i in reduced}
    return {i for i, part in rows_of.items() if len(part) and int(part[0]) in parts}


def _walked(solver: Solver, start: State) -> State:
    draw = np.random.default_rng(23)
    bodies, twists = [], []
    for freedom in block_freedoms(solver, start):
        if freedom.mobility:
            direction = freedom.basis @ draw.standard_normal(freedom.mobility)
            bodies.append(freedom.bodies)
            twists.append(WALK * direction.reshape(-1, 6) / np.abs(direction).max())
    if not bodies:
        return start
    state = solver.system.moved(start, np.concatenate(bodies), np.concatenate(twists))
    return solver.project(state)[0]


def _system(links: list[Link], scene: Scene, bodies: int) -> System:
    """The equations of the joints themselves, between the links' bodies."""
    rows = Rows()
    for i, link in enumerate(links):
        rows.owner = i
        a, b = joint_sides(link.joint, scene)
        joint_rows(rows, link.joint, replace(a, body=link.a), replace(b, body=link.b))
    return rows.system(bodies)
