"""The tagged CSV form of a bundle, for macros without a JSON library: one record a line, its tag first.

Each line becomes the object that ``NAME.bundle.json`` would hold, so both forms are interpreted alike.  The
columns of each tag stand in ``COLUMNS``; trailing ones may be left out, empty cells say nothing.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ...diagnostics import Report
from ...model import Scene
from ..reading.file import read_bytes
from ..reading.record import entries_in, is_object, shown
from ..reading.request import Request
from ..reading.table import Row, Table, encodings, read_table
from .reader import scene_from_values

TRUE, FALSE = frozenset("1 true wahr yes ja vrai".split()), frozenset("0 false falsch no nein faux".split())
"""VBA prints a Boolean in the language of the Windows it runs on."""

LIST_SEPARATOR = "|"

FRAME_A = "frameA.in frameA.o*3 frameA.z*3 frameA.x*3"
SIDE_A = "a.component a.geometry a.in a.p*3 a.d*3 a.r"

COLUMNS = {
    "COMP": "id name kind parent definition pose.o*3 pose.x*3 pose.y*3 pose.z*3"
    " grounded? flexible? suppressed? visible? file",
    "BODY": "component id name meshKey material file density",
    "MASS": "component mass in center*3 inertia*6",
    "MAT": "name density color*4 metallic smoothness",
    "JOINT": f"id name type a b {FRAME_A} {FRAME_A.replace('A', 'B')}"
    " lead flipped? suppressed? because| driver",
    "DOF": "joint name value min max rest minEnabled? maxEnabled? restEnabled?",
    "COUP": "id name kind a.joint a.dof b.joint b.dof ratio radiusA radiusB teethA teethB radius pitch"
    " offset reversed? suppressed?",
    "CONS": f"id name kind {SIDE_A} {SIDE_A.replace('a.', 'b.')} value min max sense side suppressed?"
    f" rawKind lockRotation? a.halfAngle b.halfAngle a.x*3 b.x*3 {SIDE_A.replace('a.', 'c.')}",
    "FREE": "component t*3 r*3 center*3",
}
"""By tag: paths in the record's object; *n takes n columns, ? is true or false, | a list in one cell."""

LISTS = {
    "COMP": "components",
    "MAT": "materials",
    "JOINT": "joints",
    "COUP": "couplings",
    "CONS": "constraints",
}
"""Tags whose line is a record of its own, and the list it goes to; others belong to a line before them."""

OWNED = {"BODY": ("COMP", "bodies"), "MASS": ("COMP", "mass"), "DOF": ("JOINT", "dof")}
"""Tags whose line belongs to the record that its first column names, and the field it goes to."""

TEXTS = frozenset(
    "id name kind parent definition file component meshKey material in type a b driver dof joint geometry"
    " sense side rawKind".split()
)
"""Last part of the paths that hold a text, even where it looks like a number."""


def sniff(head: bytes) -> bool:
    """Whether a CSV begins as a tagged one: a line whose first cell is the tag META."""
    lines = head.decode(next(iter(encodings(head)), "utf-8"), "replace").splitlines()
    return any(line.lstrip(' "').startswith("META") for line in lines)


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a tagged CSV.  request: nothing of it is needed here.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    reading = _Reading(read_table(data, path.name, report), path.name, report)
    for row in reading.table.rows:
        reading.take(row)
    return scene_from_values(reading.values, path, data, report, reading.lines)


