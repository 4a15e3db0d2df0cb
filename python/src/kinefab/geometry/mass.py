"""Mass, centre of mass and inertia: of a mesh, of a named shape, of several bodies together, and along principal axes."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from functools import lru_cache
from itertools import permutations

import numpy as np

from ..model import MassProperties
from ..spatial import Array, BoolArray, IntArray, Pose, bounds, skew

STAND_IN_DENSITY = 1000.0
"""kg/m^3 of the ball that stands in for an inertia that is not stated at all."""
DIAGONAL = 1e-9
"""Products of inertia below this share of the largest moment are noise: the axes are principal already."""
THIN = 1e-3
"""Smallest moment against the largest that stands in for one that is zero or negative."""
ROUNDING = 1e-9
"""Share of the largest moment that is lost in sums and turns."""
POINT = 1e-6
"""Metres of the radius of gyration up to which no inertia is stated at all."""


def solid_properties(vertices: Array, faces: IntArray, density: float) -> MassProperties:
    """Of the solid inside a closed, outward wound mesh.

    vertices: metres, shape (n, 3).  faces: shape (m, 3).  density: kg/m^3.
    The mass is negative for an inward wound mesh.  Sum over the tetrahedra from the mesh's middle to its faces; source:
    Blow and Binstock, *How to find the inertia tensor (or other mass properties) of a 3D solid body represented by a
    triangle mesh*.
    """
    low, high = bounds(vertices)
    middle = 0.5 * (low + high)  # moments lose digits far from the origin
    corners, six = _tetrahedra(vertices - middle, faces)
    whole = corners[:, 0] + corners[:, 1] + corners[:, 2]
    volume = float(six.sum()) / 6.0
    with np.errstate(divide="ignore", invalid="ignore"):  # of no volume: the caller looks at the mass
        center = (whole @ six) / (24.0 * volume)
    # The integral of x x' over a tetrahedron with a corner at the origin is det / 120 (sum of v v' + s s').
    second = (corners * six).reshape(3, -1) @ corners.reshape(3, -1).T + (whole * six) @ whole.T
    second = second / 120.0 - volume * np.outer(center, center)
    inertia = np.trace(second) * np.eye(3) - second
    return MassProperties(volume * density, center + middle, inertia * density)


def shape_properties(kind: str, size: Sequence[float]) -> MassProperties:
    """Of a shape of ``primitives`` with density 1, as that stands it, and exactly: the mesh of a ball is 0.3 % short.

    kind, size: box: extents; ellipsoid: half extents; sphere: (radius,); cylinder, capsule, cone: (radius, length).
    """
    z = 0.0
    if kind in ("box", "ellipsoid", "sphere"):
        a, b, c = size if len(size) == 3 else (*size, *size, *size)
        volume = a * b * c * (1.0 if kind == "box" else 4.0 / 3.0 * math.pi)
        squares = np.array([b * b + c * c, a * a + c * c, a * a + b * b])
        moments = volume * squares / (12.0 if kind == "box" else 5.0)
    else:
        r, h = size
        volume = math.pi * r * r * h
        across, along = volume * (3.0 * r * r + h * h) / 12.0, 0.5 * volume * r * r
        if kind == "cone":
            volume, z = volume / 3.0, -0.25 * h
            across, along = 0.0375 * volume * (4.0 * r * r + h * h), 0.3 * volume * r * r
        elif kind == "capsule":
            ball = 4.0 / 3.0 * math.pi * r**3
            volume += ball
            along += 0.4 * ball * r * r
            across += ball * (0.4 * r * r + 0.375 * r * h + 0.25 * h * h)
        moments = np.array([across, across, along])
    return MassProperties(float(volume), np.array([0.0, 0.0, z]), np.diag(moments))


def solid_volume(vertices: Array, faces: IntArray) -> float:
    """Of the solid inside a closed mesh, cubic metres; negative where it is wound inwards."""
    return float(_tetrahedra(vertices - vertices[0], faces)[1].sum()) / 6.0


def _tetrahedra(vertices: Array, faces: IntArray) -> tuple[Array, Array]:
    """From the origin to each face: its corners by axis and corner, shape (3, 3, m), and six times its volume, shape (m,).

    Numpy is twice as fast on three long rows as on many short ones.
    """
    corners = np.take(np.ascontiguousarray(vertices.T), faces.T, axis=1)
    (a, b, c), (d, e, f), (g, h, i) = corners[:, 0], corners[:, 1], corners[:, 2]
    return corners, a * (e * i - f * h) + b * (f * g - d * i) + c * (d * h - e * g)


def ball_inertia(mass: float) -> Array:
    """Of a ball of water, kg m^2, shape (3, 3): what stands in for an inertia that nobody knows."""
    radius = math.cbrt(3.0 * mass / (4.0 * math.pi * STAND_IN_DENSITY))
    return 0.4 * mass * radius * radius * np.eye(3)


def moved(properties: MassProperties, pose: Pose) -> MassProperties:
    """The same body seen from an outer frame in which its own frame stands at ``pose``."""
    r = pose.rotation
    return MassProperties(properties.mass, pose.point(properties.center), r @ properties.inertia @ r.T)


def stretched(properties: MassProperties, scale: tuple[float, float, float]) -> MassProperties:
    """The same body stretched along its frame's axes, its density kept; a mirroring factor turns nothing inside out."""
    if scale == (1.0, 1.0, 1.0):
        return properties
    s, size = np.array(scale), abs(scale[0] * scale[1] * scale[2])
    # The integral of x x' over the body goes as S (.) S, its trace less it is the inertia.
    inertia = properties.inertia
    second = 0.5 * np.trace(inertia) * np.eye(3) - inertia
    second = np.outer(s, s) * second * size
    return MassProperties(
        properties.mass * size, s * properties.center, np.trace(second) * np.eye(3) - second
    )


