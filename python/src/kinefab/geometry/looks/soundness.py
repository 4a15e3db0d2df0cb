"""Meshes that no target could write are left out, and what is drawn of the others by numbers that are none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...diagnostics import Report
from ...model import Mesh, Node, Scene
from ...spatial import Array
from ..loading import FARTHEST

UNIT = 1e-3
"""By which the length of a tangent may differ from 1."""


def with_sound_meshes(scene: Scene, report: Report) -> Scene:
    """The scene with what its meshes can be drawn by; itself where nothing is wrong.

    Vertices that are no numbers are errors.  A mesh without triangles, or of which one names a vertex that is not there, is left
    out of the bodies and colliders that name it; normals, texture coordinates, tangents and colours are, where they do not fit
    the vertices or hold what is no number.  The report tells each.  Colours are clipped to 0..1 and vertices that no triangle
    names left out, which is not told.
    """
    found = [_without_loose(_sound(mesh, report)) for mesh in scene.meshes]
    if all(new is old for new, old in zip(found, scene.meshes)):
        return scene
    kept = [i for i, mesh in enumerate(found) if mesh is not None]
    number: dict[int | None, int] = {old: new for new, old in enumerate(kept)}
    meshes = [mesh for mesh in found if mesh is not None]
    return replace(scene, nodes=[_numbered(node, number) for node in scene.nodes], meshes=meshes)


def _sound(mesh: Mesh, report: Report) -> Mesh | None:
    """The mesh itself where it is sound, None where it is of no use."""
    detail = _of_no_use(mesh)
    if detail:
        report.dropped(f"mesh {mesh.name}", "MESH_UNSOUND", what=f"mesh {mesh.name}", detail=detail)
        return None
    if not (np.abs(mesh.vertices) <= FARTHEST).all():
        report.add("GEOMETRY_NOT_FINITE", body=mesh.name)
        return None
    normals = mesh.normals if _fits(mesh.normals, mesh, 3) else None
    found: Mapping[str, object] = {
        "normals": normals,
        "uvs": mesh.uvs if all(_fits(uv, mesh, 2) for uv in mesh.uvs) else (),
        "tangents": mesh.tangents if normals is not None and _are_tangents(mesh) else None,
        "colors": mesh.colors if _fits(mesh.colors, mesh, 4) else None,
    }
    lost = [name for name, value in found.items() if value is not getattr(mesh, name)]
    for name in lost:
        feature = f"{name} of mesh {mesh.name}"
        detail = "they do not fit its vertices, or one is no number"
        report.dropped(feature, "MESH_UNSOUND", what=feature, detail=detail)
    if mesh.colors is not None and "colors" not in lost and not _in_range(mesh.colors):
        found = {**found, "colors": np.clip(mesh.colors, 0.0, 1.0)}
        lost.append("colors")
    return replace(mesh, **found) if lost else mesh  # type: ignore[arg-type]


def _without_loose(mesh: Mesh | None) -> Mesh | None:
    """With the vertices that its triangles name alone: files whose parts share one list of vertices give each part all of
    them, and whoever cuts triangles away leaves theirs.  Its hull and box would go round them."""
    if mesh is None:
        return None
    used = np.zeros(len(mesh.vertices), dtype=bool)
    used[mesh.faces] = True
    if used.all():
        return mesh
    lists = {
        n: None if (of := getattr(mesh, n)) is None else of[used] for n in ("normals", "tangents", "colors")
    }
    uvs, faces = tuple(uv[used] for uv in mesh.uvs), (np.cumsum(used) - 1)[mesh.faces]
    return replace(mesh, vertices=mesh.vertices[used], faces=faces, uvs=uvs, **lists)


def _of_no_use(mesh: Mesh) -> str:
    if not len(mesh.faces):
        return "it has no triangles"
    if mesh.faces.min() < 0 or mesh.faces.max() >= len(mesh.vertices):
        return "a triangle names a vertex that is not there"
    return ""


def _fits(values: Array | None, mesh: Mesh, width: int) -> bool:
    if values is None:
        return True
    return values.shape == (len(mesh.vertices), width) and bool(np.isfinite(values).all())


def _in_range(colors: Array) -> bool:
    return bool(colors.min() >= 0.0 and colors.max() <= 1.0)


def _are_tangents(mesh: Mesh) -> bool:
    if mesh.tangents is None or not _fits(mesh.tangents, mesh, 4):
        return mesh.tangents is None
    lengths = np.linalg.norm(mesh.tangents[:, :3], axis=1)
    return bool((np.abs(lengths - 1.0) <= UNIT).all() and (np.abs(mesh.tangents[:, 3]) == 1.0).all())


def _numbered(node: Node, number: Mapping[int | None, int]) -> Node:
    """number: of each mesh that is kept; bodies lose the others, and colliders go with them."""
    bodies = tuple(replace(body, mesh=number.get(body.mesh)) for body in node.bodies)
    colliders = node.colliders and tuple(
        c if c.mesh is None else replace(c, mesh=number[c.mesh])
        for c in node.colliders
        if c.mesh is None or c.mesh in number
    )
    return replace(node, bodies=bodies, colliders=colliders)
