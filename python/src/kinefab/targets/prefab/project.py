"""The Unity project that a prefab is written into."""

from __future__ import annotations

import os
from collections.abc import Collection, Sequence
from pathlib import Path

from .files import AssetFile
from .manifest import MANIFEST, Manifest, read_manifest
from .moment import meta_of
from .objects.couplings import SCRIPT, script_guid
from .text.ids import guid
from .text.metas import guid_in

ASSETS = "Assets"
Elsewhere = Sequence[tuple[Path, list[str]]]
"""Folders of a project with their files' names."""


def common_folder(target: Path) -> Path:
    """The project's ``Assets``, in which exports look at each other; outside a project the folder that gets the prefab."""
    assets = _assets(_absolute(target))
    return assets if assets.name == ASSETS else target.parent


def project_of(target: Path) -> Path | None:
    """The folder that holds the project's ``Assets``; None outside a project."""
    assets = _assets(_absolute(target))
    return assets.parent if assets.name == ASSETS else None


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

    The other may have been moved or renamed in the editor, its prefab alone or its folder, or have come in a package: Unity keeps
    guids then.
    """
    name, meta = target.stem, f"{target.name}.meta"
    taken: set[str] = set()
    for where, names in elsewhere:
        if meta in names:
            taken.add(guid_in(where / meta))
        if MANIFEST in names:
            taken.add(_prefab_guid(read_manifest(where)))
    own = read_manifest(target.with_name(name))
    # Its prefab may be one of those: ``moved_away`` sees what is in the folder.
    if own.files and not target.exists():
        return own.identity
    for identity in (own.identity, ""):
        if guid(identity or name, "prefab") not in taken:
            return identity
    place = _absolute(target)
    return f"{name}|{place.relative_to(_assets(place)).as_posix()}"


def _prefab_guid(manifest: Manifest) -> str:
    """Of the prefab that an export wrote beside its folder, wherever the two are by now; "" where it wrote none."""
    prefab = next((path for path in manifest.files if "/" not in path and path.endswith(".prefab")), "")
    return guid(manifest.identity or prefab.removesuffix(".prefab"), "prefab") if prefab else ""


def moved_away(files: Sequence[AssetFile], target: Path, ours: Collection[str]) -> list[tuple[Path, str]]:
    """What somebody moved or renamed in the editor, which keeps guids, and the path at which this export would write it again;
    a folder stands for all in it.  ours: paths that the last export wrote; the project is searched only where one of them is gone.
    """
    target = _absolute(target)
    if all((target.parent / path).exists() for path in ours if path.endswith(".meta")):
        return []
    assets = _assets(target)
    base = assets if assets.name == ASSETS else target.with_name(target.stem)
    wanted, found = {file.guid: file.path for file in files}, dict[Path, str]()
    for where, folders, names in os.walk(base):
        for path in (Path(where) / name for name in names if name.endswith(".meta")):
            own, place = wanted.get(guid_in(path)), Path(os.path.relpath(path, target.parent)).as_posix()
            if own is not None and place not in ours and place != meta_of(own):
                found[path.with_suffix("")] = own
        folders[:] = [name for name in folders if name[0] != "." and Path(where) / name not in found]
    return sorted(found.items())


def _absolute(target: Path) -> Path:
    return Path(os.path.abspath(target))


def _assets(absolute: Path) -> Path:
    """The project's folder of assets; the file system's root outside any."""
    return next((folder for folder in absolute.parents if folder.name == ASSETS), Path(absolute.anchor))


def _is_one(one: Path, other: Path) -> bool:
    """Whether two paths lead to one folder, through links or not."""
    return other.exists() and one.samefile(other)
