"""Which textures the materials show, as files of their own: one for each use, as Unity imports a normal map otherwise than a colour."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from ....diagnostics import Report
from ....geometry.looks.pixels import bytes_of
from ....model import Texture, Wrap
from ....unity.scene import Material, Vector2
from ...images import ImageError
from ..text.metas import texture_meta
from ..text.yaml import NULL, Plain, external
from .images import ENDINGS, Images, content_of, packed
from .materials import Map, Maps

TEXTURE_ID = 2800000
IMPORTED = 3
"""The type of a reference to what an importer made."""
SUFFIXES = ENDINGS | {".jpeg", ".tiff"}
"""Of images' names, which their files have anyway."""
COLOR, NORMAL, DATA = "color", "normal", "data"
"""Uses: sRGB, a normal map, linear numbers."""
WRAPS = {Wrap.REPEAT: 0, Wrap.CLAMP: 1, Wrap.MIRROR: 2}


@dataclass(frozen=True, slots=True)
class TextureFile:
    """identity: what it is in the source.  use: COLOR, NORMAL or DATA.  material: whose factors are packed in, None where none are."""

    identity: str
    name: str
    use: str
    wrap: Wrap
    ending: str
    texture: Texture
    material: Material | None = None

    def content(self) -> list[bytes]:
        return [bytes_of(self.texture) if self.material is None else packed(self.material)]

    def meta(self, guid: str) -> str:
        return texture_meta(guid, self.use == COLOR, self.use == NORMAL, WRAPS[self.wrap])


@dataclass(slots=True)
class Textures:
    """Collects the textures of materials; the report gets what cannot be shown.

    shader: its name, for the report.  twins: names that different images have.  own_emission: whether the shader places the map of
    emission by itself; it places all others as it places the colour.
    """

    report: Report
    shader: str
    twins: Collection[str] = ()
    own_emission: bool = False
    files: dict[str, TextureFile] = field(default_factory=dict[str, TextureFile])
    images: Images = field(default_factory=Images)

    def wanted(self, material: Material, identity: str) -> dict[str, tuple[str, Texture]]:
        """For each slot of ``Maps`` the identity of its file, and the texture whose place on the surface it takes.

        identity: what the material is among all.
        """
        found: dict[str, tuple[str, Texture]] = {}
        for slot, texture, use in (
            ("color", material.colorTexture, COLOR),
            ("normal", material.normalTexture, NORMAL),
            ("emission", material.emissionTexture if any(material.emission) else None, COLOR),
        ):
            if texture is not None and (image := self._plain(material, slot, texture, use)):
                found[slot] = (image, texture)
        rough = material.metallicRoughnessTexture or material.occlusionTexture
        if rough is not None and (image := self._packed(material, identity, rough)):
            found["packed"] = (image, rough)
        self._tell_placing(material, found)
        return found

    def _plain(self, material: Material, slot: str, texture: Texture, use: str) -> str | None:
        try:
            ending = self.images.ending(texture)
        except ImageError as error:
            return self._lost(material, slot, texture, error)
        held = f"|{content_of(texture)}" if texture.name in self.twins else ""
        identity = f"{texture.name}{held}|{use}|{texture.wrap.value}"
        shown = PurePosixPath(texture.name)
        plain = shown.stem if shown.suffix.lower() in SUFFIXES else texture.name
        name = plain if use == COLOR else f"{plain} {use}"
        self.files.setdefault(identity, TextureFile(identity, name, use, texture.wrap, ending, texture))
        return identity

    def _packed(self, material: Material, own: str, texture: Texture) -> str | None:
        try:
            for image in (material.metallicRoughnessTexture, material.occlusionTexture):
                if image is not None:
                    self.images.demand_pixels(image)
        except ImageError as error:
            return self._lost(material, "metallic, roughness or occlusion", texture, error)
        identity = f"{own}|mask|{texture.name}|{texture.wrap.value}"
        name = f"{material.name} mask"
        file = TextureFile(identity, name, DATA, texture.wrap, ".png", texture, material)
        self.files.setdefault(identity, file)
        return identity

    def _lost(self, material: Material, slot: str, texture: Texture, error: ImageError) -> None:
        feature = f"{slot} texture of material {material.name}"
        self.report.dropped(feature, "TEXTURE_NOT_WRITTEN", texture=texture.name, detail=str(error))

    def _tell_placing(self, material: Material, found: Mapping[str, tuple[str, Texture]]) -> None:
        shared = _place_of_all(found)
        for slot, texture, file in (
            ("color", material.colorTexture, "color"),
            ("normal", material.normalTexture, "normal"),
            ("metallic and roughness", material.metallicRoughnessTexture, "packed"),
            ("occlusion", material.occlusionTexture, "packed"),
            ("emission", material.emissionTexture, "emission"),
        ):
            if texture is None or file not in found:
                continue
            alone = self.own_emission and slot == "emission"
            for told, is_plain in (
                ("uv_set", texture.uv_set == 0),
                ("rotation", texture.rotation == 0.0),
                ("its own scale and offset", alone or (texture.scale, texture.offset) == shared),
            ):
                if not is_plain:
                    feature = f"{slot} texture of material {material.name}"
                    self.report.field_dropped(feature, told, self.shader)


def _place_of_all(slots: Mapping[str, tuple[str, Texture]]) -> tuple[Vector2, Vector2]:
    """Scale and offset that the shaders give to every map: the colour's, else those of the first map that is there."""
    placed = (slots[slot][1] for slot in ("color", "normal", "packed", "emission") if slot in slots)
    first = next(placed, None)
    return ((1.0, 1.0), (0.0, 0.0)) if first is None else (first.scale, first.offset)


def twins_of(materials: Iterable[Material]) -> frozenset[str]:
    """Names that different images have: two files of one name lie in two folders, say."""
    sources: dict[str, set[object]] = defaultdict(set)
    for material in materials:
        for texture in material.textures:
            sources[texture.name].add(texture.data if texture.path is None else texture.path)
    return frozenset(name for name, images in sources.items() if len(images) > 1)


def shown(
    slots: Mapping[str, tuple[str, Texture]], references: Mapping[str, Plain], material: Material
) -> Maps:
    """references: of the files, by their identities."""

    def placed(slot: str) -> Map | None:
        if slot not in slots:
            return None
        identity, texture = slots[slot]
        return Map(references[identity], texture.scale, texture.offset)

    return Maps(
        placed("color") or Map(NULL, *_place_of_all(slots)),
        placed("normal"),
        placed("packed"),
        material.metallicRoughnessTexture is not None and "packed" in slots,
        material.occlusionTexture is not None and "packed" in slots,
        placed("emission"),
    )


def reference(guid: str) -> Plain:
    return external(TEXTURE_ID, guid, IMPORTED)
