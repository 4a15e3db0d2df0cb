"""The prefab that the last export left: its objects, by the numbers that Unity knows them by."""

from __future__ import annotations

import re
import tarfile
import zlib
from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

DOCUMENT = re.compile(r"^--- !u!\d+ &(-?\d+)(?: stripped)?\n(\w+):\n", re.MULTILINE)
GUID = re.compile(r"guid: ([0-9a-f]{32})")
LOCAL = re.compile(r"\{fileID: (-?\d+)\}")


@dataclass(slots=True)
class Document:
    """kind: Unity's class.  text: its fields, line for line."""

    file_id: int
    kind: str
    text: str

    def reference(self, field: str) -> int:
        """The fileID that a field refers to in the same file, 0 for none."""
        found = re.search(rf"^  {field}: \{{fileID: (-?\d+)\}}", self.text, re.MULTILINE)
        return int(found[1]) if found else 0

    def listed(self, field: str) -> list[int]:
        """The fileIDs of a list."""
        found = re.search(rf"^  {field}:\n((?:  - .*\n)*)", self.text, re.MULTILINE)
        return [int(number) for number in LOCAL.findall(found[1])] if found else []

    def numbers(self, field: str) -> tuple[float, ...]:
        """Of a vector."""
        found = re.search(rf"^  {field}: \{{(.*)\}}", self.text, re.MULTILINE)
        return tuple(float(each.split(":")[1]) for each in found[1].split(",")) if found else ()

    @property
    def guids(self) -> list[str]:
        """Of the assets that it refers to, in order."""
        return GUID.findall(self.text)


class LastExport:
    """text: of a prefab; one that is damaged or somebody else's has no objects that are found again.
    own: gives the guids of the files that the export wrote."""

    def __init__(self, text: str = "", own: Callable[[], frozenset[str]] = frozenset):
        self._own = own
        heads = list(DOCUMENT.finditer(text))
        ends = [head.start() for head in heads[1:]] + [len(text)]
        self._text = text
        self._spans = {int(head[1]): (head[2], head.end(), end) for head, end in zip(heads, ends)}

    def __contains__(self, file_id: int) -> bool:
        return file_id in self._spans

    def __bool__(self) -> bool:
        return bool(self._spans)

    def document(self, file_id: int) -> Document | None:
        if (span := self._spans.get(file_id)) is None:
            return None
        kind, start, end = span
        return Document(file_id, kind, self._text[start:end])

    def is_a(self, file_id: int, kind: str) -> bool:
        return self._spans.get(file_id, ("", 0, 0))[0] == kind

    @cached_property
    def own(self) -> frozenset[str]:
        """The guids of the files that the export wrote."""
        return self._own()

    @cached_property
    def _children(self) -> dict[int, list[int]]:
        found: dict[int, list[int]] = defaultdict(list)
        for file_id, (kind, _, _) in self._spans.items():
            if kind == "Transform" and (own := self.document(file_id)) is not None:
                above = self.document(own.reference("m_Father"))
                found[0 if above is None else above.reference("m_GameObject")].append(own.reference("m_GameObject"))
        return found

    def children(self, game_object: int) -> list[int]:
        """Of a GameObject, 0 for the file's own root, by their numbers."""
        return sorted(self._children.get(game_object, ()))

    def components(self, game_object: int) -> list[Document]:
        """Of a GameObject, the Transform first."""
        own = self.document(game_object)
        each = [] if own is None else [self.document(file_id) for file_id in own.listed("m_Component")]
        return [component for component in each if component is not None]


NOTHING = LastExport()


def last_prefab(target: Path, own: Callable[[], frozenset[str]]) -> LastExport:
    """Of a prefab that is to be written anew.  One that cannot be read leaves nothing to be known again."""
    try:
        return LastExport(target.read_text("utf-8"), own)
    except (OSError, ValueError):
        return NOTHING


def last_package(target: Path, prefab_guid: str) -> LastExport:
    """Of a package, likewise."""
    try:
        with tarfile.open(target, "r:gz") as packed:
            own = frozenset(name.partition("/")[0] for name in packed.getnames())
            held = packed.extractfile(f"{prefab_guid}/asset")
            return NOTHING if held is None else LastExport(held.read().decode("utf-8"), lambda: own)
    except (OSError, EOFError, ValueError, KeyError, tarfile.TarError, zlib.error):
        return NOTHING
