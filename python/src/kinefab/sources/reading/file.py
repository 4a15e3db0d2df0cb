"""The bytes of a source file, within limits; whatever is wrong with the file becomes a diagnostic."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from ...diagnostics import Report, is_encodable

MAX_BYTES = 128 * 2**20
"""Largest text source that is read.  A bundle of 100,000 components has about 100 MB."""


def read_bytes(path: Path, report: Report, limit: int = MAX_BYTES) -> bytes:
    """The whole file.  Raises KinefabError when it is missing, a folder, unreadable, empty or too large."""
    content, before = b"", len(report.diagnostics)
    try:
        if not is_encodable(path.name):  # it stands in the scene and in every finding
            report.add("SOURCE_UNREADABLE", "", path=path, detail="its name is not UTF-8")
        elif path.is_dir():
            report.add("SOURCE_IS_FOLDER", path.name, path=path)
        elif path.exists() and not path.is_file():  # a pipe would be waited for, a device read for ever
            report.add("SOURCE_UNREADABLE", path.name, path=path, detail="it is no regular file")
        elif (size := path.stat().st_size) > limit:
            report.add("SOURCE_TOO_LARGE", path.name, path=path, size=size, limit=limit)
        else:
            # One byte more than the limit, for a file that grows under way.
            with path.open("rb") as stream:
                content = stream.read(limit + 1)
            if len(content) > limit:
                report.add("SOURCE_TOO_LARGE", path.name, path=path, size=f"more than {limit}", limit=limit)
            elif not content.strip():
                report.add("SOURCE_EMPTY", path.name, path=path)
    except FileNotFoundError:
        report.add("SOURCE_NOT_FOUND", path.name, path=path)
    except (OSError, ValueError) as error:  # ValueError: a NUL in the path
        report.add("SOURCE_UNREADABLE", path.name, path=str(path).replace("\0", "\\0"), detail=error)
    report.raise_for_errors(before)
    return content


def tell_opened(path: Path) -> None:
    """Tell of a file that a library opens by itself as Python tells of those that it opens: a batch knows by that what a
    result depends on."""
    sys.audit("open", os.fspath(path), "r", os.O_RDONLY)
