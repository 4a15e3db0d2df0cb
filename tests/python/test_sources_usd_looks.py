"""Surfaces, textures and vertex data of USD stages."""

from __future__ import annotations

import io
import os

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


@pytest.mark.posix
@pytest.mark.parametrize("what", ["device", "pipe"])
def test_an_image_that_never_ends_is_not_waited_for(tmp_path, what):
    if what == "pipe":
        os.mkfifo(tmp_path / "paint.png")
    else:
        (tmp_path / "paint.png").symlink_to("/dev/zero")
    _, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + MATERIAL, up="Y"))
    (found,) = [d for d in report.diagnostics if d.code == "USD_TEXTURE_MISSING"]
    assert "no regular file" in found.message


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


def painted(scene, name: str = "Paint"):
    return next(surface for surface in scene.surfaces if surface.name == name)


def test_subsets_keep_their_materials_where_the_rest_of_the_mesh_has_none(tmp_path):
    content = BOUND.replace("rel material:binding = </Looks/Paint>\n", "")
    scene, _ = scene_of(tmp_path, stage(body("B", inside=content) + MATERIAL, up="Y"))
    (drawn,) = scene.nodes[0].bodies
    assert [scene.surfaces[i].name for i in drawn.surfaces] == ["Plain", "Default"]


def test_a_material_for_previews_is_shown_where_the_full_one_is_none_that_is_read(tmp_path):
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    preview = BOUND.replace("rel material:binding =", "rel material:binding:preview =")
    network = 'def Material "Net" {\n token outputs:mtlx:surface.connect = </Net/S.outputs:out>\n def Shader "S" {\n token outputs:out\n}\n}\n'
    for case, more in (
        ("alone", ""),
        ("beside", "rel material:binding:full = </Net>\nrel material:binding:preview"),
    ):
        content = preview.replace("rel material:binding:preview", more, 1) if more else preview
        scene, _ = scene_of(tmp_path, stage(body("B", inside=content) + MATERIAL + network), f"{case}.usda")
        assert {surface.name for surface in scene.surfaces} == {"Plain", "Paint"}, case


def test_what_both_sides_of_show_is_double_sided_here_too(tmp_path):
    """With a material, with colours, and with neither; a closed mesh beside keeps one side."""
    plain = 'def Mesh "%s" (prepend apiSchemas = ["MaterialBindingAPI"]) {\n%s' + QUAD + "}\n"
    bound, both = "rel material:binding = </Looks/Plain>\n", "uniform bool doubleSided = 1\n"
    red = "color3f[] primvars:displayColor = [(1, 0, 0)]\n"
    said = {"A": bound + both, "B": bound, "C": red + both, "D": red, "E": both, "F": ""}
    inside = "".join(plain % entry for entry in said.items())
    scene, _ = scene_of(tmp_path, stage(body("B", inside=inside) + MATERIAL))
    shown = {
        b.name: [(scene.surfaces[i].color, scene.surfaces[i].double_sided) for i in b.surfaces]
        for b in scene.nodes[0].bodies
    }
    blue = pytest.approx((0.1, 0.2, 0.3, 0.5))
    assert shown["A"] == [(blue, True)] and shown["B"] == [(blue, False)]
    assert shown["C"] == [((1, 0, 0, 1), True)] and shown["D"] == [((1, 0, 0, 1), False)]
    assert shown["E"] == [((0.8, 0.8, 0.8, 1), True)] and shown["F"] == []


