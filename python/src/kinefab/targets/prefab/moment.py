"""The moment when an export takes the place of the one before, step by step.

1. The metas beside the folder: an asset that Unity sees without its meta would get a guid of Unity's.
2. The folder, in one step where the system can exchange two.  It holds the new assets and those that the last export wrote
   and this one did not, so that whatever the old prefab refers to is there: guids come from what things are.  Its manifest
   says that an export is under way.
3. The prefab, by a rename.
4. What the last export wrote and this one did not goes; the manifest says that nothing is under way.

A kill before 2 leaves the old set; after 3, the new one; between, the old prefab with the new set's assets, in which no reference
dangles.  ``complete`` ends what was killed; the next export begins with it.
"""

from __future__ import annotations

import os
import shutil
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

from ...replacing import exchanged
from ...replacing import remove_leftovers as remove_temporary
from .manifest import MANIFEST, Manifest, read_manifest

INCOMING = "incoming"
"""Where the new folder's files wait in the hidden one, where the system cannot exchange two folders."""


def staging_prefix(folder: Path) -> str:
    """With which the hidden folders of its exports begin."""
    return f".{folder.name}.kinefab-"


def meta_of(path: str) -> str:
    return f"{path}.meta"


def files_below(folder: Path, base: Path) -> Iterator[str]:
    """Paths from ``base``, slashes between; links are files."""
    for where, folders, names in os.walk(folder):
        links = [name for name in folders if os.path.islink(os.path.join(where, name))]
        for name in sorted([*names, *links]):
            yield (Path(where) / name).relative_to(base).as_posix()


def take_place(staging: Path, target: Path, folder: Path, manifest: Manifest) -> None:
    """The whole moment.  staging: holds the prefab, its folder and their metas.  manifest: of the new set, with what is to be
    done.  Raises OSError."""
    fresh = staging / folder.name
    manifest.write(fresh)
    for meta in (meta_of(target.name), meta_of(folder.name)):
        staged, place = staging / meta, target.with_name(meta)
        if staged.exists() and (not place.exists() or place.read_bytes() != staged.read_bytes()):
            os.replace(staged, place)
    if not folder.exists():
        os.rename(fresh, folder)
    elif not exchanged(fresh, folder):
        os.rename(fresh, staging / INCOMING)
        manifest.write(folder)
    # The manifest, read again, would stand between the steps 2 and 3, and take most of their time.
    _end(target, folder, manifest)


def is_needed(staging: Path, folder: Path) -> bool:
    """Whether the export was broken off after its folder took the old one's place: the prefab that belongs to it lies there yet."""
    pending = read_manifest(folder).pending
    return pending is not None and pending.staging == staging.name


def complete(target: Path, folder: Path) -> None:
    """End the export that stands under way in the folder's manifest, if any does: first the prefab takes its place, then what
    is left of the old set goes.  Killed, it can be done again.  Raises OSError."""
    _end(target, folder, read_manifest(folder))


def _end(target: Path, folder: Path, manifest: Manifest) -> None:
    """manifest: what stands in the folder."""
    pending = manifest.pending
    if pending is None:
        return
    staging = target.parent / Path(pending.staging).name
    if staging.name.startswith(staging_prefix(folder)) and staging.is_dir() and not staging.is_symlink():
        _bring_in(staging / INCOMING, folder, manifest)
        with suppress(FileNotFoundError):
            os.replace(staging / target.name, target)
        _rescue(staging / folder.name, folder, manifest)
    _remove(pending.leaving, manifest.files, target.parent, folder)
    replace(manifest, pending=None).write(folder)


def _bring_in(incoming: Path, folder: Path, manifest: Manifest) -> None:
    """One by one, metas first, what could not come in one step; by the names that it was written under, as some file systems list
    others (HFS+ takes letters and accents apart)."""
    if not incoming.is_dir():
        return
    inside = [
        path.removeprefix(f"{folder.name}/") for path in manifest.files if path.startswith(f"{folder.name}/")
    ]
    for path in sorted(inside, key=lambda path: (not path.endswith(".meta"), path)):
        if path != MANIFEST and os.path.lexists(incoming / path):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            os.replace(incoming / path, folder / path)


def _rescue(old: Path, folder: Path, manifest: Manifest) -> None:
    """What somebody put into the old folder while the new one was made."""
    for path in files_below(old, old):
        if (
            f"{folder.name}/{path}" not in manifest.ours
            and path != MANIFEST
            and not os.path.lexists(folder / path)
        ):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            os.rename(old / path, folder / path)


def _remove(leaving: tuple[str, ...], files: frozenset[str], parent: Path, folder: Path) -> None:
    """Files, then folders that are empty by now, the innermost first; a folder with something in it keeps its meta."""
    twins = {path.casefold(): path for path in files}
    own_metas = (meta_of(folder.name), meta_of(f"{folder.name}.prefab"))
    folders: list[Path] = []
    for path in leaving:
        if path in files or not (path.startswith(f"{folder.name}/") or path in own_metas):
            continue
        place, twin = parent / path, twins.get(path.casefold())
        if twin is not None and place.exists() and place.samefile(parent / twin):
            continue  # one file by two names, where the file system knows no capitals
        if path.endswith(".meta") and place.with_suffix("").is_dir():
            folders.append(place)
        else:
            place.unlink(missing_ok=True)
    for meta in sorted(folders, reverse=True):
        with suppress(OSError):
            meta.with_suffix("").rmdir()
            meta.unlink(missing_ok=True)


def remove_leftovers(parent: Path, folder: Path) -> None:
    """Hidden folders and files of killed exports; to be called when ``complete`` has been, where nobody else is writing."""
    for path in sorted(parent.iterdir()):
        if path.name.startswith(staging_prefix(folder)) and path.is_dir() and not path.is_symlink():
            shutil.rmtree(path, ignore_errors=True)
    if folder.is_dir():
        remove_temporary(folder / MANIFEST, "whole")
