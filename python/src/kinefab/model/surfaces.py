"""How a surface looks."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from pathlib import Path


class Wrap(str, Enum):
    """What a texture shows beyond its edge."""

    REPEAT = "repeat"
    CLAMP = "clamp"
    MIRROR = "mirror"


@dataclass(frozen=True, slots=True)
class Texture:
    """An image: a file, or bytes that lie in the source.  One of path and data is given.

    name: of the image, unique among different ones of a source.  media_type: ``image/png``, ``image/jpeg`` ...
    uv_set: which of ``Mesh.uvs``.  scale, offset, rotation: uv' = R(rotation) (scale * uv) + offset, radians, v upwards.
    """

    name: str
    path: Path | None = None
    data: bytes | None = None
    media_type: str = ""
    wrap: Wrap = Wrap.REPEAT
    uv_set: int = 0
    scale: tuple[float, float] = (1.0, 1.0)
    offset: tuple[float, float] = (0.0, 0.0)
    rotation: float = 0.0


class AlphaMode(str, Enum):
    OPAQUE = "opaque"
    MASK = "mask"  # seen where alpha is not below the cutoff
    BLEND = "blend"


@dataclass(frozen=True, slots=True)
class Surface:
    """Colours linear in 0..1, each multiplied by its texture where there is one.

    color: RGBA.  metallic, smoothness: 0..1 (Unity's Standard/Lit meaning; smoothness = 1 - roughness).
    emission: RGB, may exceed 1.  alpha_cutoff: of AlphaMode.MASK.
    color_texture: RGBA, sRGB.  normal_texture: tangent space, +Y up (OpenGL).
    metallic_roughness_texture: as glTF has it, roughness in G, metallic in B, linear.
    occlusion_texture: in R, linear.  emission_texture: RGB, sRGB.

    >>> import kinefab
    >>> brass = kinefab.Surface("brass", (0.7, 0.5, 0.2, 1.0), metallic=1.0, smoothness=0.8)
    >>> kinefab.Scene().add_part("Bush", material=brass)
    0
    """

    name: str
    color: tuple[float, float, float, float] = (0.8, 0.8, 0.8, 1.0)
    metallic: float = 0.0
    smoothness: float = 0.5
    alpha_mode: AlphaMode = AlphaMode.OPAQUE
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    emission: tuple[float, float, float] = (0.0, 0.0, 0.0)
    color_texture: Texture | None = None
    normal_texture: Texture | None = None
    metallic_roughness_texture: Texture | None = None
    occlusion_texture: Texture | None = None
    emission_texture: Texture | None = None

    @property
    def blending(self) -> AlphaMode:
        """How alpha is shown: BLEND where a colour that is not whole came without a mode, as most formats have none.

        >>> kinefab.Surface("glass", (0.9, 0.9, 1.0, 0.3)).blending.value
        'blend'
        """
        seen_through = self.alpha_mode is AlphaMode.OPAQUE and self.color[3] < 1.0
        return AlphaMode.BLEND if seen_through else self.alpha_mode


PLAIN = Surface("Default")
"""Stands in where the source names no surface."""
