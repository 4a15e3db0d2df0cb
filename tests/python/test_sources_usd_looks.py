"""Surfaces, textures and vertex data of USD stages."""

from __future__ import annotations

import numpy as np
import pytest
from kinefab.diagnostics import Report
from kinefab.model import Wrap
from kinefab.sources import read
from usd_stages import body, scene_of, stage

pytest.importorskip("pxr", reason="usd-core is not installed")

QUAD = (
    'uniform token subdivisionScheme = "none"\nint[] faceVertexCounts = [4, 4]\nint[] faceVertexIndices = [0, 1, 2, 3, 1, 4, 5, 2]\n'
    "point3f[] points = [(0,0,0), (1,0,0), (1,1,0), (0,1,0), (2,0,0), (2,1,0)]\n"
)
SETS = (
    'texCoord2f[] primvars:st = [(0,0), (1,0), (1,1), (0,1), (0,0), (1,0), (1,1), (0,1)] (interpolation = "faceVarying")\n'
    'texCoord2f[] primvars:lightmap = [(0,0), (.5,0), (.5,1), (0,1), (1,0), (1,1)] (interpolation = "vertex")\n'
)
MATERIAL = """def Scope "Looks" {
 def Material "Paint" {
  token outputs:surface.connect = </Looks/Paint/Shader.outputs:surface>
  def Shader "Shader" {
   uniform token info:id = "UsdPreviewSurface"
   color3f inputs:diffuseColor.connect = </Looks/Paint/Image.outputs:rgb>
   float inputs:metallic = 0.25
   float inputs:roughness = 0.75
   color3f inputs:emissiveColor = (0, 2, 0)
   token outputs:surface
  }
  def Shader "Image" {
   uniform token info:id = "UsdUVTexture"
   asset inputs:file = @paint.png@
   float2 inputs:st.connect = </Looks/Paint/Reader.outputs:result>
   token inputs:wrapS = "clamp"
   token inputs:wrapT = "clamp"
   float3 outputs:rgb
  }
  def Shader "Reader" {
   uniform token info:id = "UsdPrimvarReader_float2"
   string inputs:varname = "lightmap"
   float2 outputs:result
  }
 }
 def Material "Plain" {
  token outputs:surface.connect = </Looks/Plain/Shader.outputs:surface>
  def Shader "Shader" {
   uniform token info:id = "UsdPreviewSurface"
   color3f inputs:diffuseColor = (0.1, 0.2, 0.3)
   float inputs:opacity = 0.5
   token outputs:surface
  }
 }
}
"""
BOUND = (
    'def Mesh "M" (prepend apiSchemas = ["MaterialBindingAPI"]) {\nrel material:binding = </Looks/Paint>\n' + QUAD + SETS
    + 'def GeomSubset "S" (prepend apiSchemas = ["MaterialBindingAPI"]) {\nuniform token elementType = "face"\n'
    'uniform token familyName = "materialBind"\nint[] indices = [0]\nrel material:binding = </Looks/Plain>\n}\n}\n'
)  # fmt: skip


@pytest.mark.parametrize("packed", [False, True])
def test_materials_textures_and_uv_sets_are_those_of_the_stage(tmp_path, packed):
    from pxr import UsdUtils

    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    text = stage(body("B", inside=BOUND) + MATERIAL, up="Y")
    scene, report = scene_of(tmp_path, text)
    if packed:
        assert UsdUtils.CreateNewUsdzPackage(str(tmp_path / "stage.usda"), str(tmp_path / "stage.usdz"))
        scene = read(tmp_path / "stage.usdz", report := Report())
    (drawn,) = scene.nodes[0].bodies
    mesh = scene.meshes[drawn.mesh]
    plain, paint = (scene.surfaces[i] for i in drawn.surfaces)
    assert mesh.face_counts == (2, 2) and len(mesh.uvs) == 2
    assert plain.name == "Plain" and plain.color == pytest.approx((0.1, 0.2, 0.3, 0.5))
    assert (paint.metallic, paint.smoothness, paint.emission) == (0.25, 0.25, (0, 2, 0))
    texture = paint.color_texture
    assert (texture.uv_set, texture.wrap, texture.media_type) == (1, Wrap.CLAMP, "image/png")
    assert (
        (texture.data is not None and len(texture.data) == 48)
        if packed
        else texture.path == tmp_path / "paint.png"
    )
    assert not [d for d in report.diagnostics if d.severity.value != "info"]


