"""Moves a mechanism to stated values of its joint coordinates, whatever their limits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ...model import Joint
from ...spatial import Array, Pose
from ..assembly.assemble import Assembly
from ..equations.system import State
from ..ranges.measured import Measured
from .coordinates import block_of, links_to
from .walk import Walk


class OutOfReach(Exception):
    """The mechanism cannot take the value; ``value`` is the furthest one reached, ``joint`` whose it is."""

    def __init__(self, joint: str, value: float):
        self.joint, self.value = joint, value
        super().__init__(f"{joint} stops at {value}")


class Drive:
    """A mechanism held by some of its joint coordinates.

    joints: found joints (``Analysis.joints``) and their freedoms TX..RZ, the coordinates that are driven.
    values: where they stand, metres and radians, counted from where the joints' frames meet.
    """

    def __init__(self, assembly: Assembly, joints: Sequence[tuple[Joint, int]]):
        self.assembly, self.joints = assembly, list(joints)
        scene = assembly.closed_scene
        blocks: dict[int, list[int]] = {}
        for i, (joint, _) in enumerate(self.joints):
            part = block_of(assembly, joint)
            if part is None:
                raise ValueError(f"{joint.id} joins nothing that moves")
            blocks.setdefault(part, []).append(i)
        self.values: Array = np.zeros(len(self.joints))
        self._walks: dict[int, tuple[list[int], Walk]] = {}
        for part, own in blocks.items():
            links = links_to(assembly, [self.joints[i] for i in own])
            walk = Walk(Measured(assembly, part, links, scene), range(len(own)))
            self._walks[part] = own, walk
            self.values[own] = walk.values

    def to(self, values: Sequence[float]) -> None:
        """Follow the mechanism to these values (metres, radians).  Raises OutOfReach where it stops."""
        target = np.asarray(values, dtype=float)
        for own, walk in self._walks.values():
            _, reached = walk.towards(target[own])
            self.values[own] = walk.values
            if not reached:
                worst = own[int(np.argmax(np.abs(target[own] - walk.values)))]
                raise OutOfReach(self.joints[worst][0].id, float(self.values[worst]))

    @property
    def state(self) -> State:
        """Displacements of the assembly's bodies, each against its block's root."""
        start = self.assembly.start
        rotation, shift = start.rotation.copy(), start.shift.copy()
        for part, (_, walk) in self._walks.items():
            bodies = self.assembly.freedoms[part].bodies
            rotation[bodies], shift[bodies] = walk.state.rotation[1:], walk.state.shift[1:]
        return State(rotation, shift, start.angle)

    def poses(self) -> list[Pose]:
        """World poses of the scene's nodes."""
        assembly = self.assembly
        rotation, translation = (values.copy() for values in assembly.relative.displacement(self.state))
        assembly.blocks.carry(rotation, translation, assembly.blocks.order)
        moved = (Pose(rotation[int(b)], translation[int(b)]) for b in assembly.body[1:])
        return [displacement @ pose for displacement, pose in zip(moved, assembly.poses)]
