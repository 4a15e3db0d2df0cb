"""The whole assembly: closed, merged into rigid groups, and split into blocks with their freedoms."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ...diagnostics import Report
from ...model import Constraint, ConstraintKind, Coupling, Joint, Scene
from ...partition import Partition
from ...rigid import RigidGroups, is_between_led
from ...spatial import Array, BoolArray, IntArray, Pose, cross
from ..equations.coupled import COUPLED
from ..equations.scene_equations import Equations, equations_of
from ..equations.solve import Solver
from ..equations.system import State, System
from ..freedom.bodies import stated_bodies
from ..freedom.first_order import BlockFreedom, block_freedoms, moved_to_one_point
from ..freedom.motion import FiniteFreedom, displaced, finite_freedoms
from ..freedom.probes import STEP
from ..pairs.relations import Pairs, batched_null_spaces, pairs_of, relative_rows
from .blocks import Blocks, blocks_of, edges_of, relative_system
from .canonical import canonical
from .closing import Closing, closed
from .duplicates import without_duplicates

SAME = 1e-7
"""Difference of two bodies' twists up to which they move as one."""
STEP_SAME = 1e-8
"""The same of their displacements over a trial step, by its size: exact but for what closing it again leaves."""


@dataclass(eq=False)
class Assembly:
    """An assembly at its closed pose.

    body: shape (nodes + 1,), the body of each node (entry 0: ground, body 0).
    system: all rows between bodies.  relative: the same, each block against its root at rest.
    freedoms, finite: of each block, in the order of ``solver``'s parts.
    stated: the rigid groups the source itself states.  duplicates: constraints that an explicit joint
    already stands for; their rows are left out.  counted: rows between the source's bodies without them.
    breakable, mirrored: shape (statements,), those that keep their bodies apart however rigid they are, and the symmetries.
    """

    scene: Scene
    equations: Equations
    stated: RigidGroups
    closing: Closing
    duplicates: dict[int, int]
    counted: int
    body: IntArray
    system: System
    pairs: Pairs
    blocks: Blocks
    relative: System
    solver: Solver
    start: State
    freedoms: list[BlockFreedom]
    finite: list[FiniteFreedom]
    breakable: BoolArray
    mirrored: BoolArray

    def body_of(self, node: int | None) -> int:
        """The body of a node, 0 for ground."""
        return int(self.body[0 if node is None else node + 1])

    @cached_property
    def nodes(self) -> list[list[int]]:
        """The nodes of each body, in scene order (of ground: those that stand on it)."""
        nodes: list[list[int]] = [[] for _ in range(self.system.bodies)]
        bodies: list[int] = self.body[1:].tolist()
        for node, body in enumerate(bodies):
            nodes[body].append(node)
        return nodes

    @cached_property
    def part_of_block(self) -> dict[int, int]:
        """The number among ``freedoms`` of each block."""
        return {int(self.blocks.block[f.bodies[0]]): i for i, f in enumerate(self.freedoms)}

    @cached_property
    def poses(self) -> list[Pose]:
        """World poses of the nodes with every constraint closed."""
        if not self.closing.moved:
            return [n.pose for n in self.scene.nodes]
        body = self.closing.body[1:]
        turn, inner = self.closing.rotation[body], [n.pose for n in self.scene.nodes]
        rotation = turn @ np.array([p.rotation for p in inner]).reshape(-1, 3, 3)
        place = turn @ np.array([p.translation for p in inner]).reshape(-1, 3, 1)
        return [Pose(*own) for own in zip(rotation, place[..., 0] + self.closing.translation[body])]

    @cached_property
    def closed_scene(self) -> Scene:
        """The scene with every constraint closed."""
        return self.scene.with_poses(self.poses) if self.closing.moved else self.scene

    def blocks_with(self, edges: list[tuple[int, int]], bodies: int) -> Blocks:
        """The blocks of the same bodies, and further ones, joined by these edges."""
        return blocks_of(bodies, np.unique(np.sort(np.array(edges), axis=1), axis=0))

    @property
    def floating(self) -> int:
        """Islands that hang on nothing: each adds six freedoms."""
        return len(self.blocks.island_root) - 1