@dataclass(slots=True)
class _Reading:
    """The raw bundle as it grows, line by line.  owners: records by tag and id."""

    table: Table
    name: str
    report: Report
    values: dict[str, object] = field(default_factory=dict[str, object])
    lines: dict[str, int] = field(default_factory=dict[str, int])
    owners: dict[tuple[str, str], tuple[dict[str, object], str]] = field(
        default_factory=dict[tuple[str, str], tuple[dict[str, object], str]]
    )

    def take(self, row: Row) -> None:
        tag = row.cells[0].upper()
        if tag == "META":
            self._meta(row)
        elif tag not in COLUMNS:
            known = ", ".join(["META", *COLUMNS])
            self.report.add(
                "CSV_TAG_UNKNOWN", f"{self.name}:{row.line}", tag=shown(row.cells[0]), known=known
            )
        elif (record := self._record(tag, row)) is None:
            return
        elif tag in LISTS:
            pointer = self._append(self.values, LISTS[tag], record, "", row)
            if isinstance(key := record.get("id"), str):
                self.owners.setdefault((tag, key), (record, pointer))
        elif tag == "FREE":
            self._free(record, row)
        else:
            self._own(tag, record, row)

    def _meta(self, row: Row) -> None:
        """``META;units.length;cm``: a path and its text; more cells make a list."""
        path, cells = row.cells[1] if len(row.cells) > 1 else "", [cell for cell in row.cells[2:] if cell]
        value = cells if path == "mesh.files" else cells[0] if cells else None
        _put(self.values, f"meta.{path}", value)
        self.lines[f"/meta/{path.replace('.', '/')}"] = row.line
        self.lines.setdefault("/meta", row.line)

    def _record(self, tag: str, row: Row) -> dict[str, object] | None:
        """The row as an object; None, after a report, when it has too many columns."""
        cells = list(row.cells[1:])
        while cells and not cells[-1]:
            cells.pop()
        columns = _PARSED[tag]
        if len(cells) > (most := sum(count for _, count, _ in columns)):
            place = f"{self.name}:{row.line}"
            self.report.add("CSV_COLUMNS", place, tag=tag, found=len(cells) + 1, most=most + 1)
            return None
        record: dict[str, object] = {}
        at = 0
        for path, count, mark in columns:
            part, at = cells[at : at + count], at + count
            if any(part):
                convert = self._converter(path, mark)
                numbers = [self.table.number(cell) for cell in part]
                _put(record, path, convert(part[0]) if count == 1 else numbers)
        return record

    def _converter(self, path: str, mark: str) -> Callable[[str], object]:
        if mark == "?":
            return _flag
        if mark == LIST_SEPARATOR:
            return lambda cell: [entry.strip() for entry in cell.split(LIST_SEPARATOR) if entry.strip()]
        return str if path.rpartition(".")[2] in TEXTS else self.table.number

    def _append(self, owner: dict[str, object], key: str, record: object, pointer: str, row: Row) -> str:
        entries = entries_in(owner, key)
        entries.append(record)
        pointer = f"{pointer}/{key}/{len(entries) - 1}"
        self.lines[pointer] = row.line
        return pointer

    def _own(self, tag: str, record: dict[str, object], row: Row) -> None:
        """A line that belongs to a component's or a joint's line before it."""
        wanted, key = OWNED[tag]
        name = str(record.pop(COLUMNS[tag].split()[0], ""))
        if (wanted, name) not in self.owners:
            place = f"{self.name}:{row.line}"
            self.report.add("CSV_OWNER_UNKNOWN", place, tag=tag, owner=shown(name), wanted=wanted)
            return
        owner, pointer = self.owners[wanted, name]
        if tag == "MASS":
            owner[key] = record
            self.lines[f"{pointer}/{key}"] = row.line
        else:
            self._append(owner, key, record, pointer, row)

    def _free(self, line: dict[str, object], row: Row) -> None:
        """A free direction; the lines of one component make one DOF record."""
        name = str(line.get("component", ""))
        if ("FREE", name) not in self.owners:
            record: dict[str, object] = {"component": name}
            pointer = self._append(self.values, "dof", record, "", row)
            self.owners["FREE", name] = record, pointer
        record, pointer = self.owners["FREE", name]
        for short, key in (("t", "translations"), ("r", "rotations")):
            if short in line:
                self._append(record, key, line[short], pointer, row)
        if "center" in line:
            record["center"] = line["center"]


def _put(record: dict[str, object], path: str, value: object) -> None:
    *outer, last = path.split(".")
    for key in outer:
        inner = record.setdefault(key, {})
        record = inner if is_object(inner) else {}
    record[last] = value


def _flag(cell: str) -> bool | str:
    word = cell.lower()
    return True if word in TRUE else False if word in FALSE else cell


def _parsed(columns: str) -> tuple[tuple[str, int, str], ...]:
    """Path, number of columns and mark of each column."""
    found: list[tuple[str, int, str]] = []
    for column in columns.split():
        path, _, count = column.partition("*")
        mark = path[-1] if path[-1] in "?|" else ""
        found.append((path.rstrip("?|"), int(count or 1), mark))
    return tuple(found)


_PARSED = {tag: _parsed(columns) for tag, columns in COLUMNS.items()}