def combined(bodies: Iterable[MassProperties]) -> MassProperties:
    """Of several bodies as one (parallel axis theorem); all in one frame, at least one body."""
    parts: Sequence[MassProperties] = list(bodies)
    if len(parts) == 1:
        return parts[0]
    mass = sum(p.mass for p in parts)
    center = np.sum([p.mass * p.center for p in parts], axis=0) / mass
    inertia = np.zeros((3, 3))
    for p in parts:
        d = p.center - center
        inertia += p.inertia + p.mass * ((d @ d) * np.eye(3) - np.outer(d, d))
    return MassProperties(float(mass), center, inertia)


def principal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments, shape (3,), and the proper rotation whose columns are their axes, shape (3, 3).

    Of the 24 ways to name and point the axes the one closest to the given frame is taken; likewise of all that there are where two
    moments are equal.
    """
    moments, axes = _principal(np.ascontiguousarray(inertia, dtype=np.float64).tobytes())
    return moments.copy(), axes.copy()


EQUAL = 1e-9
"""Of the largest moment: by how much two may differ and be one, whose axes rounding would choose."""


@lru_cache(maxsize=4096)
def _principal(inertia_bytes: bytes) -> tuple[Array, Array]:
    """As ``principal``; an assembly has few shapes and many copies of them."""
    inertia = np.frombuffer(inertia_bytes).reshape(3, 3)
    symmetric = 0.5 * (inertia + inertia.T)
    diagonal = np.diag(symmetric)
    if np.abs(symmetric - np.diag(diagonal)).max() <= DIAGONAL * np.abs(diagonal).max():
        return diagonal.copy(), np.eye(3)
    moments, axes = np.linalg.eigh(symmetric)
    for equal, lone in ((moments[1] - moments[0], 2), (moments[2] - moments[1], 0)):
        if equal <= EQUAL * moments[2]:
            axes = _nearest_with(axes[:, lone])
            return np.diag(axes.T @ symmetric @ axes).copy(), axes
    along = np.abs(axes).tolist()
    order = max(permutations(range(3)), key=lambda p: sum(along[i][p[i]] for i in range(3)))
    axes, moments = axes[:, order], moments[list(order)]
    # The hand is right: the trace is above 1 now (its squares average to 1 over all orders), which a reflection's is not.
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    return moments, axes


def is_possible(inertia: Array, tolerance: float = 1e-6) -> bool:
    """Whether a body can have this inertia."""
    return bool(are_possible(principal_moments(inertia), tolerance))


def _nearest_with(axis: Array) -> Array:
    """The rotation nearest to none that has the axis, or its opposite, for a column."""
    column = int(np.abs(axis).argmax())
    to = axis * np.sign(axis[column])
    own = np.eye(3)[column]
    across = np.cross(own, to)
    return np.eye(3) + skew(across) + skew(across) @ skew(across) / (1.0 + float(own @ to))


def principal_moments(inertia: Array) -> Array:
    """Ascending, of tensors of shape (..., 3, 3): (..., 3)."""
    symmetric = 0.5 * (inertia + np.swapaxes(inertia, -1, -2))
    return np.linalg.eigvalsh(symmetric).astype(np.float64, copy=False)


def are_possible(moments: Array, tolerance: float = 1e-6) -> BoolArray:
    """Whether bodies can have these principal moments, ascending, shape (..., 3): positive, none above the sum of the others."""
    low, middle, high = moments[..., 0], moments[..., 1], moments[..., 2]
    return (low > 0.0) & (high <= (low + middle) * (1.0 + tolerance))


def mended_inertia(inertia: Array, mass: float) -> Array | None:
    """The possible inertia next to one that no body of this mass can have: moments positive, none above the sum of the others.
    kg m^2, shape (3, 3); None where a body can have it."""
    # Stricter than what is asked of a scene, so that the rounding of a later turn decides nothing.
    moments, axes = np.linalg.eigh(inertia)
    if float(moments[0]) > ROUNDING * float(np.abs(inertia).max()) and are_possible(moments, ROUNDING):
        return None
    if not float(moments[2]) > POINT * POINT * mass:  # zero, or what is left of it by the sums
        return ball_inertia(mass)
    return axes @ np.diag(nearest_possible(moments)) @ axes.T


def nearest_possible(moments: Array) -> Array:
    """Principal moments that a body can have, next to three that none can: in the same order, shape (3,).  The largest is
    above zero."""
    found = np.maximum(moments, THIN * float(moments.max()))
    last = int(np.argmax(found))
    first, second = (i for i in range(3) if i != last)
    if (excess := float(found[last] - found[first] - found[second])) > 0.0:
        found[first] += excess / 3.0
        found[second] += excess / 3.0
        found[last] = (found[last] - excess / 3.0) * (1.0 - 2.0 * ROUNDING)
    return found
