"""Images that Unity imports, and the one that it wants in another form: metallic, occlusion and smoothness in one."""

from __future__ import annotations

import hashlib
import io
from collections.abc import Callable

from ....extras import install
from ....geometry.looks.pixels import bytes_of, eight_bit, pillow
from ....model import Texture
from ....unity.scene import Material
from ... import images
from ...images import LOADED, MAGIC, ImageError

ENDINGS = frozenset(ending for _, ending in MAGIC) | {".tga"}


class Images:
    """Whether images can be used, each looked at once, however many materials show it."""

    def __init__(self) -> None:
        self._endings: dict[object, str | ImageError] = {}
        self._pixels: dict[object, str | ImageError] = {}

    def ending(self, texture: Texture) -> str:
        """Of the file.  Raises ImageError for what is not there and for what Unity imports no such file of."""
        return _once(self._endings, texture, _ending)

    def demand_pixels(self, texture: Texture) -> None:
        """Raises ImageError where they cannot be read, also because Pillow is not installed."""
        ending = self.ending(texture)
        try:
            pillow()
        except ImportError:
            told = f"it has to be repacked, which needs Pillow: {install('picture')}"
            raise ImageError(told) from None
        if ending not in LOADED:
            _once(self._pixels, texture, _decoded)


def _once(known: dict[object, str | ImageError], texture: Texture, ask: Callable[[Texture], str]) -> str:
    image = texture.path if texture.data is None else texture.data
    if image not in known:
        try:
            known[image] = ask(texture)
        except ImageError as error:
            known[image] = error
    found = known[image]
    if isinstance(found, ImageError):
        raise found
    return found


def _ending(texture: Texture) -> str:
    return images.read_image(texture, ENDINGS, "it is no image of a kind that Unity imports").ending


def _decoded(texture: Texture) -> str:
    try:
        eight_bit(bytes_of(texture))
    except Exception as error:  # Pillow raises OSError, SyntaxError, struct.error ... by the format
        raise ImageError(str(error) or type(error).__name__) from None
    return ""


def content_of(texture: Texture) -> str:
    """What the texture's image holds, whatever it is called and wherever it lies, as a digest; "" where it is not to be had."""
    try:
        data = bytes_of(texture)
    except OSError:
        return ""
    return hashlib.md5(data, usedforsecurity=False).hexdigest()


def packed(material: Material) -> bytes:
    """A PNG with metallic in R, occlusion in G, smoothness in A, with the material's own factors, which shaders do not apply to
    a map; of images whose pixels were demanded before."""
    Pillow = pillow()
    rough, occluded = material.metallicRoughnessTexture, material.occlusionTexture
    sources = [None if t is None else eight_bit(bytes_of(t)) for t in (rough, occluded)]
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
    return out.getvalue()
