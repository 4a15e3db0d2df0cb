"""OmniPBR, the MDL surface of Omniverse and Isaac Sim, as the inputs of a UsdPreviewSurface.

Its images stand in inputs of its own shader, and are counted only as far as their influence says so.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ..api import UsdShade
from ..values import Values
from .inputs import Inputs
from .textures import Sampler, moved, read_floats, read_image, read_input

NAMES = frozenset(("OmniPBR", "OmniPBR_Opacity", "OmniPBR_ClearCoat", "OmniPBR_ClearCoat_Opacity"))
"""What the material is called in its module."""
WHITE = (1.0, 1.0, 1.0)
DIFFUSE = (0.2, 0.2, 0.2)
EMISSIVE = (1.0, 0.1, 0.1)
"""Colours of a shader that states none."""
REFLECTED = 0.08
"""Share of the light that falls straight on a surface of specular level 1."""
ALPHA = 0
"""The mode in which an image's alpha is the opacity; the others make it of its colours."""


def inputs_of(
    shader: Any, uv_names: tuple[str, ...], display: Mapping[str, tuple[float, ...]], values: Values
) -> OmniInputs:
    """Of an OmniPBR shader; what other shaders make for it is told, as none is read."""
    found = OmniInputs(shader, uv_names, display, values)
    for given in shader.GetInputs():
        for attribute in given.GetValueProducingAttributes():
            source = UsdShade.Shader(attribute.GetPrim())
            if source and source.GetPrim() != shader.GetPrim():
                found.lost(given.GetBaseName(), f"it comes from {source.GetPath()}, which is not read")
    return found