def assemble(scene: Scene, report: Report) -> Assembly:
    """Bring a scene's constraints to the point where every question about freedoms can be answered."""
    body, stated = stated_bodies(scene)
    order = canonical(scene, body)
    body = order.body
    equations = equations_of(order.scene, report, order.frame.rotation, scene)
    closing = closed(equations, body, report)
    mirrored = np.array([_is_symmetry(s) for s in equations.statements], dtype=bool)
    folded = closing.system.folded(mirrored[closing.system.owner])
    system, duplicates = without_duplicates(folded, equations, report)
    counted = system.rows
    breakable = np.array([_stays_apart(s, scene) for s in equations.statements], dtype=bool)
    keeping_step = np.array([_keeps_step(s) for s in equations.statements], dtype=bool)
    while True:
        body, system = merged_rigid_pairs(body, system, breakable, mirrored, equations.length)
        edges = edges_of(system)
        blocks = blocks_of(system.bodies, edges)
        relative = relative_system(system, blocks)
        solver = Solver.fitted(relative, equations.length)
        start = relative.start()
        freedoms = block_freedoms(solver, start)
        finite = finite_freedoms(solver, freedoms, start)
        joined = edges_of(system.select(~keeping_step[system.owner]))
        together = _moving_as_one(relative, solver, start, freedoms, finite, blocks, joined, breakable)
        if together is None:
            break
        body, system = together[body], _merged(system, together, mirrored)
    system.center, system.length = relative.center, relative.length
    system.row_length = relative.row_length
    pairs = pairs_of(system)
    return Assembly(
        scene,
        equations,
        stated,
        closing,
        duplicates,
        counted,
        body,
        system,
        pairs,
        blocks,
        relative,
        solver,
        start,
        freedoms,
        finite,
        breakable,
        mirrored,
    )


def _merged(system: System, label: IntArray, mirrored: BoolArray) -> System:
    """With other body numbers, without rows inside one body.  mirrored: shape (statements,), the symmetries."""
    merged = system.relabel(label)
    merged = merged.select(merged.joining())
    return merged.folded(mirrored[merged.owner])


def _is_symmetry(statement: object) -> bool:
    """Its rows join three bodies, or two, where the plane's body moves as one with that of a side."""
    return isinstance(statement, Constraint) and statement.kind is ConstraintKind.SYMMETRY


def _keeps_step(statement: object) -> bool:
    """Whether it couples motions without joining bodies: two that it gives the same motion stay two, each in its own range."""
    if isinstance(statement, Constraint):
        return statement.kind in COUPLED
    return isinstance(statement, Coupling)


def _stays_apart(statement: object, scene: Scene) -> bool:
    """A joint that may break, or of which scripts lead both sides, keeps its two bodies apart, however rigid it is."""
    if not isinstance(statement, Joint):
        return False
    return min(statement.break_force, statement.break_torque) < np.inf or is_between_led(statement, scene)


def merged_rigid_pairs(
    body: IntArray, system: System, breakable: BoolArray, mirrored: BoolArray, length: float
) -> tuple[IntArray, System]:
    """Merge bodies whose common rows leave nothing, and again, until none are left."""
    while True:
        system.length = np.full(system.bodies, length)
        pairs = pairs_of(system)
        if not len(pairs):
            return body, system
        rows, _, _ = relative_rows(system, pairs, system.start())
        rank = batched_null_spaces(rows, pairs.row_pair, len(pairs))[0]
        rank[pairs.row_pair[breakable[system.owner] & (pairs.row_pair >= 0)]] = 0
        rigid = np.flatnonzero(rank == 6)
        if not len(rigid):
            return body, system
        partition = Partition(system.bodies)
        for i in rigid:
            partition.join(int(pairs.first[i]), int(pairs.second[i]))
        label = partition.labels()
        body, system = label[body], _merged(system, label, mirrored)


