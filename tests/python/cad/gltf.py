"""A part as Onshape exports it to glTF: one node with its id, a mesh with a primitive for each face, no textures."""

from __future__ import annotations

import base64
import json
import struct
from typing import Any

import numpy as np


def exported(
    points: np.ndarray,
    faces: list[list[int]],
    paints: list[dict[str, Any] | None],
    binary: bool = True,
    linear: np.ndarray | None = None,
    node: dict[str, Any] | None = None,
) -> bytes:
    """The file's bytes.  faces: triangles, each a face of the part with corners and a normal of its own.  paints: of each face,
    ``pbrMetallicRoughness``.  linear: what the points are mapped by, (3, 3); node: members of the node beside its mesh.
    """
    linear = np.eye(3) if linear is None else linear
    held = bytearray()
    views: list[dict[str, Any]] = []
    accessors: list[dict[str, Any]] = []

    def stored(values: np.ndarray, kind: int, word: str) -> int:
        views.append({"buffer": 0, "byteOffset": len(held), "byteLength": values.nbytes})
        held.extend(values.tobytes() + b"\0" * (-values.nbytes % 4))
        accessors.append(
            {"bufferView": len(views) - 1, "componentType": kind, "count": len(values), "type": word}
        )
        return len(accessors) - 1

    materials: list[dict[str, Any]] = []
    primitives: list[dict[str, Any]] = []
    for face, paint in zip(faces, paints):
        corners = (points[face] @ linear.T).astype("<f4")
        normal = np.cross(corners[1] - corners[0], corners[2] - corners[0])
        normals = np.repeat((normal / np.linalg.norm(normal))[None], 3, axis=0).astype("<f4")
        attributes = {"POSITION": stored(corners, 5126, "VEC3"), "NORMAL": stored(normals, 5126, "VEC3")}
        indices = stored(np.arange(3, dtype="<u2"), 5123, "SCALAR")
        primitives.append({"attributes": attributes, "indices": indices})
        if paint is not None:
            if {"pbrMetallicRoughness": paint} not in materials:
                materials.append({"pbrMetallicRoughness": paint})
            primitives[-1]["material"] = materials.index({"pbrMetallicRoughness": paint})
    extension = {"PTC_onshape_metadata": {"id": ["JHD"]}}
    document = {
        "asset": {"version": "2.0"}, "extensionsUsed": ["PTC_onshape_metadata"], "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "Part 1", "mesh": 0, "extensions": extension, **(node or {})}],
        "meshes": [{"primitives": primitives}], "materials": materials, "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(held)}],
    }  # fmt: skip
    if not binary:
        data = base64.b64encode(bytes(held)).decode()
        document["buffers"][0]["uri"] = f"data:application/octet-stream;base64,{data}"
        return json.dumps(document).encode()
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    chunks = (
        struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(held), 0x004E4942) + held
    )
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks
