"""Joint coordinates of one block, measured along its motions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...model import RX, Motion, Scene
from ...spatial import Array, IntArray
from ..assembly.assemble import Assembly
from ..equations.rows import Rows
from ..equations.scene_equations import joint_coordinate, joint_sides
from ..equations.solve import Solver
from ..equations.system import State, System, joined
from ..joints.links import Link

CLOSED = 1e-9
"""Scaled residual up to which a pose is one of the mechanism's."""


class Measured:
    """A block and coordinates (a link and its freedom TX..RZ each) to measure in it.

    part: the block's number among ``Assembly.freedoms``; in here its bodies are 1 to n, its root is at rest as 0.
    without: statements (by place) whose rows are left out.
    lower, upper: the source's limits, or the exported pose where that is outside; infinite where there are none.  rotary: which coordinates are angles.
    system, start, turns: the block's equations, the exported pose, and the last angles there (``State.angle``
    of ``probe``).  length: metres, of its twists.
    """

    def __init__(
        self,
        assembly: Assembly,
        part: int,
        coordinates: Sequence[tuple[Link, int]],
        scene: Scene,
        without: Sequence[int] = (),
    ):
        bodies = assembly.freedoms[part].bodies.tolist()
        number = {body: i for i, body in enumerate(bodies, start=1)}
        self.bodies = np.arange(1, len(bodies) + 1)
        whole = assembly.solver.alone(part)
        self.system: System = whole.select(~np.isin(whole.owner, without)) if len(without) else whole
        self.length = float(self.system.length[1])
        self.solver = Solver(self.system)
        probe = Rows()
        for i, (link, freedom) in enumerate(coordinates):
            probe.owner = i
            ends = zip(joint_sides(link.joint, scene), (link.a, link.b))
            a, b = (replace(side, body=number.get(body, 0)) for side, body in ends)
            joint_coordinate(probe, probe.row(freedom < RX), a, b, freedom, link.joint)
        self.probe = probe.system(len(bodies) + 1)
        self.probe.center, self.probe.length = self.system.center, self.system.length
        self.start = self.system.start()
        self.rotary = np.array([f >= RX for _, f in coordinates], dtype=bool)
        limits = [link.joint.freedoms[freedom] for link, freedom in coordinates]
        self.lower, self.upper = (
            np.array([getattr(f, end) if f.motion is Motion.LIMITED else away for f in limits])
            for end, away in (("lower", -np.inf), ("upper", np.inf))
        )
        # A pose tells an angle up to whole turns only; the source's limits say which is meant.
        turns = self.probe.start().angle
        value = self.read(self.start, turns)[0]
        meant = [f.nearest_turn(v) if turn else v for f, v, turn in zip(limits, value.tolist(), self.rotary)]
        self.turns = turns + (np.array(meant) - value)[self.probe.row]
        # A pose outside of a limit is where the mechanism starts: it has the way back in, and none further out.
        self.lower, self.upper = np.minimum(self.lower, meant), np.maximum(self.upper, meant)

    def read(self, state: State, turns: Array) -> tuple[Array, Array]:
        """Coordinates, metres and radians, and their rates: rows on the bodies' scaled twists, (k, 6 n)."""
        return self.probe.dense(State(state.rotation, state.shift, turns))

    def passed(self, state: State, turns: Array) -> Array:
        """Note a pose as the one further turns are counted from; the angles there."""
        here = State(state.rotation, state.shift, turns)
        self.probe.remember(here)
        self.system.remember(state)
        return here.angle

    def moved(self, state: State, twist: Array) -> State | None:
        """The pose after scaled twists (6 n) of the bodies, back on the block's rows; None where it is off them."""
        there = self.system.moved(state, self.bodies, twist.reshape(-1, 6))
        there, left = self.solver.project(there)
        return there if left.max(initial=0.0) < CLOSED else None

    def held(self, at: IntArray, values: Array) -> Held:
        """The block with some of the coordinates held at values."""
        return Held(self, at, values)


class Held:
    """A block whose coordinates ``at`` keep ``values``."""

    def __init__(self, block: Measured, at: IntArray, values: Array):
        self.block = block
        held = block.probe.select(at)
        held.d = held.d + np.asarray(values)[held.row]
        held.row_length = np.where(held.is_length, block.length, 1.0)
        self.system = joined(block.system, held)
        self.solver = Solver(self.system)
        self._own = len(block.system.kind)
        self._held = np.isin(block.probe.row, at)

    def moved(self, state: State, turns: Array, twist: Array) -> State | None:
        """As ``Measured.moved``, back on the held values too."""
        there = self.block.system.moved(state, self.block.bodies, twist.reshape(-1, 6))
        angle = np.concatenate([state.angle, turns[self._held]])
        there, left = self.solver.project(State(there.rotation, there.shift, angle))
        if not left.max(initial=0.0) < CLOSED:
            return None
        return State(there.rotation, there.shift, there.angle[: self._own])
