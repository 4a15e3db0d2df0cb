"""What is seen of a part: normals, texture coordinates, colours and textures, from scripts and from files."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab.diagnostics import Outcome, Report
from kinefab.geometry.files import read_mesh_file
from kinefab.geometry.looks.shading import shaded
from kinefab.geometry.looks.visuals import surface_of
from kinefab.model import AlphaMode, Mesh
from kinefab.unity.back.scene_file import read_scene
from trimesh.visual.material import PBRMaterial

RED = (1.0, 0.0, 0.0, 1.0)

OLD_TRIMESH = tuple(map(int, trimesh.__version__.split(".")[:2])) < (4, 6)


def exported(part, tmp_path, **options) -> tuple[dict, kinefab.ExportResult]:
    scene = kinefab.Scene()
    scene.add_part("Part", part, grounded=True)
    result = kinefab.export(scene, tmp_path / "p.kinefab", kinefab.ExportOptions(colliders="none", **options))
    return json.loads(result.path.read_text("utf-8")), result


def colors(content: dict) -> list[list[float]]:
    return [m.get("color", [0.8, 0.8, 0.8, 1.0]) for m in content["materials"]]


def mesh_of(shape: trimesh.Trimesh) -> Mesh:
    return Mesh("m", np.array(shape.vertices), np.array(shape.faces))


def soup(shape: trimesh.Trimesh) -> Mesh:
    corners = np.array(shape.vertices)[shape.faces].reshape(-1, 3)
    return Mesh("m", corners, np.arange(len(corners)).reshape(-1, 3))


def face_normals(mesh: Mesh) -> np.ndarray:
    a, b, c = (mesh.vertices[mesh.faces[:, i]] for i in range(3))
    across = np.cross(b - a, c - a)
    return across / np.linalg.norm(across, axis=1, keepdims=True)


@pytest.mark.parametrize("made", [mesh_of, soup])
def test_a_box_keeps_its_edges(made):
    """Each corner has a normal for each of its three sides, that side's own, whether or not vertices are shared."""
    found = shaded(made(trimesh.creation.box((0.4, 0.2, 0.3))), 30.0)
    assert found.normals is not None
    for corner in range(3):
        assert np.allclose(found.normals[found.faces[:, corner]], face_normals(found), atol=1e-12)
    assert len(np.unique(np.column_stack([found.vertices, found.normals]).round(6), axis=0)) == 24


def test_normals_are_the_same_where_a_processor_rounds_an_arc_cosine_differently(monkeypatch):
    """numpy takes AVX-512's own where there is one, which differs in the last bits: a file had normals of 2e-16, or of 0, and another name."""
    arccos, rng = np.arccos, np.random.default_rng(1)

    def rounded(x, out):
        out[...] = arccos(x) * (1.0 + rng.integers(-3, 4, np.shape(x)) * 1.1e-16)
        return out

    shapes = [trimesh.creation.cylinder(0.1, 0.3, sections=24), trimesh.creation.icosphere(2), trimesh.creation.cone(0.2, 0.5)]
    expected = [shaded(mesh_of(shape), 30.0).normals.astype(np.float32) for shape in shapes]
    monkeypatch.setattr(np, "arccos", rounded)
    for shape, normals in zip(shapes, expected):
        assert shaded(mesh_of(shape), 30.0).normals.astype(np.float32).tobytes() == normals.tobytes()


def test_a_cylinder_is_round_and_its_ends_are_flat():
    """Normals of the side point away from the axis to 1e-12, however its quads are cut; those of the ends along it."""
    found = shaded(mesh_of(trimesh.creation.cylinder(0.1, 0.3, sections=24)), 30.0)
    across = face_normals(found)
    side = np.abs(across[:, 2]) < 0.5
    at = found.faces[side].reshape(-1)
    outward = found.vertices[at] * [1.0, 1.0, 0.0]
    assert np.allclose(
        found.normals[at], outward / np.linalg.norm(outward, axis=1, keepdims=True), atol=1e-12
    )
    ends = found.faces[~side]
    assert np.allclose(found.normals[ends], across[~side][:, None], atol=1e-12)


