"""Frames that links scale: a rigid pose, and what it is stretched by inside.  Millimetres, FreeCAD's axes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...spatial import Array, Pose


@dataclass(frozen=True, slots=True, eq=False)
class Frame:
    """A point p inside is ``pose.point(stretch @ p)`` in the world.  stretch: shape (3, 3); a part that stands turned
    in a link of uneven scale is sheared."""

    pose: Pose = field(default_factory=Pose)
    stretch: Array = field(default_factory=lambda: np.eye(3))

    def at(self, placed: Pose) -> Frame:
        """The frame of what is placed inside this one."""
        turn, stretch = placed.rotation, self.stretch
        pose = Pose(self.pose.rotation @ turn, self.pose.point(stretch @ placed.translation))
        even = stretch[0, 0] * np.eye(3)
        return Frame(pose, stretch if np.array_equal(stretch, even) else turn.T @ stretch @ turn)

    def scaled(self, x: float, y: float, z: float) -> Frame:
        """The same frame, its inside scaled along its own axes."""
        return Frame(self.pose, self.stretch @ np.diag([x, y, z]))
