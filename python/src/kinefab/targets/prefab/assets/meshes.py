"""Meshes as Unity's own assets: one interleaved stream of float32, hexadecimal."""

from __future__ import annotations

from binascii import hexlify
from collections.abc import Iterator
from functools import lru_cache

import numpy as np

from ....spatial import bounds
from ....unity.scene import Mesh
from ..text.documents import HEAD
from ..text.forms import BLANK, Form
from ..text.yaml import HEADER, Fields, Plain, text, vector

MESH_ID = 4300000
"""The fileID of the object in its file: the class's number and five zeros."""
VERSION = 10
"""Of editors from 2019.3 on; every later one reads it."""
UINT16_VERTICES = 65535
"""Most vertices that 16-bit indices count."""
CHANNELS = 14
"""Vertex attributes: position, normal, tangent, colour, eight sets of texture coordinates, blend weights and indices."""
POSITION, NORMAL, TANGENT, COLOR, FIRST_UV = 0, 1, 2, 3, 4
MOST_UVS = 8

_RANGED = {"m_NumItems": 0, "m_Range": 0, "m_Start": 0, "m_Data": "", "m_BitSize": 0}
_COUNTED = {"m_NumItems": 0, "m_Data": "", "m_BitSize": 0}
_UNCOMPRESSED: Fields = {
    "m_Vertices": _RANGED,
    "m_UV": _RANGED,
    "m_Normals": _RANGED,
    "m_Tangents": _RANGED,
    "m_Weights": _COUNTED,
    "m_NormalSigns": _COUNTED,
    "m_TangentSigns": _COUNTED,
    "m_FloatColors": _RANGED,
    "m_BoneIndices": _COUNTED,
    "m_Triangles": _COUNTED,
    "m_UVInfo": 0,
}


def mesh_asset(mesh: Mesh, name: str) -> Iterator[bytes]:
    """The file, piece by piece."""
    vertices = np.ascontiguousarray(mesh.vertices, dtype="<f4")
    columns: list[tuple[int, np.ndarray]] = [(POSITION, vertices)]
    for channel, values in ((NORMAL, mesh.normals), (TANGENT, mesh.tangents), (COLOR, mesh.colors)):
        if values is not None:
            columns.append((channel, values))
    columns += [(FIRST_UV + i, uv) for i, uv in enumerate(mesh.uvs[:MOST_UVS])]
    short = len(vertices) <= UINT16_VERTICES
    indices = np.ascontiguousarray(mesh.triangles, dtype="<u2" if short else "<u4")
    width = 4 * sum(values.shape[1] for _, values in columns)
    extent = _bounds(vertices)
    submeshes = _submeshes(mesh, vertices, indices, extent)
    form = _form(tuple((channel, values.shape[1]) for channel, values in columns), len(submeshes))
    told = form.filled(
        MESH_ID,
        text(name),
        *(value for values in submeshes for value in values),
        0 if short else 1,
        _SPLIT,
        len(vertices),
        width * len(vertices),
        _SPLIT,
        *extent,
    )
    head, middle, tail = (HEADER + told).encode("ascii").split(_SPLIT.encode())
    yield head
    yield hexlify(indices.data)
    yield middle
    yield from _interleaved(columns, width)
    yield tail


@lru_cache(maxsize=64)
def _form(layout: tuple[tuple[int, int], ...], submeshes: int) -> Form:
    """The document of a mesh with these channels, each with its width in floats, and so many submeshes."""
    box: Fields = {"m_Center": BLANK, "m_Extent": BLANK}
    submesh: Fields = {
        "serializedVersion": 2,
        "firstByte": BLANK,
        "indexCount": BLANK,
        "topology": 0,
        "baseVertex": 0,
        "firstVertex": BLANK,
        "vertexCount": BLANK,
        "localAABB": box,
    }
    fields: Fields = {
        **HEAD,
        "m_Name": BLANK,
        "serializedVersion": VERSION,
        "m_SubMeshes": [submesh] * submeshes,
        "m_Shapes": {"vertices": [], "shapes": [], "channels": [], "fullWeights": []},
        "m_BindPose": [],
        "m_BoneNameHashes": "",
        "m_RootBoneNameHash": 0,
        "m_BonesAABB": [],
        "m_VariableBoneCountWeights": {"m_Data": ""},
        "m_MeshCompression": 0,
        "m_IsReadable": 1,
        "m_KeepVertices": 1,
        "m_KeepIndices": 1,
        "m_IndexFormat": BLANK,
        "m_IndexBuffer": BLANK,
        "m_VertexData": {
            "serializedVersion": 3,
            "m_VertexCount": BLANK,
            "m_Channels": _channels(layout),
            "m_DataSize": BLANK,
            "_typelessdata": BLANK,
        },
        "m_CompressedMesh": _UNCOMPRESSED,
        "m_LocalAABB": box,
        "m_MeshUsageFlags": 0,
        "m_BakedConvexCollisionMesh": "",
        "m_BakedTriangleCollisionMesh": "",
        "m_MeshMetrics[0]": 1,
        "m_MeshMetrics[1]": 1,
        "m_MeshOptimizationFlags": 1,
        "m_StreamData": {"serializedVersion": 2, "offset": 0, "size": 0, "path": ""},
    }
    return Form(43, "Mesh", fields)


_SPLIT = "\x7f"
"""Stands where the hexadecimal goes; no name holds it, as YAML escapes it."""
_ROWS = 65536
"""Vertices of one piece."""


def _channels(layout: tuple[tuple[int, int], ...]) -> list[Fields]:
    """Where each attribute stands in a vertex."""
    unused: Fields = {"stream": 0, "offset": 0, "format": 0, "dimension": 0}
    channels: list[Fields] = [unused] * CHANNELS
    offset = 0
    for channel, size in layout:
        channels[channel] = {"stream": 0, "offset": offset, "format": 0, "dimension": size}
        offset += 4 * size
    return channels


def _interleaved(columns: list[tuple[int, np.ndarray]], width: int) -> Iterator[bytes]:
    count = len(columns[0][1])
    for start in range(0, count, _ROWS):
        rows = np.empty((min(_ROWS, count - start), width // 4), dtype="<f4")
        at = 0
        for _, values in columns:
            rows[:, at : at + values.shape[1]] = values[start : start + _ROWS]
            at += values.shape[1]
        yield hexlify(rows.data)


def _submeshes(
    mesh: Mesh, vertices: np.ndarray, indices: np.ndarray, whole: tuple[Plain, Plain]
) -> list[tuple[int | Plain, ...]]:
    """Of each its first byte, how many indices, its first vertex, how many vertices, centre and extent.  whole: the mesh's."""
    found: list[tuple[int | Plain, ...]] = []
    start = 0
    for count in mesh.submeshes or (len(indices),):
        used = indices[start : start + count]
        first, last = (int(used.min()), int(used.max())) if count else (0, -1)
        extent = _bounds(vertices[first : last + 1]) if len(mesh.submeshes) > 1 else whole
        found.append((3 * start * indices.itemsize, 3 * count, first, last - first + 1, *extent))
        start += count
    return found


def _bounds(vertices: np.ndarray) -> tuple[Plain, Plain]:
    """Centre and extent."""
    if not len(vertices):
        return vector((0, 0, 0)), vector((0, 0, 0))
    low, high = (corner.astype(np.float64) for corner in bounds(vertices))
    return vector((0.5 * (low + high)).tolist()), vector((0.5 * (high - low)).tolist())
