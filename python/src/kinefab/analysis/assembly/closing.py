"""Does the exported pose satisfy its own constraints, by how much not, and where would it?"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from ...diagnostics import Report, named
from ...model import Constraint, ConstraintKind, Joint, Sense
from ...spatial import Array, IntArray
from ..equations.atoms import Atom
from ..equations.scene_equations import Equations
from ..equations.solve import Solver
from ..equations.system import State, System
from .blocks import blocks_of, edges_of, relative_system

TIGHT = 1e-12
"""Scaled residual below which a pose is taken as it is."""
ABSORBED = 1e-4
"""Scaled residual (fraction of the length, radians) that counts as rounding of the export."""
NUDGES, NUDGE = 3, 0.01
"""How often a part that does not close is tried again, and from how far beside its pose: radians, fractions of the length."""


@dataclass(frozen=True, slots=True)
class Gap:
    """How far the exported pose is from satisfying a constraint.  metres, degrees: the worst of its rows."""

    constraint: str
    metres: float
    degrees: float
    where: str = ""
    of_joint: bool = False


@dataclass(slots=True, eq=False)
class Closing:
    """The closed pose.

    system: the equations with the closed pose as their start, bodies as stated.  gaps: constraints that
    the exported pose misses by more than rounding.  worst: (metres, degrees) over all constraints.
    body: shape (nodes + 1,), the stated body of each node.
    rotation, translation: of each body, the displacement that closes the pose.  moved: whether there is any.
    contradictory: constraints that cannot hold together.
    """

    system: System
    gaps: list[Gap]
    worst: tuple[float, float]
    body: IntArray
    rotation: Array
    translation: Array
    contradictory: list[str]
    moved: bool = False


def closed(equations: Equations, body: IntArray, report: Report) -> Closing:
    """Solve every block of the assembly for the nearest pose that satisfies it."""
    whole = equations.system.relabel(body)
    n = whole.bodies
    rotation, translation = np.broadcast_to(np.eye(3), (n, 3, 3)).copy(), np.zeros((n, 3))
    whole.row_length = np.full(whole.rows, equations.length)
    contradictory = _held_fast(whole, equations, report)
    system = whole.select(whole.joining())
    if not system.rows:
        return Closing(system, [], (0.0, 0.0), body, rotation, translation, contradictory)
    blocks = blocks_of(n, edges_of(system))
    relative = relative_system(system, blocks)
    solver = Solver.fitted(relative, equations.length)
    start = relative.start()
    residual = relative.residual(start)
    gaps, worst = _gaps(relative, residual, equations)
    for gap in gaps:
        if gap.of_joint:
            continue  # the export says how far an explicit joint's frames are apart
        report.add(
            "CONSTRAINT_GAP",
            gap.where,
            id=gap.constraint,
            metres=f"{gap.metres:.4g}",
            degrees=f"{gap.degrees:.4g}",
        )
    moved = bool(np.abs(residual).max(initial=0.0) > TIGHT)
    if moved:
        state, left = _nudged(solver, start, *solver.project(start))
        for part in np.flatnonzero(left > ABSORBED).tolist():
            contradictory += _contradiction(
                relative, solver, part, relative.residual(state), equations, report
            )
        rotation, translation = relative.displacement(state)
        blocks.carry(rotation, translation, blocks.order)
        system = _displaced(system, rotation, translation)
    return Closing(system, gaps, worst, body, rotation, translation, contradictory, moved)


def _nudged(solver: Solver, start: State, state: State, left: Array) -> tuple[State, Array]:
    """The same with the parts that did not close tried again from beside the exported pose.

    There a row's rate may vanish (an angle of 10 degrees between axes that stand parallel), and no step leads off.
    left: residual of each part, shape (parts,).
    """
    for seed in range(NUDGES):
        stuck = left > ABSORBED
        if not stuck.any():
            break
        bodies = np.flatnonzero((solver.part >= 0) & stuck[solver.part])
        twists = NUDGE * np.random.default_rng(seed).standard_normal((len(bodies), 6))
        tried, now = solver.project(solver.system.moved(start, bodies, twists), stuck)
        better = stuck & (now <= ABSORBED)
        own = np.flatnonzero((solver.part >= 0) & better[solver.part])
        state.rotation[own], state.shift[own] = tried.rotation[own], tried.shift[own]
        left = np.where(better, now, left)
    return state, left


def _displaced(system: System, rotation: Array, translation: Array) -> System:
    def point(body: IntArray, p: Array) -> Array:
        return np.einsum("nij,nj->ni", rotation[body], p) + translation[body]

    def direction(body: IntArray, v: Array) -> Array:
        return np.einsum("nij,nj->ni", rotation[body], v)

    a, b = system.body_a, system.body_b
    return replace(
        system,
        p_a=point(a, system.p_a),
        a=direction(a, system.a),
        k=direction(a, system.k),
        p_b=point(b, system.p_b),
        b=direction(b, system.b),
    )


def _gaps(system: System, residual: Array, equations: Equations) -> tuple[list[Gap], tuple[float, float]]:
    metres = np.where(system.is_length, np.abs(residual) * system.row_length, 0.0)
    degrees = np.degrees(_angles(system, residual))
    count = len(equations.statements)
    by_metres, by_degrees, scaled = np.zeros(count), np.zeros(count), np.zeros(count)
    np.maximum.at(by_metres, system.owner, metres)
    np.maximum.at(by_degrees, system.owner, degrees)
    np.maximum.at(
        scaled,
        system.owner,
        np.maximum(np.where(system.is_length, np.abs(residual), 0.0), np.radians(degrees)),
    )
    wrong = _wrong_way_round(equations)
    for i in wrong:
        by_degrees[i], scaled[i] = 180.0, np.pi
    gaps: list[Gap] = []
    for i in np.flatnonzero(scaled > ABSORBED):
        statement = equations.statements[i]
        gaps.append(
            Gap(
                statement.id,
                float(by_metres[i]),
                float(by_degrees[i]),
                statement.where,
                isinstance(statement, Joint),
            )
        )
    gaps.sort(key=lambda gap: equations.places[gap.constraint])
    return gaps, (float(by_metres.max(initial=0.0)), float(by_degrees.max(initial=0.0)))


def _angles(system: System, residual: Array) -> Array:
    """Misfit of angle rows in radians; of a cosine, the angle it stands for."""
    angle = np.where(system.is_length, 0.0, np.abs(residual))
    dots = np.flatnonzero(system.kind == Atom.DOT)
    rows = system.row[dots]
    single = np.bincount(system.row, minlength=system.rows)[rows] == 1
    rows, wanted = rows[single], np.clip(system.d[dots[single]], -1.0, 1.0)
    found = np.clip(wanted + residual[rows], -1.0, 1.0)
    angle[rows] = np.abs(np.arccos(found) - np.arccos(wanted))
    return angle


_SENSED = (
    ConstraintKind.COINCIDENT,
    ConstraintKind.CONCENTRIC,
    ConstraintKind.INSERT,
    ConstraintKind.PARALLEL,
    ConstraintKind.DISTANCE,
)


def _wrong_way_round(equations: Equations) -> list[int]:
    """Statements whose two directions stand against each other where the source says along, or the reverse.

    Parallel rows (a.b = 0 across) hold both ways round, so the residual does not show it.
    """
    wrong: list[int] = []
    for i, sign in equations.directions.items():
        statement = equations.statements[i]
        if (
            isinstance(statement, Constraint)
            and statement.kind in _SENSED
            and statement.sense is not Sense.EITHER
        ):
            if sign * (1.0 if statement.sense is Sense.ALIGNED else -1.0) < 0.0:
                wrong.append(i)
    return wrong


def _held_fast(system: System, equations: Equations, report: Report) -> list[str]:
    """Rows inside one rigid group that are not satisfied: nothing can move to mend them."""
    residual = np.abs(system.residual(system.start()))
    fast = ~system.joining() & (residual > ABSORBED)
    names = equations.names(system.owner[fast])
    if names:
        report.add("CONSTRAINTS_CONTRADICT", names=named(names), gap=f"{residual[fast].max():.3g}")
    return names


def _contradiction(
    system: System, solver: Solver, part: int, residual: Array, equations: Equations, report: Report
) -> list[str]:
    """The constraints of a part that pull against each other.

    At a least-squares pose J' r = 0: the residual is itself a state of self-stress, and the constraints
    that carry it are the ones that cannot hold together.
    """
    mine = (solver.row_part == part) & (
        np.abs(residual) > 0.01 * np.abs(residual[solver.row_part == part]).max()
    )
    names = equations.names(system.owner[mine])
    report.add("CONSTRAINTS_CONTRADICT", names=named(names), gap=f"{np.abs(residual[mine]).max():.3g}")
    return names
