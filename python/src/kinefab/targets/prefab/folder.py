"""Puts the files of an export in place: whoever reads, and whenever the writer is killed, there is the old set or the new one.

Everything is written into a hidden folder beside the target, which Unity does not import.  Then the folder beside the prefab
changes places with the new one, in one step where the system has one, and the prefab is renamed over the old one.  A
manifest in the folder says what is Kinefab's; whatever else is there is carried over and stays.
"""

from __future__ import annotations

import json
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path, PurePosixPath
from typing import Any

from ...diagnostics import KinefabError, Report
from ...replacing import exchanged, one_at_a_time, sync_directory
from .files import AssetFile

MANIFEST = ".kinefab.json"
"""In the folder beside the prefab; Unity leaves out what begins with a dot."""
FORMAT = "kinefab.prefab"

Progress = Callable[[float], None]


def put_in_place(
    files: Sequence[AssetFile], target: Path, report: Report, progress: Progress
) -> tuple[Path, ...]:
    """files: the prefab first.  Returns it and every other file that has content."""
    parent, folder = target.parent, target.with_name(target.stem)
    if folder.is_symlink() or (folder.exists() and not folder.is_dir()):
        detail = "it is no folder of its own, and the prefab's assets go there"
        raise KinefabError([report.add("TARGET_UNWRITABLE", path=folder, detail=detail)])
    with one_at_a_time(parent):
        _remove_left_over(parent, folder)
        ours = _listed(folder)
        _refuse_foreign(files, parent, folder, ours, report)
        staging = Path(tempfile.mkdtemp(prefix=_prefix(folder), dir=parent))
        try:
            written = _write_all(files, staging, parent, folder, ours, progress)
            _carry_over(folder, staging / folder.name, parent, ours)
            _exchange(staging, target, folder, ours | written)
        finally:
            shutil.rmtree(staging, ignore_errors=True)
        _remove_stale_metas(parent, folder, ours - written)
        sync_directory(parent)
    return tuple(parent / file.path for file in files if file.content is not None)


def _prefix(folder: Path) -> str:
    return f".{folder.name}.kinefab-"


def _remove_left_over(parent: Path, folder: Path) -> None:
    """What a killed export left: its hidden folder; where a folder was on its way out and none had come in, it goes back."""
    for path in sorted(parent.glob(f"{glob_escaped(_prefix(folder))}*")):
        if path.is_dir() and not path.is_symlink():
            aside = path / ASIDE
            if aside.is_dir() and not folder.exists():
                os.rename(aside, folder)
            shutil.rmtree(path, ignore_errors=True)


ASIDE = "aside"
"""Where the old folder waits, where the system cannot exchange two."""


def glob_escaped(text: str) -> str:
    return "".join(f"[{c}]" if c in "*?[" else c for c in text)


def _listed(folder: Path) -> set[str]:
    """Paths that the last export wrote, from the prefab's folder; nothing where no manifest says so."""
    try:
        read = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        files: list[Any] = read["files"] if read.get("format") == FORMAT else []
        return {path for path in files if isinstance(path, str)}
    except (OSError, ValueError, AttributeError, KeyError, TypeError):
        return set()


def _meta(path: str) -> str:
    return f"{path}.meta"


def _refuse_foreign(
    files: Sequence[AssetFile], parent: Path, folder: Path, ours: set[str], report: Report
) -> None:
    """The prefab was named by the user; nothing else that is not ours is overwritten."""
    in_the_way: list[Path] = []
    there = _by_folded_name(folder, parent)
    for file in files[1:]:
        paths = [file.path, _meta(file.path)] if file.content is not None else []
        for path in paths:
            twin = there.get(path.casefold())
            if twin is not None and twin not in ours:
                in_the_way.append(parent / twin)
        if file.content is None and (parent / file.path).exists() and not (parent / file.path).is_dir():
            in_the_way.append(parent / file.path)
    if in_the_way:
        raise KinefabError([report.add("TARGET_FILE_FOREIGN", path=path) for path in in_the_way])


def _by_folded_name(folder: Path, parent: Path) -> dict[str, str]:
    """Every file of a folder, by its path without capitals: file systems that know none would take two for one."""
    return {path.casefold(): path for path in _files_below(folder, parent)}


