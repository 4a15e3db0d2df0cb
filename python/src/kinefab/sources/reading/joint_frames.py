"""Joint frames and coordinates at the exported pose, for many joints at once.

CAD joints name Z as their axis, ``model.Joint`` names X: Z-main axes (x, y, z) are re-labelled by the cyclic
permutation (z, x, y) -> (X, Y, Z), a proper rotation.  This is the only place that knows both.
"""

from __future__ import annotations

import math

import numpy as np

from ...model import RX, RZ, TX, TZ, JointKind
from ...spatial import Array, BoolArray

Z_MAIN = {"tz": TX, "tx": TX + 1, "ty": TX + 2, "rz": RX, "rx": RX + 1, "ry": RX + 2}
"""Freedom in the scene's joint frame by its name in the source's Z-main frame."""
AS_NAMED = {"tx": TX, "ty": TX + 1, "tz": TZ, "rx": RX, "ry": RX + 1, "rz": RZ}
"""A universal joint's cross keeps its names: Z turns in a, X turns in b, as in ``JointKind.UNIVERSAL``."""


def freedom_names(kind: JointKind) -> dict[str, int]:
    """The source's names of a joint's freedoms."""
    return AS_NAMED if kind is JointKind.UNIVERSAL else Z_MAIN


def frame_axes(z: Array, x: Array) -> Array:
    """Columns x, y, z of right-handed frames; x is made perpendicular to z.  z, x: unit, shape (n, 3)."""
    x = x - z * np.einsum("ni,ni->n", x, z)[:, None]
    x = x / np.linalg.norm(x, axis=1)[:, None]
    return np.stack([x, np.cross(z, x), z], axis=2)


def relabel(axes: Array, universal: BoolArray, second: bool) -> Array:
    """Z-main frames to the scene's X-main frames; shape (n, 3, 3).

    universal: which joints keep their labels, shape (n,).  second: the frames belong to b, where a universal
    joint's z is the arm that turns in b: the scene's X.
    """
    turned = axes[:, :, [2, 0, 1]]
    if second:
        # z is X and x is Z: Y = Z x X = x x z = -y.
        kept = np.stack([axes[:, :, 2], -axes[:, :, 1], axes[:, :, 0]], axis=2)
    else:
        kept = axes
    return np.where(universal[:, None, None], kept, turned)


def motion(coordinates: Array) -> Array:
    """Pose (4, 4) of b's frame in a's at the coordinates tx ty tz rx ry rz; at most one rotation, or rx and
    rz.

    Source: the Cardan order of ``JointKind.UNIVERSAL``, R = Rz(rz) Rx(rx), of which a single turn is a case.
    """
    cx, sx = math.cos(coordinates[RX]), math.sin(coordinates[RX])
    cz, sz = math.cos(coordinates[RZ]), math.sin(coordinates[RZ])
    tx, ty, tz = coordinates[:3]
    return np.array(
        [[cz, -sz * cx, sz * sx, tx], [sz, cz * cx, -cz * sx, ty], [0.0, sx, cx, tz], [0.0, 0.0, 0.0, 1.0]]
    )


def coordinates(rotations: Array, translations: Array) -> Array:
    """What ``motion`` undoes, for b's frames in a's: shapes (n, 3, 3) and (n, 3) to (n, 6); ry is 0."""
    rx = np.arctan2(rotations[:, 2, 1], rotations[:, 2, 2])
    rz = np.arctan2(rotations[:, 1, 0], rotations[:, 0, 0])
    return np.column_stack([translations, rx, np.zeros(len(rx)), rz])


def shifted(frame: Array, measured: Array, wanted: Array) -> Array:
    """b's joint frame (4, 4), moved along the joint so that it reads ``wanted`` where it read ``measured``.

    With b's frame at W M(measured), W M(wanted) is M(measured)^-1 M(wanted) further on; what a saved pose
    misses in the locked freedoms stays.
    """
    return frame @ np.linalg.inv(motion(measured)) @ motion(wanted)
