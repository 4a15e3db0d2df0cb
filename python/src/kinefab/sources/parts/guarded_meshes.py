"""Mesh files that a native library reads in a process of its own: 3DS, FBX, X3D and 3MF by assimp, VRML by OpenCASCADE."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ...diagnostics import Report
from ...geometry.files import noted
from ...geometry.pieces import MeshFile, Piece, placed
from ...geometry.references import (
    UnsafeReference,
    demand_honest_archive,
    heads_of_3mf,
    metres_of_3mf,
    read_regular,
)
from ...model import MeshKey, Surface
from ...spatial import Array, IntArray
from ..guard import GuardedCrash, GuardedError, guarded

PACKAGE = __name__.rpartition(".parts")[0]
SECONDS, SECONDS_PER_MEGABYTE = 20.0, 4.0
MOST_BYTES = 512 * 2**20
METRES = {".fbx": 1.0}
"""Of formats whose unit stands in the file, and is brought into metres."""
INCLUDES = re.compile(rb"\b(?:Inline|EXTERNPROTO|ExternProtoDeclare)\b")
"""What has a VRML or X3D file read others."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What the process sends back of one placed mesh, in the file's axes and unit.

    vertices (n, 3), triangles (m, 3), matrix (3, 4) into the file's frame, color linear RGBA or None.
    """

    name: str
    vertices: Array
    triangles: IntArray
    matrix: Array
    material: str = ""
    color: tuple[float, float, float, float] | None = None


def read_guarded(path: Path, report: Report, where: str) -> MeshFile | None:
    """The file's pieces, or None with an error in the report.  where: the place that names the file."""
    suffix = path.suffix.lower()
    module = "step.vrml" if suffix in (".wrl", ".vrml") else "parts.with_assimp"
    try:
        _check(path, suffix)
        metres = metres_of_3mf(heads_of_3mf(path)) if suffix == ".3mf" else METRES.get(suffix)
        seconds = SECONDS + SECONDS_PER_MEGABYTE * path.stat().st_size / 2**20
        file = str(path.absolute())  # the process may have been begun in another folder
        found: list[Found] = [
            Found(*entry) for entry in guarded(f"{PACKAGE}.{module}", "meshes", file, seconds=seconds)
        ]
    except (GuardedError, GuardedCrash, OSError, ValueError) as error:
        detail = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        report.add("GEOMETRY_UNREADABLE", where, path=path.name, detail=" ".join(detail.split())[:200])
        return None
    file = _file(path, [entry for entry in found if len(entry.triangles)])
    if not file.pieces:
        report.add("GEOMETRY_EMPTY", where, path=path.name)
        return None
    file.metres = metres
    return file


def _check(path: Path, suffix: str) -> None:
    """Raises OSError for what is not to be opened."""
    if suffix == ".3mf":
        demand_honest_archive(path)
    content = read_regular(path, MOST_BYTES)
    if suffix in (".wrl", ".vrml", ".x3d") and INCLUDES.search(content):
        raise UnsafeReference("it includes other files (Inline, EXTERNPROTO), which are not followed")


def _file(path: Path, found: list[Found]) -> MeshFile:
    pieces: list[Piece] = []
    surfaces: dict[str, Surface] = {}
    names: dict[str, list[tuple[int, ...]]] = {}
    for number, entry in enumerate(found):
        looks: tuple[str, ...] = ()
        if entry.color is not None:
            looks = (noted(Surface(entry.material or "Default", entry.color), surfaces),)
        faces = np.asarray(entry.triangles, dtype=np.int64)
        piece = Piece(np.asarray(entry.vertices, dtype=np.float64), faces, None, None, (len(faces),), looks)
        pieces.append(placed(piece, entry.matrix[:, :3], entry.matrix[:, 3]))
        names.setdefault(entry.name, []).append((number,))
    return MeshFile(path, pieces, {MeshKey.OBJECT: names, MeshKey.GROUP: names}, surfaces)
