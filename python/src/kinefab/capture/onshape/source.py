"""Onshape's saved answers as a source: ``definition.json`` and what lies beside it, by the road of ``kinefab capture onshape``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...diagnostics import KinefabError, Report
from ...model import Body, Mesh, Scene
from ...sources.bundle.reader import scene_from_values
from ...sources.reading.file import read_bytes
from ...sources.reading.json_text import parse_json, top_keys
from ...sources.reading.placement import MIRROR
from ...sources.reading.request import Request
from ...sources.reading.source_frame import DIRECTIONS, FORWARD, turn_to_scene
from ...spatial import Array
from ..draft import BodyMesh
from ..run import drafted
from .answers import opened

MIRRORED = " (mirrored)"
"""What the bundle's reader puts behind the definition of a mirrored part."""


def sniff(head: bytes) -> bool:
    """Whether a JSON begins as an assembly definition."""
    keys = top_keys(head)
    return keys.get("rootAssembly") == "{" or keys.get("subAssemblies") == "[" or "partStudioFeatures" in keys


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of an assembly definition.  request: ``up``.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    parse_json(data, path.name, report)
    up = request.text("up", "Z")
    try:
        draft = drafted("onshape", opened(str(path), {}, report), report, up)
    except RecursionError:
        raise KinefabError([report.add("CAPTURE_RECORD", path.name, detail="it refers to itself")]) from None
    values = draft.values()
    materials: dict[str, str | None] = {
        c["definition"]: c["bodies"][0].get("material") for c in draft.components if c.get("bodies")
    }
    values["components"] = [{k: v for k, v in c.items() if k != "bodies"} for c in draft.components]
    scene = scene_from_values(values, path, data, report)
    _add_meshes(scene, draft.meshes, materials, up)
    return scene


def _add_meshes(
    scene: Scene, meshes: dict[str, list[BodyMesh]], materials: dict[str, str | None], up: str
) -> None:
    """Give each part the meshes of its definition, turned as the part's own axes are; Onshape's unit is the metre.
    materials: of what has one look, by definition."""
    turn = turn_to_scene(DIRECTIONS[up], DIRECTIONS[FORWARD[up]])
    surfaces = {surface.name: index for index, surface in enumerate(scene.surfaces)}
    made: dict[str, tuple[Body, ...]] = {}
    for index, node in enumerate(scene.nodes):
        name = node.definition or ""
        plain = name.removesuffix(MIRRORED)
        if plain not in meshes:
            continue
        if name not in made:
            local = turn @ MIRROR if name != plain else turn
            made[name] = tuple(
                _body(scene, mesh, materials.get(plain), surfaces, local) for mesh in meshes[plain]
            )
        scene.nodes[index] = replace(node, bodies=made[name])


def _body(scene: Scene, mesh: BodyMesh, material: str | None, surfaces: dict[str, int], local: Array) -> Body:
    """local: orthogonal, (3, 3)."""
    corners = np.reshape(mesh.points, (-1, 3)) @ local.T
    if mesh.normals is not None:
        corners = np.hstack([corners, np.reshape(mesh.normals, (-1, 3)) @ local.T])
    corners, back = np.unique(corners, axis=0, return_inverse=True)
    faces = np.reshape(back, -1)[np.reshape(mesh.triangles, (-1, 3))].astype(np.int64)
    if np.linalg.det(local) < 0.0:
        faces = faces[:, ::-1]
    normals = None if mesh.normals is None else corners[:, 3:]
    runs = mesh.runs or ([] if material is None else [(len(faces), material)])
    counts = tuple(count for count, _ in runs) or (len(faces),)
    scene.meshes.append(Mesh(mesh.name, corners[:, :3], faces, normals, face_counts=counts))
    return Body(mesh.name, len(scene.meshes) - 1, tuple(surfaces[name] for _, name in runs))
