"""Document.xml: the objects and their properties, as FreeCAD saves them.

Lengths are millimetres, angles of joints degrees, quaternions x y z w; poses here are FreeCAD's own, Z up.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree.ElementTree import Element

import numpy as np

from ...diagnostics import Report
from ...spatial import Pose, matrix_from_quaternion
from ..reading.record import MAX_NUMBER, shown
from ..reading.xml_text import parse_xml
from .archive import Archive, ArchiveError

UNIT = 1e-3
"""Metres in a millimetre: FreeCAD saves no other length, whatever it shows."""


@dataclass(frozen=True, slots=True)
class Target:
    """What a link names.  file: of another document, relative to this one's folder, "" for this one.
    subs: paths below the object, names with dots between them, the last one an element's."""

    name: str
    file: str = ""
    subs: tuple[str, ...] = ()


@dataclass(slots=True, eq=False)
class Thing:
    """An object of a document.  type: FreeCAD's class.  values: the properties' value elements, by name."""

    document: Document
    name: str
    type: str
    values: dict[str, Element] = field(default_factory=dict[str, Element])
    kinds: dict[str, str] = field(default_factory=dict[str, str])

    @property
    def where(self) -> str:
        return f"{self.document.path.name}#{shown(self.name)}"

    @property
    def key(self) -> tuple[Path, str]:
        """The same for the same object of the same file."""
        return self.document.path, self.name

    @property
    def label(self) -> str:
        return self.text("Label") or self.name

    def has(self, name: str) -> bool:
        return name in self.values

    def text(self, name: str, default: str = "") -> str:
        value = self.values.get(name)
        return default if value is None else value.get("value", default)

    def number(self, name: str, default: float = 0.0) -> float:
        """A finite number; what is none is reported once and read as the default."""
        value = self.values.get(name)
        return default if value is None else self._number(name, value.get("value", ""), default)

    def flag(self, name: str, default: bool = False) -> bool:
        value = self.values.get(name)
        return default if value is None else value.get("value", "").lower() == "true"

    def flags(self, name: str) -> str:
        """A list of flags as "0" and "1", the first one first: FreeCAD saves the last one first."""
        return self.text(name)[::-1]

    def count(self, name: str) -> int:
        return int(max(0.0, min(self.number(name), 1e9)))

    def word(self, name: str) -> str:
        """The word of an enumeration, by the list that is saved with it: other versions have other lists."""
        value = self.values.get(name)
        if value is None:
            return ""
        words = self.document.enumerations.get((self.name, name), ())
        index = value.get("value", "")
        if index.isdecimal() and len(index) < 9 and int(index) < len(words):
            return words[int(index)]
        return "" if index.lstrip("-").isdecimal() else index

    def placement(self, name: str = "Placement") -> Pose:
        """A pose in millimetres; the identity where there is none."""
        value = self.values.get(name)
        return Pose() if value is None else self._pose(name, value)

    def target(self, name: str) -> Target | None:
        """What a link of any kind names, None for nothing."""
        value = self.values.get(name)
        if value is None:
            return None
        found = value.get("name") or value.get("value") or ""
        subs = [sub.get("value", "") for sub in value.iter("Sub")] or [value.get("sub", "")]
        return Target(found, value.get("file", ""), tuple(s for s in subs if s)) if found else None

    def targets(self, name: str) -> list[Target]:
        """What a list of links names."""
        value = self.values.get(name)
        if value is None:
            return []
        found = [
            (entry.get("value") or entry.get("name") or entry.get("obj") or "", entry.get("file", ""))
            for entry in value
        ]
        return [Target(name, file) for name, file in found if name]

    def file(self, name: str) -> str:
        """The archive's member that a property's value is in."""
        value = self.values.get(name)
        return "" if value is None else value.get("file", "")

    def _number(self, name: str, text: str, default: float) -> float:
        try:
            number = float(text)
        except ValueError:
            number = math.nan
        if not abs(number) <= MAX_NUMBER:
            self.document.fault(self, name, f"'{shown(text)}' is no number in range")
            return default
        return number

    def _pose(self, name: str, value: Element) -> Pose:
        numbers = {
            key: self._number(name, value.get(key, "0"), 0.0) for key in ("Px", "Py", "Pz", "Q0", "Q1", "Q2")
        }
        q = np.array(
            [numbers["Q0"], numbers["Q1"], numbers["Q2"], self._number(name, value.get("Q3", "1"), 1.0)]
        )
        translation = np.array([numbers["Px"], numbers["Py"], numbers["Pz"]])
        if not 1e-6 < np.linalg.norm(q) < 1e6:
            self.document.fault(self, name, "its rotation has no length")
            return Pose(np.eye(3), translation)
        return Pose(matrix_from_quaternion(q), translation)


@dataclass(slots=True, eq=False)
class Document:
    """A document: its objects in the file's order, by name."""

    path: Path
    archive: Archive
    report: Report
    things: dict[str, Thing] = field(default_factory=dict[str, Thing])
    enumerations: dict[tuple[str, str], tuple[str, ...]] = field(
        default_factory=dict[tuple[str, str], tuple[str, ...]]
    )
    version: str = ""
    told: set[tuple[str, str]] = field(default_factory=set[tuple[str, str]])

    def fault(self, thing: Thing, name: str, detail: str) -> None:
        if (thing.name, name) not in self.told:
            self.told.add((thing.name, name))
            self.report.add(
                "FREECAD_VALUE", thing.where, object=shown(thing.label), property=shown(name), detail=detail
            )


def read_document(path: Path, report: Report) -> Document:
    """The document of a file.  Raises KinefabError when it is none."""
    archive = Archive(path, report)
    document = Document(path, archive, report)
    content = b""
    try:
        content = archive.read("Document.xml")
    except ArchiveError as error:
        report.add("ARCHIVE_REFUSED", path.name, path=path.name, detail=str(error))
        report.raise_for_errors()
    root = parse_xml(content, f"{path.name}/Document.xml", report)
    document.version = root.get("ProgramVersion", "")
    for entry in root.iterfind("Objects/Object"):
        name = entry.get("name", "")
        if name:
            document.things[name] = Thing(document, name, entry.get("type", ""))
    for entry in root.iterfind("ObjectData/Object"):
        thing = document.things.get(entry.get("name", ""))
        if thing is None:
            continue
        for prop in entry.iterfind("Properties/Property"):
            _add(document, thing, prop)
        for extension in entry.iterfind("Extensions/Extension"):
            thing.kinds.setdefault("extension", extension.get("type", ""))
    return document


def _add(document: Document, thing: Thing, prop: Element) -> None:
    name = prop.get("name", "")
    value = next(iter(prop), None)
    if value is None:
        return
    thing.values[name] = value
    thing.kinds[name] = prop.get("type", "")
    words = prop.find("CustomEnumList")
    if words is not None:
        document.enumerations[thing.name, name] = tuple(word.get("value", "") for word in words)
