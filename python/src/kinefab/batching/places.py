"""Files by path or by URL (``s3://bucket/key``, ``memory://``): read here, written there, one way for both.

URLs go through fsspec (extra ``cluster``); paths need nothing.
"""

from __future__ import annotations

import glob
import os
import posixpath
import re
from collections.abc import Generator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, cast

from ..replacing import write_whole

WITH_NEIGHBOURS = (
    ".urdf",
    ".xacro",
    ".xml",
    ".mjcf",
    ".sdf",
    ".world",
    ".json",
    ".csv",
    ".txt",
    ".usd",
    ".usda",
    ".usdc",
    ".asmt",
)
"""Endings of sources that name files beside them: their folder is fetched too."""
MOST_NEIGHBOURS = 2000
OBJECT_STORES = frozenset("s3 s3a gs gcs abfs abfss az adl".split())
"""Schemes without folders; to make one there would make a bucket."""


def is_url(place: str) -> bool:
    return "://" in place


def join(place: str, *names: str) -> str:
    return posixpath.join(place, *names) if is_url(place) else os.path.join(place, *names)


def name_of(place: str) -> str:
    return posixpath.basename(place) if is_url(place) else os.path.basename(place)


def file_system(place: str) -> tuple[Any, str]:
    """fsspec's file system of a URL, and the path in it.  Raises ImportError without fsspec or what the scheme needs."""
    import fsspec  # pyright: ignore[reportMissingTypeStubs]

    system, path = cast("Any", fsspec).core.url_to_fs(place)  # a library without types
    return system, path


def exists(place: str) -> bool:
    if not is_url(place):
        return os.path.lexists(place)
    system, path = file_system(place)
    return bool(system.exists(path))


def read_bytes(place: str) -> bytes | None:
    """The bytes, None where there is no file."""
    try:
        if not is_url(place):
            return Path(place).read_bytes()
        system, path = file_system(place)
        return bytes(system.cat_file(path))
    except FileNotFoundError:
        return None


def remove(place: str) -> None:
    """Remove a file, if it is there."""
    with suppress(FileNotFoundError):
        if is_url(place):
            system, path = file_system(place)
            system.rm_file(path)
        else:
            os.unlink(place)


def write_bytes(place: str, content: bytes, lasting: bool = True) -> None:
    """The whole file or none of it; folders are made.  lasting: a path's file, also when the power fails afterwards."""
    if not is_url(place):
        Path(place).parent.mkdir(parents=True, exist_ok=True)
        write_whole(Path(place), content, lasting)
        return
    system, path = file_system(place)
    if not OBJECT_STORES.intersection(
        [system.protocol] if isinstance(system.protocol, str) else system.protocol
    ):
        system.makedirs(posixpath.dirname(path), exist_ok=True)
    system.pipe_file(path, content)


@dataclass(frozen=True, slots=True)
class Expanded:
    """base: what the files' names are relative to.  files: sorted.  searched: they were found, not named one by one.
    unlisted: folders whose files cannot be told, each with the reason."""

    base: str
    files: list[str]
    searched: bool
    unlisted: tuple[tuple[str, str], ...] = ()


def expand(place: str) -> Expanded:
    """The files of a folder, of a pattern, or the one that is named."""
    pattern = any(c in place for c in "*?[")
    if is_url(place):
        system, path = file_system(place)
        if pattern:
            base = re.split(r"[*?[]", path)[0].rpartition("/")[0]
            found = [f for f in system.glob(path) if system.isfile(f)]
        elif system.isdir(path):
            base, found = path, system.find(path)
        else:
            return Expanded(place.rpartition("/")[0], [place], False)
        full = system.unstrip_protocol
        return Expanded(str(full(base)), sorted(str(full(f)) for f in found), True)
    if os.path.isdir(place):
        unlisted: list[tuple[str, str]] = []

        def heard(error: OSError) -> None:
            unlisted.append((str(error.filename), error.strerror or str(error)))

        files = [os.path.join(at, name) for at, _, names in os.walk(place, onerror=heard) for name in names]
        return Expanded(place, sorted(files), True, tuple(sorted(unlisted)))
    if pattern and not os.path.lexists(place):
        base = os.path.dirname(re.split(r"[*?[]", place)[0]) or "."
        return Expanded(base, sorted(f for f in glob.glob(place, recursive=True) if os.path.isfile(f)), True)
    return Expanded(os.path.dirname(place) or ".", [place], False)


def within(place: str, folder: str) -> bool:
    """Whether a place is below a folder, and not the folder itself."""
    head = join(folder, "")
    return place != head and place.startswith(head)


@contextmanager
def local(place: str) -> Generator[Path, None, None]:
    """A source as a local file, with what it may name beside it."""
    if not is_url(place):
        yield Path(place)
        return
    system, path = file_system(place)
    with TemporaryDirectory() as folder:
        target = Path(folder) / posixpath.basename(path)
        if path.lower().endswith(WITH_NEIGHBOURS):
            root = posixpath.dirname(path)
            for found in sorted(system.find(root))[:MOST_NEIGHBOURS]:
                own = Path(folder) / posixpath.relpath(str(found), root)
                own.parent.mkdir(parents=True, exist_ok=True)
                system.get_file(found, str(own))
        else:
            system.get_file(path, str(target))
        yield target
