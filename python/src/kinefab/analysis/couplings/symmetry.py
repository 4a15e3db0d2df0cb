"""Symmetry of two moving parts about a plane of a third (or of the ground), as couplings of their joints.

No joint joins three bodies.  But where both parts hang on joints that mirror each other, as a gripper's jaws do, one
joint's coordinate is the other's, or its negative; of slides at different slants, a multiple.  First order says which
coordinates keep step for the symmetry's sake; a walk with the couplings in place of the symmetry must then keep it.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from ...diagnostics import Report
from ...model import RX, Constraint, ConstraintKind, Coupling, CouplingKind, JointKind, Scene, Term
from ...spatial import Array
from ..assembly.assemble import Assembly
from ..equations.solve import Solver
from ..equations.system import State, System, joined
from ..freedom.first_order import block_freedoms
from ..freedom.rank import spans
from ..joints.links import Link
from ..loops.spanning import Tree
from ..ranges.measured import CLOSED, Measured

NONE = 1e-6
"""Share of a rate up to which it is a rounding."""
ONE = 1e-9
"""Difference up to which a ratio is 1: that of a mirror image."""
KEPT = 1e-8
"""Scaled residual of the symmetry up to which a walk proves the couplings."""
WALKS = 2
STEPS = 2
STEP = 0.3
"""Radians, or fractions of the length, of the body that moves most in a step."""

Coordinate = tuple[Link, int]
"""A link and one of its freedoms TX..RZ."""


def symmetric_couplings(
    assembly: Assembly, tree: Tree, links: list[Link], scene: Scene, report: Report
) -> list[Coupling]:
    """Couplings with just the effect of the symmetries of three bodies; those that have none are reported.

    tree: of the same links, in the same order.  scene: with middle bodies, at the closed pose.
    """
    found: dict[str, list[Coupling]] = {}
    for part, owners in _symmetries(assembly).items():
        block = _Block(assembly, part, owners, tree, links, scene)
        for owner in owners:
            statement = assembly.equations.statements[owner]
            own: list[Coupling] = []
            found[statement.id] = own
            ties = block.ties(owner)
            if ties is None:
                names = {"names": statement.id}
                report.dropped(f"constraint {statement.id}", "RELATION_DROPPED", statement.where, **names)
            for number, (i, j, ratio) in enumerate(ties or (), 1):
                (a, freedom_a), (b, freedom_b) = block.coordinates[i], block.coordinates[j]
                name = statement.id if number == 1 else f"{statement.id}:{number}"
                offset = float(block.value[j] - ratio * block.value[i])
                terms = (Term(a.joint.id, freedom_a, ratio),)
                own.append(
                    Coupling(name, CouplingKind.LINEAR, b.joint.id, freedom_b, terms, offset, statement.where)
                )
    places = assembly.equations.places
    return [coupling for name in sorted(found, key=places.__getitem__) for coupling in found[name]]


def _symmetries(assembly: Assembly) -> dict[int, list[int]]:
    """Symmetries that join three bodies, by the block they are in."""
    wide = np.unique(assembly.system.owner[assembly.pairs.row_pair == -1])
    found: dict[int, list[int]] = {}
    owners: list[int] = wide.tolist()
    for owner in owners:
        statement = assembly.equations.statements[owner]
        if isinstance(statement, Constraint) and statement.kind is ConstraintKind.SYMMETRY:
            row = int(np.flatnonzero(assembly.system.owner == owner)[0])
            part = int(assembly.solver.row_part[row])
            found.setdefault(part, []).append(owner)
    return found


@dataclass(slots=True, eq=False)
class _Way:
    """The coordinates that move either part of a symmetry against the plane, and not the other part too: numbers."""

    first: list[int]
    second: list[int]


class _Block:
    """A block of the assembly without its symmetries, and with the couplings found so far instead.

    coordinates, value: of the joints that both parts of a symmetry hang on, and what they are at the closed pose.
    """

    def __init__(
        self, assembly: Assembly, part: int, owners: list[int], tree: Tree, links: list[Link], scene: Scene
    ):
        self.assembly, self.first = assembly, assembly.freedoms[part]
        self.singular = assembly.finite[part].singular
        self.coordinates: list[Coordinate] = []
        self.ways = {owner: self._way(owner, tree, links) for owner in owners}
        self.measured = Measured(assembly, part, self.coordinates, scene, without=owners)
        self.system: System = self.measured.system
        self.value, self.rates = self.measured.read(self.measured.start, self.measured.turns)

    def _way(self, owner: int, tree: Tree, links: list[Link]) -> _Way | None:
        """None where a part does not hang on the plane's body."""
        statement = self.assembly.equations.statements[owner]
        assert isinstance(statement, Constraint), "a symmetry is a constraint"
        a, b, plane = (self.assembly.body_of(f.node) for f in statement.features[:3])
        first, second = (tree.way(plane, body) for body in (a, b))
        if first is None or second is None:
            return None
        ways = (first, second), (second, first)
        own = [[links[i] for i in way if i not in other] for way, other in ways]
        return _Way(*([self._number(c) for link in way for c in _plain(link, self.assembly)] for way in own))

    def _number(self, coordinate: Coordinate) -> int:
        if coordinate not in self.coordinates:
            self.coordinates.append(coordinate)
        return self.coordinates.index(coordinate)

    def ties(self, owner: int) -> list[tuple[int, int, float]] | None:
        """Pairs of coordinates and dq_b / dq_a, which stand for the symmetry from now on; None where none do."""
        way = self.ways[owner]
        if way is None or self.singular:
            return None
        start = self.system.start()
        motions = _motions(self.system, start)
        symmetry = self._rows_of(owner)
        wanted = _span(symmetry.dense(symmetry.start())[1] @ motions)
        chosen: list[tuple[int, int, float]] = []
        tied = np.zeros((0, motions.shape[1]))
        rates = self.rates @ motions
        free = rates - rates @ wanted.T @ wanted  # what the symmetry lets them do
        for i, j in product(way.first, way.second):
            ratio = _ratio(free[i], free[j])
            if ratio is None:
                continue
            more = _span(np.vstack([tied, rates[j] - ratio * rates[i]]))
            if len(tied) < len(more) <= len(wanted):
                chosen.append((i, j, ratio))
                tied = more
        if len(tied) < len(wanted):
            return None
        tied_system = self.system
        for tie in chosen:
            tied_system = joined(tied_system, self._coupled(*tie))
        if not _kept(tied_system, symmetry):
            return None
        self.system = tied_system
        return chosen

    def _rows_of(self, owner: int) -> System:
        """A symmetry's rows, over the block's own bodies."""
        label = np.zeros(self.assembly.relative.bodies, dtype=np.int64)
        label[self.first.bodies] = self.measured.bodies
        relative = self.assembly.relative
        rows = relative.select(relative.owner == owner).relabel(label)
        rows.center, rows.length = self.system.center, self.system.length
        return rows

    def _coupled(self, i: int, j: int, ratio: float) -> System:
        """The row q_j - ratio q_i, zero at the closed pose."""
        both = self.measured.probe.select(np.array(sorted((i, j))))
        of_j = both.row == (j > i)
        turning = self.measured.rotary[i]
        return replace(
            both,
            row=np.zeros_like(both.row),
            weight=both.weight * np.where(of_j, 1.0, -ratio),
            d=both.d + np.where(of_j, self.value[j], self.value[i]),
            owner=np.zeros(1, dtype=np.int64),
            is_length=np.array([not turning]),
            row_length=np.array([1.0 if turning else self.measured.length]),
        )


