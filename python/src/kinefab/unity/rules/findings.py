"""What is found wrong with a scene, each with its place in the file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ...diagnostics import Report

Entry = Mapping[str, Any]


class Findings:
    """Of one file."""

    def __init__(self, path: Path):
        self._path, self._report = path, Report()

    def add(self, code: str, pointer: str = "", **values: object) -> None:
        """pointer: JSON pointer of the place, "" for the file; half of a surrogate pair in it is shown as it is escaped."""
        pointer = pointer.encode("utf-8", "backslashreplace").decode("utf-8")
        self._report.add(code, f"{self._path}#{pointer}" if pointer else str(self._path), **values)

    def reference(self, index: int | None, list: str, count: int, pointer: str) -> bool:
        """Whether an index (None: there is none) points into a list of that many."""
        if index is None or 0 <= index < count:
            return True
        self.add("REFERENCE_UNRESOLVED", pointer, index=index, list=list, count=count)
        return False

    def refuse_for(self, code: str, pointer: str = "", **values: object) -> None:
        """Raises KinefabError with this alone: what else was found may mean another thing."""
        self._report = Report()
        self.add(code, pointer, **values)
        self.refuse()

    def refuse(self) -> None:
        """Raises KinefabError with all that was found, if anything was."""
        self._report.raise_for_errors()
