"""Gives every part that has geometry and no mass of its own the mass of that geometry."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from ..diagnostics import Report
from ..model import Body, MassProperties, Mesh, Node, Scene
from ..spatial import Array, bounds
from .closure import is_skin
from .hulls import hull_of_points
from .mass import (
    are_possible,
    ball_inertia,
    combined,
    is_possible,
    moved,
    principal_moments,
    solid_properties,
    stretched,
)

LEAST = 1.1754944e-38
"""Least normal number of a 32-bit float: a mass or moment below it would be written and read as nothing."""
MOST = 3.4028234e38
"""The largest."""
THIN = 1e-9
"""A volume below this share of the cube of the mesh's size is none."""

_Kind = tuple[object, ...]
"""What tells parts of different mass apart."""


def weigh(scene: Scene, density: float, report: Report) -> Scene:
    """The scene with ``Node.mass`` filled in from meshes, whose volumes are noted; given masses are checked and kept.

    density: kg/m^3 of bodies that state none.
    """
    unit: dict[int, MassProperties | None] = {}  # of each mesh at density 1, so that copies are weighed once
    nodes = list(scene.nodes)
    meshes = list(scene.meshes)
    alike: dict[_Kind, tuple[MassProperties, bool]] = {}  # of copies together, and whether no file holds it
    sound = _sound(nodes)
    assumed: list[Node] = []
    for i, node in enumerate(nodes):
        if node.mass is not None:
            if i not in sound:
                _check_given(node, node.mass, report)
            continue
        solids: list[Body] = []
        for body in node.bodies:
            if body.mesh is None or not body.weighed:
                continue
            if body.mesh not in unit:
                label, mesh = f"{node.id}/{body.name}", meshes[body.mesh]
                unit[body.mesh], meshes[body.mesh] = _turned_out(mesh, label, node.where, report)
            if unit[body.mesh] is not None:
                solids.append(body)
        if not solids and node.kilograms is not None:
            nodes[i] = replace(node, mass=_ball(node, node.kilograms, report))
        if solids:
            if node.kilograms is None and not node.grounded and any(body.density is None for body in solids):
                assumed.append(node)
            kind = (node.kilograms, *map(_told_apart, solids))
            if kind not in alike:
                mass = combined([_placed(body, unit, density) for body in solids])
                if node.kilograms is not None:
                    share = node.kilograms / mass.mass
                    mass = MassProperties(node.kilograms, mass.center, mass.inertia * share)
                alike[kind] = mass, _unsayable(mass)
            mass, unsayable = alike[kind]
            nodes[i] = replace(node, mass=mass)
            if unsayable:
                _tell_size(node, mass, report)
    if assumed:
        first = assumed[0]
        report.add("DENSITY_ASSUMED", first.where, node=first.id, count=len(assumed), density=f"{density:g}")
    return replace(scene, nodes=nodes, meshes=meshes)


def _turned_out(mesh: Mesh, label: str, where: str, report: Report) -> tuple[MassProperties | None, Mesh]:
    """A mesh at density 1, and the mesh: its outside outward, its volume noted where it is closed."""
    found, closed = _unit_properties(mesh, label, where, report)
    if found is None:
        return None, mesh
    if found.mass < 0.0:
        report.add("MESH_INSIDE_OUT", where, body=label)
        mesh = _inside_out(mesh)
        found = MassProperties(-found.mass, found.center, -found.inertia)
    return found, replace(mesh, volume=found.mass) if closed else mesh


def _ball(node: Node, kilograms: float, report: Report) -> MassProperties:
    """Of a part whose weight is known and that has no volume: at its origin."""
    mass = MassProperties(kilograms, np.zeros(3), ball_inertia(kilograms))
    if not node.grounded:
        detail = {"node": node.id, "mass": f"{kilograms:g}"}
        report.approximated(f"inertia {node.id}", "INERTIA_ASSUMED", node.where, **detail)
    if _unsayable(mass):
        _tell_size(node, mass, report)
    return mass


