"""Puts the files of an export in place: whoever reads, and whenever the writer is killed, there is the old set or the new one.

Everything is written into a hidden folder beside the target, which Unity does not import; then ``moment`` lets it take the old
set's place.  A manifest in the folder says what is Kinefab's; whatever else is there is carried over and stays.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path, PurePosixPath

from ...diagnostics import KinefabError, Report
from ...replacing import sync_directory
from .files import AssetFile
from .manifest import MANIFEST, Manifest, Pending, read_manifest
from .moment import (
    complete,
    files_below,
    is_needed,
    meta_of,
    remove_leftovers,
    staging_prefix,
    take_place,
)
from .project import moved_away
from .text.metas import guid_in

Progress = Callable[[float], None]


def put_in_place(
    files: Sequence[AssetFile], target: Path, identity: str, report: Report, progress: Progress
) -> tuple[Path, ...]:
    """To be called where nobody else writes.  files: the prefab first.  identity: see ``Manifest``.  Returns the prefab and every
    other file that has content."""
    parent, folder = target.parent, target.with_name(target.stem)
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        detail = "it is no folder of its own, and the prefab's assets go there"
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=folder, detail=detail)])
    complete(target, folder)
    remove_leftovers(parent, folder)
    ours = read_manifest(folder).ours
    ours |= _known_by_guid(files, parent, ours)
    _refuse_foreign(files, parent, folder, ours, report)
    if moved := moved_away(files, target, ours):
        raise KinefabError([report.add("TARGET_ASSET_MOVED", path=p, asset=parent / a) for p, a in moved])
    staging = Path(tempfile.mkdtemp(prefix=staging_prefix(folder), dir=parent))
    try:
        guids = _guids(ours, parent)
        written = _write_all(files, staging, parent, folder, guids, progress)
        gone = ours - written
        _carry_over(folder, staging / folder.name, written | _taken_up(gone, files, guids))
        pending = Pending(staging.name, tuple(sorted(gone)))
        take_place(staging, target, folder, Manifest(written, pending, identity))
    finally:
        if not is_needed(staging, folder):
            shutil.rmtree(staging, ignore_errors=True)
    sync_directory(parent)
    return tuple(parent / file.path for file in files if file.content is not None)


def own_guids(target: Path) -> frozenset[str]:
    """Of all files that the last export of the target wrote."""
    ours = read_manifest(target.with_name(target.stem)).ours
    return frozenset(_guids(ours, target.parent).values()) - {""}


def _known_by_guid(files: Sequence[AssetFile], parent: Path, ours: frozenset[str]) -> frozenset[str]:
    """What stands in an asset's place with the asset's own guid: a package brought it, or the manifest was lost on its way."""
    held = (file for file in files if file.content is not None and file.path not in ours)
    known = [file.path for file in held if guid_in(parent / meta_of(file.path)) == file.guid]
    return frozenset([*known, *map(meta_of, known)])


def _refuse_foreign(
    files: Sequence[AssetFile], parent: Path, folder: Path, ours: frozenset[str], report: Report
) -> None:
    """The prefab was named by the user; nothing else that is not ours is overwritten."""
    in_the_way: list[Path] = []
    there = _by_folded_name(folder, parent)
    for file in files[1:]:
        paths = [file.path, meta_of(file.path)] if file.content is not None else []
        for path in paths:
            twin = there.get(path.casefold())
            if twin is not None and twin not in ours:
                in_the_way.append(parent / twin)
        place = parent / file.path
        if file.content is None and (place.is_symlink() or (place.exists() and not place.is_dir())):
            in_the_way.append(place)
    if in_the_way:
        raise KinefabError([report.add("TARGET_FILE_FOREIGN", path=path) for path in in_the_way])


def _by_folded_name(folder: Path, parent: Path) -> dict[str, str]:
    """Every file of a folder, by its path without capitals: file systems that know none would take two for one."""
    return {path.casefold(): path for path in files_below(folder, parent)}


def _write_all(
    files: Sequence[AssetFile],
    staging: Path,
    parent: Path,
    folder: Path,
    guids: Mapping[str, str],
    progress: Progress,
) -> frozenset[str]:
    """Everything, in the hidden folder; returns the paths that are ours from now on.

    guids: of the metas that the last export left.  The editor writes all import settings into them and people change them there,
    so they go on with the asset.  What we would say in them follows from what the asset is, as its guid does.
    """
    written: set[str] = set()
    known = {guid: parent / meta for meta, guid in guids.items() if guid}
    (staging / folder.name).mkdir()
    for i, file in enumerate(files):
        path = staging / file.path
        meta = meta_of(file.path)
        if file.content is None:
            path.mkdir(exist_ok=True)
        else:
            with open(path, "xb") as out:
                for piece in file.content():
                    out.write(piece)
                out.flush()
                os.fsync(out.fileno())
            written.add(file.path)
        if (
            (file.content is None or i == 0)
            and meta not in guids
            and _other_content(parent / meta, file.meta)
        ):
            continue  # of their folder or prefab before we came: it keeps its guid, by which others refer to it
        with open(staging / meta, "xb") as out:
            out.write(known[file.guid].read_bytes() if file.guid in known else file.meta.encode("utf-8"))
            out.flush()
            os.fsync(out.fileno())
        written.add(meta)
        progress((i + 1) / len(files))
    return frozenset([*written, f"{folder.name}/{MANIFEST}"])


def _guids(ours: frozenset[str], parent: Path) -> dict[str, str]:
    """Of each meta that the last export left, by its path."""
    return {path: guid_in(parent / path) for path in sorted(ours) if path.endswith(".meta")}


def _taken_up(gone: frozenset[str], files: Sequence[AssetFile], guids: Mapping[str, str]) -> frozenset[str]:
    """Of the paths that the last export wrote and this one did not, those whose guid another file has now: side by side
    Unity would give one of the two a new guid."""
    taken = {file.guid for file in files}
    return frozenset(path for path in gone if guids.get(meta_of(path.removesuffix(".meta"))) in taken)


def _carry_over(folder: Path, fresh: Path, but: frozenset[str]) -> None:
    """Into the folder that takes the old one's place what is in that: theirs for good, ours for a moment."""
    for path in (path for path in files_below(folder, folder.parent) if path not in but):
        place = fresh / PurePosixPath(path).relative_to(folder.name)
        if not os.path.lexists(place):
            place.parent.mkdir(parents=True, exist_ok=True)
            _linked(folder.parent / path, place)
    for where, folders, names in os.walk(folder):
        if not folders and not names and where != str(folder):  # theirs: no export leaves an empty one
            (fresh / Path(where).relative_to(folder)).mkdir(parents=True, exist_ok=True)


def _other_content(path: Path, text: str) -> bool:
    """Whether a file is there and says something else."""
    return path.exists() and path.read_bytes() != text.encode("utf-8")


def _linked(source: Path, place: Path) -> None:
    """The same file by a second name; a copy where the file system knows no such names."""
    try:
        os.link(source, place, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(source, place, follow_symlinks=False)
