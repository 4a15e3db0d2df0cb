"""What a mesh file holds: pieces of triangles, and the names that lead to them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from ..model import MeshKey, Surface
from ..spatial import Array, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Triangles in the file's frame and unit.

    vertices (n, 3), faces (m, 3), normals (n, 3) or None, uv (n, 2) or None,
    colors (n, 4), linear RGBA, or None.
    face_counts, surfaces: for each run of faces its length and its surface's name ("" for none).
    """

    vertices: Array
    faces: IntArray
    normals: Array | None = None
    uv: Array | None = None
    face_counts: tuple[int, ...] = ()
    surfaces: tuple[str, ...] = ()
    colors: Array | None = None


@dataclass(slots=True, eq=False)
class MeshFile:
    """A file that was read.

    named: for each kind of name, name to its occurrences in file order; an occurrence is a tuple of pieces.
    surfaces: the looks that the file or its library defines, by name.
    metres: in one unit of the file, where the file itself states it; it rules over what others say of it.
    """

    path: Path
    pieces: list[Piece]
    named: dict[MeshKey, dict[str, list[tuple[int, ...]]]] = field(
        default_factory=dict[MeshKey, dict[str, list[tuple[int, ...]]]]
    )
    surfaces: dict[str, Surface] = field(default_factory=dict[str, Surface])
    metres: float | None = None


def placed(piece: Piece, linear: Array, translation: Array) -> Piece:
    """A piece through an affine map; where that mirrors, the winding is turned too."""
    vertices = piece.vertices @ linear.T + translation
    mirrored = np.linalg.det(linear) < 0.0
    normals = piece.normals
    if normals is not None:
        normals = normals @ np.linalg.inv(linear)  # normals go by the inverse transpose
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.finfo(float).tiny)
    faces = piece.faces[:, ::-1] if mirrored else piece.faces
    return replace(piece, vertices=vertices, faces=faces, normals=normals)


def joined(pieces: list[Piece]) -> Piece:
    """Several pieces as one, with their runs of faces behind each other."""
    if len(pieces) == 1:
        return pieces[0]
    starts = np.cumsum([0, *(len(p.vertices) for p in pieces)])
    normals = [p.normals for p in pieces if p.normals is not None]
    uv = colors = None
    if any(p.uv is not None for p in pieces):  # what has none shows no texture, or the one pixel of it
        uv = np.concatenate([np.zeros((len(p.vertices), 2)) if p.uv is None else p.uv for p in pieces])
    if any(p.colors is not None for p in pieces):  # what has none is multiplied by one
        colors = np.concatenate(
            [np.ones((len(p.vertices), 4)) if p.colors is None else p.colors for p in pieces]
        )
    return Piece(
        np.concatenate([p.vertices for p in pieces]),
        np.concatenate([p.faces + start for p, start in zip(pieces, starts)]),
        np.concatenate(normals) if len(normals) == len(pieces) else None,
        uv,
        sum((p.face_counts or (len(p.faces),) for p in pieces), ()),
        sum((p.surfaces or ("",) for p in pieces), ()),
        colors,
    )


def cut(
    piece: Piece, start: int, stop: int, face_counts: tuple[int, ...], surfaces: tuple[str, ...]
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
        local = np.reshape(local, faces.shape)

    def pick(values: Array | None) -> Array | None:
        return None if values is None else values[kept]

    return Piece(
        piece.vertices[kept],
        local,
        pick(piece.normals),
        pick(piece.uv),
        face_counts,
        surfaces,
        pick(piece.colors),
    )
