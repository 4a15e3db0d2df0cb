"""What a prefab cannot hold is told by name; names, images and sizes that Unity cannot take."""

from __future__ import annotations

import io
from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
import trimesh
from kinefab import model
from kinefab.model import ColliderKind
from kinefab.spatial import Pose
from kinefab.targets.prefab.names import file_name, object_name, sibling_names, unique
from prefab_reader import Node, Project, read_mesh, read_prefab, vector
from prefab_scenes import block, png, rich_scene
from unity_yaml import documents, mapping


def exported(scene, folder: Path, **writing) -> kinefab.ExportResult:
    (folder / "out").mkdir(exist_ok=True)
    return kinefab.export(scene, folder / "out" / "Rich.prefab", kinefab.ExportOptions(writing=writing))


def told(result: kinefab.ExportResult) -> set[tuple[str, str]]:
    return {(o.feature, o.code) for o in result.report.outcomes if o.outcome.value != "kept"}


def material(folder: Path, name: str) -> dict:
    found = documents((folder / "out" / "Rich" / "Materials" / f"{name}.mat").read_text("utf-8"))
    return found[0].fields


def properties(fields: dict, kind: str) -> dict:
    return {k: v for entry in fields["m_SavedProperties"][kind] for k, v in entry.items()}


@pytest.mark.parametrize("writing", [{}, {"unity": "2021"}, {"physics": "articulation"}])
def test_what_is_told_as_lost_is_not_told_as_kept_too(tmp_path, writing):
    """Couplings without a script, and fields of joints that only an earlier stage kept."""
    scene = rich_scene(tmp_path)
    scene.joints = [j for j in scene.joints if j.id != "Snap"]  # which no articulation has
    result = exported(scene, tmp_path, **writing)
    outcomes = result.report.outcomes
    lost = {o.feature for o in outcomes if o.outcome.value != "kept"}
    assert "coupling Gear" in lost
    assert not lost & {o.feature for o in outcomes if o.outcome.value == "kept" and not o.code}


def test_layers_tags_and_what_2021_has_no_place_for(tmp_path):
    found = told(exported(rich_scene(tmp_path), tmp_path, unity="2021"))
    assert ("layer Scenery of Top/Base", "TARGET_LAYER_OF_PROJECT") in found
    assert ("tag Ground of Top/Base", "TARGET_TAG_OF_PROJECT") in found
    assert ("centre of mass and inertia of Top/Arm:1", "TARGET_MASS_DROPPED") in found
    assert ("other side of material Glass", "LOOK_NOT_SHOWN") in found  # Standard has no other side
    later = told(exported(rich_scene(tmp_path), tmp_path, pipeline="urp"))
    assert (
        not any(code == "TARGET_MASS_DROPPED" for _, code in later)
        and ("other side of material Glass", "LOOK_NOT_SHOWN") not in later
    )
    with pytest.raises(kinefab.KinefabError):
        kinefab.export(
            rich_scene(tmp_path),
            tmp_path / "S.prefab",
            kinefab.ExportOptions(strict=True, writing={"unity": "2021"}),
        )
    assert not (tmp_path / "S.prefab").exists()


TAG_MANAGER = """%YAML 1.1
%TAG !u! tag:unity3d.com,2011:
--- !u!78 &1
TagManager:
  serializedVersion: 2
  tags:
  - Ground
  - 'It''s: "odd"'
  layers:
  - Default
  - TransparentFX
  - Ignore Raycast
  -
  - Water
  - UI
  -
  -
  - "Pass\\xE9 & co"
  - Scenery
  -
  m_SortingLayers:
  - name: Default
    uniqueID: 0
    locked: 0
"""


def project(folder: Path, tags: str = TAG_MANAGER) -> Path:
    """The Assets of a Unity project with these layers and tags."""
    (folder / "ProjectSettings").mkdir()
    (folder / "ProjectSettings" / "TagManager.asset").write_text(tags, "utf-8")
    (folder / "Assets").mkdir()
    return folder / "Assets" / "Rich.prefab"


def words(prefab: Path) -> dict[str, tuple[int, str]]:
    """Layer and tag of each object, by name."""
    found = [d.fields for d in documents(prefab.read_text("utf-8")) if d.kind == "GameObject"]
    return {str(o["m_Name"]): (int(o["m_Layer"]), o["m_TagString"]) for o in found}


