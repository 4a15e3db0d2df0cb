"""Images that a prefab shows: each its own file whatever it is called, and packed ones by what their pixels say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import kinefab
import numpy as np
import pytest
from kinefab import model
from prefab_scenes import block, png
from unity_yaml import documents

PIXELS = {"a": (255, 0, 0, 255), "b": (0, 255, 0, 255)}


def twins(folder: Path, order: str = "ab", names: str = "MM") -> model.Scene:
    """Two materials, mostly of one name, with images of one name that lie in two folders."""
    scene = model.Scene(meshes=[block("Block", (0.1, 0.1, 0.1), uvs=True)])
    for i, own in enumerate(order):
        (folder / own).mkdir(exist_ok=True)
        image = png(folder / own / "tex.png", np.full((2, 2, 4), PIXELS[own], dtype=np.uint8))
        texture = model.Texture("tex.png", image)
        look = {"color_texture": texture, "metallic_roughness_texture": texture}
        scene.surfaces.append(model.Surface(names["ab".index(own)], metallic=1.0, smoothness=0.0, **look))
        scene.nodes.append(model.Node(own, own, bodies=(model.Body("b", 0, (i,)),)))
    return scene


def shown(prefab: Path) -> dict[str, dict[str, tuple[bytes, str]]]:
    """Of each part the files that its material shows, by slot, with their guids."""
    by_guid = {
        line.removeprefix("guid: "): meta.with_suffix("")
        for meta in prefab.parent.rglob("*.meta")
        for line in meta.read_text("utf-8").splitlines()
        if line.startswith("guid: ")
    }
    found = {d.file_id: d for d in documents(prefab.read_text("utf-8"))}
    told: dict[str, dict[str, tuple[bytes, str]]] = {}
    for d in (d for d in found.values() if d.kind == "MeshRenderer"):
        owner = str(found[int(d.fields["m_GameObject"]["fileID"])].fields["m_Name"])
        (reference,) = d.fields["m_Materials"]
        own = documents(by_guid[reference["guid"]].read_text("utf-8"))[0]
        slots = {
            k: v["m_Texture"]
            for entry in own.fields["m_SavedProperties"]["m_TexEnvs"]
            for k, v in entry.items()
        }
        told[owner] = {
            slot: (by_guid[r["guid"]].read_bytes(), r["guid"])
            for slot, r in slots.items()
            if r["fileID"] != "0"
        }
    return told


@pytest.mark.parametrize("names", ["MM", "MN"])
def test_images_of_one_name_are_two_files(tmp_path, names):
    image = pytest.importorskip("PIL.Image")
    import io

    kinefab.export(twins(tmp_path, names=names), tmp_path / "Twins.prefab")
    found = shown(tmp_path / "Twins.prefab")
    for own in "ab":
        assert found[own]["_MainTex"][0] == (tmp_path / own / "tex.png").read_bytes()
        mask = image.open(io.BytesIO(found[own]["_MetallicGlossMap"][0])).getpixel((0, 0))
        assert mask == (0, 255, 0, 255 - PIXELS[own][1])  # metallic from blue, smoothness from green


def test_their_guids_hang_neither_on_order_nor_on_where_they_lie(tmp_path):
    guids: list[dict[str, dict[str, str]]] = []
    for k, order in enumerate(("ab", "ba")):
        folder = tmp_path / str(k)
        folder.mkdir()
        kinefab.export(twins(folder, order), folder / "Twins.prefab")
        found = shown(folder / "Twins.prefab")
        guids.append({own: {slot: guid for slot, (_, guid) in slots.items()} for own, slots in found.items()})
    assert guids[0] == guids[1] and guids[0]["a"] != guids[0]["b"]


def test_grey_of_16_bits_is_packed_by_its_upper_half(tmp_path):
    image = pytest.importorskip("PIL.Image")
    values = np.array([[0, 12850], [40000, 65535]], dtype=np.uint16)
    image.fromarray(values).save(tmp_path / "grey.png")
    scene = twins(tmp_path, "a")
    texture = model.Texture("grey", tmp_path / "grey.png")
    scene.surfaces = [model.Surface("M", metallic=1.0, metallic_roughness_texture=texture)]
    kinefab.export(scene, tmp_path / "Grey.prefab")
    (mask,) = (tmp_path / "Grey" / "Textures").glob("*mask*.png")
    assert np.array_equal(np.asarray(image.open(mask))[:, :, 0], np.round(values / 257.0))


def test_an_image_of_unity_s_most_pixels_is_no_fault(tmp_path):
    """Of as many as Pillow by itself warns of."""
    image = pytest.importorskip("PIL.Image")
    image.new("1", (16384, 12000)).save(tmp_path / "large.png")
    scene = twins(tmp_path, "a")
    scene.surfaces = [model.Surface("M", color_texture=model.Texture("large", tmp_path / "large.png"))]
    result = kinefab.export(scene, tmp_path / "Large.prefab")
    assert not [d for d in result.report.diagnostics if d.code == "TEXTURE_NOT_WRITTEN"]
    assert shown(tmp_path / "Large.prefab")["a"]["_MainTex"][0] == (tmp_path / "large.png").read_bytes()


@pytest.mark.parametrize("dialect, version, blend", [("2021", 5, 1.0), ("2022", 7, 0.0), ("6", 7, 0.0)])
def test_urp_knows_which_of_its_changes_a_material_has_seen(tmp_path, dialect, version, blend):
    """Its fourth change darkens emission, its sixth takes what shines through glass out of the blend mode: neither may
    happen to a material that is written as after it, nor be left out where it is written as before."""
    scene = model.Scene(meshes=[block("Block", (0.1, 0.1, 0.1))])
    scene.surfaces += [
        model.Surface("Glass", (0.2, 0.4, 0.6, 0.3), alpha_mode=model.AlphaMode.BLEND),
        model.Surface("Leaf", alpha_mode=model.AlphaMode.MASK, emission=(0.5, 0.25, 0.0)),
    ]
    scene.nodes += [model.Node(n, n, bodies=(model.Body("b", 0, (i,)),)) for i, n in enumerate("ab")]
    for pipeline, versioned in (("urp", True), ("builtin", False)):
        folder = tmp_path / pipeline
        folder.mkdir()
        writing = {"unity": dialect, "pipeline": pipeline}
        kinefab.export(scene, folder / "A.prefab", kinefab.ExportOptions(writing=writing))
        glass, leaf = (
            documents((folder / "A" / "Materials" / f"{n}.mat").read_text("utf-8")) for n in ("Glass", "Leaf")
        )
        assert [d.kind for d in glass] == ["Material", "MonoBehaviour"][: 1 + versioned]
        if not versioned:
            continue
        assert glass[1].fields["version"] == leaf[1].fields["version"] == str(version)
        assert glass[1].fields["m_Script"]["guid"] == "d0353a89b1f911e48b9e16bdc9f2e058"
        floats = [
            {k: float(v) for entry in d[0].fields["m_SavedProperties"]["m_Floats"] for k, v in entry.items()}
            for d in (glass, leaf)
        ]
        expected = {
            "_Surface": 1.0,
            "_Blend": blend,
            "_BlendModePreserveSpecular": 1.0,
            "_AlphaClip": 0.0,
            "_AlphaToMask": 0.0,
        }
        expected |= {
            "_SrcBlend": 1.0,
            "_DstBlend": 10.0,
            "_SrcBlendAlpha": 1.0,
            "_DstBlendAlpha": 10.0,
            "_ZWrite": 0.0,
        }
        assert {k: floats[0][k] for k in expected} == expected
        expected = {
            "_Surface": 0.0,
            "_Blend": 0.0,
            "_AlphaClip": 1.0,
            "_AlphaToMask": 1.0,
            "_DstBlendAlpha": 0.0,
            "_ZWrite": 1.0,
        }
        assert {k: floats[1][k] for k in expected} == expected


@pytest.mark.parametrize("count", [1, 7])
def test_an_image_is_looked_at_once_however_many_materials_show_it(tmp_path, monkeypatch, count):
    """And once more for each mask that it is packed into, with that material's factors."""
    image = pytest.importorskip("PIL.Image")
    scene = model.Scene(meshes=[block("Block", (0.1, 0.1, 0.1), uvs=True)])
    texture = model.Texture("tex.png", png(tmp_path / "tex.png", np.full((2, 3, 4), 7)))
    look = {"color_texture": texture, "normal_texture": texture, "metallic_roughness_texture": texture}
    for i in range(count):
        scene.surfaces.append(model.Surface(f"M{i}", metallic=0.1 * i, **look))
        scene.nodes.append(model.Node(f"N{i}", f"N{i}", bodies=(model.Body("b", 0, (i,)),)))
    opened, once = [], image.open
    monkeypatch.setattr(image, "open", lambda *given, **named: opened.append(1) or once(*given, **named))
    kinefab.export(scene, tmp_path / "T.prefab")
    assert len(opened) == 1 + count
    assert len(list((tmp_path / "T" / "Textures").glob("*.png"))) == 2 + count