def test_a_material_shows_a_mesh_s_own_colours_where_it_reads_them_alone(tmp_path):
    """Of one colour and of one for each point; a material that reads none hides them, and that is told."""
    reader = 'def Shader "R" {\n uniform token info:id = "UsdPrimvarReader_float3"\n string inputs:varname = "%s"\n float3 inputs:fallback = (0, 0, 1)\n float3 outputs:result\n}\n'
    reads = MATERIAL.replace(
        "color3f inputs:diffuseColor = (0.1, 0.2, 0.3)",
        "color3f inputs:diffuseColor.connect = </Looks/Plain/R.outputs:result>",
    )
    mesh = (
        'def Mesh "M" (prepend apiSchemas = ["MaterialBindingAPI"]) {\nrel material:binding = </Looks/Plain>\n%s'
        + QUAD
        + "}\n"
    )
    one = "color3f[] primvars:displayColor = [(1, 0, 0)]\n"
    each = 'color3f[] primvars:displayColor = [(1,0,0), (0,1,0), (0,0,1), (1,1,0), (0,0,0), (1,1,1)] (interpolation = "vertex")\n'
    cases = {
        "one": (one, "displayColor", (1, 0, 0), False, 0),
        "each": (each, "displayColor", (1, 1, 1), True, 0),
        "none": ("", "displayColor", (0, 0, 1), False, 0),
        "other": (each, "wear", (0, 0, 1), False, 2),
        "hidden": (each, "", (0.1, 0.2, 0.3), False, 1),
    }
    for case, (colors, name, expected, colored, lost) in cases.items():
        looks = reads.replace('"Plain" {\n', f'"Plain" {{\n{reader % name}', 1) if name else MATERIAL
        scene, report = scene_of(tmp_path, stage(body("B", inside=mesh % colors) + looks), f"{case}.usda")
        assert painted(scene, "Plain").color[:3] == pytest.approx(expected), case
        (drawn,) = scene.nodes[0].bodies
        assert (scene.meshes[drawn.mesh].colors is not None) == colored, case
        assert len([o for o in report.outcomes if o.outcome.value == "dropped"]) == lost, case


def test_what_an_input_follows_and_nothing_reads_is_told(tmp_path):
    looks = MATERIAL.replace(
        "   float inputs:roughness = 0.75", "   float inputs:roughness.connect = </Looks/Paint/Noise.outputs:out>"
    ).replace(' def Material "Plain"', ' def Material "Plain"').replace(
        '  def Shader "Reader"', '  def Shader "Noise" {\n   uniform token info:id = "ND_noise2d_float"\n   float outputs:out\n  }\n  def Shader "Reader"'
    )  # fmt: skip
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    (told,) = [o for o in report.outcomes if o.feature == "roughness of /Looks/Paint/Shader"]
    assert told.outcome.value == "dropped" and painted(scene).smoothness == 0.5


@pytest.mark.parametrize(
    ("metallic", "roughness", "expected", "told"),
    [
        ("b", "g", (1.0, 1.0, True), set()),
        ("r", "g", (0.0, 1.0, True), {"dropped metallic of /Looks/Paint/Shader"}),
        ("b", "r", (1.0, 0.5, True), {"dropped roughness of /Looks/Paint/Shader", "approximated texture paint.png"}),
        ("", "g", (0.25, 1.0, True), {"approximated texture paint.png"}),
        ("r", "r", (0.0, 0.5, False), {"dropped metallic of /Looks/Paint/Shader", "dropped roughness of /Looks/Paint/Shader"}),
    ],
)  # fmt: skip
def test_a_channel_that_is_lost_leaves_no_trace_in_the_other(tmp_path, metallic, roughness, expected, told):
    """Without its image metallic is the schema's 0, not what the image of the roughness has in blue."""
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    looks = MATERIAL.replace(
        "   float3 outputs:rgb",
        "   float3 outputs:rgb\n   float outputs:r\n   float outputs:g\n   float outputs:b",
    )
    for name, value, channel in (("metallic", "0.25", metallic), ("roughness", "0.75", roughness)):
        if channel:
            looks = looks.replace(
                f"inputs:{name} = {value}", f"inputs:{name}.connect = </Looks/Paint/Image.outputs:{channel}>"
            )
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    paint = painted(scene)
    assert (paint.metallic, 1.0 - paint.smoothness, paint.metallic_roughness_texture is not None) == expected
    lost = {f"{o.outcome.value} {o.feature}" for o in report.outcomes if o.outcome.value != "kept"}
    assert lost == told


