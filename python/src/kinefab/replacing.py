"""Files that are written whole or not at all."""

from __future__ import annotations

import errno
import os
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO, Iterator


def beside(target: Path, role: str) -> Path:
    """A temporary name beside the target, as a rename is atomic within one file system only."""
    return target.with_name(f".{target.name}.{role}.tmp")


@contextmanager
def replacing(target: Path, role: str) -> Iterator[BinaryIO]:
    """A file that takes ``target``'s place when the block ends well, and goes when it does not.

    role: a word in the temporary file's name.  Raises OSError as the file system does.
    """
    temporary = beside(target, role)
    try:
        with open(temporary, "wb") as file:
            yield file
            file.flush()
            os.fsync(file.fileno())
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def write_whole(path: Path, content: bytes) -> None:
    """Write a file at once; behind a link, where it leads.  Raises OSError; then the old file stands as it was."""
    if _takes_no_other(path):
        path.write_bytes(content)
        return
    with replacing(Path(os.path.realpath(path)), "whole") as file:
        file.write(content)


def demand_writable(path: Path) -> None:
    """Raises OSError where ``write_whole`` would, as far as can be told without writing; leaves everything as it is."""
    if not _takes_no_other(path):
        temporary = beside(Path(os.path.realpath(path)), "whole")
        temporary.touch()
        temporary.unlink()
    elif not os.access(path, os.W_OK):  # opened to see, a pipe would wait for its reader
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _takes_no_other(path: Path) -> bool:
    """Whether it is a pipe or device, in whose place no other file can be put."""
    return path.exists() and not path.is_file()