@pytest.mark.parametrize(
    "alpha, mode, shown", [(0.3, "OPAQUE", 3.0), (1.0, "OPAQUE", 0.0), (0.3, "MASK", 1.0)]
)
def test_a_colour_that_is_not_whole_is_seen_through(tmp_path, alpha, mode, shown):
    """Bundles, STEP and OBJ state an alpha and no mode; a mode that is stated stays."""
    surface = model.Surface("Pane", (0.2, 0.4, 0.6, alpha), alpha_mode=model.AlphaMode[mode])
    scene = model.Scene(meshes=[block("Block", (0.1, 0.1, 0.1))], surfaces=[surface])
    scene.nodes.append(model.Node("N", "N", bodies=(model.Body("b", 0, (0,)),)))
    kinefab.export(scene, tmp_path / "T.prefab")
    (own,) = documents((tmp_path / "T" / "Materials" / "Pane.mat").read_text("utf-8"))
    floats = {k: v for entry in own.fields["m_SavedProperties"]["m_Floats"] for k, v in entry.items()}
    assert float(floats["_Mode"]) == shown


def test_a_texture_s_file_has_one_ending(tmp_path):
    """That of what it holds, whatever the source calls the image."""
    scene = model.Scene(meshes=[block("Block", (0.1, 0.1, 0.1), uvs=True)])
    image = png(tmp_path / "a.png", np.zeros((2, 2, 4)))
    for i, name in enumerate(("wood.png", "Stone.JPEG", "v1.2", ".png")):
        texture = model.Texture(name, image)
        scene.surfaces.append(model.Surface(f"M{i}", color_texture=texture, normal_texture=texture))
        scene.nodes.append(model.Node(f"N{i}", f"N{i}", bodies=(model.Body("b", 0, (i,)),)))
    kinefab.export(scene, tmp_path / "T.prefab")
    found = {path.name for path in (tmp_path / "T" / "Textures").glob("*.png")}
    plain = ("wood", "Stone", "v1.2")
    assert found >= {f"{name}.png" for name in plain} | {f"{name} normal.png" for name in plain}
    assert len(found) == 8


