"""Files by path or by URL (``s3://bucket/key``, ``memory://``): read here, written there, one way for both.

URLs go through fsspec (extra ``cluster``); paths need nothing.
"""

from __future__ import annotations

import os
import posixpath
from collections.abc import Generator
from contextlib import contextmanager
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
    ".asmt",
)
"""Endings of sources that name files beside them: their folder is fetched too."""
MOST_NEIGHBOURS = 2000


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


def write_bytes(place: str, content: bytes) -> None:
    """The whole file or none of it; folders are made."""
    if not is_url(place):
        Path(place).parent.mkdir(parents=True, exist_ok=True)
        write_whole(Path(place), content)
        return
    system, path = file_system(place)
    system.makedirs(posixpath.dirname(path), exist_ok=True)
    system.pipe_file(path, content)


def expand(place: str) -> tuple[str, list[str]]:
    """A folder, a glob or a file as (the folder that names are relative to, the files), sorted."""
    if is_url(place):
        system, path = file_system(place)
        if any(c in path for c in "*?["):
            base = path.split("*")[0].rpartition("/")[0]
            found = [f for f in system.glob(path) if system.isfile(f)]
        elif system.isdir(path):
            base, found = path, system.find(path)
        else:
            base, found = posixpath.dirname(path), [path]
        return str(system.unstrip_protocol(base)), sorted(str(system.unstrip_protocol(f)) for f in found)
    if os.path.isdir(place):
        files = [os.path.join(folder, name) for folder, _, names in os.walk(place) for name in names]
        return place, sorted(files)
    if any(c in place for c in "*?[") and not os.path.exists(place):
        import glob

        base = os.path.dirname(place.split("*")[0].split("?")[0].split("[")[0]) or "."
        return base, sorted(f for f in glob.glob(place, recursive=True) if os.path.isfile(f))
    return os.path.dirname(place) or ".", [place]


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
