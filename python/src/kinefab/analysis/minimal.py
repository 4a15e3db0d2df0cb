"""Loop-closing joints with only their independent rows.

Every row of a closing joint that the rest of the loop implies makes an iterative solver fight itself.  A
planar four-bar's last hinge needs two of its five: the two in the plane.  Here the rows of a closing joint
are chosen, in its own frame, so that their span over the tree's freedoms is that of all its rows: the row
space, hence the null space and every body's freedoms, stay the same.  That is first order; a walk along
the mechanism with only the kept rows then checks that the left-out ones stay satisfied.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import combinations

import numpy as np

from ..diagnostics import Report
from ..model import FREE, LOCKED, RX, UNLOCKED, Joint, JointKind, Motion, Scene
from ..spatial import Array, Pose
from .assembly import Assembly
from .blocks import relative_system
from .equations import joint_rows, joint_sides
from .freedom import block_freedoms
from .loops import Link, Tree, replace_link
from .rank import rank_of
from .rows import Rows
from .solve import Solver
from .system import State, System

CLEAR = 0.9
"""A choice of rows must be this much better conditioned to win over an earlier one."""
WALK = 0.05
"""Radians or fractions of the length, of the walk that proves the choice."""
IMPLIED = 1e-8
"""Scaled residual of the left-out rows up to which the walk proves that nothing moves by them."""


@dataclass(slots=True, eq=False)
class _Block:
    """Closing joints of one block and the bodies it has."""

    bodies: list[int]
    closures: list[int]


def minimal_closures(assembly: Assembly, tree: Tree, scene: Scene, report: Report) -> list[Link]:
    """The links with their closing joints reduced.  scene: with middle bodies, at the closed pose."""
    links = list(tree.links)
    kept = {i: rows for block in _blocks(assembly, tree) for i, rows in _choose(block, tree, scene).items()}
    reduced = {}
    for i, rows in kept.items():
        joint = links[i].joint
        locked = _locked(joint)
        if len(rows) < len(locked):
            reduced[i] = replace_link(links[i], freedoms=_freed(joint, rows), kind=_kind(joint, rows))
    refused = _refused(assembly, links, reduced, scene)
    mobility = sum(f.mobility for f in assembly.finite) + 6 * assembly.floating
    for i, link in reduced.items():
        joint = links[i].joint
        rows, freed = len(_locked(joint)), len(_locked(joint)) - len(_locked(link.joint))
        if i in refused:
            report.add("CLOSURE_KEPT_WHOLE", joint.where, joint=joint.id, freed=freed)
        else:
            links[i] = link
            report.add(
                "CLOSURE_ROWS_FREED",
                joint.where,
                joint=joint.id,
                rows=rows,
                kept=rows - freed,
                freed=freed,
                mobility=mobility,
            )
    return links


def _locked(joint: Joint) -> list[int]:
    return [i for i, f in enumerate(joint.freedoms) if f.motion is Motion.LOCKED]


def _freed(joint: Joint, rows: tuple[int, ...]):
    return tuple(
        LOCKED if i in rows else (f if f.motion is not Motion.LOCKED else FREE)
        for i, f in enumerate(joint.freedoms)
    )


def _kind(joint: Joint, rows: tuple[int, ...]) -> JointKind:
    free = tuple(i for i in range(6) if i not in rows)
    return next(
        (k for k, unlocked in UNLOCKED.items() if unlocked == free and k is not JointKind.SCREW),
        JointKind.GENERAL,
    )


def _blocks(assembly: Assembly, tree: Tree) -> list[_Block]:
    """Closures by the block they are in; blocks at a singular pose keep their joints whole."""
    found: dict[int, _Block] = {}
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
            found.setdefault(block, _Block([], [])).closures.append(i)
    for body in tree.order:
        if age[body] in found:
            found[int(age[body])].bodies.append(body)
    return list(found.values())


def _choose(block: _Block, tree: Tree, scene: Scene) -> dict[int, tuple[int, ...]]:
    """For each closure of a block the locked freedoms that stay."""
    carried, origin, length = _carried(block, tree, scene)
    columns = next(iter(carried.values())).shape[1] if carried else 0
    basis = np.zeros((0, columns))
    chosen = {}
    for i in block.closures:
        link = tree.links[i]
        zero = np.zeros((6, columns))
        twist = carried.get(link.b, zero) - carried.get(link.a, zero)
        frame = scene.pose(link.joint.a) @ link.joint.frame_a
        locked = _locked(link.joint)
        rows = _wrenches(frame, origin, length)[locked] @ twist
        fresh = rows - rows @ basis.T @ basis
        rank = int(rank_of(np.linalg.svd(fresh, compute_uv=False))[0]) if _any(fresh, rows) else 0
        best, worth = tuple(locked), 0.0
        for pick in combinations(range(len(locked)), rank):
            names = tuple(locked[p] for p in pick)
            if not _expressible(names):
                continue
            size = np.linalg.svd(fresh[list(pick)], compute_uv=False)[-1] if rank else 1.0
            if size > worth / CLEAR:
                best, worth = names, float(size)
        chosen[i] = best
        if rank:
            basis = np.concatenate([basis, np.linalg.svd(fresh, full_matrices=False)[2][:rank]])
    return chosen


def _any(fresh: Array, rows: Array) -> bool:
    return bool(np.abs(fresh).max(initial=0.0) > 1e-7 * max(np.abs(rows).max(initial=0.0), 1e-300))


def _expressible(locked: tuple[int, ...]) -> bool:
    """A lone locked twist is homokinetic in PhysX, which is not what its row says."""
    return tuple(i for i in locked if i >= RX) != (RX,)


def _wrenches(frame: Pose, origin: Array, length: float) -> Array:
    """Rows of a joint's six freedoms about ``origin`` on scaled twists (v / length, w), shape (6, 6)."""
    axes = frame.rotation.T
    lever = (frame.translation - origin) / length
    return np.block([[axes, np.cross(lever, axes)], [np.zeros((3, 3)), axes]])


def _carried(block: _Block, tree: Tree, scene: Scene) -> tuple[dict[int, Array], Array, float]:
    """Scaled twist of each body of the block in the freedoms of its tree joints, about one origin."""
    inside = set(block.bodies)
    joints = [tree.links[tree.parent[b]] for b in block.bodies if tree.parent[b] >= 0]
    frames = [scene.pose(l.joint.a) @ l.joint.frame_a for l in joints]
    points = np.array([f.translation for f in frames] or [np.zeros(3)])
    origin = points.mean(axis=0)
    length = float(np.linalg.norm(points - origin, axis=1).max()) or 1.0
    free = [[i for i, f in enumerate(l.joint.freedoms) if f.motion is not Motion.LOCKED] for l in joints]
    columns = sum(len(f) for f in free)
    carried: dict[int, Array] = {}
    at = 0
    for body, link, frame, freedoms in zip(
        [b for b in block.bodies if tree.parent[b] >= 0], joints, frames, free
    ):
        other = link.a if link.b == body else link.b
        twist = carried[other].copy() if other in inside and other in carried else np.zeros((6, columns))
        axes = frame.rotation.T
        lever = (frame.translation - origin) / length
        for k, i in enumerate(freedoms):
            axis = axes[i % 3]
            twist[:, at + k] += np.concatenate(
                [axis, np.zeros(3)] if i < RX else [np.cross(lever, axis), axis]
            )
        carried[body] = twist
        at += len(freedoms)
    return carried, origin, length


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
