"""What an OBJ's material library states: of each material its statements, and the textures that it names."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import Any

from ...diagnostics import Report
from ...model import Texture, Wrap
from ..references import read_reference
from .pixels import MOST_BYTES

MAPS = {
    "map_kd": "color_texture",
    "norm": "normal_texture",
    "map_ke": "emission_texture",
}
"""What a statement of a library is in the model."""
UNREAD = ("map_bump", "bump", "map_d", "map_ks", "map_ns", "map_pr", "map_pm", "disp", "refl")
"""Maps that the model has no place for: heights, and single channels that Unity packs otherwise."""
_ARGUMENTS = {"-o": 3, "-s": 3, "-t": 3, "-mm": 2}
"""Most values of an option; of any other one."""
_MEDIA = {
    ".png": "image/png",
    ".jpg": "image/jpeg",
    ".jpeg": "image/jpeg",
    ".bmp": "image/bmp",
    ".tga": "image/x-tga",
}


def library_statements(content: bytes) -> dict[str, dict[str, str]]:
    """For each material of a library its statements, by their word in lower case; the last of a word, and of a name, rules."""
    found: dict[str, dict[str, str]] = {}
    material: dict[str, str] = {}
    for line in content.decode("utf-8", "replace").splitlines():
        word, rest = (*line.split(None, 1), "", "")[:2]
        if word.lower() == "newmtl":
            material = found[" ".join(rest.split())] = {}
        elif rest:
            material[word.lower()] = rest
    return found


def library_textures(statements: Mapping[str, str], path: Path, report: Report) -> dict[str, Any]:
    """The fields of a surface that are textures, and the emission they multiply.

    statements: of one material.  path: the OBJ, beside which the images stand.  What cannot be kept is in the report.
    """
    found: dict[str, Any] = {}
    for word, rest in statements.items():
        if word in MAPS and (texture := _texture(rest, path, report)) is not None:
            found[MAPS[word]] = texture
            if word == "map_ke":
                found["emission"] = (1.0, 1.0, 1.0)
        elif word in UNREAD:
            _told(rest.split()[-1], path, f"{word} has no place among the textures of a surface", report)
    return found


def _texture(statement: str, path: Path, report: Report) -> Texture | None:
    """``[options] file``; the file's name may hold spaces."""
    words = statement.split()
    values: dict[str, list[str]] = {}
    at = 0
    while at < len(words) - 1 and words[at].startswith("-"):
        option, at = words[at].lower(), at + 1
        most = _ARGUMENTS.get(option, 1)
        taken = 0
        while taken < most and at < len(words) - 1 and (taken == 0 or _number(words[at]) is not None):
            values.setdefault(option, []).append(words[at])
            at, taken = at + 1, taken + 1
    name = " ".join(words[at:]).replace("\\", "/")
    if not name:
        return None
    try:
        read_reference(path.parent, name, MOST_BYTES)  # inside the folder, regular, of bounded size
    except (OSError, ValueError) as error:
        _told(name, path, getattr(error, "strerror", None) or str(error), report)
        return None
    clamped = values.get("-clamp", [""])[0].lower() == "on"
    return Texture(
        PurePosixPath(name).name,
        Path(os.path.normpath(path.parent / name)),
        media_type=_MEDIA.get(PurePosixPath(name).suffix.lower(), ""),
        wrap=Wrap.CLAMP if clamped else Wrap.REPEAT,
        scale=_pair(values.get("-s", []), 1.0),
        offset=_pair(values.get("-o", []), 0.0),
    )


def _pair(words: list[str], absent: float) -> tuple[float, float]:
    numbers = [n for w in words[:2] if (n := _number(w)) is not None] + [absent, absent]
    return numbers[0], numbers[1]


def _number(word: str) -> float | None:
    try:
        return float(word)
    except ValueError:
        return None


def _told(name: str, path: Path, detail: str, report: Report) -> None:
    where = str(path)
    report.dropped(f"texture {name}", "TEXTURE_UNREADABLE", where, file=name, path=path.name, detail=detail)
