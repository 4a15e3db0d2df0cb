"""What the JSON of a glTF file says of looks and numbers beyond what trimesh takes of it."""

from __future__ import annotations

import base64
import math
import struct
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import AlphaMode, Surface, Texture, Wrap
from ...spatial import Array
from .gltf_document import COMPRESSIONS, GLB_HEAD, Json, accessor_values
from .visuals import Look, linear_colors

READ_MODES = (0, 1, 4, 5)
"""Of primitives that trimesh makes geometries of, one each: points, lines, triangles, strips."""
WRAPS = {10497: Wrap.REPEAT, 33071: Wrap.CLAMP, 33648: Wrap.MIRROR}
NEAREST = 9728
SLOTS = {
    "baseColorTexture": "color_texture",
    "metallicRoughnessTexture": "metallic_roughness_texture",
    "normalTexture": "normal_texture",
    "occlusionTexture": "occlusion_texture",
    "emissiveTexture": "emission_texture",
}
"""What glTF's textures are called in the model."""
STRENGTHS = {"normalTexture": "scale", "occlusionTexture": "strength"}
TRANSFORM, STRENGTH = "KHR_texture_transform", "KHR_materials_emissive_strength"
GLOSSY = "KHR_materials_pbrSpecularGlossiness"


@dataclass(slots=True, eq=False)
class GltfFile:
    """A file that trimesh has read.

    document: its JSON, whose lists may hold anything; whoever asks gets a KeyError, IndexError, TypeError or ValueError where
    they do not fit together.  read: the bytes of a file beside it by its name.  where: the place that names the file.
    """

    path: Path
    document: Json
    read: Callable[[str], bytes]
    report: Report
    where: str
    _told: set[str] = field(default_factory=set[str])
    _buffers: dict[int, bytes] = field(default_factory=dict[int, bytes])

    def completed(self, look: Look, primitive: Json) -> Look:
        """The look of a primitive as trimesh has it, with all that the file says of it."""
        (surface,), uv, colors, chosen = look.surfaces, look.uv, look.colors, 0
        if surface is not None and "material" in primitive:
            surface, chosen = self.surface(surface, primitive)
        # trimesh takes coordinates with a material alone, and as whole numbers what are shares
        if uv is None or chosen or self.is_share(primitive, "TEXCOORD_0"):
            uv = self.numbers(primitive, f"TEXCOORD_{chosen}")
            uv = None if uv is None else np.column_stack([uv[:, 0], 1.0 - uv[:, 1]])
        if colors is not None and self.is_share(primitive, "COLOR_0"):
            stated = self.numbers(primitive, "COLOR_0")
            colors = colors if stated is None else linear_colors(stated, True)
        return replace(look, surfaces=(surface,), uv=uv, colors=colors)

    def is_share(self, primitive: Json, name: str) -> bool:
        """Whether an attribute holds whole numbers that stand for shares of their largest, which trimesh takes as they are."""
        index = primitive["attributes"].get(name)
        return index is not None and bool(self.document["accessors"][index].get("normalized"))

    def primitives(self, names: Sequence[str]) -> dict[str, Json]:
        """By the names of the geometries that trimesh made of them, all in order; none where it made another number."""
        found = [p for mesh in self.document.get("meshes", []) for p in mesh["primitives"]]
        found = [p for p in found if p.get("mode", 4) in READ_MODES]
        return dict(zip(names, found)) if len(found) == len(names) else {}

    def places(self, primitive: Json) -> Array | None:
        """Of the vertices, where the file has them as shares; else None."""
        return self.numbers(primitive, "POSITION") if self.is_share(primitive, "POSITION") else None

    def surface(self, surface: Surface, primitive: Json) -> tuple[Surface, int]:
        """A surface, as trimesh has it, with what the primitive's material says more, and the set of coordinates of its textures."""
        material: Json = self.document["materials"][primitive["material"]]
        shading: Json = material.get("pbrMetallicRoughness", {})
        extensions: Json = material.get("extensions", {})
        slots = {name: info for name in SLOTS if (info := shading.get(name) or material.get(name))}
        sets = [_placing(info).get("texCoord", info.get("texCoord", 0)) for info in slots.values()]
        chosen = sets[0] if sets else 0
        found: dict[str, Any] = {}
        for (name, info), uv_set in zip(slots.items(), sets):
            texture: Texture | None = getattr(surface, SLOTS[name])
            if texture is None:
                continue
            if uv_set != chosen:
                detail = f"it lies on coordinates {uv_set}, the material's first texture on {chosen}"
                self._tell(f"{name} of material {surface.name}", detail, lost=True)
                found[SLOTS[name]] = None
                continue
            found[SLOTS[name]] = self._placed(texture, info, name, surface.name)
            amount = info.get(STRENGTHS.get(name, ""), 1.0)
            if amount != 1.0:
                self._tell(f"{name} of material {surface.name}", f"its {STRENGTHS[name]} {amount:g} became 1")
        color = _color(shading, surface.color if GLOSSY in extensions else (1.0, 1.0, 1.0, 1.0))
        if surface.alpha_mode is AlphaMode.OPAQUE:
            color = (*color[:3], 1.0)
        strength = float(extensions.get(STRENGTH, {}).get("emissiveStrength", 1.0))
        red, green, blue = surface.emission
        for name in sorted(extensions.keys() - {STRENGTH}):
            detail = "it became metallic and roughness" if name == GLOSSY else "a surface has no such thing"
            self._tell(f"{name} of material {surface.name}", detail)
        return replace(
            surface, color=color, emission=(strength * red, strength * green, strength * blue), **found
        ), chosen

    def _placed(self, texture: Texture, info: Json, slot: str, material: str) -> Texture:
        """The texture as its sampler and its transform lay it."""
        number = self.document["textures"][info["index"]].get("sampler")
        sampler: Json = {} if number is None else self.document["samplers"][number]
        ways = [WRAPS.get(sampler.get(key, 10497), Wrap.REPEAT) for key in ("wrapS", "wrapT")]
        if ways[0] is not ways[1]:
            self._tell(
                f"{slot} of material {material}", f"wrap {ways[0].value} and {ways[1].value} became the first"
            )
        if sampler.get("magFilter") == NEAREST:
            self._tell(f"{slot} of material {material}", "its single pixels are shown smoothed")
        moved = _placing(info)
        (sx, sy), turn = moved.get("scale", (1.0, 1.0)), float(moved.get("rotation", 0.0))
        ox, oy = moved.get("offset", (0.0, 0.0))
        # With v turned, v' = 1 - v, R S uv + t becomes R' S uv' + t', R' turning the other way in its own sense.
        offset = (ox + math.sin(turn) * sy, 1.0 - oy - math.cos(turn) * sy)
        return replace(
            texture, wrap=ways[0], scale=(float(sx), float(sy)), offset=offset if moved else (0.0, 0.0),
            rotation=turn,
        )  # fmt: skip

    def _tell(self, feature: str, detail: str, lost: bool = False) -> None:
        if feature + detail in self._told:
            return
        self._told.add(feature + detail)
        told = self.report.dropped if lost else self.report.approximated
        told(feature, "MESH_LOOK", self.where, what=feature, path=self.path.name, detail=detail)

    def numbers(self, primitive: Json, name: str) -> Array | None:
        """An attribute of a primitive, one row a vertex, whole numbers that stand for shares as these; None where it has none,
        or where they are not plainly in the file (sparse, compressed)."""
        index = primitive["attributes"].get(name)
        if index is None or not COMPRESSIONS.keys().isdisjoint(primitive.get("extensions", ())):
            return None
        entry = self.document["accessors"][index]
        if "sparse" in entry or "bufferView" not in entry:
            return None
        values = accessor_values(self.document, entry, self._buffer)
        if entry.get("normalized") and values.dtype.kind != "f":
            return np.maximum(values.astype(np.float64) / float(np.iinfo(values.dtype).max), -1.0)
        return values.astype(np.float64)

    def _buffer(self, number: int) -> bytes:
        if number not in self._buffers:
            address = self.document["buffers"][number].get("uri")
            if address is None:
                self._buffers[number] = _binary(self.path.read_bytes())
            elif str(address).startswith("data:"):
                self._buffers[number] = base64.b64decode(str(address).partition(",")[2])
            else:
                self._buffers[number] = self.read(str(address))
        return self._buffers[number]


def _binary(content: bytes) -> bytes:
    """The second chunk of a GLB, behind its JSON."""
    (size,) = struct.unpack_from("<I", content, 12)
    return content[GLB_HEAD + size + 8 :]


def _placing(info: Json) -> Json:
    return info.get("extensions", {}).get(TRANSFORM, {})


def _color(shading: Json, absent: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    red, green, blue, alpha = (min(1.0, max(0.0, float(c))) for c in shading.get("baseColorFactor", absent))
    return red, green, blue, alpha