BASE_AND_GLOW = {
    "builtin": ("_MainTex", "_EmissionMap", {"normal", "occlusion", "emission"}),
    "urp": ("_BaseMap", "_EmissionMap", {"normal", "occlusion", "emission"}),
    "hdrp": ("_BaseColorMap", "_EmissiveColorMap", {"normal", "occlusion"}),
}


@pytest.mark.parametrize("pipeline", BASE_AND_GLOW)
def test_the_shaders_place_every_map_as_they_place_the_colour(tmp_path, pipeline):
    """UnityStandardInput.cginc, URP's LitInput.hlsl and HDRP's LitDataIndividualLayer.hlsl know one scale and offset, that of the
    colour's slot; HDRP's emission has its own.  A map that lies otherwise is told, and one without a colour lies as it did."""
    pytest.importorskip("PIL", reason="pillow, which repacks maps, is not installed")
    image = model.Texture("Bumps", data=png(tmp_path / "Bumps.png", np.full((4, 4, 4), 128)).read_bytes())
    tiled = replace(image, scale=(4.0, 3.0), offset=(0.25, 0.125))
    plain = model.Surface("Plain", normal_texture=tiled, occlusion_texture=tiled)
    mixed = model.Surface(
        "Mixed",
        emission=(1.0, 1.0, 1.0),
        color_texture=tiled,
        normal_texture=image,
        metallic_roughness_texture=tiled,
        occlusion_texture=replace(tiled, scale=(1.0, 1.0), uv_set=1),
        emission_texture=replace(tiled, offset=(0.0, 0.0)),
    )
    scene = model.Scene(surfaces=[plain, mixed], meshes=[block("Block", (0.1, 0.2, 0.3), uvs=True)])
    scene.nodes = [
        model.Node(s.name, s.name, bodies=(model.Body("b", 0, (i,)),)) for i, s in enumerate((plain, mixed))
    ]
    options = kinefab.ExportOptions(writing={"pipeline": pipeline})
    result = kinefab.export(scene, tmp_path / "A.prefab", options)
    base, glow, told = BASE_AND_GLOW[pipeline]
    for name in ("Plain", "Mixed"):
        (found,) = [
            d
            for d in documents((tmp_path / "A" / "Materials" / f"{name}.mat").read_text())
            if d.kind == "Material"
        ]
        slots = {k: v for entry in found.fields["m_SavedProperties"]["m_TexEnvs"] for k, v in entry.items()}
        assert (slots[base]["m_Scale"], slots[base]["m_Offset"]) == (
            {"x": "4", "y": "3"},
            {"x": "0.25", "y": "0.125"},
        )
        assert (slots[base]["m_Texture"]["fileID"] == "0") == (name == "Plain")
    assert (slots[glow]["m_Scale"], slots[glow]["m_Offset"]) == ({"x": "4", "y": "3"}, {"x": "0", "y": "0"})
    lost = {
        (o.feature, o.message.partition("no place for ")[2].partition(" of ")[0])
        for o in result.report.outcomes
        if o.code
    }
    expected = {(f"{slot} texture of material Mixed", "its own scale and offset") for slot in told}
    assert lost == expected | {("occlusion texture of material Mixed", "uv_set")}
