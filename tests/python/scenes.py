"""Small scenes and checks that several tests share."""

from __future__ import annotations

import hashlib
import json
from functools import lru_cache
from pathlib import Path

import jsonschema
import kinefab
import numpy as np
import trimesh
from kinefab.diagnostics import schema_directory
from unity_semantics import compose, matrix

BOX = trimesh.creation.box((0.1, 0.2, 0.3))


def lid_scene() -> kinefab.Scene:
    """A box on the ground with a lid that opens from 0 to 110 degrees."""
    scene = kinefab.Scene()
    box = scene.add_part("Box", trimesh.creation.box((0.4, 0.2, 0.3)), translation=(0, 0.1, 0), grounded=True)
    lid = scene.add_part("Lid", trimesh.creation.box((0.4, 0.02, 0.3)), translation=(0, 0.21, 0), density=700)
    scene.add_hinge(box, lid, point=(0, 0.2, -0.15), axis=(-1, 0, 0), limits=(0, 110), name="Hinge")
    return scene


@lru_cache(maxsize=1)
def scene_validator():
    schema = json.loads((schema_directory() / "scene.schema.json").read_text(encoding="utf-8"))
    return jsonschema.Draft202012Validator(schema)


def read(path: Path) -> dict:
    """A written scene, checked against the schema and with its buffer checked against size and hash."""
    content = json.loads(Path(path).read_text(encoding="utf-8"))
    scene_validator().validate(content)
    for buffer in content.get("buffers", []):
        data = (Path(path).parent / buffer["uri"]).read_bytes()
        assert len(data) == buffer["byteLength"]
        assert hashlib.sha256(data).hexdigest() == buffer["sha256"]
    return content


def mesh_arrays(path: Path, content: dict, index: int):
    """(positions, triangles) of a mesh in a written scene."""
    entry = content["meshes"][index]
    data = (Path(path).parent / content["buffers"][0]["uri"]).read_bytes()
    positions = np.frombuffer(data, "<f4", 3 * entry["vertexCount"], entry["positions"]["offset"]).reshape(
        -1, 3
    )
    count = sum(s["indexCount"] for s in entry["submeshes"])
    kind = "<u2" if entry["indexFormat"] == "uint16" else "<u4"
    faces = np.frombuffer(data, kind, count, entry["indices"]["offset"]).reshape(-1, 3)
    return positions, faces.astype(int)


def world_pose(content: dict, index: int):
    """A GameObject's world pose by its chain of parents: (rotation matrix, position)."""
    entry = content["gameObjects"][index]
    transform = entry.get("transform", {})
    local = (
        matrix(transform.get("localRotation", (0, 0, 0, 1))),
        np.array(transform.get("localPosition", (0, 0, 0)), dtype=float),
    )
    return local if "parent" not in entry else compose(world_pose(content, entry["parent"]), local)


def components(content: dict, name: str, kind: str) -> list[dict]:
    """Components of one type on the object of that name."""
    (entry,) = [o for o in content["gameObjects"] if o["name"] == name]
    return [c for c in entry.get("components", []) if c["type"] == kind]


def exported(scene, tmp_path, **options):
    """Joints to the ground are joints to the world, unless ``ground`` says otherwise: what the tests of other things look at."""
    options = {"ground": "world", **options}
    result = kinefab.export(scene, tmp_path / "out.kinefab", kinefab.ExportOptions(**options))
    return read(result.path), result