def test_corners_that_differ_are_vertices_of_their_own(tmp_path):
    """The two quads share an edge; their face-varying coordinates differ along it, their points do not."""
    scene, _ = scene_of(tmp_path, stage(body("B", inside=f'def Mesh "M" {{\n{QUAD}{SETS}}}\n'), up="Y"))
    mesh = scene.meshes[0]
    assert len(mesh.vertices) == 8 and len(mesh.faces) == 4
    seen = {(*p, *uv) for p, uv in zip(mesh.vertices[:, :2].tolist(), mesh.uvs[0].tolist())}
    assert {(1, 0, 1, 0), (1, 0, 0, 0), (1, 1, 1, 1), (1, 1, 0, 1)} <= seen


def test_a_left_handed_mesh_a_hole_and_a_hollow_polygon_are_wound_right(tmp_path):
    """An L of six corners, no fan of which lies inside; a hole; the same left-handed."""
    corners = "point3f[] points = [(0,0,0), (2,0,0), (2,1,0), (1,1,0), (1,2,0), (0,2,0)]\n"
    faces = "int[] faceVertexCounts = [6, 3]\nint[] faceVertexIndices = [0, 1, 2, 3, 4, 5, 0, 1, 2]\nint[] holeIndices = [1]\n"
    for word, sign in (("rightHanded", 1.0), ("leftHanded", -1.0)):
        inside = f'def Mesh "M" {{\nuniform token subdivisionScheme = "none"\nuniform token orientation = "{word}"\n{corners}{faces}}}\n'
        scene, _ = scene_of(tmp_path, stage(body("B", inside=inside), up="Y"), f"{word}.usda")
        a, b, c = (scene.meshes[0].vertices[scene.meshes[0].faces[:, i]] for i in range(3))
        areas = 0.5 * np.cross(b - a, c - a)[:, 2]
        assert (areas * sign > 0.0).all() and areas.sum() == pytest.approx(3.0 * sign)


def test_display_colours_are_a_surface_or_the_vertices_own(tmp_path):
    red = "color3f[] primvars:displayColor = [(1, 0, 0)]\nfloat[] primvars:displayOpacity = [0.5]\n"
    each = 'color3f[] primvars:displayColor = [(1,0,0), (0,1,0), (0,0,1), (1,1,0), (0,0,0), (1,1,1)] (interpolation = "vertex")\n'
    inside = f'def Cube "C" {{\n{red}}}\ndef Mesh "M" {{\n{QUAD}{each}}}\n'
    scene, _ = scene_of(tmp_path, stage(body("B", inside=inside), up="Y"))
    cube, mesh = scene.nodes[0].bodies
    assert scene.surfaces[cube.surfaces[0]].color == (1, 0, 0, 0.5)
    assert scene.surfaces[mesh.surfaces[0]].color == (1, 1, 1, 1)
    assert scene.meshes[mesh.mesh].colors[1].tolist() == [0, 1, 0, 1]


def test_images_that_are_counted_or_packed_otherwise_are_told(tmp_path):
    """A base colour of raw numbers, and an occlusion in green."""
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    text = stage(MATERIAL.replace(
        "   float inputs:metallic", "   float inputs:occlusion.connect = </Looks/Paint/Image.outputs:g>\n   float inputs:metallic"
    ).replace('   float2 inputs:st', '   token inputs:sourceColorSpace = "raw"\n   float outputs:g\n   float2 inputs:st') + BOUND)  # fmt: skip
    scene, report = scene_of(tmp_path, text)
    paint = next(surface for surface in scene.surfaces if surface.name == "Paint")
    assert paint.color_texture is not None and paint.occlusion_texture is None
    told = {(o.feature, o.outcome.value) for o in report.outcomes}
    assert ("occlusion of /Looks/Paint/Shader", "dropped") in told
    assert ("texture /Looks/Paint/Image", "approximated") in told


def test_the_fallback_of_an_image_that_is_not_there_is_taken(tmp_path):
    """The image of the base colour, and of the opacity by its alpha."""
    image = "   asset inputs:file = @paint.png@\n   float4 inputs:fallback = (0.7, 0.2, 0.1, 0.4)\n   float outputs:a\n"
    opacity = "   float inputs:opacity.connect = </Looks/Paint/Image.outputs:a>\n   float inputs:metallic"
    text = MATERIAL.replace("   asset inputs:file = @paint.png@\n", image).replace(
        "   float inputs:metallic", opacity
    )
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + text, up="Y"))
    paint = next(surface for surface in scene.surfaces if surface.name == "Paint")
    assert paint.color == pytest.approx((0.7, 0.2, 0.1, 0.4)) and paint.color_texture is None
    assert paint.alpha_mode.value == "blend"
    assert {o.code for o in report.outcomes if o.outcome.value == "dropped"} == {"USD_TEXTURE_MISSING"}
