"""Images beside the stage, or within its package: each once, named by what it holds."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field

from ....diagnostics import Report
from ....model import Texture

SIGNATURES = {b"\x89PNG\r\n\x1a\n": "png", b"\xff\xd8\xff": "jpg", b"v/1\x01": "exr"}
"""First bytes of the images that packages may hold, and their endings."""
MOST_BYTES = 256 * 2**20
"""Of one image."""
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
        data, why = texture.data, ""
        if data is None and texture.path is not None:
            try:
                if not texture.path.is_file() or texture.path.stat().st_size > MOST_BYTES:
                    raise OSError("it is no regular file of a bounded size")
                data = texture.path.read_bytes()
            except OSError as error:
                why = error.strerror or str(error)
        ending = next((e for head, e in SIGNATURES.items() if data is not None and data.startswith(head)), "")
        if data is None or not ending:
            self.report.dropped(
                f"texture {texture.name}", "TEXTURE_DROPPED",
                texture=texture.name, surface=surface, detail=why or "USD holds PNG, JPEG and OpenEXR only",
            )  # fmt: skip
            return ""
        name = f"{self.prefix}{hashlib.sha256(data).hexdigest()[:HASH_DIGITS]}.{ending}"
        self.files[name] = data
        return name
