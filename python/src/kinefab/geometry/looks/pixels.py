"""Bytes of textures, and where Pillow is installed their pixels: as eight bits a channel, and channels of several images in one."""

from __future__ import annotations

import io
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...model import Texture
from ..references import read_regular

MOST_BYTES = 256 * 2**20
"""Of one image."""
MOST_PIXELS = 16384 * 16384
"""Of one image: what Unity and others show at most."""
GREY = {"rgb": 0, "r": 0, "g": 1, "b": 2, "a": 3}
"""Which channel of red, green, blue and opacity one number is taken of."""


def bytes_of(texture: Texture) -> bytes:
    """As they are.  Raises OSError for a file that is not there, no regular one, or too large."""
    if texture.data is not None:
        return texture.data
    return read_regular(texture.path, MOST_BYTES) if texture.path else b""


def pillow() -> Any:
    """The library that reads images, taking those of as many pixels as an editor does.  Raises ImportError."""
    from PIL import Image

    Image.MAX_IMAGE_PIXELS = MOST_PIXELS
    return Image


def eight_bit(data: bytes, mode: str = "RGB") -> Any:
    """An image in that mode of Pillow; grey of 16 bits by their upper half, which Pillow would clip.  Raises what Pillow does:
    OSError, SyntaxError, struct.error ... by the format."""
    Pillow = pillow()
    image = Pillow.open(io.BytesIO(data))
    if image.mode.startswith("I"):
        pixels = np.asarray(image.convert("I"), dtype=np.float64) / 257.0
        image = Pillow.fromarray(pixels.round().clip(0, 255).astype(np.uint8))
    return image.convert(mode)


def merged(channels: Sequence[tuple[bytes, str] | None]) -> bytes:
    """A PNG of three or four channels, each of an image and its channel ('r', 'g', 'b', 'a'), full for None; as large as the
    largest image.  Raises ImportError, and what Pillow does."""
    Pillow = pillow()
    read = {data: eight_bit(data, "RGBA") for data in dict.fromkeys(c[0] for c in channels if c is not None)}
    size = max((image.size for image in read.values()), key=lambda size: size[0] * size[1])
    bands = {data: image.resize(size).split() for data, image in read.items()}
    full = Pillow.new("L", size, 255)
    chosen = [full if c is None else bands[c[0]][GREY[c[1]]] for c in channels]
    out = io.BytesIO()
    Pillow.merge("RGBA" if len(chosen) > 3 else "RGB", chosen).save(out, "PNG", compress_level=1)
    return out.getvalue()


def recoded(data: bytes, factors: Sequence[float], offsets: Sequence[float]) -> bytes:
    """A PNG whose red, green and blue, from 0 to 1, are those of an image times their factors, and their offsets added.
    Raises ImportError, and what Pillow does."""
    pixels = np.asarray(eight_bit(data), dtype=np.float64) * factors + 255.0 * np.array(offsets)
    out = io.BytesIO()
    pillow().fromarray(pixels.round().clip(0, 255).astype(np.uint8)).save(out, "PNG", compress_level=1)
    return out.getvalue()
