"""Surfaces as glTF materials, with their images in the buffer."""

from __future__ import annotations

import math
from typing import Any

from ...diagnostics import Report
from ...model import AlphaMode, Surface, Texture, Wrap
from ..images import ImageError, jpeg_channels, read_image
from .binary import Binary

WRAPS = {Wrap.REPEAT: 10497, Wrap.CLAMP: 33071, Wrap.MIRROR: 33648}
MEDIA_TYPES = {".png": "image/png", ".jpg": "image/jpeg"}
"""Of the images that glTF holds, by their endings."""


SHADING = ("baseColorTexture", "metallicRoughnessTexture")
"""Textures that stand among the numbers of PBR; the others stand in the material itself."""


def textures(surface: Surface) -> list[tuple[str, Texture]]:
    """A surface's, by what glTF calls them."""
    named = {
        "baseColorTexture": surface.color_texture,
        "metallicRoughnessTexture": surface.metallic_roughness_texture,
        "normalTexture": surface.normal_texture,
        "occlusionTexture": surface.occlusion_texture,
        "emissiveTexture": surface.emission_texture,
    }
    return [(name, texture) for name, texture in named.items() if texture is not None]


class Looks:
    """The document's materials, textures, samplers and images."""

    def __init__(self, binary: Binary, report: Report):
        self._binary, self._report = binary, report
        self.materials: list[dict[str, Any]] = []
        self.textures: list[dict[str, Any]] = []
        self.samplers: list[dict[str, Any]] = []
        self.images: list[dict[str, Any]] = []
        self.extensions: set[str] = set()
        self._known: dict[tuple[object, ...], int] = {}
        self._image_of: dict[tuple[object, ...], int | None] = {}

    def material(self, surface: Surface, uv_sets: int) -> int:
        """Index of a surface's material, on a mesh with so many sets of texture coordinates."""
        key = (
            "material",
            id(surface),
            min(uv_sets, 1 + max((t.uv_set for _, t in textures(surface)), default=-1)),
        )
        if key not in self._known:
            self.materials.append(self._entry(surface, uv_sets))
            self._known[key] = len(self.materials) - 1
        return self._known[key]

    def _entry(self, surface: Surface, uv_sets: int) -> dict[str, Any]:
        shading: dict[str, Any] = {
            "baseColorFactor": list(surface.color),
            "metallicFactor": surface.metallic,
            "roughnessFactor": 1.0 - surface.smoothness,
        }
        entry: dict[str, Any] = {"name": surface.name, "pbrMetallicRoughness": shading}
        for name, texture in textures(surface):
            if texture.uv_set >= uv_sets:
                self._lost(texture, surface.name, "a mesh that shows it has no texture coordinates for it")
            elif (reference := self._texture(texture, surface.name)) is not None:
                (shading if name in SHADING else entry)[name] = reference
        strongest = max(surface.emission)
        if strongest > 0.0:
            entry["emissiveFactor"] = [c / max(1.0, strongest) for c in surface.emission]
        if strongest > 1.0:
            entry["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": strongest}}
            self.extensions.add("KHR_materials_emissive_strength")
        mode = surface.blending
        if mode is not AlphaMode.OPAQUE:
            entry["alphaMode"] = mode.value.upper()
        if mode is AlphaMode.MASK:
            entry["alphaCutoff"] = surface.alpha_cutoff
        if surface.double_sided:
            entry["doubleSided"] = True
        return entry

    def _texture(self, texture: Texture, surface: str) -> dict[str, Any] | None:
        image = self._image(texture, surface)
        if image is None:
            return None
        wrap = WRAPS[texture.wrap]
        sampler = self._numbered("sampler", {"wrapS": wrap, "wrapT": wrap}, self.samplers)
        number = self._numbered("texture", {"sampler": sampler, "source": image}, self.textures)
        reference: dict[str, Any] = {"index": number}
        if texture.uv_set:
            reference["texCoord"] = texture.uv_set
        moved = (texture.scale, texture.offset, texture.rotation) != ((1.0, 1.0), (0.0, 0.0), 0.0)
        if moved:
            # With v turned (v' = 1 - v) a map R S uv + t becomes R' S uv' + t', R' turning the other way in its own sense.
            s, c = math.sin(texture.rotation), math.cos(texture.rotation)
            (sx, sy), (tx, ty) = texture.scale, texture.offset
            offset = [tx - s * sy, 1.0 - ty - c * sy]
            reference["extensions"] = {
                "KHR_texture_transform": {"offset": offset, "rotation": texture.rotation, "scale": [sx, sy]}
            }
            self.extensions.add("KHR_texture_transform")
        return reference

    def _numbered(self, kind: str, entry: dict[str, Any], entries: list[dict[str, Any]]) -> int:
        key = (kind, *entry.values())
        if key not in self._known:
            entries.append(entry)
            self._known[key] = len(entries) - 1
        return self._known[key]

    def _image(self, texture: Texture, surface: str) -> int | None:
        """Index of the image, None with a report where it cannot be had or glTF has no place for it."""
        key = (texture.path, texture.data)
        if key not in self._image_of:
            self._image_of[key] = self._embedded(texture, surface)
        return self._image_of[key]

    def _embedded(self, texture: Texture, surface: str) -> int | None:
        try:
            image = read_image(texture, MEDIA_TYPES, "glTF holds PNG and JPEG only")
            if image.ending == ".jpg" and jpeg_channels(image.data) not in (1, 3):
                raise ImageError("glTF holds JPEG of grey or of three colours only")
        except ImageError as error:
            self._lost(texture, surface, str(error))
            return None
        kind = MEDIA_TYPES[image.ending]
        self.images.append(
            {"name": texture.name, "mimeType": kind, "bufferView": self._binary.view(image.data)}
        )
        return len(self.images) - 1

    def _lost(self, texture: Texture, surface: str, detail: str) -> None:
        told = {"texture": texture.name, "surface": surface, "detail": detail}
        self._report.dropped(f"texture {texture.name}", "TEXTURE_DROPPED", **told)