def test_layers_and_tags_are_the_projects(tmp_path):
    """By the list of the project that the prefab stands in; outside any the tag is kept by its word, which is told."""
    result = kinefab.export(rich_scene(tmp_path), project(tmp_path))
    assert words(result.path)["Base"] == (9, "Ground")
    assert {o for o in words(result.path).values()} == {(9, "Ground"), (0, "Untagged")}
    assert not any(feature.startswith(("layer", "tag")) for feature, _ in told(result))
    assert words(exported(rich_scene(tmp_path), tmp_path).path)["Base"] == (0, "Ground")


@pytest.mark.parametrize("word", ["Scenery", "Water", "Pass\xe9 & co", "Default"])
def test_a_layer_of_any_spelling_has_its_number(tmp_path, word):
    scene = rich_scene(tmp_path)
    scene.nodes = [replace(n, layer=word, tag="It's: \"odd\"") if n.name == "Base" else n for n in scene.nodes]
    number = {"Scenery": 9, "Water": 4, "Pass\xe9 & co": 8, "Default": 0}[word]
    assert words(kinefab.export(scene, project(tmp_path)).path)["Base"] == (number, "It's: \"odd\"")


def test_what_the_project_lacks_is_told_once(tmp_path):
    scene = rich_scene(tmp_path)
    scene.nodes = [replace(n, layer="Robots", tag="Robots") for n in scene.nodes]
    result = kinefab.export(scene, project(tmp_path))
    assert set(words(result.path).values()) == {(0, "Untagged")}
    (layer, tag) = (d for d in result.report.diagnostics if d.code == "UNITY_LAYER_OR_TAG_MISSING")
    assert f"no layer Robots, which {len(scene.nodes)} object(s)" in layer.message and "no tag Robots" in tag.message


@pytest.mark.parametrize("text", ["", "\0binary", "%YAML 1.1\nTagManager:\n  layers: []\n", "%YAML 1.1\n  layers:\n  - \"\\"])
def test_a_list_that_cannot_be_read_stands_in_nobodys_way(tmp_path, text):
    result = kinefab.export(rich_scene(tmp_path), project(tmp_path, text))
    assert words(result.path)["Base"][0] == 0
    assert any(feature == "layer Scenery of Top/Base" for feature, _ in told(result))


def test_project_settings_are_told(tmp_path):
    scene = rich_scene(tmp_path)
    scene.physics = model.Physics(gravity=(0, 0, 0), solver_iterations=20)
    found = {feature for feature, _ in told(exported(scene, tmp_path))}
    assert {"project setting gravity", "project setting solverIterations"} <= found
    messages = [d.message for d in exported(scene, tmp_path).report.diagnostics if d.code == "TARGET_PROJECT_SETTING"]
    assert any("solverIterations 20," in message for message in messages)


@pytest.mark.parametrize("word", [{"unity": "5"}, {"pipeline": "own"}, {"physics": "none"}])
def test_a_word_that_is_none_is_refused(tmp_path, word):
    with pytest.raises(ValueError):
        exported(rich_scene(tmp_path), tmp_path, **word)


KEYWORDS = {
    "builtin": {
        "Glass": {"_ALPHAPREMULTIPLY_ON"},
        "Mesh": {"_ALPHATEST_ON"},
        "Lamp": {"_NORMALMAP", "_EMISSION", "_METALLICGLOSSMAP"},
    },
    "urp": {
        "Glass": {"_ALPHAPREMULTIPLY_ON", "_SURFACE_TYPE_TRANSPARENT"},
        "Mesh": {"_ALPHATEST_ON"},
        "Lamp": {"_NORMALMAP", "_EMISSION", "_METALLICSPECGLOSSMAP", "_OCCLUSIONMAP"},
    },
    "hdrp": {
        "Glass": {"_SURFACE_TYPE_TRANSPARENT", "_ENABLE_FOG_ON_TRANSPARENT", "_DOUBLESIDED_ON"},
        "Mesh": {"_ALPHATEST_ON"},
        "Lamp": {"_NORMALMAP", "_MASKMAP", "_EMISSIVE_COLOR_MAP"},
    },
}
SLOTS = {
    "builtin": (
        "_MainTex",
        "_BumpMap",
        "_MetallicGlossMap",
        "_EmissionMap",
        "_Color",
        "_EmissionColor",
        "_Glossiness",
    ),
    "urp": (
        "_BaseMap",
        "_BumpMap",
        "_MetallicGlossMap",
        "_EmissionMap",
        "_BaseColor",
        "_EmissionColor",
        "_Smoothness",
    ),
    "hdrp": (
        "_BaseColorMap",
        "_NormalMap",
        "_MaskMap",
        "_EmissiveColorMap",
        "_BaseColor",
        "_EmissiveColor",
        "_Smoothness",
    ),
}


