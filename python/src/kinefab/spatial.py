"""Rigid poses and the few rotation formulas shared by every stage.

Everything here is right-handed, float64, SI and radians.  Quaternions are ``(x, y, z, w)``.
Nothing here knows of Unity: the one mirror lives in ``unity/frames.py``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]
ROUNDING = 6
"""Digits of a unit vector by which a choice is made, so that the last bit of a turned one decides nothing."""


def vector(values: ArrayLike) -> Array:
    """Three numbers as a float64 array, shape (3,)."""
    array = np.asarray(values, dtype=np.float64)
    if array.shape != (3,):
        raise ValueError(f"expected three numbers, got shape {array.shape}")
    return array


@dataclass(frozen=True, slots=True, eq=False)
class Pose:
    """A rigid pose: a point p of the inner frame is ``rotation @ p + translation`` in the outer one.

    rotation: proper rotation matrix, shape (3, 3), columns are the inner axes in the outer frame.
    translation: inner origin in the outer frame, metres, shape (3,).

    >>> import kinefab, numpy as np
    >>> quarter = kinefab.Pose(np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]), np.array([5.0, 0.0, 0.0]))
    >>> (quarter @ quarter).translation.tolist()
    [5.0, 5.0, 0.0]
    """

    rotation: Array = field(default_factory=lambda: np.eye(3))
    translation: Array = field(default_factory=lambda: np.zeros(3))

    def __matmul__(self, inner: Pose) -> Pose:
        return Pose(self.rotation @ inner.rotation, self.rotation @ inner.translation + self.translation)

    def inverse(self) -> Pose:
        """The outer frame in the inner one.

        >>> import numpy as np
        >>> kinefab.Pose(translation=np.array([1.0, 2.0, 3.0])).inverse().translation.tolist()
        [-1.0, -2.0, -3.0]
        """
        return Pose(self.rotation.T, -self.rotation.T @ self.translation)

    def point(self, p: Array) -> Array:
        """A point, or points of shape (n, 3), from the inner frame to the outer one.

        >>> import numpy as np
        >>> kinefab.Pose(np.diag([1.0, -1.0, -1.0]), np.array([5.0, 0.0, 0.0])).point(np.array([1.0, 2.0, 3.0])).tolist()
        [6.0, -2.0, -3.0]
        """
        return p @ self.rotation.T + self.translation

    def direction(self, d: Array) -> Array:
        """A direction, or directions of shape (n, 3), from the inner frame to the outer one.

        >>> import numpy as np
        >>> kinefab.Pose(np.diag([1.0, -1.0, -1.0])).direction(np.array([1.0, 2.0, 3.0])).tolist()
        [1.0, -2.0, -3.0]
        """
        return d @ self.rotation.T


def bounds(points: Array) -> tuple[Array, Array]:
    """Lowest and highest coordinates of points, shape (n, 3): each of shape (3,).  Numpy is several times as fast along rows."""
    rows = np.ascontiguousarray(points.T)
    return rows.min(axis=1), rows.max(axis=1)


def lengths_of(vectors: Array) -> Array:
    """Lengths of vectors, shape (n, 3) to (n,): to the bit those of ``np.linalg.norm``, which is slow along short rows."""
    x, y, z = vectors[:, 0], vectors[:, 1], vectors[:, 2]
    return np.sqrt(x * x + y * y + z * z)


def cross(x: Array, y: Array) -> Array:
    """Cross product over the last axis, far cheaper than numpy's own on the small arrays used here."""
    if x.ndim == y.ndim == 1:
        (a, b, c), (d, e, f) = x.tolist(), y.tolist()
        return np.array([b * f - c * e, c * d - a * f, a * e - b * d])
    out = np.empty(np.broadcast_shapes(x.shape, y.shape))
    out[..., 0] = x[..., 1] * y[..., 2] - x[..., 2] * y[..., 1]
    out[..., 1] = x[..., 2] * y[..., 0] - x[..., 0] * y[..., 2]
    out[..., 2] = x[..., 0] * y[..., 1] - x[..., 1] * y[..., 0]
    return out


def skew(v: Array) -> Array:
    """The matrices S with ``S @ u == cross(v, u)``, shape (..., 3) to (..., 3, 3)."""
    s = np.zeros(v.shape + (3,))
    s[..., 0, 1], s[..., 0, 2], s[..., 1, 2] = -v[..., 2], v[..., 1], -v[..., 0]
    s[..., 1, 0], s[..., 2, 0], s[..., 2, 1] = v[..., 2], -v[..., 1], v[..., 0]
    return s


def rotation_about(axis: Array, angle: float) -> Array:
    """Rotation matrix by ``angle`` radians about ``axis`` (unit vector), right-hand rule (Rodrigues)."""
    s, c = np.sin(angle), np.cos(angle)
    k = skew(axis)
    return np.eye(3) + s * k + (1.0 - c) * (k @ k)


def rotation_exp(w: Array) -> Array:
    """Rotation matrix of the rotation vector ``w``, radians, shape (3,)."""
    angle = float(np.linalg.norm(w))
    return rotation_about(w / angle, angle) if angle > 0.0 else np.eye(3)


def rotation_log(r: Array) -> Array:
    """Rotation vector of a rotation matrix, radians, shape (3,); of length pi at most."""
    q = quaternion_from_matrix(r)
    size = float(np.linalg.norm(q[:3]))
    return q[:3] * (2.0 * math.atan2(size, q[3]) / size) if size > 0.0 else np.zeros(3)


