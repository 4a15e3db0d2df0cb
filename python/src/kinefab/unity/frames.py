"""The one mirror: from the right-handed scene to Unity's left-handed frame, M = diag(-1, 1, 1).

Both frames have +Y up and +Z forward, so only X changes sign.  After the mirror every formula (cross
product, quaternion product, rotation matrix) is evaluated component by component as before; that *is*
Unity's left-hand convention.  One function for each kind of quantity, numbered as in ``schemas/SPEC.md``;
all take arrays with the quantity along the last axis (or axes) and return float64, or the integers given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..spatial import Array, Pose, cross

_POLAR = np.array([-1.0, 1.0, 1.0])
_AXIAL = np.array([1.0, -1.0, -1.0])
_QUATERNION = np.array([1.0, -1.0, -1.0, 1.0])
_BOTH_SIDES = np.outer(_POLAR, _POLAR)
_JOINT_AXES = np.array([1.0, 1.0, -1.0])
"""The axes of ``joint_basis`` against the mirrored CAD axes: M X, M Y and -M Z."""


def point(p: ArrayLike) -> Array:
    """F1. Points, metres, shape (..., 3): M p."""
    return np.asarray(p, dtype=np.float64) * _POLAR


def direction(v: ArrayLike) -> Array:
    """F1. Polar vectors, shape (..., 3): directions, normals, velocities, forces: M v."""
    return np.asarray(v, dtype=np.float64) * _POLAR


def axial(w: ArrayLike) -> Array:
    """F2. Axial vectors, shape (..., 3): angular velocity, torque, the axis of a rotation whose angle keeps
    its sign: det(M) M w = -M w."""
    return np.asarray(w, dtype=np.float64) * _AXIAL


def rotation(r: ArrayLike) -> Array:
    """F4. Rotation matrices, shape (..., 3, 3): M R M."""
    return np.asarray(r, dtype=np.float64) * _BOTH_SIDES


def quaternion(q: ArrayLike) -> Array:
    """F3. Quaternions (x, y, z, w), shape (..., 4): the vector part is axial, w stays."""
    return np.asarray(q, dtype=np.float64) * _QUATERNION


def pose(p: Pose) -> Pose:
    """F1, F4. A rigid pose.  Local and world poses alike: the mirror commutes with composition."""
    return Pose(rotation(p.rotation), point(p.translation))


def inertia(i: ArrayLike) -> Array:
    """F5. Inertia tensors, kg m^2, shape (..., 3, 3): M I M.  Principal moments stay as they are."""
    return rotation(i)


def winding(faces: np.ndarray) -> np.ndarray:
    """F6. Triangles, shape (m, 3): counter-clockwise from outside becomes clockwise."""
    return faces[:, [0, 2, 1]]


def handedness(sense: Array) -> Array:
    """F6. The sense of a mesh's bitangent, +1 or -1, shape (n,): the mirror turns it."""
    return -np.asarray(sense, dtype=np.float64)


def angle(q: ArrayLike) -> Array:
    """F8. A right-handed angle about an axis that is itself mapped as a direction (F1), read by Unity's
    left-hand rule: -q.  (Where the axis is mapped by F2 instead, the angle keeps its sign: F7.)"""
    return -np.asarray(q, dtype=np.float64)


def distance(q: ArrayLike) -> Array:
    """F1. A distance along an axis mapped as a direction keeps its sign."""
    return np.asarray(q, dtype=np.float64)


def lead(metres_per_turn: ArrayLike) -> Array:
    """F8. The lead of a screw: its sign turns, as the angle's does and the distance's does not."""
    return -np.asarray(metres_per_turn, dtype=np.float64)


def joint_basis(r: Array) -> Array:
    """F1. Joint axes, shape (3, 3), columns X Y Z: X and Y are mapped as directions, and Z is the cross
    product that Unity forms of them, which is -M z."""
    x, y = direction(r[:, 0]), direction(r[:, 1])
    return np.column_stack([x, y, cross(x, y)])


COUNTS_CONNECTED = {"counts": "connected"}
"""In ``extras`` of a component that the own body carries only because the other has no Rigidbody: the source counts the
connected body's motion against the own one, which none of Unity's fields tells."""


@dataclass(frozen=True, slots=True)
class Senses:
    """F1, F8. How a joint's CAD coordinates q read along and about the axes of ``joint_basis``: as sign * q.

    linear, angular: the signs for X, Y and Z.
    """

    linear: tuple[float, float, float]
    angular: tuple[float, float, float]

    @staticmethod
    def of(b_in_a: bool) -> Senses:
        """b_in_a: whether what is read is b's motion seen from a, as in CAD; a's seen from b is the other way round."""
        axes = _JOINT_AXES if b_in_a else -_JOINT_AXES
        return Senses(tuple(distance(axes).tolist()), tuple(angle(axes).tolist()))
