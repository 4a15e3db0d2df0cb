"""Meshes: their submeshes, and the numbers in their buffers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from ..definitions import UV_SETS
from .buffers import check_place
from .findings import Entry, Findings

FLOATS = {"positions": 3, "normals": 3, **dict.fromkeys(UV_SETS, 2), "tangents": 4, "colors": 4}
"""Numbers for each vertex."""
INDICES: Mapping[str, type[np.unsignedinteger]] = {"uint16": np.uint16, "uint32": np.uint32}


def check_mesh(
    mesh: Entry, at: str, buffers: list[Entry], contents: Sequence[bytes | None], found: Findings
) -> None:
    """contents: of each buffer, None where it is not sound."""
    for axis, extent in enumerate(mesh["bounds"]["extents"]):
        if extent < 0:
            found.add("NUMBER_OUT_OF_RANGE", f"{at}/bounds/extents/{axis}", value=extent, range="0 or above")
    _check_submeshes(mesh["submeshes"], at, found)
    there = {
        name: check_place(mesh[name], 4 * width * max(0, mesh["vertexCount"]), buffers, f"{at}/{name}", found)
        for name, width in FLOATS.items()
        if name in mesh
    }
    length = _index_count(mesh) * _index_type(mesh).itemsize
    there["indices"] = check_place(mesh["indices"], length, buffers, f"{at}/indices", found)
    if there["positions"] and (content := contents[mesh["positions"]["buffer"]]) is not None:
        _check_positions(mesh, content, at, found)
    if there["indices"] and (content := contents[mesh["indices"]["buffer"]]) is not None:
        _check_indices(mesh, content, at, found)


def _check_submeshes(submeshes: Sequence[Entry], at: str, found: Findings) -> None:
    """Each holds whole triangles and starts where the one before ends."""
    following = 0
    for index, submesh in enumerate(submeshes):
        start, count = submesh["indexStart"], submesh["indexCount"]
        if count < 0 or count % 3:
            found.add("SUBMESH_NOT_TRIANGLES", f"{at}/submeshes/{index}/indexCount", count=count)
        elif start != following:
            found.add("SUBMESH_GAP", f"{at}/submeshes/{index}/indexStart", start=start, expected=following)
        following = start + count


def _check_positions(mesh: Entry, content: bytes, at: str, found: Findings) -> None:
    positions = np.frombuffer(content, "<f4", 3 * max(0, mesh["vertexCount"]), mesh["positions"]["offset"])
    finite = np.isfinite(positions)
    if not finite.all():
        found.add("MESH_POSITION_NOT_FINITE", f"{at}/positions", vertex=int(np.argmin(finite)) // 3)


def _check_indices(mesh: Entry, content: bytes, at: str, found: Findings) -> None:
    """Each names a vertex."""
    count = mesh["vertexCount"]
    indices = np.frombuffer(content, _index_type(mesh), _index_count(mesh), mesh["indices"]["offset"])
    largest = int(indices.max(initial=0))
    if largest >= count:
        found.add("MESH_INDEX_RANGE", f"{at}/indices", index=largest, count=count)


def _index_type(mesh: Entry) -> np.dtype[np.unsignedinteger]:
    return np.dtype(INDICES[mesh["indexFormat"]]).newbyteorder("<")


def _index_count(mesh: Entry) -> int:
    return sum(max(0, submesh["indexCount"]) for submesh in mesh["submeshes"])