@pytest.mark.parametrize(
    ("moves", "sheared"),
    [
        (["(2, 0.5)|30|(0.1, -0.2)"], False),
        (["(1, 1)|0|(-0.5, -0.5)", "(2, 3)|40|(0, 0)", "(1, 1)|0|(0.5, 0.5)"], False),
        (["(1, 1)|25|(0.3, 0)", "(-2, 3)|0|(0, 0.1)"], True),
    ],
)
def test_transforms_of_coordinates_act_one_after_the_other(tmp_path, moves, sheared):
    """The middle one turns and scales about the middle of the image."""
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    before, shaders, points = "Reader", "", np.array([[0, 0], [1, 0], [0, 1]], float)
    for i, move in enumerate(moves):
        scale, turn, away = move.split("|")
        shaders += (
            f'def Shader "T{i}" {{\n uniform token info:id = "UsdTransform2d"\n float2 inputs:in.connect = </Looks/Paint/{before}.outputs:result>\n'
            f" float2 inputs:scale = {scale}\n float inputs:rotation = {turn}\n float2 inputs:translation = {away}\n float2 outputs:result\n}}\n"
        )
        before, s, c = f"T{i}", np.sin(np.radians(float(turn))), np.cos(np.radians(float(turn)))
        points = points * eval(scale) @ np.array([[c, s], [-s, c]]) + eval(away)
    looks = MATERIAL.replace(
        "inputs:st.connect = </Looks/Paint/Reader", f"inputs:st.connect = </Looks/Paint/{before}"
    )
    looks = looks.replace('  def Shader "Reader"', f'{shaders}  def Shader "Reader"')
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    image = painted(scene).color_texture
    s, c = np.sin(image.rotation), np.cos(image.rotation)
    found = np.array([[0, 0], [1, 0], [0, 1]]) * image.scale @ np.array([[c, s], [-s, c]]) + image.offset
    assert np.allclose(found, points, atol=1e-6) != sheared
    told = [
        o
        for o in report.outcomes
        if o.feature == "texture /Looks/Paint/Image" and o.outcome.value == "approximated"
    ]
    assert len(told) == sheared


@pytest.mark.parametrize(
    ("kind", "color", "metal", "rough"),
    [
        ("ND_standard_surface_surfaceshader", "base_color", "metalness", "specular_roughness"),
        ("ND_open_pbr_surface_surfaceshader", "base_color", "base_metalness", "specular_roughness"),
        ("ND_gltf_pbr_surfaceshader", "base_color", "metallic", "roughness"),
        ("ND_UsdPreviewSurface_surfaceshader", "diffuseColor", "metallic", "roughness"),
    ],
)
def test_constants_of_a_material_for_materialx_alone_are_taken_and_it_is_told_by_name(
    tmp_path, kind, color, metal, rough
):
    net = (
        'def Material "Plain" {\n token outputs:mtlx:surface.connect = </Looks/Plain/S.outputs:out>\n def Shader "S" {\n'
        f' uniform token info:id = "{kind}"\n color3f inputs:{color} = (0.1, 0.2, 0.3)\n float inputs:{metal} = 0.7\n'
        f" float inputs:{rough} = 0.4\n token outputs:out\n }}\n}}\n"
    )
    mesh = (
        'def Mesh "M" (prepend apiSchemas = ["MaterialBindingAPI"]) {\nrel material:binding = </Looks/Plain>\n'
        + QUAD
        + "}\n"
    )
    scene, report = scene_of(tmp_path, stage(body("B", inside=mesh) + f'def Scope "Looks" {{\n{net}}}\n'))
    plain = painted(scene, "Plain")
    assert plain.color == pytest.approx((0.1, 0.2, 0.3, 1.0))
    assert (plain.metallic, plain.smoothness) == pytest.approx((0.7, 0.6))
    (told,) = [d for d in report.diagnostics if d.code == "USD_MATERIAL_UNKNOWN"]
    assert kind in told.message


