"""The zip of a FreeCAD document: members by name, within limits."""

from __future__ import annotations

import io
import lzma
import zipfile
import zlib
from pathlib import Path

from ...diagnostics import Report
from ..reading.file import read_bytes

MAX_FILE = 1024 * 2**20
"""Largest document that is read."""
MAX_MEMBER = 512 * 2**20
"""Largest unpacked member."""
MAX_TOTAL = 2048 * 2**20
"""Most that is unpacked of one document: a small file must not fill the memory."""
MAX_MEMBERS = 200_000

BROKEN = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, OSError, NotImplementedError, RuntimeError, ValueError,
)  # fmt: skip
"""What the standard library raises for damaged, encrypted and unknown members."""


class ArchiveError(Exception):
    """A member that cannot be had, and why."""


class Archive:
    """A document's members.  Nothing is ever unpacked to a disk, so that their names lead nowhere."""

    def __init__(self, path: Path, report: Report):
        """Raises KinefabError when the file cannot be read or is no zip."""
        self.path = path
        self.data = read_bytes(path, report, MAX_FILE)
        self._left = MAX_TOTAL
        detail = ""
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(self.data))
            self._members = {info.filename: info for info in self._zip.infolist()}
            if len(self._members) > MAX_MEMBERS:
                detail = f"it has more than {MAX_MEMBERS} members"
        except BROKEN as error:
            detail = " ".join(str(error).split()) or type(error).__name__
        if detail:
            report.add("ARCHIVE_REFUSED", path.name, path=path.name, detail=detail)
            report.raise_for_errors()

    def __contains__(self, name: str) -> bool:
        return name in self._members

    def read(self, name: str) -> bytes:
        """A member's bytes.  Raises ArchiveError."""
        info = self._members.get(name)
        if info is None:
            raise ArchiveError(f"the document has no '{name}'")
        limit = min(MAX_MEMBER, self._left)
        try:
            with self._zip.open(info) as stream:
                content = stream.read(limit + 1)
        except BROKEN as error:
            raise ArchiveError(f"'{name}' is damaged: {' '.join(str(error).split())}") from None
        if len(content) > limit:
            raise ArchiveError(f"'{name}' unpacks to more than {limit} bytes")
        self._left -= len(content)
        return content
