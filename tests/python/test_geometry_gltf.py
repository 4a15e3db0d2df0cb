"""What a glTF file's own JSON says of looks and of shares, which trimesh passes over."""

from __future__ import annotations

import base64
import json
import math
from pathlib import Path

import numpy as np
import pytest
from kinefab.diagnostics import Outcome, Report
from kinefab.geometry.files import read_mesh_file
from kinefab.geometry.pieces import MeshFile
from kinefab.model import Wrap

CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)
COORDINATES = np.array([[0.25, 0.75], [1, 0.75], [0.25, 0]], np.float32)
PIXEL = base64.b64encode(
    bytes.fromhex(
        "89504e470d0a1a0a0000000d4948445200000001000000010802000000907753de0000000c49444154789c63f8cfc000000301"
        "0100c9fe92ef0000000049454e44ae426082"
    )
).decode()


def read(
    folder: Path, material: dict, sampler: dict | None = None, **attributes: np.ndarray
) -> tuple[MeshFile, Report]:
    """A triangle with these attributes, whole numbers as shares, and this material; texture 0 has the sampler."""
    arrays = {"POSITION": CORNERS, "TEXCOORD_0": COORDINATES, **attributes}
    views, accessors, data = [], [], b""
    for values in arrays.values():
        views.append({"buffer": 0, "byteOffset": len(data), "byteLength": values.nbytes})
        kind = {"f4": 5126, "u2": 5123, "i2": 5122}[values.dtype.str[1:]]
        shares = {} if kind == 5126 else {"normalized": True}
        accessors.append(
            {"bufferView": len(views) - 1, "componentType": kind, "count": 3, "type": f"VEC{values.shape[1]}", **shares}
        )  # fmt: skip
        data += values.tobytes() + bytes(-values.nbytes % 4)
    document = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": dict(zip(arrays, range(9))), "material": 0}]}],
        "materials": [{"name": "m", **material}], "accessors": accessors, "bufferViews": views,
        "buffers": [{"byteLength": len(data), "uri": "data:;base64," + base64.b64encode(data).decode()}],
        "textures": [{"source": 0, "sampler": 0}], "samplers": [sampler or {}],
        "images": [{"uri": "data:image/png;base64," + PIXEL}],
    }  # fmt: skip
    (folder / "t.gltf").write_text(json.dumps(document), "utf-8")
    found = read_mesh_file(folder / "t.gltf", report := Report(), "here")
    assert found is not None
    return found, report


def test_a_material_has_all_that_the_file_says_of_it_or_it_is_told(tmp_path):
    """Colours are not rounded to bytes, emission has its strength, pictures lie as sampler and transform have it."""
    pytest.importorskip("PIL", reason="pillow is not installed")
    placed = {"offset": [0.25, 0.5], "scale": [2, 3], "rotation": 0.3}
    material = {
        "pbrMetallicRoughness": {
            "baseColorFactor": [0.003, 0.02, 0.5, 1],
            "baseColorTexture": {"index": 0, "extensions": {"KHR_texture_transform": placed}},
        },
        "normalTexture": {"index": 0, "scale": 0.5},
        "occlusionTexture": {"index": 0, "texCoord": 1},
        "emissiveFactor": [1, 0.5, 0],
        "extensions": {
            "KHR_materials_emissive_strength": {"emissiveStrength": 7},
            "KHR_materials_transmission": {"transmissionFactor": 0.9},
        },
    }
    sampler = {"wrapS": 33071, "wrapT": 33071, "magFilter": 9728}
    file, report = read(tmp_path, material, sampler, TEXCOORD_1=COORDINATES)
    (surface,) = file.surfaces.values()
    assert surface.color == (0.003, 0.02, 0.5, 1.0) and surface.emission == (7.0, 3.5, 0.0)
    texture = surface.color_texture
    assert texture.wrap is Wrap.CLAMP and surface.normal_texture.wrap is Wrap.CLAMP
    # the same place of the picture, by the extension's formula with v downwards and by ours with v upwards
    u, v = 0.4, 0.9
    s, c = math.sin(0.3), math.cos(0.3)
    theirs = (0.25 + c * 2 * u + s * 3 * v, 0.5 - s * 2 * u + c * 3 * v)
    x, y = texture.scale[0] * u, texture.scale[1] * (1.0 - v)
    s, c = math.sin(texture.rotation), math.cos(texture.rotation)
    ours = (c * x - s * y + texture.offset[0], s * x + c * y + texture.offset[1])
    assert (ours[0], 1.0 - ours[1]) == pytest.approx(theirs)
    assert surface.occlusion_texture is None
    told = {(o.feature, o.outcome) for o in report.outcomes if o.code == "MESH_LOOK"}
    assert told == {
        ("baseColorTexture of material m", Outcome.APPROXIMATED),  # its pixels
        ("normalTexture of material m", Outcome.APPROXIMATED),  # and its strength
        ("occlusionTexture of material m", Outcome.DROPPED),
        ("KHR_materials_transmission of material m", Outcome.APPROXIMATED),
    }


def test_the_coordinates_are_those_that_the_material_s_pictures_lie_on(tmp_path):
    pytest.importorskip("PIL", reason="pillow is not installed")
    material = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}}}
    file, report = read(tmp_path, material, TEXCOORD_1=COORDINATES / 2)
    assert np.allclose(file.pieces[0].uv, np.column_stack([COORDINATES[:, 0] / 2, 1 - COORDINATES[:, 1] / 2]))
    assert report.outcomes == []


def test_whole_numbers_that_stand_for_shares_are_shares(tmp_path):
    """As gltfpack and glTF-Transform write them; trimesh takes 65535 for what it is."""
    pytest.importorskip("PIL", reason="pillow is not installed")
    half = np.array([[65535, 0, 0], [0, 32768, 0], [0, 0, 65535]], np.uint16)
    file, _ = read(
        tmp_path, {},
        POSITION=(CORNERS * 32767).astype(np.int16), TEXCOORD_0=(COORDINATES * 65535).astype(np.uint16), COLOR_0=half,
    )  # fmt: skip
    (piece,) = file.pieces
    assert np.allclose(piece.vertices, CORNERS)
    assert np.allclose(piece.uv, np.column_stack([COORDINATES[:, 0], 1 - COORDINATES[:, 1]]), atol=1e-4)
    assert np.allclose(piece.colors, [[1, 0, 0, 1], [0, 0.5, 0, 1], [0, 0, 1, 1]], atol=1e-4)


def test_coordinates_without_a_material_are_kept(tmp_path):
    """Whoever gives the part a material in Unity needs them."""
    read(tmp_path, {})
    document = json.loads((tmp_path / "t.gltf").read_text("utf-8"))
    del document["meshes"][0]["primitives"][0]["material"]
    (tmp_path / "t.gltf").write_text(json.dumps(document), "utf-8")
    file = read_mesh_file(tmp_path / "t.gltf", Report(), "here")
    assert np.allclose(file.pieces[0].uv, np.column_stack([COORDINATES[:, 0], 1 - COORDINATES[:, 1]]))
