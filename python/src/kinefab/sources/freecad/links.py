"""The documents that a document links to: files beside the first one or below its folder, and no others."""

from __future__ import annotations

import os
from pathlib import Path
from urllib.parse import unquote

from ...diagnostics import KinefabError, Report, Severity
from ..reading.record import shown
from .document import Document, Target, Thing, read_document

MAX_DOCUMENTS = 1000
"""Most files that one document may draw in."""


class Documents:
    """Documents as they are asked for, each read once.  root: the first one."""

    def __init__(self, path: Path, report: Report):
        """Raises KinefabError when the file is no document."""
        self.report = report
        self.root = read_document(path, report)
        self.folder = os.path.realpath(path.parent)
        self._read: dict[str, Document | None] = {os.path.realpath(path): self.root}
        self._told: set[tuple[str, str]] = set()

    @property
    def others(self) -> list[Document]:
        """What was read beside the first document, in the order of its links."""
        return [found for found in self._read.values() if found is not None and found is not self.root]

    def follow(self, thing: Thing, target: Target) -> Thing | None:
        """The object that a link of ``thing`` names; None, with the reason in the report, where it is not to be had."""
        document: Document | None = thing.document
        if target.file:
            document = self._open(thing, target.file)
            if document is None:
                return None
        assert document is not None
        found = document.things.get(target.name)
        if found is None:
            self.broken(thing, target, "which is not in the document")
        return found

    def broken(self, thing: Thing, target: Target, why: str) -> None:
        """Report once that a link leads nowhere."""
        aim = f"{target.file}#{target.name}" if target.file else target.name
        if (thing.where, aim) not in self._told:
            self._told.add((thing.where, aim))
            self.report.dropped(
                f"link {shown(thing.label)}", "FREECAD_LINK_BROKEN", thing.where,
                object=shown(thing.label), target=shown(aim), why=why,
            )  # fmt: skip

    def _is_inside(self, path: str) -> bool:
        return os.path.commonpath([path, self.folder]) == self.folder

    def _open(self, thing: Thing, file: str) -> Document | None:
        target = Target("", file)
        name = unquote(file).replace("\\", "/")
        if "\0" in name or "://" in name:
            self.broken(thing, target, "which is no file's name")
            return None
        path = os.path.realpath(os.path.join(os.path.dirname(os.path.realpath(thing.document.path)), name))
        if self._is_inside(path):  # no other folder is looked into
            path = os.path.realpath(as_spelled(path))
        if path in self._read:
            found = self._read[path]
            if found is None:
                self.broken(thing, target, "which could not be read")
            return found
        if not self._is_inside(path):
            self.broken(thing, target, "which lies outside the folder of the assembly; it was not opened")
            return None
        if len(self._read) >= MAX_DOCUMENTS:
            self.broken(thing, target, f"one more than the {MAX_DOCUMENTS} documents that are read")
            return None
        self._read[path] = None
        why = ""
        if not name.lower().endswith(".fcstd"):
            why = "which is no FreeCAD document"
        elif not os.path.isfile(path):
            why = "which is not there"
        else:
            own = Report()
            try:
                self._read[path] = read_document(Path(path), own)
            except KinefabError as error:
                why = f"which cannot be read ({error.diagnostics[0].message})"
            for found in own.diagnostics:
                if found.severity is not Severity.ERROR:
                    self.report.diagnostics.append(found)
            if self._read[path] is not None:
                document = self._read[path]
                assert document is not None
                document.report = self.report
        if why:
            self.broken(thing, target, why)
        return self._read[path]


def as_spelled(path: str) -> str:
    """The file meant by a path whose name is spelled with other capitals, as Windows takes it: the only one there is."""
    folder, name = os.path.split(path)
    if os.path.lexists(path) or not os.path.isdir(folder):
        return path
    alike = [entry for entry in os.listdir(folder) if entry.lower() == name.lower()]
    return os.path.join(folder, alike[0]) if len(alike) == 1 else path