@pytest.mark.parametrize("pipeline", KEYWORDS)
def test_each_pipeline_gets_its_keywords_maps_and_colours(tmp_path, pipeline):
    pytest.importorskip("PIL", reason="pillow, which repacks maps, is not installed")
    exported(rich_scene(tmp_path), tmp_path, pipeline=pipeline)
    always = {"_DISABLE_SSR_TRANSPARENT", "_NORMALMAP_TANGENT_SPACE"} if pipeline == "hdrp" else set()
    for name, expected in {**KEYWORDS[pipeline], "Steel": set()}.items():
        assert set(material(tmp_path, name)["m_ValidKeywords"]) == expected | always
    base, bump, mask, glow, color, emission, smooth = SLOTS[pipeline]
    project, lamp = Project(tmp_path / "out"), material(tmp_path, "Lamp")
    maps = properties(lamp, "m_TexEnvs")
    names = [project.paths[maps[slot]["m_Texture"]["guid"]].name for slot in (base, bump, mask, glow)]
    assert names == ["Wood.png", "Bumps normal.png", "Lamp mask.png", "Glow.png"] or names[0].startswith(
        "Wood"
    )
    assert vector(maps[base]["m_Scale"]) == [2, 3] and vector(maps[base]["m_Offset"]) == [0.25, 0.5]
    steel = material(tmp_path, "Steel")
    shown = vector(properties(steel, "m_Colors")[color])
    assert shown == pytest.approx([0.735357, 0.537099, 0.349190, 1.0], abs=1e-5)  # sRGB of 0.5, 0.25, 0.1
    assert vector(properties(lamp, "m_Colors")[emission]) == [2, 1, 0, 1]
    assert float(properties(steel, "m_Floats")[smooth]) == pytest.approx(0.6)
    queues = {n: int(material(tmp_path, n)["m_CustomRenderQueue"]) for n in ("Glass", "Mesh")}
    assert queues["Glass"] == 3000 and queues["Mesh"] == (2475 if pipeline == "hdrp" else 2450)
    imported = mapping((tmp_path / "out" / "Rich" / "Textures" / "Bumps normal.png.meta").read_text())[
        "TextureImporter"
    ]
    assert imported["textureType"] == "1" and imported["mipmaps"]["sRGBTexture"] == "0"


def test_the_mask_holds_metallic_occlusion_and_smoothness(tmp_path):
    """Worked out from the pixels that were written, with the material's own factors."""
    Pillow = pytest.importorskip("PIL.Image")
    scene = rich_scene(tmp_path)
    exported(scene, tmp_path)
    read = lambda path: np.asarray(Pillow.open(io.BytesIO(path.read_bytes())).convert("RGBA"), dtype=float)  # noqa: E731
    source, mask = (
        read(tmp_path / "Rough.png"),
        read(tmp_path / "out" / "Rich" / "Textures" / "Lamp mask.png"),
    )
    lamp = scene.surfaces[3]
    assert np.abs(mask[..., 0] - lamp.metallic * source[..., 2]).max() <= 0.5
    assert np.array_equal(mask[..., 1], source[..., 0])
    assert np.abs(mask[..., 3] - (255 - (1 - lamp.smoothness) * source[..., 1])).max() <= 0.5


