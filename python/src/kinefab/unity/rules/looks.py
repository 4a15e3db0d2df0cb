"""Materials and their textures, and images."""

from __future__ import annotations

from collections.abc import Sequence

from .buffers import check_place
from .findings import Entry, Findings

TEXTURES = (
    "colorTexture",
    "normalTexture",
    "metallicRoughnessTexture",
    "occlusionTexture",
    "emissionTexture",
)
BEGINNINGS = {"image/png": b"\x89PNG\r\n\x1a\n", "image/jpeg": b"\xff\xd8\xff"}


def check_materials(materials: Sequence[Entry], images: int, found: Findings) -> None:
    for index, material in enumerate(materials):
        for channel, value in enumerate(material.get("emission", ())):
            if value < 0:
                at = f"/materials/{index}/emission/{channel}"
                found.add("NUMBER_OUT_OF_RANGE", at, value=value, range="0 or above")
        for name in TEXTURES:
            if name in material:
                found.reference(material[name]["image"], "images", images, f"/materials/{index}/{name}/image")


def check_image(
    image: Entry, at: str, buffers: list[Entry], contents: Sequence[bytes | None], found: Findings
) -> None:
    """That its file lies in its buffer and begins as its kind does; it is not decoded."""
    place, length, kind = image["data"], image["byteLength"], image["mediaType"]
    if length < 0 or not check_place(place, length, buffers, f"{at}/data", found):
        return
    content = contents[place["buffer"]]
    beginning = BEGINNINGS.get(kind, b"")
    if content is not None and not content[place["offset"] : place["offset"] + length].startswith(beginning):
        found.add("IMAGE_NOT_OF_KIND", f"{at}/data", mediaType=kind)