def _plain(link: Link, assembly: Assembly) -> list[Coordinate]:
    """The coordinates of a link that Unity's joint reads as the model does: slides, and its only rotation."""
    free = link.joint.unlocked
    if link.joint.kind is JointKind.SCREW or max(link.a, link.b) >= assembly.system.bodies:
        return []
    return [(link, f) for f in free if f < RX or sum(g >= RX for g in free) == 1]


def _ratio(first: Array, second: Array) -> float | None:
    """second / first, where the one is the other by a factor that is not zero."""
    size = float(first @ first)
    ratio = float(first @ second) / size if size > NONE * NONE else 0.0
    if abs(ratio) < NONE or np.abs(second - ratio * first).max() > NONE * np.abs(second).max():
        return None
    return float(np.sign(ratio)) if abs(abs(ratio) - 1.0) < ONE else ratio


def _motions(system: System, state: State) -> Array:
    """Scaled twists of all bodies but the first, which the rows allow, as columns."""
    freedoms = block_freedoms(Solver(system), state)
    columns = np.zeros((system.bodies, 6, sum(f.mobility for f in freedoms)))
    at = 0
    for f in freedoms:
        columns[f.bodies, :, at : at + f.mobility] = f.basis.reshape(len(f.bodies), 6, f.mobility)
        at += f.mobility
    return columns[1:].reshape(6 * (system.bodies - 1), at)


def _span(rows: Array) -> Array:
    """Orthonormal rows with the same span."""
    if not rows.size or np.abs(rows).max() < NONE:
        return np.zeros((0, rows.shape[1]))
    return spans([rows.T], NONE)[0].T


def _kept(system: System, symmetry: System) -> bool:
    """Whether the symmetry holds wherever walks with the system's rows come to."""
    solver, draw = Solver(system), np.random.default_rng(31)
    floor = float(np.abs(symmetry.residual(symmetry.start())).max(initial=0.0))
    came = 0
    for _ in range(WALKS):
        state = system.start()
        for _ in range(STEPS):
            motions = _motions(system, state)
            if not motions.shape[1]:
                return True
            twist: Array = motions @ draw.standard_normal((motions.shape[1],))
            twist *= STEP / np.abs(twist).max()
            there = system.moved(state, np.arange(1, system.bodies), twist.reshape(-1, 6))
            state, left = solver.project(there)
            if left.max(initial=0.0) > CLOSED:
                break
            system.remember(state)
            came += 1
            rest = symmetry.residual(State(state.rotation, state.shift, symmetry.start().angle))
            if np.abs(rest).max(initial=0.0) > max(KEPT, 100.0 * floor):
                return False
    return came >= WALKS
