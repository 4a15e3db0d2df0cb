"""Images made anew: several as one, where a surface has one for what USD gives each its own, and normals as Unity counts them."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import PurePosixPath

from ....geometry.looks.pixels import bytes_of, merged, recoded
from ....model import Texture
from .textures import Sampler


def packed(channels: Sequence[tuple[Sampler, str] | None]) -> Texture | None:
    """An image whose channels are those of these samplers' images, full for None; None where the images lie differently on
    the mesh, or their pixels cannot be read, also because Pillow is not installed."""
    textures = [channel[0].texture for channel in channels if channel is not None]
    first = textures[0]
    if any(_laid(texture) != _laid(first) for texture in textures):
        return None
    return _made(
        first,
        "packed",
        lambda: merged([None if c is None else (bytes_of(c[0].texture), c[1]) for c in channels]),
    )


def normals_of(sampler: Sampler) -> Texture | None:
    """The image of normals from -1 to 1, as all their axes are counted in Unity; None where its pixels cannot be read."""
    factors, offsets = [0.5 * s for s in sampler.tint], [0.5 * (b + 1.0) for b in sampler.bias]
    return _made(sampler.texture, "normals", lambda: recoded(bytes_of(sampler.texture), factors, offsets))


def _made(like: Texture, what: str, make: Callable[[], bytes]) -> Texture | None:
    """An image that lies on the mesh as another does."""
    try:
        data = make()
    except MemoryError:
        raise
    # ImportError without Pillow, which itself raises OSError, SyntaxError, struct.error ... by the format.
    except Exception:
        return None
    name = f"{PurePosixPath(like.name).stem} {what}-{hashlib.sha256(data).hexdigest()[:8]}.png"
    return replace(like, name=name, path=None, data=data, media_type="image/png")


def _laid(texture: Texture) -> tuple[object, ...]:
    return texture.wrap, texture.uv_set, texture.scale, texture.offset, texture.rotation