def test_a_sphere_gets_no_further_vertex():
    """All edges below the angle: the vertices are what they were, the normals the directions from the middle to 1 degree."""
    ball = trimesh.creation.icosphere(subdivisions=3)
    found = shaded(mesh_of(ball), 30.0)
    assert np.array_equal(found.vertices, ball.vertices) and np.array_equal(found.faces, ball.faces)
    assert np.einsum("ij,ij->i", found.normals, found.vertices).min() > np.cos(np.radians(1.0))


@pytest.mark.parametrize("angle, sharp", [(10.0, True), (20.0, False)])
def test_the_angle_decides_which_edge_is_hard(angle, sharp):
    """A roof of 15 degrees between its sides: hard below, smooth above; the ridge's two vertices are the ones repeated."""
    slope = np.radians(7.5)
    y, z = np.cos(slope), np.sin(slope)
    vertices = np.array([[0, -y, -z], [1, -y, -z], [0, 0, 0], [1, 0, 0], [0, y, -z], [1, y, -z]], dtype=float)
    faces = np.array([[0, 1, 3], [0, 3, 2], [2, 3, 5], [2, 5, 4]])
    found = shaded(Mesh("roof", vertices, faces, uvs=(vertices[:, :2],)), angle)
    assert len(found.vertices) == (8 if sharp else 6)
    ridge = np.flatnonzero((found.vertices[:, 1:] == 0.0).all(axis=1))
    upward = found.normals[ridge] @ [0.0, 0.0, 1.0]
    assert np.allclose(upward, np.cos(slope) if sharp else 1.0, atol=1e-12)
    assert np.array_equal(found.uvs[0], found.vertices[:, :2])


def test_stated_normals_stay_and_none_are_made_when_not_asked(tmp_path):
    box = trimesh.creation.box((1, 1, 1))
    tilted = np.tile([0.6, 0.8, 0.0], (8, 1))
    stated = trimesh.Trimesh(box.vertices, box.faces, vertex_normals=tilted, process=False)
    content, result = exported(stated, tmp_path, smooth=10.0)
    mesh = result.unity.meshes[0]
    assert len(mesh.vertices) == 8 and np.allclose(np.abs(mesh.normals), [0.6, 0.8, 0.0])
    assert "normals" in content["meshes"][0]
    content, _ = exported(box, tmp_path, smooth=None)
    assert "normals" not in content["meshes"][0]
    content, _ = exported(box, tmp_path)
    assert content["meshes"][0]["vertexCount"] == 24 and "normals" in content["meshes"][0]


def test_normals_that_trimesh_computed_are_not_stated_ones(tmp_path):
    """Looking at a box's ``vertex_normals`` must not smooth its edges."""
    box = trimesh.creation.box((1, 1, 1))
    assert len(box.vertex_normals) == 8
    content, _ = exported(box, tmp_path)
    assert content["meshes"][0]["vertexCount"] == 24


def write_obj(folder: Path, name: str, kd: str, extra: str = "") -> Path:
    (folder / f"{name}.mtl").write_text(f"newmtl paint\nKd {kd}\nNs 100\n{extra}", "utf-8")
    path = folder / f"{name}.obj"
    path.write_text(
        f"mtllib {name}.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl paint\n"
        "f 1/1 3/3 2/2\nf 1/1 2/2 4/3\nf 1/1 4/3 3/3\nf 2/2 3/3 4/1\n",
        "utf-8",
    )
    return path


@pytest.mark.parametrize("loaded", [False, True])
def test_the_red_of_an_obj_arrives_through_a_script(loaded, tmp_path):
    """By its path or as what trimesh makes of it, with its texture coordinates."""
    path = write_obj(tmp_path, "red", "1 0 0")
    content, _ = exported(trimesh.load(path) if loaded else path, tmp_path)
    (material,) = content["materials"]
    assert material["color"] == [*RED]
    assert material["name"] == "paint" or (loaded and OLD_TRIMESH)  # it makes a material of its own of it
    assert material["smoothness"] == pytest.approx(1.0 - np.sqrt(2.0 / 102.0))
    assert "uv" in content["meshes"][0]


