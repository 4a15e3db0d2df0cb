"""Images beside the stage, or within its package: each once, named by what it holds."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

from ....diagnostics import Report
from ....model import Texture
from ...images import ImageError, read_image

ENDINGS = (".png", ".jpg", ".exr")
"""Of the images that packages may hold."""
HASH_DIGITS = 16
"""Hexadecimal digits of an image's SHA-256 in its name."""


@dataclass(slots=True, eq=False)
class Textures:
    """prefix: of the images' names.  files: bytes by name, in the order of their first use."""

    prefix: str
    report: Report
    files: dict[str, bytes] = field(default_factory=dict[str, bytes])
    _names: dict[tuple[object, ...], str] = field(default_factory=dict[tuple[object, ...], str])

    def name(self, texture: Texture, surface: str) -> str:
        """Of the image's file, "" with a report where it cannot be had or USD has no place for it."""
        key = (texture.path, texture.data)
        if key not in self._names:
            self._names[key] = self._taken(texture, surface)
        return self._names[key]

    def _taken(self, texture: Texture, surface: str) -> str:
        try:
            image = read_image(texture, ENDINGS, "USD holds PNG, JPEG and OpenEXR only")
        except ImageError as error:
            self.report.dropped(
                f"texture {texture.name}", "TEXTURE_DROPPED",
                texture=texture.name, surface=surface, detail=error,
            )  # fmt: skip
            return ""
        name = f"{self.prefix}{hashlib.sha256(image.data).hexdigest()[:HASH_DIGITS]}{image.ending}"
        self.files[name] = image.data
        return name