@pytest.mark.parametrize(
    ("metallic", "roughness", "expected"),
    [
        ("metal.png r", "rough.png r", (255, 128, 51)),
        ("", "rough.png r", (255, 128, 255)),
        ("metal.png g", "", (255, 255, 51)),
        ("rough.png b", "rough.png g", None),
    ],
)
def test_images_of_metallic_and_of_roughness_are_put_into_one(tmp_path, metallic, roughness, expected):
    """As Blender, Maya and Houdini write them, each grey and taken by its red; what is constant stays what it is."""
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
    image.new("L", (2, 2), 128).save(tmp_path / "rough.png")
    image.new("L", (4, 4), 51).save(tmp_path / "metal.png")
    image.new("RGB", (1, 1)).save(tmp_path / "paint.png")
    looks = MATERIAL
    for name, value, given in (("metallic", "0.25", metallic), ("roughness", "0.75", roughness)):
        if given:
            file, channel = given.split()
            looks = looks.replace(
                f"inputs:{name} = {value}",
                f"inputs:{name}.connect = </Looks/Paint/{name}.outputs:{channel}>",
            ).replace(
                '  def Shader "Reader"',
                f'  def Shader "{name}" {{\nuniform token info:id = "UsdUVTexture"\nasset inputs:file = @{file}@\n'
                f"float inputs:{name}\nfloat4 inputs:scale = (0.5, 0.5, 0.5, 1)\n"
                f'float outputs:{channel}\n}}\n  def Shader "Reader"',
            )
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    paint = painted(scene)
    assert (paint.metallic, 1.0 - paint.smoothness) == (0.5 if metallic else 0.25, 0.5 if roughness else 0.75)
    texture = paint.metallic_roughness_texture
    if expected is None:
        assert texture.name == "rough.png" and texture.data is None
    else:
        with image.open(io.BytesIO(texture.data)) as found:
            assert found.size == ((4, 4) if metallic else (2, 2)) and found.getpixel((0, 0)) == expected
    assert not [o for o in report.outcomes if "metallic" in o.feature or "roughness" in o.feature]


def test_an_opacity_of_its_own_is_the_alpha_of_the_base_colour(tmp_path):
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
    image.new("L", (1, 1), 51).save(tmp_path / "holes.png")
    image.new("RGB", (1, 1), (10, 20, 30)).save(tmp_path / "paint.png")
    looks = MATERIAL.replace(
        "   float inputs:metallic", "   float inputs:opacity.connect = </Looks/Paint/Holes.outputs:r>\n   float inputs:metallic"
    ).replace(
        '  def Shader "Reader"',
        '  def Shader "Holes" {\nuniform token info:id = "UsdUVTexture"\nasset inputs:file = @holes.png@\n'
        'token inputs:wrapS = "clamp"\ntoken inputs:wrapT = "clamp"\nfloat outputs:r\n'
        "float2 inputs:st.connect = </Looks/Paint/Reader.outputs:result>\n}\n"
        '  def Shader "Reader"',
    )  # fmt: skip
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    paint = painted(scene)
    assert paint.alpha_mode.value == "blend" and paint.color[3] == 1.0
    with image.open(io.BytesIO(paint.color_texture.data)) as found:
        assert found.getpixel((0, 0)) == (10, 20, 30, 51)
    assert not [o for o in report.outcomes if "opacity" in o.feature]


def told(report: Report) -> set[str]:
    """What is lost or not quite kept, each by its outcome and feature."""
    return {f"{o.outcome.value} {o.feature}" for o in report.outcomes if o.outcome.value != "kept"}


