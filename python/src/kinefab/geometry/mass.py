"""Mass, centre of mass and inertia: of a mesh, of several bodies together, and along principal axes."""

from __future__ import annotations

from functools import lru_cache
from itertools import permutations
from typing import Iterable, Sequence

import numpy as np

from ..model import MassProperties
from ..spatial import Array, Pose

DIAGONAL = 1e-9
"""Products of inertia below this share of the largest moment are noise: the axes are principal already."""


def solid_properties(vertices: Array, faces: np.ndarray, density: float) -> MassProperties:
    """Of the solid inside a closed, outward wound mesh.

    vertices: metres, shape (n, 3).  faces: shape (m, 3).  density: kg/m^3.
    The mass is negative for an inward wound mesh.  Source: Eberly, *Polyhedral Mass Properties*, by trimesh.
    """
    from trimesh.triangles import mass_properties

    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))  # moments lose digits far from the origin
    found = mass_properties((vertices - middle)[faces], density=density)
    return MassProperties(
        float(found["mass"]), np.asarray(found["center_mass"]) + middle, np.asarray(found["inertia"])
    )


def moved(properties: MassProperties, pose: Pose) -> MassProperties:
    """The same body seen from an outer frame in which its own frame stands at ``pose``."""
    r = pose.rotation
    return MassProperties(properties.mass, pose.point(properties.center), r @ properties.inertia @ r.T)


def combined(bodies: Iterable[MassProperties]) -> MassProperties:
    """Of several bodies as one (parallel axis theorem); all in one frame, at least one body."""
    parts: Sequence[MassProperties] = list(bodies)
    if len(parts) == 1:
        return parts[0]
    mass = sum(p.mass for p in parts)
    center = sum(p.mass * p.center for p in parts) / mass
    inertia = np.zeros((3, 3))
    for p in parts:
        d = p.center - center
        inertia += p.inertia + p.mass * ((d @ d) * np.eye(3) - np.outer(d, d))
    return MassProperties(float(mass), center, inertia)


def principal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments, shape (3,), and the proper rotation whose columns are their axes, shape (3, 3).

    Of the 24 ways to name and point the axes the one closest to the given frame is taken.
    """
    moments, axes = _principal(np.ascontiguousarray(inertia, dtype=np.float64).tobytes())
    return moments.copy(), axes.copy()


@lru_cache(maxsize=4096)
def _principal(inertia_bytes: bytes) -> tuple[Array, Array]:
    """As ``principal``; an assembly has few shapes and many copies of them."""
    inertia = np.frombuffer(inertia_bytes).reshape(3, 3)
    symmetric = 0.5 * (inertia + inertia.T)
    diagonal = np.diag(symmetric)
    if np.abs(symmetric - np.diag(diagonal)).max() <= DIAGONAL * np.abs(diagonal).max():
        return diagonal.copy(), np.eye(3)
    moments, axes = np.linalg.eigh(symmetric)
    order = max(permutations(range(3)), key=lambda p: sum(abs(axes[i, p[i]]) for i in range(3)))
    axes, moments = axes[:, order], moments[list(order)]
    axes = axes * np.where(np.diag(axes) < 0.0, -1.0, 1.0)
    if np.linalg.det(axes) < 0.0:
        weakest = int(np.argmin(np.abs(np.diag(axes))))
        axes[:, weakest] *= -1.0
    return moments, axes


def is_possible(inertia: Array, tolerance: float = 1e-6) -> bool:
    """Whether a body can have this inertia: moments positive, none above the sum of the other two."""
    moments = np.linalg.eigvalsh(0.5 * (inertia + inertia.T))
    return bool(moments[0] > 0.0 and moments[2] <= (moments[0] + moments[1]) * (1.0 + tolerance))
