"""Moves a mechanism to stated values of its joint coordinates."""

from __future__ import annotations

from dataclasses import replace
from typing import Sequence

import numpy as np

from ..model import RX, Joint
from ..spatial import Pose
from .assembly import Assembly
from .blocks import relative_system
from .equations import coordinate, joint_sides
from .rows import Rows
from .solve import Solver
from .system import State, joined

TURN_STEP = 0.1
"""Largest step of a rotation on the way to a value, radians; of a slide, as a fraction of the length."""
SMALLEST_STEP = 1e-6
REACHED = 1e-11
JUMP = 6.0
"""A step that moves some body this many times further than asked has changed to another branch."""


class OutOfReach(Exception):
    """The mechanism cannot take the value; ``value`` is the furthest one reached, ``joint`` whose it is."""

    def __init__(self, joint: str, value: float):
        self.joint, self.value = joint, value
        super().__init__(f"{joint} stops at {value}")


class Drive:
    """A mechanism held by some of its joint coordinates.

    joints: found joints (``Analysis.joints``) and their freedoms TX..RZ, the coordinates that are driven.
    """

    def __init__(self, assembly: Assembly, joints: Sequence[tuple[Joint, int]]):
        self.assembly, self.joints = assembly, list(joints)
        scene = assembly.scene.with_poses(assembly.poses)
        rows = Rows()
        for i, (joint, freedom) in enumerate(self.joints):
            rows.owner = i
            a, b = joint_sides(joint, scene)
            a, b = (replace(s, body=int(assembly.body[s.body])) for s in (a, b))
            coordinate(rows, rows.row(freedom < RX), a, b, freedom, 1.0)
        drivers = rows.system(assembly.system.bodies)
        self._system = relative_system(joined(assembly.system, drivers), assembly.blocks)
        self._system.center, self._system.length = assembly.relative.center, assembly.relative.length
        self._system.row_length[: assembly.system.rows] = assembly.relative.row_length
        self._atoms = np.flatnonzero(self._system.row >= assembly.system.rows)
        bodies = np.maximum(self._system.body_a, self._system.body_b)[self._atoms]
        self._system.row_length[assembly.system.rows :] = assembly.relative.length[bodies]
        self._solver = Solver(self._system)
        self.state: State = self._system.start()
        self.values = np.zeros(len(self.joints))

    def to(self, values: Sequence[float]) -> None:
        """Follow the mechanism to these values (metres, radians).  Raises OutOfReach where it stops."""
        start, target = self.values.copy(), np.asarray(values, dtype=float)
        reach = np.where([f < RX for _, f in self.joints], self._reach(), 1.0) * TURN_STEP
        full = max(1, int(np.ceil(np.abs((target - start) / reach).max(initial=0.0))))
        done, step = 0.0, 1.0 / full
        while done < 1.0:
            step = min(step, 1.0 - done)
            if self._step(start + (done + step) * (target - start), step * full):
                done += step
                step = min(2.0 * step, 1.0 / full)
            else:
                step *= 0.5
                if step * full < SMALLEST_STEP:
                    worst = int(np.argmax(np.abs(target - self.values)))
                    raise OutOfReach(self.joints[worst][0].id, float(self.values[worst]))

    def _reach(self) -> np.ndarray:
        bodies = np.maximum(self._system.body_a, self._system.body_b)[self._atoms]
        return self._system.length[bodies]

    def _step(self, values: np.ndarray, share: float) -> bool:
        self._system.d[self._atoms] = values
        state, left = self._solver.project(self.state)
        moved = np.abs(state.rotation - self.state.rotation).max()
        if left.max(initial=0.0) > REACHED or moved > JUMP * max(share, 1e-3) * TURN_STEP:
            return False
        self._system.remember(state)
        self.state, self.values = state, values
        return True

    def poses(self) -> list[Pose]:
        """World poses of the scene's nodes."""
        assembly = self.assembly
        rotation, translation = self._system.displacement(self.state)
        rotation, translation = rotation.copy(), translation.copy()
        blocks = assembly.blocks
        for body in blocks.order.tolist():
            if blocks.block[body] >= 0:
                root = int(blocks.root[blocks.block[body]])
                translation[body] = rotation[root] @ translation[body] + translation[root]
                rotation[body] = rotation[root] @ rotation[body]
        moved = (Pose(rotation[int(b)], translation[int(b)]) for b in assembly.body[1:])
        return [displacement @ pose for displacement, pose in zip(moved, assembly.poses)]