def test_looks_of_samples_alone_are_the_first_of_them_and_it_is_told(tmp_path):
    """Exporters that write each frame give no default: of a colour, a shader's input, faces, subsets, indices."""
    looks = MATERIAL.replace(
        "inputs:diffuseColor = (0.1, 0.2, 0.3)", "inputs:diffuseColor.timeSamples = {1: (0.1, 0.2, 0.3), 9: (1, 1, 1)}"
    )  # fmt: skip
    cage = QUAD.replace("Counts = [4, 4]", "Counts.timeSamples = {1: [4, 4]}").replace(
        "Indices = [0, 1, 2, 3, 1, 4, 5, 2]", "Indices.timeSamples = {1: [0, 1, 2, 3, 1, 4, 5, 2]}"
    )
    subset = BOUND[BOUND.index("def GeomSubset") : -2].replace(
        "indices = [0]", "indices.timeSamples = {1: [1], 9: [0]}"
    )
    coordinates = (
        'texCoord2f[] primvars:st = [(0,0), (1,0), (1,1)] (interpolation = "faceVarying")\n'
        "int[] primvars:st:indices.timeSamples = {1: [0, 1, 2, 2, 1, 0, 0, 2]}\n"
    )
    color = (
        'color3f[] primvars:displayColor (interpolation = "constant")\n'
        "color3f[] primvars:displayColor.timeSamples = {1: [(1, 0, 0)], 9: [(0, 1, 0)]}\n"
    )
    inside = f'def Mesh "M" {{\n{cage}{coordinates}{color}{subset}}}\n'
    scene, report = scene_of(tmp_path, stage(body("B", inside=inside) + looks))
    (drawn,) = scene.nodes[0].bodies
    mesh = scene.meshes[drawn.mesh]
    assert mesh.face_counts == (2, 2) and len(mesh.uvs) == 1
    assert 2.0 in mesh.vertices[mesh.faces[:2]], "the second face is the subset's"
    colors = [scene.surfaces[i].color for i in drawn.surfaces]
    assert colors == [pytest.approx((0.1, 0.2, 0.3, 0.5)), (1.0, 0.0, 0.0, 1.0)]
    assert told(report) == {
        "dropped animation of Looks/Plain/Shader.inputs:diffuseColor",
        "dropped animation of B/M/S.indices",
        "dropped animation of B/M.primvars:displayColor",
    }


def test_a_colour_by_its_index_and_several_where_a_shape_has_one(tmp_path):
    by_index = 'color3f[] primvars:displayColor = [(1,0,0), (0,1,0)] (interpolation = "constant")\nint[] primvars:displayColor:indices = [1]\n'
    of_faces = 'color3f[] primvars:displayColor = [(1,0,0), (0,1,0), (0,0,1), (1,1,0), (0,1,1), (1,1,1)] (interpolation = "uniform")\n'
    inside = f'def Mesh "M" {{\n{QUAD}{by_index}}}\ndef Cube "C" {{\n{of_faces}}}\n'
    scene, report = scene_of(tmp_path, stage(body("B", inside=inside)))
    mesh, cube = scene.nodes[0].bodies
    assert [scene.surfaces[i].color for i in mesh.surfaces] == [(0.0, 1.0, 0.0, 1.0)]
    assert cube.surfaces == () and told(report) == {"dropped displayColor of /B/C"}


@pytest.mark.parametrize(
    ("stated", "feature"),
    [
        ("float inputs:ior = 1.8", "approximated ior"),
        ("float inputs:ior = 1.45", ""),
        ("float inputs:occlusion = 0.3", "dropped occlusion"),
        ("normal3f inputs:normal = (0, 1, 0)", "dropped normal"),
        ("float inputs:metallic = 2", "approximated metallic"),
        ("float inputs:roughness = -0.5", "approximated roughness"),
        ("float inputs:roughness = 1.00000001", ""),
        ("color3f inputs:diffuseColor = (3, 0.2, 0.3)", "approximated diffuseColor"),
    ],
)
def test_what_a_surface_of_unity_cannot_be_is_told(tmp_path, stated, feature):
    looks = MATERIAL.replace("   color3f inputs:diffuseColor = (0.1, 0.2, 0.3)\n", "")
    looks = looks.replace("float inputs:opacity = 0.5", stated)
    mesh = f'def Mesh "M" (prepend apiSchemas = ["MaterialBindingAPI"]) {{\nrel material:binding = </Looks/Plain>\n{QUAD}}}\n'
    scene, report = scene_of(tmp_path, stage(body("B", inside=mesh) + looks))
    assert told(report) == ({f"{feature} of /Looks/Plain/Shader"} if feature else set())
    assert painted(scene, "Plain").metallic == (1.0 if "metallic" in stated else 0.0)


