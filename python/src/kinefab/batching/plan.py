"""Which files are sources, and where each goes."""

from __future__ import annotations

import os
import posixpath
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from ..diagnostics import diagnostic, named
from ..sources import FORMATS, format_of
from . import places
from .job import Job, Outcome, Record, unmade
from .ledger import LEDGER, is_ours

VAGUE = (".json", ".txt", ".xml", ".kinefab")
"""Endings that most files bear for other reasons: in a folder they count only where the format looks into the file, and a scene,
which mostly was made of another one there, only where it is named."""


NAMED = 3
"""Of the files that share a target, those that each one's finding names: with all of them a thousand told a million."""


@dataclass(frozen=True, slots=True)
class Plan:
    """work: (source, target) of each file to convert.  refused: what is not even tried, and why."""

    work: list[tuple[str, str]]
    refused: list[Record]


def planned(inputs: Iterable[str], out: str, ending: str) -> Plan:
    """Every source named, in a folder or matched by a pattern, and its target; a folder's tree is kept.

    Two sources that would have one target keep their endings in its name; where that does not tell them apart, as with
    one name in two folders named, both are refused.  What lies in ``out`` is no source where ``out`` is a folder below an
    input; where it is the input itself, what an earlier batch wrote is none.
    """
    found: dict[str, str] = {}
    refused: list[Record] = []
    for place in inputs:
        expanded = places.expand(place)
        files = [
            file
            for file in expanded.files
            if not expanded.searched
            or (_is_source(file) and not _is_output(file, expanded.base, out, ending))
        ]
        for folder, reason in expanded.unlisted:
            detail = f"the folder {folder}: {reason}"
            refused.append(unmade(folder, out, Outcome.FAILED, diagnostic("BATCH_IO", detail=detail)))
        if not files and not expanded.unlisted:
            nothing = diagnostic("BATCH_INPUT_EMPTY", input=place)
            refused.append(unmade(place, out, Outcome.FAILED, nothing))
        for file in files:
            relative = (
                posixpath.relpath(file, expanded.base)
                if places.is_url(file)
                else os.path.relpath(file, expanded.base)
            )
            found.setdefault(file, relative.replace(os.sep, "/"))
    stems = {file: _without_ending(relative) for file, relative in found.items()}
    often = Counter(stem.casefold() for stem in stems.values())
    targets = {
        file: places.join(out, (relative if often[stems[file].casefold()] > 1 else stems[file]) + ending)
        for file, relative in found.items()
    }
    sharing: dict[str, list[str]] = {}
    for file, target in targets.items():
        sharing.setdefault(target.casefold(), []).append(file)
    for files in sharing.values():
        for file in files if len(files) > 1 else ():
            others = named((other for other in files if other != file), NAMED)
            shared = diagnostic("BATCH_TARGET_SHARED", path=targets[file], others=others)
            refused.append(unmade(file, targets.pop(file), Outcome.FAILED, shared))
    return Plan(list(targets.items()), refused)


def _is_output(file: str, base: str, out: str, ending: str) -> bool:
    """Whether a file that was found is one that batches write."""
    if f"/{LEDGER}/" in file.replace(os.sep, "/"):
        return True
    if not places.within(file, out):
        return False
    own = Job(file, file, places.join(out, LEDGER))
    return places.within(out, base) or (file.endswith(ending) and is_ours(own))


def _is_source(file: str) -> bool:
    """Of a file that was found; what is named by itself its reader says."""
    name = places.name_of(file).lower()
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