def _told_apart(body: Body) -> _Kind:
    """What the mass of a body depends on."""
    pose = body.pose
    return body.mesh, body.density, body.scale, pose.rotation.tobytes(), pose.translation.tobytes()


def _placed(body: Body, unit: Mapping[int, MassProperties | None], density: float) -> MassProperties:
    """Of a body in its node's frame.  unit: of its mesh at density 1, which is there.  density: where it states none."""
    found = None if body.mesh is None else unit[body.mesh]
    assert found is not None
    factor = density if body.density is None else body.density
    shape = moved(stretched(found, body.scale), body.pose)
    return MassProperties(shape.mass * factor, shape.center, shape.inertia * factor)


def _unit_properties(mesh: Mesh, body: str, where: str, report: Report) -> tuple[MassProperties | None, bool]:
    """Of one mesh at density 1, None where it has no volume; and whether it is closed.  Of an open one, and of one whose
    shells are wound against each other so that no body could turn as they say, those of its convex hull."""
    low, high = bounds(mesh.vertices)
    size = float((high - low).max())
    flat = False
    if is_skin(mesh.vertices, mesh.faces):
        found = solid_properties(mesh.vertices, mesh.faces, 1.0)
        flat = abs(found.mass) <= THIN * size**3
        if not flat and is_possible(np.copysign(1.0, found.mass) * found.inertia):
            return found, True
    if not flat and (hull := hull_of_points(mesh.vertices)) is not None:
        report.add("MESH_OPEN", where, body=body)
        return solid_properties(*hull, 1.0), False
    report.add("MESH_WITHOUT_VOLUME", where, body=body)
    return None, False


def _inside_out(mesh: Mesh) -> Mesh:
    normals = None if mesh.normals is None else -mesh.normals
    return replace(mesh, faces=mesh.faces[:, ::-1], normals=normals)


def _sound(nodes: Sequence[Node]) -> frozenset[int]:
    """Numbers of nodes with a mass of their own that is plainly a body's: nearly all that have one, seen in one stack."""
    given = [(i, node.mass) for i, node in enumerate(nodes) if node.mass is not None]
    masses = np.array([mass.mass for _, mass in given])
    centers = np.array([mass.center for _, mass in given]).reshape(-1, 3)
    inertias = np.array([mass.inertia for _, mass in given]).reshape(-1, 3, 3)
    sound = np.isfinite(centers).all(axis=1) & np.isfinite(inertias).all(axis=(1, 2))
    sound &= (masses > 2.0 * LEAST) & (masses < MOST)
    moments = principal_moments(np.where(sound[:, None, None], inertias, np.eye(3)))
    sound &= are_possible(moments) & (moments[:, 0] > 2.0 * LEAST) & (moments[:, -1] < MOST)
    return frozenset(i for (i, _), good in zip(given, sound.tolist()) if good)


def _check_given(node: Node, given: MassProperties, report: Report) -> None:
    numbers: Iterable[Array] = (np.asarray(given.mass), given.center, given.inertia)
    if not all(np.isfinite(n).all() for n in numbers) or not given.mass > 0.0:
        report.add("MASS_IMPOSSIBLE", node.where, node=node.id, detail=f"the mass is {given.mass:g} kg")
    elif not is_possible(given.inertia):
        detail = "a principal moment is not positive, or above the sum of the other two"
        report.add("MASS_IMPOSSIBLE", node.where, node=node.id, detail=detail)
    elif _unsayable(given):
        _tell_size(node, given, report)


def _unsayable(mass: MassProperties) -> bool:
    """Whether it, or a moment of it, would be written and read as nothing or as no number."""
    moments = np.linalg.eigvalsh(mass.inertia)
    return not LEAST <= mass.mass <= MOST or 0.0 < float(moments[0]) < LEAST or float(moments[-1]) > MOST


def _tell_size(node: Node, mass: MassProperties, report: Report) -> None:
    detail = f"{mass.mass:g} kg, or a moment of it, is nothing or beyond all numbers in Unity's 32-bit floats"
    report.add("MASS_IMPOSSIBLE", node.where, node=node.id, detail=detail)