def test_an_image_of_occlusion_that_is_multiplied_is_told(tmp_path):
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    looks = MATERIAL.replace(
        "color3f inputs:diffuseColor.connect = </Looks/Paint/Image.outputs:rgb>",
        "float inputs:occlusion.connect = </Looks/Paint/Image.outputs:r>",
    ).replace("   float3 outputs:rgb", "   float outputs:r\n   float4 inputs:scale = (0.5, 1, 1, 1)")
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    assert painted(scene).occlusion_texture is not None
    assert told(report) == {"approximated occlusion of /Looks/Paint/Shader"}


def test_a_material_that_is_bound_without_the_schema_is_taken_and_is_no_loss(tmp_path):
    """pxr takes it and warns, and most stages of before 2023 are so."""
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n" + bytes(40))
    bound = BOUND.replace('(prepend apiSchemas = ["MaterialBindingAPI"])', "")
    scene, report = scene_of(tmp_path, stage(body("B", inside=bound) + MATERIAL))
    assert [scene.surfaces[i].name for i in scene.nodes[0].bodies[0].surfaces] == ["Plain", "Paint"]
    assert told(report) == set()


@pytest.mark.parametrize(
    ("scale", "bias", "expected"),
    [
        ("(2, 2, 2, 1)", "(-1, -1, -1, 0)", None),
        ("(2, -2, 2, 1)", "(-1, 1, -1, 0)", (10, 55, 251)),
        ("(-2, 2, 1, 1)", "(1, -1, 0, 0)", (245, 200, 253)),
    ],
)
def test_normals_that_are_counted_otherwise_are_made_anew(tmp_path, scale, bias, expected):
    """With y downwards, as DirectX has it; with x the other way and z from 0 to 1."""
    Pillow = pytest.importorskip("PIL.Image", reason="Pillow is not installed")
    Pillow.new("RGB", (4, 2), (10, 200, 251)).save(tmp_path / "paint.png")
    looks = MATERIAL.replace(
        "color3f inputs:diffuseColor.connect = </Looks/Paint/Image.outputs:rgb>",
        "normal3f inputs:normal.connect = </Looks/Paint/Image.outputs:rgb>",
    ).replace(
        "   float3 outputs:rgb",
        f"   float3 outputs:rgb\n   float4 inputs:scale = {scale}\n   float4 inputs:bias = {bias}",
    )
    scene, report = scene_of(tmp_path, stage(body("B", inside=BOUND) + looks))
    image = painted(scene).normal_texture
    assert told(report) == set() and (image.path is not None) == (expected is None)
    if expected is not None:
        assert Pillow.open(io.BytesIO(image.data)).getpixel((3, 1)) == expected


OMNIPBR = """def Scope "Looks" {
 def Material "Paint" {
  token outputs:mdl:surface.connect = </Looks/Paint/Shader.outputs:out>
  color3f inputs:diffuse_tint = (0.5, 1, 0.25)
  def Shader "Shader" {
   uniform token info:implementationSource = "sourceAsset"
   uniform asset info:mdl:sourceAsset = @OmniPBR.mdl@
   SUB
   color3f inputs:diffuse_tint.connect = </Looks/Paint.inputs:diffuse_tint>
   STATED
   token outputs:out
  }
 }
}
"""
NAMED = 'uniform token info:mdl:sourceAsset:subIdentifier = "OmniPBR"'
PAINTED = (
    'def Mesh "M" (prepend apiSchemas = ["MaterialBindingAPI"]) {\nrel material:binding = </Looks/Paint>\n'
    + QUAD
    + SETS
    + "}\n"
)


def omni(tmp_path, stated: str, named: str = NAMED):
    """The surface of an OmniPBR with these inputs, and what is told of it."""
    looks = OMNIPBR.replace("SUB", named).replace("STATED", stated)
    scene, report = scene_of(tmp_path, stage(body("B", inside=PAINTED) + looks))
    return painted(scene), {o.feature.split(" of ")[0] for o in report.outcomes}