def test_a_normal_map_gets_tangents(tmp_path):
    """Along +u, across the normal; the bitangent w (n x t) along +v."""
    result = exported(rich_scene(tmp_path), tmp_path)
    (path,) = [p for p in result.files if p.name == "Arm.asset"]
    (document,) = documents(path.read_text("utf-8"))
    mesh = read_mesh(document)
    points, normals, tangents, uv = (mesh["channels"][i].astype(float) for i in (0, 1, 2, 4))
    assert np.allclose(np.linalg.norm(tangents[:, :3], axis=1), 1, atol=1e-6) and set(tangents[:, 3]) <= {
        -1.0,
        1.0,
    }
    for a, b, c in np.vstack(mesh["submeshes"]):
        along = np.linalg.solve(
            np.array([uv[b] - uv[a], uv[c] - uv[a]]), np.array([points[b] - points[a], points[c] - points[a]])
        )
        u, v = along / np.linalg.norm(along, axis=1, keepdims=True)
        assert np.allclose(tangents[a, :3], u, atol=1e-5)
        assert np.allclose(tangents[a, 3] * np.cross(normals[a], tangents[a, :3]), v, atol=1e-5)
    (plain,) = [p for p in result.files if p.name == "Plate.asset"]
    assert 2 not in read_mesh(documents(plain.read_text("utf-8"))[0])["channels"]


@pytest.mark.parametrize("fault", ["missing", "empty", "no image", "breaks off"])
def test_an_unreadable_image_is_told_and_its_material_stays(tmp_path, fault):
    scene = rich_scene(tmp_path)
    whole = (tmp_path / "Wood.png").read_bytes()
    wrong = {"empty": b"", "no image": b"RIFF....WEBPVP8 ", "breaks off": whole[:-30]}
    (tmp_path / "Wood.png").unlink() if fault == "missing" else (tmp_path / "Wood.png").write_bytes(
        wrong[fault]
    )
    found = told(exported(scene, tmp_path))
    assert ("color texture of material Mesh", "TEXTURE_NOT_WRITTEN") in found
    assert properties(material(tmp_path, "Mesh"), "m_TexEnvs")["_MainTex"]["m_Texture"] == {"fileID": "0"}


def test_a_texture_in_the_source_and_how_it_lies(tmp_path):
    scene = rich_scene(tmp_path)
    data = (tmp_path / "Wood.png").read_bytes()
    odd = model.Texture("a/b", data=data, rotation=0.5, uv_set=1)
    scene.surfaces[0] = replace(scene.surfaces[0], color_texture=odd)
    found = [
        (o.feature, o.message)
        for o in exported(scene, tmp_path).report.outcomes
        if o.code == "TARGET_FIELD_DROPPED"
    ]
    assert sum(feature.endswith(" of color texture of material Steel") for feature, _ in found) == 2
    assert (tmp_path / "out" / "Rich" / "Textures" / "a_b.png").read_bytes() == data


def test_a_collider_without_size_is_left_out(tmp_path):
    scene = rich_scene(tmp_path)
    shapes = (
        model.Collider(ColliderKind.SPHERE, radius=0.0, name="dot"),
        model.Collider(ColliderKind.BOX, size=(0.0, 0.0, 0.3)),
        model.Collider(ColliderKind.BOX, size=(0.1, 0.0, 0.3)),
    )
    scene.nodes[2] = replace(scene.nodes[2], colliders=shapes)
    result = exported(scene, tmp_path)
    codes = [o.feature for o in result.report.outcomes if o.code == "COLLIDER_EMPTY"]
    assert codes == ["SphereCollider dot of Top/Arm:1", "BoxCollider of Top/Arm:1"]
    text = (tmp_path / "out" / "Rich.prefab").read_text()
    assert "m_Radius: 0\n" not in text
    read_prefab(tmp_path / "out" / "Rich.prefab")


