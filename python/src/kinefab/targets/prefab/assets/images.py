"""Images that Unity imports, and the one that it wants in another form: metallic, occlusion and smoothness in one."""

from __future__ import annotations

import hashlib
import io
from typing import Any

import numpy as np

from ....model import Texture
from ....unity.scene import Material
from ... import images
from ...images import MAGIC, Image, ImageError, pillow

ENDINGS = frozenset(ending for _, ending in MAGIC) | {".tga"}


def read_image(texture: Texture) -> Image:
    """The bytes of a texture.  Raises ImageError for what is not there and for what Unity imports no such file of."""
    return images.read_image(texture, ENDINGS, "it is no image of a kind that Unity imports")


def content_of(texture: Texture) -> str:
    """What the texture's image holds, whatever it is called and wherever it lies, as a digest; "" where it is not to be had."""
    try:
        data = images.bytes_of(texture)
    except OSError:
        return ""
    return hashlib.md5(data, usedforsecurity=False).hexdigest()


def packed(material: Material) -> Image:
    """Metallic in R, occlusion in G, smoothness in A, with the material's own factors, which shaders do not apply to a map.

    Raises ImageError where the images cannot be read, or Pillow is not installed.
    """
    try:
        Pillow = pillow()
    except ImportError:
        raise ImageError(
            "it has to be repacked, which needs Pillow: pip install 'kinefab[picture]'"
        ) from None
    rough, occluded = material.metallicRoughnessTexture, material.occlusionTexture
    try:
        sources = [None if t is None else _eight_bit(read_image(t).data) for t in (rough, occluded)]
    except ImageError:
        raise
    except Exception as error:
        raise ImageError(str(error) or type(error).__name__) from None
    size = next(image.size for image in sources if image is not None)
    first, second = (None if image is None else image.resize(size) for image in sources)
    full = Pillow.new("L", size, 255)
    metallic, smooth = full, full
    if first is not None:
        _, g, b = first.split()
        metallic = b.point([round(material.metallic * x) for x in range(256)])
        smooth = g.point([round(255.0 - (1.0 - material.smoothness) * x) for x in range(256)])
    occlusion = full if second is None else second.split()[0]
    out = io.BytesIO()
    Pillow.merge("RGBA", (metallic, occlusion, Pillow.new("L", size, 0), smooth)).save(out, "PNG")
    return Image(out.getvalue(), ".png")


def _eight_bit(data: bytes) -> Any:
    """Red, green and blue; grey of 16 bits by their upper half, which Pillow would clip."""
    Pillow = pillow()
    image = Pillow.open(io.BytesIO(data))
    if image.mode.startswith("I"):
        pixels = np.asarray(image.convert("I"), dtype=np.float64) / 257.0
        image = Pillow.fromarray(pixels.round().clip(0, 255).astype(np.uint8))
    return image.convert("RGB")