@dataclass(frozen=True, slots=True, eq=False)
class OmniInputs(Inputs):
    """Inputs of an OmniPBR shader by the names that a UsdPreviewSurface has for them."""

    def value(self, name: str) -> Any:
        if name == "diffuseColor":
            color = self._color("diffuse_color_constant", DIFFUSE)
            return [c * t for c, t in zip(color, self._color("diffuse_tint", WHITE))]
        if name == "roughness":
            return self._number("reflection_roughness_constant", 0.5)
        if name == "metallic":
            return self._number("metallic_constant", 0.0)
        if name == "emissiveColor":
            return self._color("emissive_color", EMISSIVE) if self._flag("enable_emission") else None
        if name == "opacity":
            return self._number("opacity_constant", 1.0) if self._flag("enable_opacity") else None
        if name == "opacityThreshold":
            return self._number("opacity_threshold", 0.0) if self._flag("enable_opacity") else None
        if name == "clearcoat":
            return self._number("clearcoat_weight", 1.0) if self._flag("enable_clearcoat") else None
        if name == "ior":
            root = math.sqrt(min(0.99, max(0.0, REFLECTED * self._number("specular_level", 0.5))))
            return (1.0 + root) / (1.0 - root)
        return None

    def sampler(self, name: str) -> Sampler | None:
        packed = self._flag("enable_ORM_texture")
        if name == "diffuseColor":
            return self._diffuse()
        if name == "roughness":
            share = self._number("reflection_roughness_texture_influence", 0.0)
            return self._of(
                name, share, *(("ORM_texture", "g") if packed else ("reflectionroughness_texture", "r"))
            )
        if name == "metallic":
            share = self._number("metallic_texture_influence", 0.0)
            return self._of(name, share, *(("ORM_texture", "b") if packed else ("metallic_texture", "r")))
        if name == "occlusion":
            share = self._number("ao_to_diffuse", 0.0)
            return self._of(name, share, "ORM_texture" if packed else "ao_texture", "r")
        if name == "opacity" and self._flag("enable_opacity") and self._flag("enable_opacity_texture"):
            alpha = self._number("opacity_mode", 1.0) == ALPHA
            return self._image("opacity_texture", "a" if alpha else "r")
        if name == "emissiveColor" and self._flag("enable_emission"):
            return self._emissive()
        if name == "normal":
            return self._normal()
        return None

    def _diffuse(self) -> Sampler | None:
        bright = self._number("albedo_brightness", 1.0)
        r, g, b = (bright * t for t in self._color("diffuse_tint", WHITE))
        found = self._image("diffuse_texture", "rgb", (r, g, b))
        for changed in ("albedo_add", "albedo_desaturation"):
            if found is not None and self._number(changed, 0.0) != 0.0:
                self.approximated(changed, "the image's colours were taken as they are")
        return found

    def _of(self, name: str, share: float, texture: str, output: str) -> Sampler | None:
        """An image that counts by a share beside the constant."""
        found = self._image(texture, output) if share > 0.0 else None
        if found is not None and share < 1.0:
            self.approximated(name, f"its image counts {share:g} times; it was taken whole")
        return found

    def _emissive(self) -> Sampler | None:
        color = self._color("emissive_color", EMISSIVE)
        self.approximated("emissive_intensity", "its unit is Omniverse's; the colour was taken alone")
        shown, mask = (
            self._image(n, "rgb", color) for n in ("emissive_color_texture", "emissive_mask_texture")
        )
        if shown is not None and mask is not None:
            self.lost("emissive_mask_texture", "Unity has one image of what shines")
        return shown or mask

    def _normal(self) -> Sampler | None:
        """An image of normals, which has y downwards, as DirectX has it, where nothing else is said."""
        detail = "detail_normalmap_texture"
        if self._named(detail) and self._number("detail_bump_factor", 0.3) != 0.0:
            self.lost(detail, "Unity's standard surface has one image of normals here")
        strength = self._number("bump_factor", 1.0)
        if strength == 0.0:
            return None
        x = -1.0 if self._flag("flip_tangent_u") else 1.0
        y = -1.0 if self._flag("flip_tangent_v", True) else 1.0
        found = self._image("normalmap_texture", "rgb", (2.0 * x, 2.0 * y, 2.0), (-x, -y, -1.0))
        if found is not None and strength != 1.0:
            self.approximated("bump_factor", f"the image of normals counts as 1, not as {strength:g}")
        return found

    def _image(
        self,
        name: str,
        output: str,
        tint: tuple[float, float, float] = WHITE,
        bias: tuple[float, float, float] = (0.0, 0.0, 0.0),
    ) -> Sampler | None:
        """The image of an input, None for none; that it is not there is told."""
        if not self._named(name):
            return None
        texture = read_image(self.shader, name, f"{name} of {self.shader.GetPath()}", self.values)
        if texture is None:
            return None
        scale = read_floats(self.shader, "texture_scale", (1.0, 1.0), self.values)
        shift = read_floats(self.shader, "texture_translate", (0.0, 0.0), self.values)
        (turn,) = read_floats(self.shader, "texture_rotate", (0.0,), self.values)
        if turn or any(shift):
            self.approximated("texture_rotate", "about which point its images turn and move may differ")
        if self._flag("project_uvw"):
            self.approximated("project_uvw", "its images lie by the mesh's coordinates, not projected")
        uv_set = int(self._number("uv_space_index", 0.0))
        if not 0 <= uv_set < max(1, len(self.uv_names)):
            self.approximated("uv_space_index", f"the mesh has no coordinates {uv_set}; its first were taken")
            uv_set = 0
        move = (scale[0], scale[1]), (shift[0], shift[1]), math.radians(turn)
        return Sampler(moved(texture, uv_set, move), output, tint, 1.0, bias)

    def _named(self, name: str) -> bool:
        given = read_input(self.shader, name, self.values)
        return given is not None and bool(getattr(given, "path", given))  # @@ is no image

    def _color(self, name: str, default: tuple[float, float, float]) -> tuple[float, float, float]:
        r, g, b = read_floats(self.shader, name, default, self.values)
        return r, g, b

    def _number(self, name: str, default: float) -> float:
        return read_floats(self.shader, name, (default,), self.values)[0]

    def _flag(self, name: str, default: bool = False) -> bool:
        return bool(read_floats(self.shader, name, (float(default),), self.values)[0])
