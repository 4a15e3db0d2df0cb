"""The Unity project that a prefab is written into."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from .manifest import MANIFEST, read_manifest
from .objects.couplings import SCRIPT, script_guid
from .text.ids import guid
from .text.metas import guid_in

ASSETS = "Assets"
Elsewhere = Sequence[tuple[Path, list[str]]]
"""Folders of a project with their files' names."""


def elsewhere_in_project(target: Path) -> Elsewhere:
    """Where scripts and prefabs of the target's name are in its project, without the target's own; nothing outside a project."""
    absolute = _absolute(target)
    assets, own, meta = _assets(absolute), absolute.with_suffix(""), f"{absolute.name}.meta"
    asked = (f"{SCRIPT}.meta", meta, MANIFEST)
    if assets.name != ASSETS:
        return []
    found: list[tuple[Path, list[str]]] = []
    for where, folders, names in os.walk(assets):
        here = Path(where)
        folders[:] = [
            name
            for name in folders
            if not name.startswith(".") and not (name == own.name and _is_one(here / name, own))
        ]
        if meta in names and _is_one(here, own.parent):
            names.remove(meta)
        if names := [name for name in names if name in asked]:
            found.append((here, names))
    return found


def has_script(elsewhere: Elsewhere) -> bool:
    """Whether another export left the script in the project already: a second one of its assembly's name, and of its guid,
    would keep the project from compiling.  False outside a project's ``Assets``."""
    script = f"{SCRIPT}.meta"
    return any(
        script in names and guid_in(where / script) == script_guid(SCRIPT) for where, names in elsewhere
    )


def lends_script(target: Path, elsewhere: Elsewhere, folder: str) -> bool:
    """Whether the last export of the target left the project its only script, which other prefabs may have come to need.
    folder: of the script, from the folder that holds the prefab."""
    if _assets(_absolute(target)).name != ASSETS:
        return False
    ours = read_manifest(target.with_name(target.stem)).ours
    return f"{folder}/{SCRIPT}" in ours and not has_script(elsewhere)


def identity_of(target: Path, elsewhere: Elsewhere) -> str:
    """By what the prefab's guids are told from those of other exports: "" for its name alone; where another export in the project
    has that one's guids, its place too.  What an earlier export of the target chose stays.

    The other may have been moved or renamed in the editor, or have come in a package: Unity keeps guids then.
    """
    name, meta = target.stem, f"{target.name}.meta"
    taken: set[str] = set()
    for where, names in elsewhere:
        metas = [where / meta] if meta in names else []
        if MANIFEST in names:
            metas.append(where.with_name(f"{where.name}{target.suffix}.meta"))
        taken |= {guid_in(path) for path in metas}
    known = read_manifest(target.with_name(name)).identity
    for identity in (known, ""):
        if guid(identity or name, "prefab") not in taken:
            return identity
    place = _absolute(target)
    return f"{name}|{place.relative_to(_assets(place)).as_posix()}"


def _absolute(target: Path) -> Path:
    return Path(os.path.abspath(target))


def _assets(absolute: Path) -> Path:
    """The project's folder of assets; the file system's root outside any."""
    return next((folder for folder in absolute.parents if folder.name == ASSETS), Path(absolute.anchor))


def _is_one(one: Path, other: Path) -> bool:
    """Whether two paths lead to one folder, through links or not."""
    return other.exists() and one.samefile(other)
