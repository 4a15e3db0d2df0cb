"""Images as they are, and the one that Unity wants in another form: metallic, occlusion and smoothness in one."""

from __future__ import annotations

import io
from dataclasses import dataclass

from ....model import Texture
from ....unity.scene import Material

MAGIC = (
    (b"\x89PNG\r\n\x1a\n", ".png"),
    (b"\xff\xd8\xff", ".jpg"),
    (b"BM", ".bmp"),
    (b"II*\0", ".tif"),
    (b"MM\0*", ".tif"),
    (b"8BPS", ".psd"),
    (b"GIF8", ".gif"),
    (b"v/1\x01", ".exr"),
    (b"#?RADIANCE", ".hdr"),
)
"""How the images that Unity imports begin, and their endings; a Targa has no such beginning."""


class ImageError(Exception):
    """Why an image cannot be used."""


@dataclass(frozen=True, slots=True)
class Image:
    """ending: of its file, by what it holds."""

    data: bytes
    ending: str


def read_image(texture: Texture) -> Image:
    """The bytes of a texture.  Raises ImageError for what is not there and for what Unity imports no such file of."""
    try:
        data = (
            texture.data if texture.data is not None else texture.path.read_bytes() if texture.path else b""
        )
    except OSError as error:
        raise ImageError(error.strerror or str(error)) from None
    ending = next((ending for magic, ending in MAGIC if data.startswith(magic)), "")
    if not ending and texture.path is not None and texture.path.suffix.lower() == ".tga" and len(data) > 18:
        ending = ".tga"
    if not ending:
        raise ImageError("it is no image of a kind that Unity imports" if data else "it is empty")
    _demand_whole(data, ending)
    return Image(data, ending)


def _demand_whole(data: bytes, ending: str) -> None:
    """Raises ImageError for an image that breaks off, as far as the libraries at hand can tell."""
    if ending == ".png" and b"IEND" not in data[-32:]:
        raise ImageError("it breaks off")
    try:
        from PIL import Image as Pillow
    except ImportError:
        return
    if ending in (".png", ".jpg", ".bmp", ".gif"):
        try:
            with Pillow.open(io.BytesIO(data)) as image:
                image.load()
        except Exception as error:  # Pillow raises OSError, SyntaxError, struct.error ... by the format
            raise ImageError(str(error) or type(error).__name__) from None


def packed(material: Material) -> Image:
    """Metallic in R, occlusion in G, smoothness in A, with the material's own factors, which shaders do not apply to a map.

    Raises ImageError where the images cannot be read, or Pillow is not installed.
    """
    try:
        from PIL import Image as Pillow
    except ImportError:
        raise ImageError(
            "it has to be repacked, which needs Pillow: pip install 'kinefab[picture]'"
        ) from None
    rough, occluded = material.metallicRoughnessTexture, material.occlusionTexture
    try:
        sources = [
            None if t is None else Pillow.open(io.BytesIO(read_image(t).data)).convert("RGB")
            for t in (rough, occluded)
        ]
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
    Pillow.merge("RGBA", (metallic, occlusion, full.point(lambda _: 0), smooth)).save(out, "PNG")
    return Image(out.getvalue(), ".png")
