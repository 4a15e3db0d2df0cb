"""Masses of bodies and colliders, as ``UsdPhysics.RigidBodyAPI.ComputeMassProperties`` adds it up.

Precedence: mass before density; a collider's own before the body's, before its material's, before 1000 kg/m^3.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....geometry.closure import is_skin
from ....geometry.hulls import hull_of_points
from ....geometry.mass import combined, moved, shape_properties, solid_properties
from ....model import Collider, ColliderKind, MassProperties, Mesh
from ....spatial import Array, Pose, rotation_about
from ..looks.gprims import axis_turn
from ..transforms import Stand, rotation_of
from ..values import Values, identity
from .stated import MassApis, Stated

WATER = 1000.0
"""kg/m^3 of what states nothing."""
ROUNDING = 1e-7
"""Share of an inertia that is none: pxr reckons in 32 bits."""
POINT = 0.1
"""Metres: radius of the sphere whose inertia a body without colliders has."""


@dataclass(frozen=True, slots=True, eq=False)
class Weighed:
    """A collider with the prim that it comes from.  world: the prim's matrix.  density: of its physics material, stage
    units, 0 for none.  solid: what its volume is that of: an approximation of a mesh, or a type of round prim."""

    collider: Collider
    prim: Any
    world: Array
    density: float
    solid: str


def body_mass(
    prim: Any,
    world: Array,
    stand: Stand,
    solids: Sequence[Weighed],
    meshes: Sequence[Mesh],
    apis: MassApis,
    values: Values,
) -> MassProperties:
    """Mass of a body, kg; centre and inertia in its node's frame."""
    stated = apis.of(prim, world, stand)
    if stated.whole is not None:
        return stated.whole
    counted = [s for s in solids if s.collider.enabled]
    parts = [_solid(s, stated.density, stand, meshes, apis, values) for s in counted]
    parts = [p for p in parts if p is not None and p.mass > 0.0]
    if not parts:
        return _without_solids(prim, stated, values)
    total = combined(parts)
    mass, inertia, center = total.mass, total.inertia, total.center
    if stated.mass is not None:
        mass, inertia = stated.mass, inertia * (stated.mass / total.mass)
    if stated.center is not None:
        inertia = inertia + _steiner(mass, stated.center - center)
        center = stated.center
    turn = values.opened.frame.turn  # moments are stated along the stage's axes
    moments, axes = _diagonal(turn.T @ inertia @ turn)
    axes = turn @ axes
    moments = moments if stated.moments is None else stated.moments
    axes = axes if stated.axes is None else stated.axes
    return MassProperties(mass, center, axes @ np.diag(moments) @ axes.T)


def _diagonal(inertia: Array) -> tuple[Array, Array]:
    """Principal moments and axes (columns) in the order that pxr has them, as PhysX's PxDiagonalize finds them: moments
    that are stated without axes are along these."""
    axes = np.eye(3)
    for _ in range(24):
        turned = axes.T @ inertia @ axes
        off = np.abs([turned[1, 2], turned[0, 2], turned[0, 1]])
        axis = 0 if off[0] > off[1] and off[0] > off[2] else 1 if off[1] > off[2] else 2
        i, j = (axis + 1) % 3, (axis + 2) % 3
        if off[axis] <= ROUNDING * np.trace(turned):
            break
        cotangent = (turned[i, i] - turned[j, j]) / (2.0 * turned[i, j])  # of twice the angle
        tangent = math.copysign(1.0 / (abs(cotangent) + math.hypot(cotangent, 1.0)), cotangent)
        axes = axes @ rotation_about(np.eye(3)[axis], math.atan(tangent))
    return np.diag(axes.T @ inertia @ axes), axes


def _without_solids(prim: Any, stated: Stated, values: Values) -> MassProperties:
    opened = values.opened
    mass = opened.frame.mass if stated.mass is None else stated.mass
    if stated.mass is None or stated.moments is None:
        what = "mass and inertia" if stated.mass is None else "inertia"
        values.report.approximated(
            f"mass {identity(prim)}", "USD_MASS_ASSUMED", opened.place(prim),
            node=identity(prim), what=what, mass=f"{mass:g}", radius=f"{POINT:g}",
        )  # fmt: skip
    moments = np.full(3, 0.4 * mass * POINT**2) if stated.moments is None else stated.moments
    axes = opened.frame.turn if stated.axes is None else stated.axes
    center = np.zeros(3) if stated.center is None else stated.center
    return MassProperties(mass, center, axes @ np.diag(moments) @ axes.T)