def perpendicular(axis: Array, axes: Array | None = None) -> Array:
    """A unit vector at right angles to ``axis`` (unit vector); the choice is deterministic.

    axes: rotation matrix, the frame in whose columns the choice is made; the outer frame's where it is None.
    """
    axes = np.eye(3) if axes is None else axes
    side = cross(axis, axes[:, int(np.argmin(np.abs(axis @ axes).round(ROUNDING)))])
    return side / math.sqrt(side @ side)


def frame_from_axes(primary: Array, secondary: Array | None = None) -> Array:
    """Rotation matrix whose first column is ``primary`` and whose second lies towards ``secondary``.

    primary: direction of X, any length above zero.
    secondary: direction that Y comes closest to; a deterministic perpendicular where it is None or
        parallel to ``primary``.
    Raises ValueError when ``primary`` has no length.
    """
    length = np.linalg.norm(primary)
    if not length > 0.0:
        raise ValueError("an axis of zero length gives no frame")
    x = primary / length
    y = np.zeros(3) if secondary is None else secondary - x * (x @ secondary)
    size = np.linalg.norm(y)
    scale = 0.0 if secondary is None else np.linalg.norm(secondary)
    y = y / size if size > 1e-9 * scale else perpendicular(x)
    return np.column_stack([x, y, cross(x, y)])


def quaternion_from_matrix(r: Array) -> Array:
    """Unit quaternion (x, y, z, w) of a rotation matrix, w >= 0, shape (4,) (Shepperd's method)."""
    return np.array(quaternion_from_rows(r.tolist()))


def quaternion_from_rows(rows: list[list[float]]) -> tuple[float, float, float, float]:
    """As ``quaternion_from_matrix``, of three rows of three numbers."""
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = rows
    trace = xx + yy + zz
    largest = max(xx, yy, zz, trace)
    if xx == largest:
        q = (1.0 - trace + 2.0 * xx, yx + xy, zx + xz, zy - yz)
    elif yy == largest:
        q = (xy + yx, 1.0 - trace + 2.0 * yy, zy + yz, xz - zx)
    elif zz == largest:
        q = (xz + zx, yz + zy, 1.0 - trace + 2.0 * zz, yx - xy)
    else:
        q = (zy - yz, xz - zx, yx - xy, 1.0 + trace)
    size = math.hypot(*q) * (-1.0 if q[3] < 0.0 else 1.0)
    return q[0] / size, q[1] / size, q[2] / size, q[3] / size


def quaternions_from_matrices(r: Array) -> Array:
    """Unit quaternions (x, y, z, w), w >= 0, of rotation matrices, shape (..., 3, 3) to (..., 4)."""
    xx, yy, zz = r[..., 0, 0], r[..., 1, 1], r[..., 2, 2]
    squares = np.stack([1 + xx - yy - zz, 1 - xx + yy - zz, 1 - xx - yy + zz, 1 + xx + yy + zz], axis=-1)
    sums = {(i, j): r[..., i, j] + r[..., j, i] for i, j in ((0, 1), (0, 2), (1, 2))}
    turns = {i: r[..., (i + 2) % 3, (i + 1) % 3] - r[..., (i + 1) % 3, (i + 2) % 3] for i in range(3)}
    table = np.empty(r.shape[:-2] + (4, 4))
    for i in range(3):
        table[..., i, i] = squares[..., i]
        table[..., i, 3] = table[..., 3, i] = turns[i]
    table[..., 3, 3] = squares[..., 3]
    for (i, j), value in sums.items():
        table[..., i, j] = table[..., j, i] = value
    best = np.argmax(squares, axis=-1)[..., None, None]
    q = np.take_along_axis(table, np.broadcast_to(best, r.shape[:-2] + (1, 4)), axis=-2)[..., 0, :]
    unit: Array = q / np.linalg.norm(q, axis=-1, keepdims=True)
    return np.where(unit[..., 3:] < 0.0, -unit, unit)


def without_flips(q: Array) -> Array:
    """Quaternions of several bodies over frames, shape (frames, n, 4), each with the sign that is nearer to the frame
    before."""
    if not len(q):
        return q
    signs = np.where(np.einsum("fni,fni->fn", q[1:], q[:-1]) < 0.0, -1.0, 1.0)
    return q * np.cumprod(np.concatenate([np.ones((1, q.shape[1])), signs]), axis=0)[..., None]


def matrix_from_quaternion(q: Array) -> Array:
    """Rotation matrix of a quaternion (x, y, z, w) of any length above zero, shape (3, 3)."""
    return np.array(_turned_rows(*(q / math.hypot(*q)).tolist()))


def matrices_from_quaternions(q: Array) -> Array:
    """Rotation matrices of quaternions (x, y, z, w) of any length above zero, shape (n, 4) to (n, 3, 3)."""
    unit = q / np.sqrt((q * q).sum(axis=1, keepdims=True))
    return np.array(_turned_rows(*unit.T)).transpose(2, 0, 1)


def _turned_rows(x: Any, y: Any, z: Any, w: Any) -> list[list[Any]]:
    """Rows of the rotation matrix of a unit quaternion, or of many at once, one number or array an entry."""
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
