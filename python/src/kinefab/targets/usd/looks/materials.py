"""Surfaces as materials of a UsdPreviewSurface, with its textures."""

from __future__ import annotations

import math
from typing import Any

from ....model import AlphaMode, Surface, Texture, Wrap
from ..api import Gf
from ..prims import Prim
from .textures import Textures

WRAPS = {Wrap.REPEAT: "repeat", Wrap.CLAMP: "clamp", Wrap.MIRROR: "mirror"}
RAW, SRGB = "raw", "sRGB"
IDENTITY_MAP = ((1.0, 1.0), (0.0, 0.0), 0.0)


class Materials:
    """Writes each surface once, below ``scope``."""

    def __init__(self, scope: Prim, textures: Textures):
        self._scope, self._textures = scope, textures
        self._paths: dict[int, Any] = {}

    def path(self, surface: Surface) -> Any:
        """Path of a surface's material, which is written when it is first asked for."""
        key = id(surface)
        if key not in self._paths:
            self._paths[key] = self._written(surface)
        return self._paths[key]

    def _written(self, surface: Surface) -> Any:
        material = self._scope.child(surface.name or "Material", "Material")
        shader = material.child("Shader", "Shader")
        _identify(shader, "UsdPreviewSurface")
        self._fill(material, shader, surface)
        shader.attribute("outputs:surface", "Token")
        material.connect("outputs:surface", "Token", shader.path.AppendProperty("outputs:surface"))
        return material.path

    def _fill(self, material: Prim, shader: Prim, surface: Surface) -> None:
        red, green, blue, alpha = surface.color
        color = self._texture(
            material, "Color", surface, surface.color_texture, SRGB, (red, green, blue, alpha)
        )
        if color is None:
            shader.attribute("inputs:diffuseColor", "Color3f", Gf.Vec3f(red, green, blue))
        else:
            _connected(shader, "diffuseColor", "Color3f", color, "rgb", "Float3")
        if color is not None and surface.alpha_mode is not AlphaMode.OPAQUE:
            _connected(shader, "opacity", "Float", color, "a", "Float")
        elif alpha != 1.0:
            shader.attribute("inputs:opacity", "Float", alpha)
        if surface.alpha_mode is AlphaMode.MASK:
            shader.attribute("inputs:opacityThreshold", "Float", surface.alpha_cutoff)
        rough = 1.0 - surface.smoothness
        packed = self._texture(
            material, "MetallicRoughness", surface, surface.metallic_roughness_texture, RAW,
            (1.0, rough, surface.metallic, 1.0),
        )  # fmt: skip
        if packed is None:
            shader.attribute("inputs:metallic", "Float", surface.metallic)
            shader.attribute("inputs:roughness", "Float", rough)
        else:
            _connected(shader, "metallic", "Float", packed, "b", "Float")
            _connected(shader, "roughness", "Float", packed, "g", "Float")
        emission = (*surface.emission, 1.0)
        glow = self._texture(material, "Emission", surface, surface.emission_texture, SRGB, emission)
        if glow is not None:
            _connected(shader, "emissiveColor", "Color3f", glow, "rgb", "Float3")
        elif any(surface.emission):
            shader.attribute("inputs:emissiveColor", "Color3f", Gf.Vec3f(*surface.emission))
        normal = self._texture(
            material,
            "Normal",
            surface,
            surface.normal_texture,
            RAW,
            (2.0, 2.0, 2.0, 1.0),
            (-1.0, -1.0, -1.0, 0.0),
        )
        if normal is not None:
            _connected(shader, "normal", "Normal3f", normal, "rgb", "Float3")
        shade = self._texture(material, "Occlusion", surface, surface.occlusion_texture, RAW)
        if shade is not None:
            _connected(shader, "occlusion", "Float", shade, "r", "Float")

    def _texture(
        self,
        material: Prim,
        name: str,
        surface: Surface,
        texture: Texture | None,
        space: str,
        scale: tuple[float, ...] = (1.0, 1.0, 1.0, 1.0),
        bias: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0),
    ) -> Prim | None:
        """The sampler of an image; its outputs are added as they are connected."""
        file = "" if texture is None else self._textures.name(texture, surface.name)
        if texture is None or not file:
            return None
        prim = material.child(name, "Shader")
        _identify(prim, "UsdUVTexture")
        prim.attribute("inputs:file", "Asset", f"./{file}")
        prim.attribute("inputs:sourceColorSpace", "Token", space)
        for way in ("wrapS", "wrapT"):
            prim.attribute(f"inputs:{way}", "Token", WRAPS[texture.wrap])
        if scale != (1.0, 1.0, 1.0, 1.0):
            prim.attribute("inputs:scale", "Float4", Gf.Vec4f(*scale))
        if any(bias):
            prim.attribute("inputs:bias", "Float4", Gf.Vec4f(*bias))
        prim.connect("inputs:st", "Float2", _coordinates(material, name, texture))
        return prim


def uv_name(number: int) -> str:
    """Primvar of a set of texture coordinates."""
    return f"st{number}" if number else "st"


def _identify(prim: Prim, kind: str) -> None:
    prim.attribute("info:id", "Token", kind, uniform=True)


def _connected(shader: Prim, name: str, kind: str, texture: Prim, output: str, output_kind: str) -> None:
    texture.attribute(f"outputs:{output}", output_kind)
    shader.connect(f"inputs:{name}", kind, texture.path.AppendProperty(f"outputs:{output}"))


def _coordinates(material: Prim, name: str, texture: Texture) -> Any:
    """Path of the output that gives a sampler its coordinates."""
    reader = material.child(f"{name}Coordinates", "Shader")
    _identify(reader, "UsdPrimvarReader_float2")
    reader.attribute("inputs:varname", "String", uv_name(texture.uv_set))
    reader.attribute("outputs:result", "Float2")
    result = reader.path.AppendProperty("outputs:result")
    if (texture.scale, texture.offset, texture.rotation) == IDENTITY_MAP:
        return result
    turned = material.child(f"{name}Placement", "Shader")
    _identify(turned, "UsdTransform2d")
    turned.connect("inputs:in", "Float2", result)
    turned.attribute("inputs:scale", "Float2", Gf.Vec2f(*texture.scale))
    turned.attribute("inputs:rotation", "Float", math.degrees(texture.rotation))
    turned.attribute("inputs:translation", "Float2", Gf.Vec2f(*texture.offset))
    turned.attribute("outputs:result", "Float2")
    return turned.path.AppendProperty("outputs:result")
