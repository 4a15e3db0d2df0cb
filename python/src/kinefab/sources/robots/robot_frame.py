"""The frame of robot formats (URDF, SDF, MJCF): right-handed, Z up, looked at along X, metres, radians.

Links and joints are turned like the world (R becomes T R T'), so that an unrotated link stays unrotated in Unity; shapes
keep their own axes (T R), since a cylinder lies along its own Z in both.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...spatial import Array, Pose
from ..reading.source_frame import DIRECTIONS, turn_to_scene

TURN: Array = turn_to_scene(DIRECTIONS["Z"], DIRECTIONS["X"])
"""Source axes to scene axes: (x, y, z) -> (y, z, x), shape (3, 3)."""


def placed(pose: Pose) -> Pose:
    """Of a link, a joint, a mesh file: from the source's frames to the scene's."""
    return Pose(TURN @ pose.rotation @ TURN.T, TURN @ pose.translation)


def shape_placed(pose: Pose) -> Pose:
    """Of a shape that keeps its own axes."""
    return Pose(TURN @ pose.rotation, TURN @ pose.translation)


def direction(v: Sequence[float] | Array) -> Array:
    """A vector, or a point in metres, from the source's axes in the scene's, shape (3,)."""
    return TURN @ np.asarray(v, dtype=np.float64)


def rotation_rpy(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation matrix of turns about the fixed axes X, then Y, then Z."""
    (cr, sr), (cp, sp), (cy, sy) = ((math.cos(a), math.sin(a)) for a in (roll, pitch, yaw))
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
