"""What a mesh file holds: pieces of triangles, and the names that lead to them."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from ..model import Material, MeshKey
from ..spatial import Array


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Triangles in the file's frame and unit.

    vertices (n, 3), faces (m, 3), normals (n, 3) or None, uv (n, 2) or None.
    face_counts, materials: for each run of faces its length and its material's name ("" for none).
    """

    vertices: Array
    faces: np.ndarray
    normals: Array | None = None
    uv: Array | None = None
    face_counts: tuple[int, ...] = ()
    materials: tuple[str, ...] = ()


@dataclass(slots=True, eq=False)
class MeshFile:
    """A file that was read.

    named: for each kind of name, name to its occurrences in file order; an occurrence is a tuple of pieces.
    materials: the looks that the file or its library defines, by name.
    """

    path: Path
    pieces: list[Piece]
    named: dict[MeshKey, dict[str, list[tuple[int, ...]]]] = field(default_factory=dict)
    materials: dict[str, Material] = field(default_factory=dict)


def joined(pieces: list[Piece]) -> Piece:
    """Several pieces as one, with their runs of faces behind each other."""
    if len(pieces) == 1:
        return pieces[0]
    starts = np.cumsum([0, *(len(p.vertices) for p in pieces)])
    every = lambda name: all(getattr(p, name) is not None for p in pieces)  # noqa: E731
    return Piece(
        np.concatenate([p.vertices for p in pieces]),
        np.concatenate([p.faces + start for p, start in zip(pieces, starts)]),
        np.concatenate([p.normals for p in pieces]) if every("normals") else None,
        np.concatenate([p.uv for p in pieces]) if every("uv") else None,
        sum((p.face_counts or (len(p.faces),) for p in pieces), ()),
        sum((p.materials or ("",) for p in pieces), ()),
    )


def cut(
    piece: Piece, start: int, stop: int, face_counts: tuple[int, ...], materials: tuple[str, ...]
) -> Piece:
    """The faces start..stop of a piece with just the vertices they use."""
    faces = piece.faces[start:stop]
    low, high = int(faces.min()), int(faces.max()) + 1
    if high - low <= 8 * len(faces):  # a body's vertices mostly stand together in the file
        used = np.zeros(high - low, dtype=bool)
        used[faces - low] = True
        kept = low + np.flatnonzero(used)
        local = (np.cumsum(used) - 1)[faces - low]
    else:
        kept, local = np.unique(faces, return_inverse=True)
        local = local.reshape(faces.shape)
    pick = lambda values: None if values is None else values[kept]  # noqa: E731
    return Piece(piece.vertices[kept], local, pick(piece.normals), pick(piece.uv), face_counts, materials)
