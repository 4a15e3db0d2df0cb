"""Which files are sources, and where each goes."""

from __future__ import annotations

import os
import posixpath
from collections import Counter
from collections.abc import Iterable
from pathlib import Path

from ..sources import FORMATS, format_of
from . import places
from .ledger import LEDGER

VAGUE = (".json", ".txt", ".xml")
"""Endings that most files bear for other reasons: in a folder they count only where the format looks into the file."""


def planned(inputs: Iterable[str], out: str, ending: str) -> list[tuple[str, str]]:
    """(source, target) of every source named, in a folder or matched by a pattern; a folder's tree is kept.

    Two sources that would have one target keep their endings in its name.
    """
    found: dict[str, str] = {}
    for place in inputs:
        base, files = places.expand(place)
        whole = not places.is_url(place) and os.path.isdir(place)
        for file in files:
            if f"/{LEDGER}/" in file.replace(os.sep, "/") or not (_is_source(file, whole or len(files) > 1)):
                continue
            relative = posixpath.relpath(file, base) if places.is_url(file) else os.path.relpath(file, base)
            found.setdefault(file, relative.replace(os.sep, "/"))
    stems = {file: _without_ending(relative) for file, relative in found.items()}
    often = Counter(stem.casefold() for stem in stems.values())
    return [
        (file, places.join(out, (relative if often[stems[file].casefold()] > 1 else stems[file]) + ending))
        for file, relative in found.items()
    ]


def _is_source(file: str, searched: bool) -> bool:
    """searched: found among others, not named by itself."""
    name = places.name_of(file).lower()
    if not searched:
        return True  # the one who reads it says what is wrong with it
    plain = not name.endswith(VAGUE) or name.endswith(".bundle.json")
    if places.is_url(file):
        return plain and any(name.endswith(entry.suffixes) for entry in FORMATS)
    kind = format_of(Path(file))
    return kind is not None and (kind.sniffed or plain)


def _without_ending(relative: str) -> str:
    folder, _, name = relative.rpartition("/")
    suffixes = sorted({s for entry in FORMATS for s in entry.suffixes}, key=len, reverse=True)
    suffix = next((s for s in suffixes if name.lower().endswith(s)), "")
    return posixpath.join(folder, name[: len(name) - len(suffix)] or name)
