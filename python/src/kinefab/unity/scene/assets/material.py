from __future__ import annotations

from dataclasses import dataclass

from ....model import AlphaMode, Texture
from ..vectors import ZERO, Color, Vector3


@dataclass(frozen=True, slots=True)
class Material:
    """Of the Standard and Lit shaders, whichever pipeline a target writes.  color: linear; emission: linear RGB.
    Textures as ``model.Surface`` has them: metallic and roughness in one image, which a target packs as its shader wants."""

    name: str
    color: Color = (1.0, 1.0, 1.0, 1.0)
    metallic: float = 0.0
    smoothness: float = 0.5
    alphaMode: AlphaMode = AlphaMode.OPAQUE
    alphaCutoff: float = 0.5
    doubleSided: bool = False
    emission: Vector3 = ZERO
    colorTexture: Texture | None = None
    normalTexture: Texture | None = None
    metallicRoughnessTexture: Texture | None = None
    occlusionTexture: Texture | None = None
    emissionTexture: Texture | None = None

    @property
    def textures(self) -> tuple[Texture, ...]:
        """Those that it has."""
        slots = (
            self.colorTexture,
            self.normalTexture,
            self.metallicRoughnessTexture,
            self.occlusionTexture,
            self.emissionTexture,
        )
        return tuple(texture for texture in slots if texture is not None)
