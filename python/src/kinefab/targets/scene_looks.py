"""Materials of a scene file with their textures, and the images that these show."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from ..diagnostics import Report
from ..model import AlphaMode, Texture
from ..unity.scene import Material
from .images import MAGIC, ImageError, read_image
from .noun_entry import entry
from .numbers import plain_value

MEDIA_TYPES = {
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".bmp": "image/bmp",
    ".tif": "image/tiff",
    ".psd": "image/vnd.adobe.photoshop",
    ".gif": "image/gif",
    ".exr": "image/x-exr",
    ".hdr": "image/vnd.radiance",
    ".tga": "image/x-tga",
}
"""Of the files that Unity imports, by their endings."""
COLOR_SPACES = {
    "colorTexture": "sRGB",
    "normalTexture": "linear",
    "metallicRoughnessTexture": "linear",
    "occlusionTexture": "linear",
    "emissionTexture": "sRGB",
}
"""Textures of a material in the schema's order, and what their images' numbers mean."""


@dataclass(slots=True)
class Looks:
    """Materials as entries, and the images that they name: one that is shown in both colour spaces stands there twice."""

    report: Report
    materials: list[dict[str, Any]] = field(default_factory=list[dict[str, Any]])
    images: list[tuple[dict[str, Any], bytes]] = field(default_factory=list[tuple[dict[str, Any], bytes]])
    """Entries without the place of their bytes."""
    _known: dict[tuple[object, ...], int | None] = field(default_factory=dict[tuple[object, ...], "int | None"])

    def add(self, materials: Sequence[Material]) -> None:
        for material in materials:
            self.materials.append(self._material(material))

    def _material(self, material: Material) -> dict[str, Any]:
        found = entry(replace(material, **dict.fromkeys(COLOR_SPACES)))
        implied = AlphaMode.BLEND if material.color[3] < 1.0 else AlphaMode.OPAQUE
        if material.alphaMode is implied:
            del found["alphaMode"]
        else:
            found["alphaMode"] = material.alphaMode.value
        for slot, space in COLOR_SPACES.items():
            texture: Texture | None = getattr(material, slot)
            if texture is not None and (image := self._image(texture, space, material.name)) is not None:
                found[slot] = _placed(texture, image)
        return found

    def _image(self, texture: Texture, space: str, surface: str) -> int | None:
        key = (texture.path, texture.data, space)
        if key not in self._known:
            self._known[key] = self._taken(texture, space, surface)
        return self._known[key]

    def _taken(self, texture: Texture, space: str, surface: str) -> int | None:
        try:
            image = read_image(texture, {*dict(map(reversed, MAGIC)), ".tga"}, "it is no image of a kind that Unity imports")
        except ImageError as error:
            told = {"texture": texture.name, "surface": surface, "detail": error}
            self.report.dropped(f"texture {texture.name}", "TEXTURE_DROPPED", **told)
            return None
        found: dict[str, Any] = {"name": texture.name, "mediaType": MEDIA_TYPES[image.ending]}
        if space != "sRGB":
            found["colorSpace"] = space
        self.images.append((found, image.data))
        return len(self.images) - 1


def _placed(texture: Texture, image: int) -> dict[str, Any]:
    """Without what is at its default."""
    placing = {
        "uvSet": texture.uv_set,
        "wrap": texture.wrap.value,
        "scale": plain_value(texture.scale),
        "offset": plain_value(texture.offset),
        "rotation": plain_value(math.degrees(texture.rotation)),
    }
    usual = {"uvSet": 0, "wrap": "repeat", "scale": [1, 1], "offset": [0, 0], "rotation": 0}
    return {"image": image} | {key: value for key, value in placing.items() if value != usual[key]}