def _moving_as_one(
    relative: System,
    solver: Solver,
    start: State,
    freedoms: list[BlockFreedom],
    finite: list[FiniteFreedom],
    blocks: Blocks,
    joined: IntArray,
    breakable: BoolArray,
) -> IntArray | None:
    """New body numbers that merge what a block's loops hold together, or None where there is nothing.

    joined: pairs of bodies with something between them beside couplings, shape (edges, 2).

    Equal twists are not enough at a dead centre, where a crank's velocity vanishes and its motion does
    not, nor where a joint on the way turns back, as between a four-bar's coupler and rocker when its
    crank lies along the frame: a trial step of finite size decides.
    """
    draw = np.random.default_rng(3)
    partition = Partition(relative.bodies)
    neighbours: dict[int, set[int]] = {}
    for i, j in joined.tolist():
        neighbours.setdefault(i, set()).add(j)
        neighbours.setdefault(j, set()).add(i)
    groups: dict[int, list[IntArray]] = {}
    doubtful: dict[int, BlockFreedom] = {}
    apart = set(solver.row_part[breakable[relative.owner]].tolist())
    for part, (first, last) in enumerate(zip(freedoms, finite)):
        if part in apart:
            continue
        root = int(blocks.root[blocks.block[first.bodies[0]]])
        if first.mobility == 0:
            groups[part] = [np.concatenate([[root], first.bodies])]
        elif len(first.bodies) > 1 and last.mobility > 0:
            twist = (first.basis @ draw.standard_normal(first.mobility)).reshape(-1, 6)
            groups[part] = _adjoining(_same_twists(relative, root, first.bodies, twist), neighbours)
            if groups[part]:
                doubtful[part] = first
    for part, shift in displaced(solver, doubtful, start).items():
        bodies = doubtful[part].bodies
        root = int(blocks.root[blocks.block[bodies[0]]])
        groups[part] = [g for g in groups[part] if _stays_one(relative, root, bodies, g, shift)]
    together = [group for of_part in groups.values() for group in of_part]
    for group in together:
        for other in group[1:]:
            partition.join(int(group[0]), int(other))
    return partition.labels() if together else None


def _same_twists(relative: System, root: int, bodies: IntArray, twist: Array) -> list[IntArray]:
    """Groups of two or more bodies (the root at rest among them) with the same twist."""
    moved = moved_to_one_point(twist[..., None], bodies, relative)[..., 0]
    common = np.concatenate([np.zeros((1, 6)), moved])
    names = np.concatenate([[root], bodies])
    near = np.abs(common[:, None] - common[None]).max(axis=2) < SAME * np.abs(common).max()
    groups: list[IntArray] = []
    seen = np.zeros(len(names), dtype=bool)
    for i in range(len(names)):
        if not seen[i]:
            seen |= near[i]
            if near[i].sum() > 1:
                groups.append(names[near[i]])
    return groups


def _adjoining(groups: list[IntArray], neighbours: dict[int, set[int]]) -> list[IntArray]:
    """The groups, split where they do not hang together by themselves.

    The rods of a parallelogram chain keep step without being joined; they stay parts of their own.
    """
    split: list[IntArray] = []
    for group in groups:
        left: set[int] = set(group.tolist())
        while left:
            reached: set[int] = set()
            queue = [min(left)]
            for body in queue:
                if body in left:
                    left.discard(body)
                    reached.add(body)
                    queue.extend(sorted(neighbours.get(body, set()) & left))
            if len(reached) > 1:
                split.append(np.array(sorted(reached)))
    return split


def _stays_one(relative: System, root: int, bodies: IntArray, group: IntArray, shift: Array) -> bool:
    """Whether a group of bodies, the root at rest perhaps among them, moved as one over a trial step.

    shift: displacements of the block's bodies, as ``displaced`` tells them, shape (6 n,).
    """
    index = {int(body): i for i, body in enumerate(bodies.tolist())}
    own = np.array([index[int(body)] for body in group if int(body) != root])
    length = relative.length[bodies[0]]
    step = STEP * shift.reshape(-1, 6)[own]
    arm = (relative.center[bodies[0]] - relative.center[bodies[own]]) / length
    sine = step[:, 3:]
    once = cross(sine, arm)  # the turn of an arm by Rodrigues' formula, of which first order is not enough
    twice = cross(sine, once) / (1.0 + np.sqrt(1.0 - (sine**2).sum(axis=1, keepdims=True)))
    moved = np.concatenate([step[:, :3] + once + twice, sine], axis=1) / STEP
    if len(own) < len(group):
        moved = np.concatenate([moved, np.zeros((1, 6))])
    return bool(np.ptp(moved, axis=0).max() < STEP_SAME)
