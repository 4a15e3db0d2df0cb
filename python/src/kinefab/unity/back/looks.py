"""A written material with its textures, whose images lie in the scene's buffers."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

from ...diagnostics import Report
from ...model import AlphaMode, Texture, Wrap
from ..scene import Material
from .nouns import told

TEXTURES = ("colorTexture", "normalTexture", "metallicRoughnessTexture", "occlusionTexture", "emissionTexture")

Entry = Mapping[str, Any]


def material(entry: Entry, images: Sequence[Entry], buffers: Sequence[bytes], report: Report) -> Material:
    """One that states no mode of its alpha is seen through where it is not whole.  Raises LookupError, TypeError or ValueError
    where an image is not there."""
    plain = {key: value for key, value in entry.items() if key not in TEXTURES}
    found: Material = told(Material, plain, f"material {entry['name']}", report)
    if "alphaMode" not in entry:
        found = replace(found, alphaMode=AlphaMode.BLEND if found.color[3] < 1.0 else AlphaMode.OPAQUE)
    shown: dict[str, Any] = {slot: _texture(entry[slot], images, buffers) for slot in TEXTURES if slot in entry}
    return replace(found, **shown) if shown else found


def _texture(entry: Entry, images: Sequence[Entry], buffers: Sequence[bytes]) -> Texture:
    image = images[int(entry["image"])]
    place, length = image["data"], int(image["byteLength"])
    offset = int(place["offset"])
    data = buffers[int(place["buffer"])][offset : offset + length]
    if offset < 0 or length < 0 or len(data) != length:
        raise ValueError("an image outside of its buffer")
    u, v = entry.get("scale", (1.0, 1.0))
    right, up = entry.get("offset", (0.0, 0.0))
    return Texture(
        str(image["name"]),
        data=data,
        media_type=str(image["mediaType"]),
        wrap=Wrap(entry.get("wrap", "repeat")),
        uv_set=int(entry.get("uvSet", 0)),
        scale=(float(u), float(v)),
        offset=(float(right), float(up)),
        rotation=math.radians(entry.get("rotation", 0.0)),
    )
