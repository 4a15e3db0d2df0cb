"""Real limits: how far each joint of a one-freedom mechanism can go before a dead point or another's limit.

The poses of such a mechanism form a curve.  It is followed along its own tangent (pseudo-arclength), which
passes dead points without noticing; there the rate of some joint coordinate changes sign, and the place
is found by bisection on the step.  Driving the joint itself would stall there: s_min falls as the square
root of the distance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from ..diagnostics import Report
from ..model import RX, Freedom, JointKind, Motion, Scene
from ..spatial import Array
from .assembly import Assembly
from .blocks import relative_system
from .equations import coordinate, joint_sides
from .freedom import block_freedoms
from .loops import Link, replace_link
from .rows import Rows
from .solve import Solver
from .system import State, System

STEP = 0.05
"""Length of a step along the curve: the fastest body's radians, or fractions of the length."""
SMALLEST = 1e-4
MOST_STEPS = 4000
CLOSED = 1e-9
STRAIGHT = 0.95
"""Cosine between tangents of neighbouring poses; below it the step was too long."""
FAR = 20.0
"""A slide that has gone this many lengths has no end."""
TURNS = 3.0
"""So has a hinge after this many turns without the mechanism coming round."""
OVERLAP = 3
"""Steps walked past the starting pose, so that no turning point is missed at the seam."""


@dataclass(frozen=True, slots=True)
class JointRange:
    """What a joint's coordinate can reach, metres or radians from the exported pose.

    Infinite where the joint turns all the way round or slides without end.
    """

    joint: str
    freedom: int
    lower: float
    upper: float


def found_ranges(assembly: Assembly, links: list[Link], scene: Scene, report: Report) -> list[JointRange]:
    """Ranges of all one-freedom joints in blocks that have loops and one freedom.

    scene: with middle bodies, at the closed pose.
    """
    ranges = []
    for part, (first, finite) in enumerate(zip(assembly.freedoms, assembly.finite)):
        bodies = set(first.bodies.tolist())
        if len(bodies) < 2:
            continue
        inside = [
            l
            for l in links
            if _in_block(assembly, l, bodies) and _single(l) is not None and not l.joint.closure
        ]
        if not inside:
            continue
        if finite.mobility != 1:
            for link in inside:
                detail = f"its mechanism has {finite.mobility} freedoms, not one"
                report.add("LIMITS_NOT_SWEPT", link.joint.where, joint=link.joint.id, detail=detail)
            continue
        ranges += _Curve(assembly, first.rows, first.bodies, inside, scene).ranges()
    return ranges


def with_found_ranges(
    assembly: Assembly, links: list[Link], ranges: list[JointRange], report: Report
) -> list[Link]:
    """The links with the ranges of the joints on each block's root as limits, where the source has none."""
    by_id = {(r.joint, r.freedom): r for r in ranges}
    roots = {int(r) for r in assembly.blocks.root}
    result = []
    for link in links:
        freedom = _single(link)
        found = by_id.get((link.joint.id, freedom))
        if found is None or not math.isfinite(found.lower) or not (link.a in roots or link.b in roots):
            result.append(link)
            continue
        unit, factor = ("degrees", math.degrees(1.0)) if freedom >= RX else ("m", 1.0)
        report.add(
            "LIMITS_FOUND",
            link.joint.where,
            joint=link.joint.id,
            unit=unit,
            lower=f"{found.lower * factor:.6f}",
            upper=f"{found.upper * factor:.6f}",
        )
        freedoms = list(link.joint.freedoms)
        old = freedoms[freedom]
        freedoms[freedom] = Freedom(
            Motion.LIMITED, max(found.lower, old.lower), min(found.upper, old.upper), old.drive
        )
        result.append(replace_link(link, freedoms=tuple(freedoms)))
    return result


def _single(link: Link) -> int | None:
    """The freedom of a hinge or slide, or None."""
    if link.joint.kind not in (JointKind.REVOLUTE, JointKind.PRISMATIC):
        return None
    return next(i for i, f in enumerate(link.joint.freedoms) if f.motion is not Motion.LOCKED)


def _in_block(assembly: Assembly, link: Link, bodies: set[int]) -> bool:
    root = int(assembly.blocks.root[assembly.blocks.block[next(iter(bodies))]])
    return {link.a, link.b} <= bodies | {root} and bool({link.a, link.b} & bodies)