def _solid(
    solid: Weighed,
    body_density: float | None,
    stand: Stand,
    meshes: Sequence[Mesh],
    apis: MassApis,
    values: Values,
) -> MassProperties | None:
    """Of one collider in the node's frame; None where it has no volume."""
    if solid.solid in ROUND:
        unit = round_solid(solid, values)
    else:
        unit = unit_solid(solid.collider, meshes, solid.solid)
    if unit is None:
        return None
    frame = values.opened.frame
    stated = apis.of(solid.prim, solid.world)
    material = solid.density * frame.mass / frame.length**3
    density = stated.density or body_density or material or WATER
    if stated.mass is not None:
        mass, inertia = stated.mass, unit.inertia * (stated.mass / unit.mass)
    else:
        mass, inertia = unit.mass * density, unit.inertia * density
    # Of the prim: its shape may be turned, or stand elsewhere.
    own = Pose(stand.axes(rotation_of(solid.world[:3, :3]) @ frame.turn.T), stand.point(solid.world[:3, 3]))
    if stated.moments is not None:
        axes = np.eye(3) if stated.axes is None else frame.turn.T @ stated.axes
        turned = own.rotation @ (frame.turn @ axes)
        inertia = turned @ np.diag(stated.moments) @ turned.T
        at = own.point(stated.center) if stated.center is not None else solid.collider.pose.point(unit.center)
        return MassProperties(mass, at, inertia)
    placed = moved(MassProperties(mass, unit.center, inertia), solid.collider.pose)
    if stated.center is None:
        return placed
    at = own.point(stated.center)
    return MassProperties(mass, at, placed.inertia + _steiner(mass, at - placed.center))


def unit_solid(collider: Collider, meshes: Sequence[Mesh], approximation: str) -> MassProperties | None:
    """Volume (as mass), centre and inertia at density 1 of a collider in its own frame; None where it is flat."""
    if collider.kind is ColliderKind.BOX:
        size = collider.size
    elif collider.kind is ColliderKind.SPHERE:
        size = (collider.radius,)
    elif collider.kind in (ColliderKind.CAPSULE, ColliderKind.CYLINDER):
        size = (collider.radius, collider.length)
    else:
        return _mesh_solid(collider, meshes, approximation)
    found = shape_properties(collider.kind.value, size)
    return found if found.mass > 0.0 else None


def _mesh_solid(collider: Collider, meshes: Sequence[Mesh], approximation: str) -> MassProperties | None:
    """Of the mesh itself where it is closed and stands for itself, else of its hull."""
    assert collider.mesh is not None, "hulls and meshes name their mesh"
    mesh = meshes[collider.mesh]
    vertices = mesh.vertices * np.array(collider.scale)
    if approximation not in ("convexHull", "") and is_skin(vertices, mesh.faces):
        found = solid_properties(vertices, mesh.faces, 1.0)
        if found.mass < 0.0:
            found = MassProperties(-found.mass, found.center, -found.inertia)
        if found.mass > 0.0:
            return found
    hull = hull_of_points(vertices)
    return None if hull is None else solid_properties(*hull, 1.0)


ROUND = frozenset(("Cone", "Cylinder_1", "Capsule_1"))
"""Bodies of revolution that no collider of the model is: a hull stands for them, their mass is exact."""
NODES, WEIGHTS = np.polynomial.legendre.leggauss(4)
"""Exact for the polynomials up to the seventh degree that a cone or a ball gives."""


def round_solid(solid: Weighed, values: Values) -> MassProperties | None:
    """As ``unit_solid`` for a prim of ROUND: moments of its discs, stretched by the collider's scale."""
    prim, kind, frame = solid.prim, solid.solid, values.opened.frame
    size = {
        name: abs(values.number(prim, name, default)) * frame.length
        for name, default in (("radius", 1.0), ("radiusBottom", 0.5), ("radiusTop", 0.5), ("height", 2.0))
    }
    bottom, top = (size["radius"], 0.0) if kind == "Cone" else (size["radiusBottom"], size["radiusTop"])
    half = 0.5 * size["height"]
    pieces: list[tuple[float, float, Callable[[Array], Array]]] = [
        (-half, half, lambda z: (bottom + (top - bottom) * (z + half) / (2.0 * half or 1.0)) ** 2)
    ]
    if kind == "Capsule_1":
        pieces.append((-half - bottom, -half, lambda z: bottom**2 - (z + half) ** 2))
        pieces.append((half, half + top, lambda z: top**2 - (z - half) ** 2))
    volume, first, across, along = 0.0, 0.0, 0.0, 0.0
    for low, high, square in pieces:
        z, w = 0.5 * (high + low) + 0.5 * (high - low) * NODES, 0.5 * (high - low) * WEIGHTS
        area = np.pi * square(z)
        volume += float(w @ area)
        first += float(w @ (area * z))
        across += float(w @ (area * square(z))) / 4.0
        along += float(w @ (area * z * z))
    if not volume > 0.0:
        return None
    turned = frame.turn @ axis_turn(values.word(prim, "axis", "Z"))
    scale = np.diag(solid.collider.scale)
    volume_scale = float(np.prod(solid.collider.scale))
    center = scale @ turned @ np.array([0.0, 0.0, first / volume])
    second = scale @ turned @ np.diag([across, across, along]) @ turned.T @ scale * volume_scale
    volume *= volume_scale
    second = second - volume * np.outer(center, center)
    return MassProperties(volume, center, np.trace(second) * np.eye(3) - second)


def _steiner(mass: float, offset: Array) -> Array:
    return mass * ((offset @ offset) * np.eye(3) - np.outer(offset, offset))