def _files_below(folder: Path, parent: Path) -> Iterator[str]:
    """Paths from ``parent``, slashes between; links are files."""
    for where, folders, names in os.walk(folder):
        links = [name for name in folders if os.path.islink(os.path.join(where, name))]
        for name in sorted([*names, *links]):
            yield (Path(where) / name).relative_to(parent).as_posix()


def _write_all(
    files: Sequence[AssetFile], staging: Path, parent: Path, folder: Path, ours: set[str], progress: Progress
) -> set[str]:
    """Everything, in the hidden folder; returns the paths that are ours from now on."""
    written: set[str] = set()
    (staging / folder.name).mkdir()
    for i, file in enumerate(files):
        path = staging / file.path
        if file.content is None:
            path.mkdir(exist_ok=True)
            meta = _meta(file.path)
            if (parent / meta).exists() and meta not in ours:
                continue  # their folder, or Unity's meta of it, before we came: it keeps its guid
        else:
            with open(path, "xb") as out:
                for piece in file.content():
                    out.write(piece)
                out.flush()
                os.fsync(out.fileno())
            written.add(file.path)
        with open(staging / _meta(file.path), "xb") as out:
            out.write(file.meta.encode("utf-8"))
            out.flush()
            os.fsync(out.fileno())
        written.add(_meta(file.path))
        progress((i + 1) / len(files))
    manifest = f"{folder.name}/{MANIFEST}"
    written.add(manifest)
    text = json.dumps({"format": FORMAT, "files": sorted(written)}, indent=1, ensure_ascii=False) + "\n"
    (staging / manifest).write_text(text, encoding="utf-8", newline="\n")
    return written


def _carry_over(folder: Path, fresh: Path, parent: Path, ours: set[str]) -> None:
    """What is not ours into the folder that takes the old one's place."""
    for where, folders, _ in os.walk(folder):
        for name in folders:
            inner = Path(where) / name
            inside = any(True for _ in inner.rglob("*")) and not inner.is_symlink()
            all_ours = inside and all(
                p.is_dir() or p.relative_to(parent).as_posix() in ours for p in inner.rglob("*")
            )
            if not inner.is_symlink() and not all_ours:
                (fresh / inner.relative_to(folder)).mkdir(parents=True, exist_ok=True)
    for path in _files_below(folder, parent):
        place = fresh / PurePosixPath(path).relative_to(folder.name)
        if path not in ours and not os.path.lexists(place):
            place.parent.mkdir(parents=True, exist_ok=True)
            _linked(parent / path, place)


def _linked(source: Path, place: Path) -> None:
    """The same file by a second name; a copy where the file system knows no such names."""
    try:
        os.link(source, place, follow_symlinks=False)
    except (OSError, NotImplementedError):
        shutil.copy2(source, place, follow_symlinks=False)


def _exchange(staging: Path, target: Path, folder: Path, known: set[str]) -> None:
    """The moment itself."""
    fresh = staging / folder.name
    for meta in (_meta(target.name), _meta(folder.name)):
        staged, place = staging / meta, target.with_name(meta)
        if staged.exists() and (not place.exists() or place.read_bytes() != staged.read_bytes()):
            os.replace(staged, place)
    if not folder.exists():
        os.rename(fresh, folder)
        os.replace(staging / target.name, target)
        return
    if exchanged(fresh, folder):
        os.replace(staging / target.name, target)
        old = fresh
    else:
        old = staging / ASIDE
        os.rename(folder, old)
        os.rename(fresh, folder)
        os.replace(staging / target.name, target)
    for path in _files_below(old, old):  # what came while we wrote
        if f"{folder.name}/{path}" not in known and not os.path.lexists(folder / path):
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            os.rename(old / path, folder / path)


def _remove_stale_metas(parent: Path, folder: Path, gone: set[str]) -> None:
    """Files of the last export beside the folder that this one has not: none but a meta can be."""
    for path in gone:
        if "/" not in path and (parent / path).is_file() and path.startswith(folder.name):
            (parent / path).unlink(missing_ok=True)
