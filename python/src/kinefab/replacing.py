"""Files that are written whole or not at all."""

from __future__ import annotations

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
    if path.exists() and not path.is_file():  # a pipe or device has no place that another could take
        path.write_bytes(content)
        return
    with replacing(Path(os.path.realpath(path)), "whole") as file:
        file.write(content)
