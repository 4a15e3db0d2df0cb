"""Files that a mesh file refers to: libraries, buffers, images.  They stay inside its folder, and are of a bounded size."""

from __future__ import annotations

import os
import re
import stat
from collections.abc import Generator, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING
from urllib.parse import unquote

if TYPE_CHECKING:  # the command line lists the formats, which takes this file's names alone
    import zipfile

MOST_BYTES = 2 * 2**30
"""Of one file that is referred to, and of all that an archive holds unpacked."""
MOST_GROWTH = 200
"""Times that an archive may grow when it is unpacked: meshes grow about tenfold."""


MANIFESTS = ("package.xml", "model.config", "manifest.xml")
"""Files that stand at the top of a ROS package and of a Gazebo model."""
UPWARDS = 8
"""Folders above a file that are looked into for one."""


class UnsafeReference(OSError):
    """A reference that is not followed; the message says why."""


def read_reference(folder: Path, name: str, limit: int = MOST_BYTES) -> bytes:
    """The bytes of a file that a mesh file in ``folder`` names.

    It may lie anywhere in the package or model that holds the folder: Gazebo's keep images in ``../materials/textures``.
    Raises UnsafeReference for one that leads out of there, also through a link, is no regular file (a pipe, a device) or is
    larger than ``limit``; OSError as the file system does.
    """
    plain = PurePosixPath(unquote(name).replace("\\", "/"))
    root = Path(os.path.realpath(folder))
    path = Path(os.path.realpath(root / plain))
    if plain.is_absolute() or not path.is_relative_to(root) and not path.is_relative_to(package_of(root)):
        raise UnsafeReference(f"{name!r} leads out of the folder of the file that names it")
    return read_regular(path, limit)


def is_package(folder: Path) -> bool:
    """Whether a folder is the top of a package or model."""
    return any((folder / name).is_file() for name in MANIFESTS)


def package_of(folder: Path) -> Path:
    """The outermost folder above, or this, that is a package or model; this where none is.  A package of Gazebo's holds models,
    which share its images."""
    above = [folder, *folder.parents][:UPWARDS]
    return next(filter(is_package, reversed(above)), folder)


def read_regular(path: Path, limit: int = MOST_BYTES) -> bytes:
    """The bytes of a regular file; what could make the reader wait or never end is refused."""
    descriptor = os.open(path, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    with open(descriptor, "rb") as stream:
        found = os.fstat(descriptor)
        if not stat.S_ISREG(found.st_mode):
            raise UnsafeReference(f"{path.name!r} is no regular file")
        if found.st_size > limit:
            raise UnsafeReference(f"{path.name!r} has {found.st_size} bytes; at most {limit} are read")
        return stream.read()


@contextmanager
def _opened(path: Path) -> Generator[zipfile.ZipFile, None, None]:
    """The archive; what is wrong with it is an UnsafeReference."""
    import zipfile
    import zlib

    try:
        with zipfile.ZipFile(path) as archive:
            yield archive
    except (
        zipfile.BadZipFile,
        zlib.error,
        EOFError,
        RuntimeError,
    ) as error:  # RuntimeError: encrypted, or a method unknown
        raise UnsafeReference(f"it is no whole archive: {error}") from error


MILLIMETRE = 1e-3
UNITS_OF_3MF = {
    b"micron": 1e-6, b"millimeter": MILLIMETRE, b"centimeter": 1e-2, b"inch": 0.0254, b"foot": 0.3048, b"meter": 1.0,
}  # fmt: skip
HEAD_BYTES = 65536
_UNIT = re.compile(rb"""<(?:\w+:)?model\b[^>]*?\bunit\s*=\s*["'](\w+)["']""")


def demand_honest_archive(path: Path) -> None:
    """Raises UnsafeReference for a zip archive that unpacks to more than it may."""
    with _opened(path) as archive:
        unpacked = sum(entry.file_size for entry in archive.infolist())
    allowed = min(MOST_BYTES, max(2**20, MOST_GROWTH * path.stat().st_size))
    if unpacked > allowed:
        raise UnsafeReference(f"it unpacks to {unpacked} bytes; at most {allowed} are read")


def heads_of_3mf(path: Path) -> list[bytes]:
    """How each model in a 3MF archive begins."""
    found: list[bytes] = []
    with _opened(path) as archive:
        for entry in archive.infolist():
            if entry.filename.lower().endswith(".model"):
                with archive.open(entry) as model:
                    found.append(model.read(HEAD_BYTES))
    return found


def metres_of_3mf(heads: list[bytes]) -> float:
    """Metres in the unit that a 3MF archive states; millimetres where it states none (3MF Core Specification, 3.4)."""
    stated = next((found[1] for head in heads if (found := _UNIT.search(head))), b"")
    return UNITS_OF_3MF.get(stated, MILLIMETRE)


class FolderResolver:
    """trimesh's resolver of references, kept inside one folder; what may not be read is not there."""

    def __init__(self, folder: Path, failed: dict[str, str] | None = None):
        """failed: what could not be read, and why; it grows."""
        self._folder = folder
        self.failed: dict[str, str] = {} if failed is None else failed

    def get(self, name: str) -> bytes:
        try:
            return read_reference(self._folder, name)
        except OSError as error:
            self.failed[name] = error.strerror or str(error)
            raise

    def __getitem__(self, name: str) -> bytes:
        return self.get(name)

    def __contains__(self, name: str) -> bool:
        try:
            self.get(name)
        except OSError:
            return False
        return True

    def keys(self) -> Iterator[str]:
        """Nothing is listed: a format that searches a folder finds nothing in it."""
        return iter(())

    def namespaced(self, namespace: str) -> FolderResolver:
        return FolderResolver(self._folder / namespace, self.failed)