@pytest.mark.parametrize("named", [NAMED, ""])
def test_the_constants_of_an_omnipbr_are_the_material(tmp_path, named):
    stated = (
        "color3f inputs:diffuse_color_constant = (0.4, 0.6, 0.8)\nfloat inputs:metallic_constant = 0.25\n"
        "float inputs:reflection_roughness_constant = 0.7\nbool inputs:enable_emission = 0\n"
        "bool inputs:enable_opacity = 1\nfloat inputs:opacity_constant = 0.5\nasset inputs:diffuse_texture = @@"
    )
    paint, told = omni(tmp_path, stated, named)
    assert paint.color == pytest.approx((0.2, 0.6, 0.2, 0.5))
    assert (paint.metallic, paint.smoothness) == pytest.approx((0.25, 0.3))
    assert (paint.alpha_mode.value, paint.emission, told) == ("blend", (0, 0, 0), set())


def test_the_images_of_an_omnipbr_are_the_material_s(tmp_path):
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
    for name in ("paint", "orm"):
        image.new("RGB", (2, 2), (10, 20, 30)).save(tmp_path / f"{name}.png")
    image.new("RGB", (2, 2), (128, 40, 250)).save(tmp_path / "normal.png")
    stated = (
        "asset inputs:diffuse_texture = @paint.png@\nasset inputs:ORM_texture = @orm.png@\nbool inputs:enable_ORM_texture = 1\n"
        "float inputs:reflection_roughness_texture_influence = 1\nfloat inputs:metallic_texture_influence = 1\n"
        "float inputs:ao_to_diffuse = 1\nasset inputs:normalmap_texture = @normal.png@\nbool inputs:enable_emission = 1\n"
        "color3f inputs:emissive_color = (0, 2, 1)\nasset inputs:emissive_color_texture = @paint.png@\n"
        "float2 inputs:texture_scale = (3, 2)\nint inputs:uv_space_index = 1"
    )
    paint, told = omni(tmp_path, stated)
    assert paint.color == pytest.approx((0.5, 1.0, 0.25, 1.0))
    assert (paint.color_texture.name, paint.color_texture.uv_set, paint.color_texture.scale) == (
        "paint.png",
        1,
        (3, 2),
    )
    assert paint.metallic_roughness_texture.name == paint.occlusion_texture.name == "orm.png"
    assert (paint.metallic, paint.smoothness) == (1.0, 0.0)
    assert (paint.emission, paint.emission_texture.name) == ((0, 2, 1), "paint.png")
    with image.open(io.BytesIO(paint.normal_texture.data)) as found:  # y is downwards, as DirectX has it
        assert found.getpixel((0, 0)) == (128, 215, 250)
    assert told == {"emissive_intensity"}
    kept, _ = omni(tmp_path, "asset inputs:normalmap_texture = @normal.png@\nbool inputs:flip_tangent_v = 0")
    assert kept.normal_texture.name == "normal.png"


def test_what_an_omnipbr_has_and_unity_has_not_is_told(tmp_path):
    (tmp_path / "paint.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    stated = (
        "asset inputs:diffuse_texture = @paint.png@\nfloat inputs:albedo_desaturation = 0.5\nbool inputs:project_uvw = 1\n"
        "float inputs:reflection_roughness_texture_influence = 0.5\nasset inputs:reflectionroughness_texture = @paint.png@\n"
        "asset inputs:metallic_texture = @paint.png@\nasset inputs:detail_normalmap_texture = @paint.png@\n"
        "asset inputs:normalmap_texture = @gone.png@\nfloat inputs:specular_level = 1\n"
        "float inputs:metallic_constant.connect = </Looks/Paint/Other.outputs:out>\ntoken outputs:out\n}\n"
        'def Shader "Other" {\nuniform token info:id = "Noise"'
    )
    paint, told = omni(tmp_path, stated)
    assert paint.metallic == 0.0 and paint.color_texture.name == "paint.png"
    assert told >= {
        "albedo_desaturation", "project_uvw", "roughness", "detail_normalmap_texture", "normalmap_texture",
        "ior", "metallic_constant",
    }  # fmt: skip
