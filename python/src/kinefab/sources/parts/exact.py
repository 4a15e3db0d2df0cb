"""A STEP or IGES file as the geometry of one part: every solid in it where it stands, in metres."""

from __future__ import annotations

from pathlib import Path

from ...diagnostics import KinefabError, Report, Severity
from ...geometry.files import noted
from ...geometry.pieces import MeshFile, Piece, placed
from ...model import MeshKey, Scene, Surface
from ..reading.request import Request

AS_IT_STANDS = {"up": "Y"}
"""The scene's own up axis: the file's axes stay."""


def read_exact(path: Path, report: Report, where: str) -> MeshFile | None:
    """The file's pieces, named by their solids and parts, or None with an error in the report.

    The joints that an AP242 file may state are not asked for: it is one part here.
    """
    from ..step.reader import read  # the lightest part of a scene of meshes would wait for all of STEP

    own = Report()
    try:
        scene = read(path, own, Request(AS_IT_STANDS))
    except KinefabError:
        first = own.of(Severity.ERROR)[0]
        report.add("GEOMETRY_UNREADABLE", where, path=path.name, detail=first.message.rstrip("."))
        return None
    report.extend(own)
    return _file(path, scene)


def _file(path: Path, scene: Scene) -> MeshFile:
    pieces: list[Piece] = []
    surfaces: dict[str, Surface] = {}
    names: dict[str, list[tuple[int, ...]]] = {}
    for node in scene.nodes:
        first = len(pieces)
        for body in node.bodies:
            if body.mesh is None:
                continue
            mesh = scene.meshes[body.mesh]
            looks = tuple(noted(scene.surfaces[index], surfaces) for index in body.surfaces)
            piece = Piece(mesh.vertices, mesh.faces, mesh.normals, None, mesh.face_counts, looks)
            names.setdefault(body.name, []).append((len(pieces),))
            pieces.append(placed(piece, node.pose.rotation, node.pose.translation))
        if len(pieces) > first:
            names.setdefault(node.name, [tuple(range(first, len(pieces)))])
    return MeshFile(path, pieces, {MeshKey.OBJECT: names, MeshKey.GROUP: names}, surfaces, metres=1.0)
