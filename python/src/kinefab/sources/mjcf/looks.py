"""Materials and the colours of geoms as surfaces."""

from __future__ import annotations

import struct
import zlib
from dataclasses import dataclass, field

import numpy as np

from ...color import linear
from ...diagnostics import Report
from ...model import AlphaMode, Surface, Texture
from ...spatial import IntArray
from ..robots.colors import clamped
from .engine import Compiled

UNCOLOURED = (0.5, 0.5, 0.5, 1.0)
"""MuJoCo's colour of a geom that states none: then its material's counts."""
COLOURING = (1, 8)
"""Roles of textures that colour, without and with opacity (mjtTextureRole)."""


@dataclass(slots=True)
class Looks:
    """surfaces: the scene's, which grow; one for each material and colour."""

    compiled: Compiled
    surfaces: list[Surface]
    report: Report
    _known: dict[tuple[object, ...], int] = field(default_factory=dict[tuple[object, ...], int])
    _told: set[int] = field(default_factory=set[int])

    def of(self, geom: int, has_uvs: bool) -> tuple[int, ...]:
        """The index of a geom's surface in the scene's, as a body has it: of its material, in its own colour where it
        states one."""
        m = self.compiled.model
        material = int(m.geom_matid[geom])
        rgba = tuple(round(float(v), 7) for v in m.geom_rgba[geom])
        if material >= 0 and rgba == UNCOLOURED:
            rgba = tuple(round(float(v), 7) for v in m.mat_rgba[material])
        texture = self._texture_of(material) if material >= 0 else -1
        plain = int(self.compiled.mujoco.mjtTexture.mjTEXTURE_2D)
        if texture >= 0 and not (has_uvs and int(m.tex_type[texture]) == plain):
            name = self.compiled.name("tex", texture) or f"texture {texture}"
            self.report.dropped(
                f"texture {name} on {self.compiled.name('geom', geom) or f'geom {geom}'}",
                "MJCF_TEXTURE",
                self.compiled.where("texture", name),
                texture=name,
            )
            texture = -1
        key = (material, rgba, texture)
        if key not in self._known:
            self._known[key] = len(self.surfaces)
            color = self._color(geom, material, rgba)
            self.surfaces.append(self._surface(material, color, texture))
        return (self._known[key],)

    def _color(self, geom: int, material: int, rgba: tuple[float, ...]) -> tuple[float, ...]:
        kind, word, index = ("geom", "geom", geom) if material < 0 else ("mat", "material", material)
        name = self.compiled.name(kind, index) or str(index)
        return clamped(rgba, f"colour of {word} {name}", self.compiled.where(word, name), self.report)

    def _texture_of(self, material: int) -> int:
        """The one that colours; -1 without one."""
        ids = np.atleast_1d(self.compiled.model.mat_texid[material])
        found = [int(ids[role]) for role in COLOURING if role < len(ids) and ids[role] >= 0]
        return found[0] if found else -1

    def _tell_layers(self, material: int, name: str) -> None:
        """The textures that do not colour; MuJoCo's own windows show none of them either."""
        roles = self.compiled.mujoco.mjtTextureRole
        ids: IntArray = np.atleast_1d(self.compiled.model.mat_texid[material])
        for role, texture in enumerate(ids.tolist()):
            if role not in COLOURING and texture >= 0:
                word = str(roles(role).name).removeprefix("mjTEXROLE_").lower()
                feature = f"{word} texture {self.compiled.name('tex', texture)} of material {name}"
                self.report.dropped(feature, "MJCF_LEFT_OUT", self.compiled.where("material", name))

    def _surface(self, material: int, rgba: tuple[float, ...], texture: int) -> Surface:
        m = self.compiled.model
        red, green, blue, alpha = rgba
        mode = AlphaMode.BLEND if alpha < 1.0 else AlphaMode.OPAQUE
        name = "Color " + "".join(f"{round(255 * v):02X}" for v in (red, green, blue, alpha))
        red, green, blue = linear(red), linear(green), linear(blue)
        if material < 0:
            return Surface(name, (red, green, blue, alpha), alpha_mode=mode)
        name = self.compiled.name("mat", material) or f"material{material}"
        metallic, roughness = float(m.mat_metallic[material]), float(m.mat_roughness[material])
        shine = 1.0 - roughness if roughness >= 0.0 else float(m.mat_shininess[material])
        glow = float(m.mat_emission[material])
        if material not in self._told:
            self._told.add(material)
            self._tell_layers(material, name)
        return Surface(
            name,
            (red, green, blue, alpha),
            min(1.0, max(0.0, metallic)),
            min(1.0, max(0.0, shine)),
            mode,
            emission=(glow * red, glow * green, glow * blue),
            color_texture=None if texture < 0 else self._texture(material, texture),
        )

    def _texture(self, material: int, index: int) -> Texture | None:
        m = self.compiled.model
        name = self.compiled.name("tex", index) or f"texture{index}"
        across, up = (float(v) for v in m.mat_texrepeat[material])
        if name in self.compiled.textures:
            path = self.compiled.textures[name]
            turned, headlong = self.compiled.flipped.get(name, (False, False))
            scale = (-across if turned else across, -up if headlong else up)
            offset = (float(turned), float(headlong))
            return None if path is None else Texture(path.name, path, scale=scale, offset=offset)
        width, height = int(m.tex_width[index]), int(m.tex_height[index])
        channels, start = int(m.tex_nchannel[index]), int(m.tex_adr[index])
        pixels = np.array(m.tex_data[start : start + width * height * channels], dtype=np.uint8)
        data = png(pixels.reshape(height, width, channels)[:, :, :3])
        return Texture(f"{name}.png", data=data, media_type="image/png", scale=(across, up))


def png(pixels: np.ndarray) -> bytes:
    """Of 8-bit RGB, shape (height, width, 3), the first row on top.  Source: PNG specification, third edition, section 5."""
    height, width, _ = pixels.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), pixels.reshape(height, -1)], axis=1)

    def chunk(kind: bytes, content: bytes) -> bytes:
        return (
            struct.pack(">I", len(content)) + kind + content + struct.pack(">I", zlib.crc32(kind + content))
        )

    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", head)
        + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6))
        + chunk(b"IEND", b"")
    )