def test_two_files_may_call_different_looks_by_one_name(tmp_path):
    scene = kinefab.Scene()
    for name, kd in (("red", "1 0 0"), ("blue", "0 0 1")):
        scene.add_part(name, write_obj(tmp_path, name, kd), grounded=True)
    result = kinefab.export(scene, tmp_path / "two.kinefab")
    assert colors(json.loads(result.path.read_text("utf-8"))) == [[1, 0, 0, 1], [0, 0, 1, 1]]


def test_colours_of_faces_become_surfaces(tmp_path):
    """A submesh for each colour, sRGB to linear; no triangle is lost."""
    box = trimesh.creation.box((1, 1, 1))
    box.visual.face_colors = [[255, 0, 0, 255]] * 2 + [[0, 128, 255, 255]] * 9 + [[255, 0, 0, 255]]
    content, _ = exported(box, tmp_path)
    assert np.allclose(colors(content), [[1, 0, 0, 1], [0, 0.21586, 1, 1]], atol=1e-5)
    assert [s["indexCount"] for s in content["meshes"][0]["submeshes"]] == [9, 27]
    (renderer,) = (
        c for o in content["gameObjects"] for c in o.get("components", ()) if c["type"] == "MeshRenderer"
    )
    assert renderer["materials"] == [0, 1]


def test_one_colour_of_all_vertices_is_a_surface_many_are_the_mesh_s(tmp_path):
    """Colours that differ stand in the buffer, four floats a vertex."""
    ball = trimesh.creation.icosphere(subdivisions=1)
    ball.visual.vertex_colors = [255, 0, 0, 255]
    content, _ = exported(ball, tmp_path)
    assert colors(content) == [[1, 0, 0, 1]]
    ball.visual.vertex_colors = np.arange(len(ball.vertices) * 4).reshape(-1, 4).astype(np.uint8)
    content, result = exported(ball, tmp_path)
    _, (buffer,) = read_scene(result.path)
    place = content["meshes"][0]["colors"]["offset"]
    held = np.frombuffer(buffer, "<f4", 4 * len(ball.vertices), place).reshape(-1, 4)
    assert (held == result.unity.meshes[0].colors).all() and content["version"] == "1.1"
    assert all(o.code != "TARGET_FIELD_DROPPED" for o in result.report.outcomes)