@pytest.mark.parametrize("moves", [True, False])
def test_a_cylinder_or_mesh_without_volume_is_left_out(tmp_path, moves):
    """PhysX cooks no hull of them, and Unity says so in the console of whoever opens the prefab."""
    scene = rich_scene(tmp_path)
    mesh = scene.nodes[1].bodies[0].mesh
    shapes = (
        model.Collider(ColliderKind.CYLINDER, radius=0.0, length=0.3, name="needle"),
        model.Collider(ColliderKind.CYLINDER, radius=0.2, length=0.0, name="coin"),
        model.Collider(ColliderKind.HULL, mesh=mesh, scale=(1.0, 0.0, 2.0), name="sheet"),
        model.Collider(ColliderKind.MESH, mesh=mesh, scale=(1.0, 0.0, 2.0), name="floor"),
        model.Collider(ColliderKind.MESH, mesh=mesh, scale=(1.0, 0.0, 0.0), name="wire"),
    )
    index = 2 if moves else 1
    scene.nodes[index] = replace(scene.nodes[index], colliders=shapes)
    result = exported(scene, tmp_path)
    lost = [o.feature.rpartition("/")[2] for o in result.report.outcomes if o.code == "COLLIDER_FLAT_DROPPED"]
    sheets = ["floor"] if moves else []  # one that stands still may be a sheet
    assert lost == ["needle", "coin", "sheet", *sheets, "wire"]
    for path in (p for p in result.files if p.name.startswith("cylinder")):  # of another part
        points = read_mesh(documents(path.read_text("utf-8"))[0])["channels"][0]
        assert np.ptp(points, axis=0).min() > 0.0
    read_prefab(tmp_path / "out" / "Rich.prefab")


def test_hulls_keep_to_unitys_255_triangles(tmp_path):
    result = exported(rich_scene(tmp_path), tmp_path)
    assert [d for d in result.report.diagnostics if d.code == "HULL_SIMPLIFIED"]
    (hull,) = [p for p in result.files if "Ball hull" in p.name]
    mesh = read_mesh(documents(hull.read_text("utf-8"))[0])
    assert 4 <= len(np.vstack(mesh["submeshes"])) <= 255


NAMES = [
    "a/b",
    "a_b",
    "CON",
    "con",
    "nul.txt",
    "x" * 300,
    "ü" * 200,
    "  ",
    "",
    "tab\there",
    "end.",
    ".hidden",
    'q"<>|?*:\\',
    "Ａ",
    "a~",
    "e\u0301",
    "é",
]


def test_names_that_no_file_system_takes(tmp_path):
    """As object, as file: every file is there, in one way of writing, and is found again."""
    scene = model.Scene(
        nodes=[model.Node("Top", "Top", model.NodeKind.ASSEMBLY, flexible=True)],
        surfaces=[model.Surface(name, (i / 20, 0.0, 0.0, 1.0)) for i, name in enumerate(NAMES)],
    )
    for i, name in enumerate(NAMES):
        scene.meshes.append(block(name, (0.1, 0.1, 0.1 + i)))
        body = model.Body(name, i, (i,))
        scene.nodes.append(
            model.Node(
                f"Top/{i}",
                name,
                parent=0,
                grounded=True,
                bodies=(body,),
                pose=Pose(np.eye(3), np.array([i, 0, 0])),
            )
        )
    result = exported(scene, tmp_path)
    root, _ = read_prefab(tmp_path / "out" / "Rich.prefab")

    def walk(node: Node) -> list[Node]:
        return [node, *(n for c in node.children for n in walk(c))]

    for node in walk(root):
        names = [c.name for c in node.children]
        assert len(set(names)) == len(names) and not any("/" in n or not n.strip() for n in names)
    files = [p.relative_to(tmp_path / "out").as_posix() for p in (tmp_path / "out").rglob("*")]
    assert len({f.casefold() for f in files}) == len(files)
    assert all(
        len(p.name.encode()) <= 255 and not p.name.startswith(" ") for p in (tmp_path / "out").rglob("*")
    )
    changed = {o.feature for o in result.report.outcomes if o.code == "TARGET_NAME_CHANGED"}
    assert {"name of Top/0", "name of Top/7", "name of Top/9"} <= changed


def test_names_do_not_depend_on_order():
    named = [("Bolt", "A/3"), ("Bolt", "A/1"), ("Nut", "A/2"), ("Bolt", "A/2b")]
    found = dict(zip((i for _, i in named), unique(named)))
    again = dict(zip((i for _, i in named[::-1]), unique(named[::-1])))
    assert found == again and found["A/1"] == "Bolt" and len(set(found.values())) == 4
    less = [n for n in named if n[1] != "A/3"]
    assert dict(zip((i for _, i in less), unique(less))) == {k: v for k, v in found.items() if k != "A/3"}
    assert sibling_names([None, None, 0], ["a", "a", "a"], ["1", "2", "3"])[::2] == ["a", "a"]
    assert object_name("a/b\n") == "a_b_" and file_name("con.txt") == "_con.txt"


