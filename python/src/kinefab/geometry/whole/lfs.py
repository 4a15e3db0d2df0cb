"""Git LFS: a small text stands in place of a large file that was not fetched."""

from __future__ import annotations

from pathlib import Path

FIRST_LINE = b"version https://git-lfs.github.com/spec/"


def is_pointer(path: Path) -> bool:
    """Whether a file is such a text, by its first line; False where it cannot be read."""
    try:
        if not path.is_file():  # a pipe would be waited for
            return False
        with path.open("rb") as stream:
            return stream.read(len(FIRST_LINE)) == FIRST_LINE
    except (OSError, ValueError):
        return False
