"""Meshes for the page: positions in 16 bits of their box, thinned out where there are too many triangles."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from ...spatial import Array
from ...unity import frames
from ..seen import mesh_triangles
from .blob import Blob

MOST_TRIANGLES = 2_000_000
"""Triangles that a page carries; of larger scenes all meshes are thinned alike."""
STEPS = 65535

Entry = Mapping[str, Any]


def packed_meshes(
    document: Entry, buffers: Sequence[bytes], used: Iterable[int], blob: Blob
) -> tuple[list[Entry | None], tuple[int, int]]:
    """The used meshes of a scene (None: not used), and their triangles (in the scene, in the page); right-handed.

    Of each: ``p`` (16-bit positions) in the box from ``low`` over ``span``, ``i`` (indices), ``groups`` (start, count).
    """
    meshes: Sequence[Entry] = document.get("meshes", ())
    wanted = sorted(set(used))
    total = sum(sum(s["indexCount"] for s in meshes[i]["submeshes"]) // 3 for i in wanted)
    share = min(1.0, MOST_TRIANGLES / max(total, 1))
    found: list[Entry | None] = [None] * len(meshes)
    kept = 0
    for i in wanted:
        corners, faces = mesh_triangles(meshes[i], buffers)
        counts = [s["indexCount"] // 3 for s in meshes[i]["submeshes"]]
        starts = [s["indexStart"] // 3 for s in meshes[i]["submeshes"]]
        pieces = [frames.winding(faces[s : s + n]) for s, n in zip(starts, counts)]
        right: Array = frames.point(corners)
        entry, count = _packed(right, pieces, share, blob)
        found[i], kept = entry, kept + count
    return found, (total, kept)


def _packed(corners: Array, pieces: list[np.ndarray], share: float, blob: Blob) -> tuple[Entry, int]:
    low, high = (corners.min(axis=0), corners.max(axis=0)) if len(corners) else (np.zeros(3), np.zeros(3))
    span = np.maximum(high - low, 1e-12)
    steps = STEPS
    if share < 1.0:  # cells so large that about this share of the triangles is left
        steps = max(int(np.sqrt(share * sum(map(len, pieces)) / 4.0)), 8)
    whole = np.round((corners - low) / span * steps)
    place = np.round(whole * (STEPS / steps)).astype(np.uint16)
    if share < 1.0:
        place, number = np.unique(place, axis=0, return_inverse=True)
        pieces = [_whole(number.reshape(-1)[faces]) for faces in pieces]
    sizes = [len(faces) for faces in pieces]
    starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]) if sizes else np.zeros(0)
    entry = {
        "p": blob.add(place, "u2"),
        "i": blob.add(np.concatenate(pieces) if pieces else [], "u2" if len(place) <= STEPS else "u4"),
        "low": low.tolist(),
        "span": span.tolist(),
        "groups": [[3 * int(s), 3 * n] for s, n in zip(starts, sizes)],
    }
    return entry, sum(sizes)


def _whole(faces: np.ndarray) -> np.ndarray:
    """Triangles that still have three corners, each once."""
    distinct = (faces[:, 0] != faces[:, 1]) & (faces[:, 1] != faces[:, 2]) & (faces[:, 2] != faces[:, 0])
    faces = faces[distinct]
    first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)[1]
    return faces[np.sort(first)]
