"""Images of textures, as the files that targets hold: their bytes as they are, of a kind that is known by how it begins."""

from __future__ import annotations

import io
from collections.abc import Collection
from dataclasses import dataclass

from ..geometry.looks.pixels import bytes_of, pillow
from ..model import Texture

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
"""How images begin, and the endings of their files; a Targa has no such beginning."""
LOADED = (".png", ".jpg", ".bmp", ".gif")
"""Endings of images whose every pixel is looked at, where Pillow is installed."""


class ImageError(Exception):
    """Why an image cannot be used."""


@dataclass(frozen=True, slots=True)
class Image:
    """ending: of its file, by what it holds."""

    data: bytes
    ending: str


def read_image(texture: Texture, endings: Collection[str], otherwise: str) -> Image:
    """The bytes of a texture.

    endings: of the kinds that the target holds.  otherwise: what is said of another kind.
    Raises ImageError for what is not there, is no regular file of a bounded size, breaks off, or is of another kind.
    """
    try:
        data = bytes_of(texture)
    except OSError as error:
        raise ImageError(error.strerror or str(error)) from None
    ending = next((ending for magic, ending in MAGIC if data.startswith(magic)), "")
    named = texture.media_type == "image/x-tga" or (texture.path is not None and texture.path.suffix.lower() == ".tga")
    if not ending and named and len(data) > 18:
        ending = ".tga"
    if ending not in endings:
        raise ImageError(otherwise if data else "it is empty")
    _demand_whole(data, ending)
    return Image(data, ending)


def _demand_whole(data: bytes, ending: str) -> None:
    """Raises ImageError for an image that breaks off, as far as the libraries at hand can tell."""
    if ending == ".png" and b"IEND" not in data[-32:]:
        raise ImageError("it breaks off")
    try:
        Pillow = pillow()
    except ImportError:
        return
    if ending in LOADED:
        try:
            with Pillow.open(io.BytesIO(data)) as image:
                image.load()
        except Exception as error:  # Pillow raises OSError, SyntaxError, struct.error ... by the format
            raise ImageError(str(error) or type(error).__name__) from None


def jpeg_channels(data: bytes) -> int:
    """Of a JPEG, by its frame header (ITU-T T.81, B.2.2): 1 grey, 3 colours, 4 inks; 0 where there is none."""
    at = 2
    while at + 9 < len(data) and data[at] == 0xFF:
        marker = data[at + 1]
        if 0xC0 <= marker <= 0xCF and marker not in (0xC4, 0xC8, 0xCC):
            return data[at + 9]
        at += 1 if marker == 0xFF else 2 + int.from_bytes(data[at + 2 : at + 4], "big")
    return 0