def test_more_colours_than_surfaces_stay_apart_at_the_corners(tmp_path):
    ball = trimesh.creation.icosphere(subdivisions=2)
    ball.visual.face_colors = np.column_stack([np.arange(320) % 256, np.arange(320) // 256] * 2).astype(
        np.uint8
    )
    _, result = exported(ball, tmp_path)
    mesh = result.unity.meshes[0]
    of_faces = mesh.colors[mesh.triangles]
    assert np.ptp(of_faces, axis=1).max() == 0.0 and len(np.unique(of_faces[:, 0], axis=0)) == 320


def painted(**more) -> trimesh.Trimesh:
    box = trimesh.creation.box((1, 1, 1))
    material = PBRMaterial(
        name="lacquer", baseColorFactor=[51, 102, 153, 255], metallicFactor=0.25, roughnessFactor=0.4,
        emissiveFactor=[0.0, 0.5, 1.0], doubleSided=True, alphaMode="MASK", alphaCutoff=0.3, **more,
    )  # fmt: skip
    box.visual = trimesh.visual.TextureVisuals(uv=np.array(box.vertices)[:, :2] + 0.5, material=material)
    return box


@pytest.mark.parametrize(
    "mode, expected",
    [("OPAQUE", (1.0, AlphaMode.OPAQUE)), ("BLEND", (0.2, AlphaMode.BLEND)), (None, (1.0, AlphaMode.OPAQUE))],
)
def test_alpha_of_what_gltf_calls_opaque_is_not_seen(mode, expected, tmp_path):
    """OPAQUE is also what glTF means where no mode stands."""
    box = trimesh.creation.box((1, 1, 1))
    material = PBRMaterial(name="lacquer", baseColorFactor=[51, 102, 153, 51], alphaMode=mode)
    box.visual = trimesh.visual.TextureVisuals(uv=np.array(box.vertices)[:, :2], material=material)
    box.export(tmp_path / "p.glb")
    _, result = exported(tmp_path / "p.glb", tmp_path)
    (found,) = result.unity.materials
    assert (pytest.approx(found.color[3]), found.alphaMode) == expected


@pytest.mark.parametrize("through_file", [False, True])
def test_a_pbr_material_arrives_whole(through_file, tmp_path):
    """Factors, modes and textures, from a script's mesh or through a GLB."""
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
    shades = {
        f"{role}Texture": image.new("RGB", (2, 2), (i, 7, 9))
        for i, role in enumerate(("baseColor", "metallicRoughness", "normal", "emissive", "occlusion"))
    }
    part = painted(**shades)
    if through_file:
        part.export(tmp_path / "p.glb")
        part = tmp_path / "p.glb"
    _, result = exported(part, tmp_path)
    (found,) = result.unity.materials
    assert found.name == "lacquer"
    assert np.allclose(found.color, (0.2, 0.4, 0.6, 1.0)) and found.metallic == 0.25
    assert found.smoothness == pytest.approx(0.6) and found.emission == (0.0, 0.5, 1.0)
    analysed = result.content.scene.surfaces[0]
    assert analysed.alpha_mode is AlphaMode.MASK and analysed.alpha_cutoff == 0.3 and analysed.double_sided
    textures = (
        analysed.color_texture, analysed.metallic_roughness_texture, analysed.normal_texture,
        analysed.emission_texture, analysed.occlusion_texture,
    )  # fmt: skip
    assert all(t.data.startswith(b"\x89PNG") and t.media_type == "image/png" for t in textures)
    assert len({t.name for t in textures}) == 5
    assert result.unity.meshes[0].uvs[0].shape == (len(result.unity.meshes[0].vertices), 2)
    told = {o.message for o in result.report.outcomes if o.outcome is Outcome.DROPPED}
    assert sum("Texture of" in message for message in told) == 5


@pytest.mark.parametrize(
    "made, through_file",
    [(PBRMaterial, False), (PBRMaterial, True), (trimesh.visual.material.SimpleMaterial, False)],
)
def test_a_picture_is_multiplied_with_white_where_no_colour_is_stated(made, through_file, tmp_path):
    """As glTF says, and as scripts mean it; trimesh has a grey of 0.4 for what nobody states."""
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed").new("RGB", (2, 2), (9, 8, 7))
    part = trimesh.creation.box((1, 1, 1))
    material = made(**{"baseColorTexture" if made is PBRMaterial else "image": image})
    part.visual = trimesh.visual.TextureVisuals(uv=np.array(part.vertices)[:, :2], material=material)
    if through_file:
        files = trimesh.Scene(part).export(file_type="gltf")
        document = json.loads(files["model.gltf"])
        assert "baseColorFactor" not in document["materials"][0]["pbrMetallicRoughness"]
        for name, data in files.items():
            (tmp_path / name).write_bytes(data)
        part = tmp_path / "model.gltf"
    _, result = exported(part, tmp_path)
    (found,) = result.unity.materials
    assert found.color == (1.0, 1.0, 1.0, 1.0) and found.colorTexture is not None


@pytest.mark.parametrize("kind, mode", [("PNG", "RGBA"), ("JPEG", "RGB"), ("JPEG", "CMYK"), ("BMP", "RGB")])
def test_an_image_that_is_read_stays_the_file_that_it_was(kind, mode):
    """PNG and JPEG byte for byte; what not every target takes, or what a script has changed, is packed as PNG."""
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
    written = io.BytesIO()
    image.effect_noise((16, 8), 40).convert(mode).save(written, format=kind)
    opened = [image.open(io.BytesIO(written.getvalue())) for _ in range(2)]
    opened[1].putpixel((3, 3), tuple(range(len(mode))))
    found = [surface_of(PBRMaterial(baseColorTexture=each)).color_texture for each in opened]
    kept = kind != "BMP" and mode != "CMYK"
    assert (found[0].data == written.getvalue()) == kept
    ending, media = ("jpg", "image/jpeg") if kept and kind == "JPEG" else ("png", "image/png")
    assert found[0].name.endswith(f".{ending}") and found[0].media_type == media
    for texture in found:
        with image.open(io.BytesIO(texture.data)) as again:
            assert again.size == (16, 8)
    assert found[1].data.startswith(b"\x89PNG") and found[1].data != found[0].data


def test_an_obj_s_textures_are_named_or_told(tmp_path):
    """A picture beside it is kept with its scale and offset; one outside, one missing and a height map are told."""
    (tmp_path / "wood.png").write_bytes(b"\x89PNG")
    path = write_obj(
        tmp_path, "o", "0.5 0.5 0.5",
        "map_Kd -s 2 3 1 -o 0.25 wood.png\nmap_Ke ../secret.png\nnorm gone.png\nmap_Bump high.png\n",
    )  # fmt: skip
    report = Report()
    file = read_mesh_file(path, report, "here")
    surface = file.surfaces["paint"]
    assert surface.color_texture.path == tmp_path / "wood.png" and surface.color == pytest.approx(
        (0.21404, 0.21404, 0.21404, 1.0), abs=1e-5
    )
    assert surface.color_texture.scale == (2.0, 3.0) and surface.color_texture.offset == (0.25, 0.0)
    assert surface.normal_texture is None and surface.emission_texture is None
    lost = [o for o in report.outcomes if o.code == "TEXTURE_UNREADABLE"]
    assert [o.feature for o in lost] == [f"texture {n}" for n in ("../secret.png", "gone.png", "high.png")]
    assert all(o.outcome is Outcome.DROPPED for o in lost)


@pytest.mark.parametrize("mark", ["model.config", "package.xml", ""])
def test_pictures_may_lie_anywhere_in_the_model_that_the_mesh_is_part_of(mark, tmp_path):
    """Gazebo's models keep them in materials/textures, beside meshes; what is out of the model is not read."""
    for folder in ("model/meshes", "model/materials/textures"):
        (tmp_path / folder).mkdir(parents=True)
    for place in ("model/materials/textures/hull.png", "secret.png"):
        (tmp_path / place).write_bytes(b"\x89PNG")
    if mark:
        (tmp_path / "model" / mark).write_text("<x/>", "utf-8")
    statements = "map_Kd ../materials/textures/hull.png\nmap_Ke ../../secret.png\n"
    path = write_obj(tmp_path / "model/meshes", "o", "1 1 1", statements)
    surface = read_mesh_file(path, report := Report(), "here").surfaces["paint"]
    assert (surface.color_texture is not None) == bool(mark) and surface.emission_texture is None
    lost = {o.feature for o in report.outcomes if o.code == "TEXTURE_UNREADABLE"}
    assert "texture ../../secret.png" in lost and len(lost) == (1 if mark else 2)
    (tmp_path / "package.xml").write_text("<package/>", "utf-8")  # models of one package share its images
    read_mesh_file(path, report := Report(), "here")
    assert not [o for o in report.outcomes if o.code == "TEXTURE_UNREADABLE"]


def test_an_obj_s_library_is_parted_by_tabs_and_words_of_any_case(tmp_path):
    """Each picture belongs to the material that it stands under, whatever the blanks, and the last statement rules."""
    for name in ("oak.png", "ash.png", "old.png"):
        (tmp_path / name).write_bytes(b"\x89PNG")
    path = write_obj(
        tmp_path,
        "o",
        "0.5 0.5 0.5",
        "\tmap_Kd\told.png\nMAP_KD\toak.png\nNewMtl\tash  grey\n  KD\t0.25 0.5 0.75\n map_ke \t ash.png \n",
    )
    path.write_text(path.read_text("utf-8") + "usemtl ash grey\nf 1/1 2/2 3/3\n", "utf-8")
    report = Report()
    surfaces = read_mesh_file(path, report, "here").surfaces
    paint, ash = surfaces["paint"], surfaces["ash grey"]
    assert paint.color_texture.path == tmp_path / "oak.png" and paint.emission_texture is None
    assert ash.emission_texture.path == tmp_path / "ash.png" and ash.color_texture is None
    assert ash.color == pytest.approx((0.05088, 0.21404, 0.52252, 1.0), abs=1e-5)
    assert ash.emission == (1.0, 1.0, 1.0)
    assert [o for o in report.outcomes if o.code == "TEXTURE_UNREADABLE"] == []


@pytest.mark.skipif(OLD_TRIMESH, reason="trimesh before 4.6 reads no glTF that lacks a picture")
def test_a_picture_that_a_gltf_cannot_read_is_told(tmp_path):
    image = pytest.importorskip("PIL.Image", reason="pillow is not installed")
    files = painted(baseColorTexture=image.new("RGB", (2, 2))).export(file_type="gltf", merge_buffers=True)
    text = trimesh.Scene(painted(baseColorTexture=image.new("RGB", (2, 2)))).export(file_type="gltf")
    del files
    for name, data in text.items():
        if name.endswith(".gltf"):
            document = json.loads(data)
            document["images"] = [{"uri": "gone.png"}]
            data = json.dumps(document).encode()
        (tmp_path / name).write_bytes(data)
    report = Report()
    assert read_mesh_file(tmp_path / "model.gltf", report, "here") is not None
    assert [(o.feature, o.code) for o in report.outcomes] == [("texture gone.png", "TEXTURE_UNREADABLE")]


DAE = """<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/><library_effects><effect id="e">
<profile_COMMON><technique sid="c"><phong><emission><color>0.5 0 0 1</color></emission><diffuse><color>0.2 0.4 0.6 1</color></diffuse>
</phong></technique></profile_COMMON></effect></library_effects><library_materials><material id="m" name="m">
<instance_effect url="#e"/></material></library_materials><library_geometries><geometry id="g"><mesh><source id="p">
<float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common><accessor source="#a" count="3" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices><triangles material="s" count="1">
<input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node id="n"><instance_geometry url="#g"><bind_material><technique_common>
<instance_material symbol="s" target="#m"/></technique_common></bind_material></instance_geometry></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>"""


@pytest.mark.parametrize("suffix", [".obj", ".dae"])
def test_a_phong_material_s_colours_are_those_of_the_screen(suffix, tmp_path):
    """RViz, Gazebo, Unity's own importer show the numbers of the file; a scene's are linear, so they are sRGB."""
    path = write_obj(tmp_path, "m", "0.2 0.4 0.6", "Ke 0.5 0 0\n")
    if suffix == ".dae":
        pytest.importorskip("collada", reason="pycollada is not installed")
        path = tmp_path / "m.dae"
        path.write_text(DAE, "utf-8")
    (surface,) = read_mesh_file(path, Report(), "here").surfaces.values()
    assert surface.color == pytest.approx((0.03310, 0.13287, 0.31855, 1.0), abs=1e-5)
    assert surface.emission == pytest.approx((0.21404, 0.0, 0.0), abs=1e-5)


def test_an_obj_s_physical_numbers_and_colours_of_vertices_are_kept(tmp_path):
    """Pr and Pm beside Ns, which they rule over; colours behind the places of vertices, sRGB as MeshLab writes them."""
    path = write_obj(tmp_path, "p", "0.2 0.4 0.6", "Pr 0.3\nPm 0.9\n")
    (surface,) = read_mesh_file(path, Report(), "here").surfaces.values()
    assert (surface.metallic, surface.smoothness) == pytest.approx((0.9, 0.7))
    bare = tmp_path / "colored.obj"
    bare.write_text("v 0 0 0 1 0 0\nv 1 0 0 0 0.5 0\nv 0 1 0 0 0 1\nvt 0 0\nf 3/1 2/1 1/1\n", "utf-8")
    file = read_mesh_file(bare, Report(), "here")
    (piece,) = file.pieces
    order = np.lexsort(piece.vertices.T)
    assert np.allclose(piece.colors[order], [[1, 0, 0, 1], [0, 0.21404, 0, 1], [0, 0, 1, 1]], atol=1e-5)
    assert file.surfaces[piece.surfaces[0]].color == (1.0, 1.0, 1.0, 1.0)
    bare.write_text(bare.read_text("utf-8").replace("1 0 0 0 0.5 0", "1 0 0"), "utf-8")
    assert read_mesh_file(bare, Report(), "here").pieces[0].colors is None


def stl(head: bytes, marks: list[int]) -> bytes:
    shape = trimesh.creation.box((1, 1, 1))
    body = b"".join(
        np.float32([[0, 0, 1], *corners]).tobytes() + mark.to_bytes(2, "little")
        for corners, mark in zip(shape.triangles, marks)
    )
    return head.ljust(80, b" ") + (12).to_bytes(4, "little") + body


@pytest.mark.parametrize(
    "head, marks, expected",
    [
        (
            b"",
            [0x8000 | 31 << 10] * 6 + [0x8000 | 31] * 6,
            [[1, 0, 0, 1], [0, 0, 1, 1]],
        ),  # VisCAM: red on top
        (
            b"COLOR=\x00\xff\x00\xff",
            [31] * 6 + [0x8000] * 6,
            [[1, 0, 0, 1], [0, 1, 0, 1]],
        ),  # Magics: red below
        (b"", [0] * 12, []),
        (b"", [7] * 12, []),
    ],
)
def test_colours_of_an_stl_are_kept(head, marks, expected, tmp_path):
    (tmp_path / "c.stl").write_bytes(stl(head, marks))
    surfaces = read_mesh_file(tmp_path / "c.stl", Report(), "here").surfaces
    assert [list(surface.color) for surface in surfaces.values()] == expected


def test_looks_of_a_collada_file_that_are_passed_over_are_told(tmp_path):
    """Colours of vertices, transparency, pictures of what glows: trimesh would show the base colour's there."""
    pytest.importorskip("collada", reason="pycollada is not installed")
    path = tmp_path / "m.dae"
    path.write_text(DAE, "utf-8")
    assert read_mesh_file(path, report := Report(), "here") is not None and report.outcomes == []
    text = DAE.replace("</phong>", "<transparency><float>0.3</float></transparency></phong>").replace(
        'offset="0"/><p>0 1 2', 'offset="0"/><input semantic="COLOR" source="#p" offset="0"/><p>0 1 2'
    )
    path.write_text(text, "utf-8")
    read_mesh_file(path, report, "here")
    told = [(o.feature, o.code) for o in report.outcomes]
    assert told == [("colors of vertices", "MESH_LOOK"), ("transparency", "MESH_LOOK")]


@pytest.mark.parametrize("colors, told", [('displaycolor="#FF0000"', ["colors"]), ("", [])])
def test_colours_of_a_3mf_are_told(colors, told, tmp_path):
    for module in ("networkx", "lxml"):
        pytest.importorskip(module, reason=f"{module} is not installed")
    base = f'<basematerials id="5"><base name="Red" {colors}/></basematerials>' if colors else ""
    corners = "".join(f'<vertex x="{x}" y="{y}" z="0"/>' for x, y in ((0, 0), (1, 0), (0, 1)))
    with zipfile.ZipFile(tmp_path / "c.3mf", "w") as archive:
        archive.writestr(
            "3D/3dmodel.model",
            f'<model xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>{base}<object id="1">'
            f'<mesh><vertices>{corners}</vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object>'
            '</resources><build><item objectid="1"/></build></model>',
        )
    assert read_mesh_file(tmp_path / "c.3mf", report := Report(), "here") is not None
    assert [o.feature for o in report.outcomes] == told
