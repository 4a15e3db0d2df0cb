"""Files that are written whole or not at all."""

from __future__ import annotations

import ctypes
import errno
import os
import re
import secrets
import sys
from collections.abc import Generator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO


@contextmanager
def beside(target: Path, role: str) -> Generator[tuple[BinaryIO, Path], None, None]:
    """A new file beside the target, as a rename is atomic within one file system only; when the block ends it is gone,
    unless it was renamed.

    Its name cannot be foreseen and it is opened only where nothing stands, not even a link: whoever else may write into
    the folder cannot have it lead elsewhere.  role: a word in its name.
    """
    path = target.with_name(f".{target.name}.{role}.{secrets.token_hex(8)}.tmp")
    flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0) | getattr(os, "O_BINARY", 0)
    with open(os.open(path, flags, 0o666), "wb") as file:
        try:
            yield file, path
        finally:
            path.unlink(missing_ok=True)


def remove_leftovers(target: Path, *roles: str) -> None:
    """Remove what killed runs left beside the target; to be called where nobody else is writing to it."""
    pattern = re.compile(re.escape(f".{target.name}.") + f"({'|'.join(roles)})" + r"\.[0-9a-f]{16}\.tmp")
    for path in target.parent.iterdir():
        if pattern.fullmatch(path.name) and path.is_file() and not path.is_symlink():
            path.unlink(missing_ok=True)


@contextmanager
def replacing(target: Path, role: str, lasting: bool = True) -> Generator[BinaryIO, None, None]:
    """A file that takes ``target``'s place when the block ends well, and goes when it does not.

    role: a word in the temporary file's name.  lasting: whole even when the power fails afterwards, which takes a disk's
    time; a kill leaves it whole either way.  Raises OSError as the file system does.
    """
    with beside(target, role) as (file, temporary):
        yield file
        file.flush()
        if lasting:
            os.fsync(file.fileno())
        if os.name == "nt":  # which renames no open file
            file.close()
        os.replace(temporary, target)


def write_whole(path: Path, content: bytes, lasting: bool = True) -> None:
    """Write a file at once; behind a link, where it leads.  lasting: see ``replacing``.

    Raises OSError; then the old file stands as it was."""
    if _takes_no_other(path):
        path.write_bytes(content)
        return
    with replacing(Path(os.path.realpath(path)), "whole", lasting) as file:
        file.write(content)


def why_unwritable(path: Path, error: OSError) -> str:
    """In words why a file could not be written: the system names no folder that is missing."""
    if isinstance(error, FileNotFoundError) and not path.parent.exists():
        return f"there is no folder {path.parent}"
    if error.errno == errno.ENAMETOOLONG:  # while it is written a longer name stands beside it
        return f"its name has {len(os.fsencode(path.name))} bytes, or its path more than the system takes; give a shorter one"
    return error.strerror or str(error)


def demand_writable(path: Path) -> None:
    """Raises OSError where ``write_whole`` would, as far as can be told without writing; leaves everything as it is."""
    if not _takes_no_other(path):
        with beside(Path(os.path.realpath(path)), "whole"):
            pass
    elif not os.access(path, os.W_OK):  # opened to see, a pipe would wait for its reader
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _takes_no_other(path: Path) -> bool:
    """Whether it is a pipe or device, in whose place no other file can be put."""
    return path.exists() and not path.is_file()


@contextmanager
def one_at_a_time(folder: Path) -> Generator[None, None, None]:
    """Wait for other exports into the folder: two to one target would remove each other's files.

    The lock is the folder's own, so it leaves no file and ends with its process.  Windows cannot open a folder
    and some network file systems cannot lock one; there the exports are on their own.
    """
    if os.name == "nt":
        yield
        return
    import fcntl

    descriptor = os.open(folder, os.O_RDONLY)
    try:
        with suppress(OSError):
            fcntl.flock(descriptor, fcntl.LOCK_EX)
        yield
    finally:
        os.close(descriptor)


def sync_directory(folder: Path) -> None:
    """Make the renames last through a power cut, where the system can open a folder (not on Windows)."""
    if os.name == "nt":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def exchanged(first: Path, second: Path) -> bool:
    """Let two folders of one file system change places in one step; False where the system has no such call."""
    here, swap = -100, 2  # AT_FDCWD, RENAME_EXCHANGE of Linux; RENAME_SWAP of macOS
    names = os.fsencode(first), os.fsencode(second)
    try:
        library = ctypes.CDLL(None, use_errno=True)
        if sys.platform == "darwin":
            return library.renamex_np(names[0], names[1], swap) == 0
        return library.renameat2(here, names[0], here, names[1], swap) == 0
    except (AttributeError, OSError, TypeError):
        return False