class _Curve:
    """The poses of one block with one freedom, followed from the exported one both ways."""

    def __init__(
        self, assembly: Assembly, rows: np.ndarray, bodies: np.ndarray, links: list[Link], scene: Scene
    ):
        self.system: System = assembly.relative.select(rows)
        self.solver = Solver(self.system)
        self.bodies = bodies
        self.links = links
        self.freedoms = [_single(l) for l in links]
        probe = Rows()
        for i, (link, freedom) in enumerate(zip(links, self.freedoms)):
            probe.owner = i
            a, b = (replace(s, body=n) for s, n in zip(joint_sides(link.joint, scene), (link.a, link.b)))
            coordinate(probe, probe.row(freedom < RX), a, b, freedom, 1.0)
        self.probe = relative_system(probe.system(assembly.system.bodies), assembly.blocks)
        self.probe.center, self.probe.length = self.system.center, self.system.length
        self.start = self.system.start()
        self.turns = self.probe.start().angle

    def ranges(self) -> list[JointRange]:
        low, high = np.zeros(len(self.links)), np.zeros(len(self.links))
        endless = np.zeros(len(self.links), dtype=bool)
        for sign in (1.0, -1.0):
            came_round = self._follow(sign, low, high, endless)
            if came_round:
                break
        return [
            JointRange(
                l.joint.id, f, *((-math.inf, math.inf) if endless[i] else (float(low[i]), float(high[i])))
            )
            for i, (l, f) in enumerate(zip(self.links, self.freedoms))
        ]

    def _tangent(self, state: State, towards: Array) -> Array:
        """Unit velocity along the curve, the way that ``towards`` goes.

        Where branches cross there are more velocities; the one nearest to the old is kept.
        """
        basis = block_freedoms(self.solver, state)[0].basis
        along = basis @ (basis.T @ towards)
        return along / np.abs(along).max()

    def _coordinates(self, state: State, tangent: Array) -> tuple[Array, Array]:
        """Joint coordinates and their rates along the tangent."""
        here = State(state.rotation, state.shift, self.turns)
        residual, block_a, block_b = self.probe.linearise(here)
        velocity = np.zeros((self.probe.bodies, 6))
        velocity[self.bodies] = tangent.reshape(-1, 6)
        rate = np.einsum("ni,ni->n", block_a, velocity[self.probe.body_a])
        rate += np.einsum("ni,ni->n", block_b, velocity[self.probe.body_b])
        return residual, rate

    def _moved(self, state: State, tangent: Array, step: float) -> State | None:
        there = self.system.moved(state, self.bodies, step * tangent.reshape(-1, 6))
        there, left = self.solver.project(there)
        return there if left.max() < CLOSED else None

    def _follow(self, sign: float, low: Array, high: Array, endless: np.ndarray) -> bool:
        """Extend the ranges along one way of the curve; whether it came back to where it began."""
        basis = block_freedoms(self.solver, self.start)[0].basis
        state, tangent = self.start, sign * basis[:, 0] / np.abs(basis[:, 0]).max()
        self.turns = self.probe.start().angle
        q, rate = self._coordinates(state, tangent)
        step, travelled, overlap = STEP, 0.0, 0
        for _ in range(MOST_STEPS):
            there = self._moved(state, tangent, step)
            ahead = None if there is None else self._tangent(there, tangent)
            if ahead is None or ahead @ tangent < STRAIGHT * np.linalg.norm(ahead) * np.linalg.norm(tangent):
                step *= 0.5
                if step < SMALLEST:
                    return False
                continue
            new_q, new_rate = self._coordinates(there, ahead)
            stop = self._first_limit(state, tangent, step, new_q)
            for i in np.flatnonzero(rate * new_rate < 0.0):
                at = self._turning_point(state, tangent, step, int(i))
                low[i], high[i] = min(low[i], at), max(high[i], at)
            if stop is not None:
                low[:], high[:] = np.minimum(low, stop), np.maximum(high, stop)
                return False
            low[:], high[:] = np.minimum(low, new_q), np.maximum(high, new_q)
            self.probe.remember(here := State(there.rotation, there.shift, self.turns))
            self.turns = here.angle
            self.system.remember(there)
            travelled += step
            state, tangent, q, rate = there, ahead, new_q, new_rate
            step = min(STEP, 1.5 * step)
            if self._lost(q):
                endless |= (q <= low) | (q >= high)
                return False
            overlap += travelled > 3.0 * STEP and self._back(state) or overlap > 0
            if overlap > OVERLAP:
                endless |= self._rotary() & (np.round(q / math.tau) != 0.0)
                return True
        return False

    def _lost(self, q: Array) -> bool:
        """Whether a coordinate has gone so far that it will not come back."""
        reach = np.where(self._rotary(), TURNS * math.tau, FAR * self.system.length[self.bodies[0]])
        return bool((np.abs(q) >= reach).any())

    def _rotary(self) -> np.ndarray:
        return np.array([f >= RX for f in self.freedoms])

    def _back(self, state: State) -> bool:
        """Whether every body is where it began, within a step."""
        turn = np.abs(state.rotation[self.bodies] - self.start.rotation[self.bodies]).max()
        shift = np.abs(
            (state.shift - self.start.shift)[self.bodies] / self.system.length[self.bodies, None]
        ).max()
        return max(turn, shift) < STEP

    def _turning_point(self, state: State, tangent: Array, step: float, i: int) -> float:
        """The coordinate where its rate vanishes between two poses."""

        def rate(s: float) -> float:
            there = self._moved(state, tangent, s)
            return float(self._coordinates(there, self._tangent(there, tangent))[1][i])

        s = brentq(rate, 0.0, step, xtol=1e-13, rtol=1e-14)
        there = self._moved(state, tangent, s)
        return float(self._coordinates(there, tangent)[0][i])

    def _first_limit(self, state: State, tangent: Array, step: float, new_q: Array) -> Array | None:
        """Coordinates where the first joint meets a limit of the source's, or None when none does."""
        hits = []
        for i, (link, freedom) in enumerate(zip(self.links, self.freedoms)):
            limits = link.joint.freedoms[freedom]
            bound = (
                limits.upper if new_q[i] > limits.upper else limits.lower if new_q[i] < limits.lower else None
            )
            if limits.motion is Motion.LIMITED and bound is not None:

                def beyond(s: float, i=i, bound=bound) -> float:
                    there = self._moved(state, tangent, s)
                    return float(self._coordinates(there, tangent)[0][i]) - bound

                start = beyond(0.0)
                hits.append(brentq(beyond, 0.0, step, xtol=1e-13) if start * beyond(step) < 0.0 else 0.0)
        if not hits:
            return None
        there = self._moved(state, tangent, min(hits))
        return self._coordinates(there, tangent)[0]