def test_png_of_the_tests_is_one(tmp_path):
    Pillow = pytest.importorskip("PIL.Image")
    pixels = np.arange(64).reshape(4, 4, 4)
    assert np.array_equal(np.asarray(Pillow.open(png(tmp_path / "x.png", pixels))), pixels)


@pytest.mark.parametrize("pipeline", ["builtin", "urp", "hdrp"])
def test_colours_of_vertices_are_kept_and_told(tmp_path, pipeline):
    """No pipeline's standard shader shows them; the asset has them for one that does."""
    box = trimesh.creation.box((1, 1, 1))
    colors = np.linspace(0.0, 1.0, 32).reshape(8, 4)
    mesh = model.Mesh("Painted", np.array(box.vertices), np.array(box.faces), colors=colors)
    scene = model.Scene([model.Node("A", "A", bodies=(model.Body("b", 0),))], meshes=[mesh])
    options = kinefab.ExportOptions(writing={"pipeline": pipeline})
    result = kinefab.export(scene, tmp_path / "A.prefab", options)
    told = [(o.feature, o.outcome.value) for o in result.report.outcomes if o.code == "LOOK_NOT_SHOWN"]
    assert told == [("vertex colours of mesh Painted", "approximated")]


def test_no_image_is_made_smaller(tmp_path):
    """Unity's own most of a side, in what the editor reads for every platform; no side is made a power of two."""
    scene = rich_scene(tmp_path)
    exported(scene, tmp_path)
    images = sorted((tmp_path / "out").rglob("*.png.meta"))
    assert images
    for path in images:
        imported = mapping(path.read_text())["TextureImporter"]
        (platform,) = imported["platformSettings"]
        assert platform["buildTarget"] == "DefaultTexturePlatform"
        assert imported["maxTextureSize"] == platform["maxTextureSize"] == "16384"
        assert imported["nPOTScale"] == "0"


@pytest.mark.parametrize("count, short", [(65_535, True), (65_536, False)])
def test_indices_have_16_bits_up_to_65535_vertices(tmp_path, count, short):
    """A sheet whose last triangle uses the last vertex, in two submeshes."""
    angle = np.linspace(0.0, 6.0, count)
    vertices = np.column_stack([angle, np.tile([0.0, 1.0], count)[:count], np.zeros(count)])
    corners = np.arange(count - 2)
    faces = np.column_stack([corners, corners + 1, corners + 2])
    normals = np.tile([0.0, 0.0, 1.0], (count, 1))
    mesh = model.Mesh("Sheet", vertices, faces, normals, face_counts=(count - 3, 1))
    scene = model.Scene([model.Node("A", "A", grounded=True, bodies=(model.Body("b", 0),))], meshes=[mesh])
    result = kinefab.export(scene, tmp_path / "A.prefab", kinefab.ExportOptions(colliders="none"))
    (asset,) = [path for path in result.files if path.suffix == ".asset"]
    found = read_mesh(documents(asset.read_text("utf-8"))[0])
    assert found["short"] == short and len(found["channels"][0]) == count
    assert [len(part) for part in found["submeshes"]] == [count - 3, 1]
    assert sorted(found["submeshes"][1][0]) == [count - 3, count - 2, count - 1]


def test_a_trigger_is_convex_wherever_it_stands(tmp_path):
    """Unity: "Triggers on concave MeshColliders are not supported", on what stands still too; what stops things there keeps its
    true mesh."""
    scene = rich_scene(tmp_path)
    mesh = scene.nodes[1].bodies[0].mesh
    shapes = [
        model.Collider(ColliderKind.MESH, mesh=mesh, trigger=trigger, name=f"{trigger}")
        for trigger in (True, False)
    ]
    scene.nodes[1] = replace(scene.nodes[1], colliders=tuple(shapes))
    exported(scene, tmp_path)
    found = documents((tmp_path / "out" / "Rich.prefab").read_text("utf-8"))
    own = {(d.fields["m_IsTrigger"], d.fields["m_Convex"]) for d in found if d.kind == "MeshCollider"}
    assert ("1", "0") not in own and {("1", "1"), ("0", "0")} <= own
