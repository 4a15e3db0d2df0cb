"""The extension file of Braun et al. (2020): one row a part or assembly, with its free directions and its
axes.

The paper lists the columns (name, type, parent, bodies, origin, the X, Y and Z direction vectors, free DOF
with directions, axis-axis constraints) and not their names, so columns are found by what they are called in
English or German, or else taken in the paper's order.  A vector is one cell of three numbers or three
columns.  Entries of one cell stand between ``|``.  Comment lines ``# length: cm``, ``# up: Z``, ``# mesh:
NAME.obj`` and ``# mesh length: cm`` state what the paper's file leaves to the reader.
"""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass, field
from difflib import get_close_matches
from pathlib import Path

from ...diagnostics import Report
from ...model import Scene
from ..bundle.reader import FORMAT, scene_from_values
from ..reading.file import read_bytes
from ..reading.record import MAX_NUMBER, entries_in, shown
from ..reading.request import Request
from ..reading.table import Row, Table, read_table
from .axis import Axis, Numbers, Part, axis_records, slide_records

COLUMNS = {
    "name": "name bauteilname bezeichnung komponente component",
    "type": "type typ art kind",
    "parent": "parent superiorassembly assembly baugruppe uebergeordnetebaugruppe elternbaugruppe",
    "bodies": "bodies body koerper volumenkoerper",
    "origin": "origin ursprung position",
    "x": "x xaxis xachse xvector xvektor xrichtung",
    "y": "y yaxis yachse yvector yvektor yrichtung",
    "z": "z zaxis zachse zvector zvektor zrichtung",
    "dof": "dof freedof freiheitsgrade freiefreiheitsgrade",
    "axes": "axisconstraints constraints axes abhaengigkeiten achsabhaengigkeiten achsen",
    "center": "dofcenter dofcentre center centre zentrum dofzentrum",
    "points": "points axispoints punkte achspunkte",
}
"""What each column may be called, without blanks and signs; in the order taken where no row names them."""

VECTORS = ("origin", "x", "y", "z", "center")
AXES = ("x", "y", "z")
KINDS = {"part": "part", "teil": "part", "bauteil": "part", "assembly": "assembly", "baugruppe": "assembly"}
FREEDOM = re.compile(r"(t|trans\w*|r|rot\w*)[\s:(]+([^)]*)\)?", re.IGNORECASE)

SETTINGS = {"length": "cm", "up": "Z", "mesh": "", "mesh length": ""}
"""What a comment line may state, and what holds without: Inventor's programming interface speaks
centimetres."""


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of a CSV with the paper's columns.

    request.vertices: finds the point of an axis in the geometry.  Raises KinefabError with
    every error found.
    """
    data = read_bytes(path, report)
    reading = _Reading(read_table(data, path.name, report), path, report)
    reading.take_all()
    axis_records(reading.axes, reading.parts, reading.values, reading.lines, path, report, request.vertices)
    slide_records(reading.axes, reading.parts, reading.values, reading.lines, path.name, report)
    return scene_from_values(reading.values, path, data, report, reading.lines)


@dataclass(slots=True)
class _Reading:
    """The raw bundle as it grows, row by row.  parts, axes: what the axes are resolved from."""

    table: Table
    path: Path
    report: Report
    values: dict[str, object] = field(default_factory=dict[str, object])
    lines: dict[str, int] = field(default_factory=dict[str, int])
    parts: dict[str, Part] = field(default_factory=dict[str, Part])
    axes: list[Axis] = field(default_factory=list[Axis])

    def take_all(self) -> None:
        self._settings()
        columns, rows = self._columns()
        if columns is None:
            return
        cells = [
            (row, {key: [row.cells[i] for i in at if i < len(row.cells)] for key, at in columns.items()})
            for row in rows
        ]
        ids = self._ids(cells)
        components = entries_in(self.values, "components")
        for (row, cell), name in zip(cells, ids.of_row):
            self.lines[f"/components/{len(components)}"] = row.line
            components.append(self._component(row, cell, name, ids))
        for (row, cell), name in zip(cells, ids.of_row):
            self._axes(row, cell, name, ids)

    def _settings(self) -> None:
        given = dict(SETTINGS)
        for row in self.table.comments:
            key, _, value = row.cells[0].partition(":")
            if key.strip().lower() in given and value.strip():
                given[key.strip().lower()] = value.strip()
        assumed = [f"{key} {value}" for key, value in SETTINGS.items() if value and given[key] == value]
        stated = {row.cells[0].partition(":")[0].strip().lower() for row in self.table.comments}
        if silent := [entry for entry in assumed if entry.rpartition(" ")[0] not in stated]:
            self.report.add("PAPER_ASSUMED", self.path.name, assumed=", ".join(silent))
        self.values["meta"] = {
            "format": FORMAT,
            "version": "1.0",
            "units": {"length": given["length"], "angle": "deg"},
            "up": given["up"],
            "mesh": {
                "files": [given["mesh"] or f"{self.path.stem}.obj"],
                "units": given["mesh length"] or given["length"],
                "coordinates": "world",
            },
        }

    def _columns(self) -> tuple[dict[str, range] | None, tuple[Row, ...]]:
        """The cells of each column, and the rows below the heading."""
        if not self.table.rows:
            self.report.add("SOURCE_EMPTY", self.path.name, path=self.path)
            return None, ()
        heading = self.table.rows[0]
        names = [_plain(cell) for cell in heading.cells]
        by_word = {word: key for key, words in COLUMNS.items() for word in words.split()}
        if by_word.get(names[0]) != "name" and "name" not in {by_word.get(name) for name in names}:
            return self._positions(heading), self.table.rows
        found: dict[str, range] = {}
        for i, name in enumerate(names):
            key = by_word.get(name)
            if key is None and name[-1:] in AXES and by_word.get(name[:-1]) in VECTORS:
                first = by_word[name[:-1]]
                found[first] = range(found[first].start if first in found else i, i + 1)
            elif key is None and name:
                place = f"{self.path.name}:{heading.line}"
                self.report.add("CSV_HEADING_UNKNOWN", place, heading=shown(heading.cells[i]))
            elif key:
                found[key] = range(i, i + 1)
        for key in ("name", "type", "parent", "origin", *AXES):
            if key not in found:
                place = f"{self.path.name}:{heading.line}"
                self.report.add(
                    "CSV_HEADING_MISSING", place, heading=key, known=COLUMNS[key].replace(" ", ", ")
                )
        return (
            found if {"name", "type", "parent", "origin", *AXES} <= found.keys() else None
        ), self.table.rows[1:]

    def _positions(self, row: Row) -> dict[str, range]:
        """The paper's order; a vector has three columns unless its first cell holds three numbers."""
        in_one_cell = len(row.cells) > 4 and len(row.cells[4].split()) == 3
        found: dict[str, range] = {}
        at = 0
        for key in COLUMNS:
            width = 1 if in_one_cell or key not in VECTORS else 3
            found[key], at = range(at, at + width), at + width
        return found

    def _ids(self, cells: list[tuple[Row, dict[str, list[str]]]]) -> _Ids:
        """Ids as occurrence paths; the rows name each other by bare names."""
        names = [_text(cell, "name") for _, cell in cells]
        parents = {name: _text(cell, "parent") for name, (_, cell) in zip(names, cells)}
        of_name: dict[str, str] = {}
        of_row: list[str] = []
        for name, (_, cell) in zip(names, cells):
            chain, at = [name], _text(cell, "parent")
            while at in parents and at not in chain:
                chain.append(at)
                at = parents[at]
            of_row.append("/".join(reversed(chain)) if name else "")
            of_name.setdefault(name, of_row[-1])
        twice = frozenset(name for name, count in Counter(names).items() if count > 1 and name)
        return _Ids(of_row, of_name, twice)

    def _component(self, row: Row, cell: dict[str, list[str]], name: str, ids: _Ids) -> dict[str, object]:
        kind, parent = _text(cell, "type"), _text(cell, "parent")
        freedoms = self._freedoms(row, cell)
        vectors = {key: self._numbers(row, cell, key) for key in VECTORS}
        # The DOF analysis counts against the ground: a part of the top assembly without a freedom stands on
        # it.
        top = bool(parent) and "/" not in ids.of_name.get(parent, "/")
        fixed = top and "dof" in cell and freedoms == {"translations": [], "rotations": []}
        bodies = [body.strip() for body in re.split(r"[|,]", _text(cell, "bodies")) if body.strip()]
        self.parts[name] = Part(
            name,
            tuple(bodies),
            fixed,
            freedoms["translations"],
            freedoms["rotations"],
            vectors["center"],
            vectors["origin"],
            row.line,
        )
        if freedoms["translations"] or freedoms["rotations"]:
            record: dict[str, object] = {"component": name, **freedoms}
            if vectors["center"]:
                record["center"] = vectors["center"]
            records = entries_in(self.values, "dof")
            self.lines[f"/dof/{len(records)}"] = row.line
            records.append(record)
        component: dict[str, object] = {
            "id": name,
            "name": _text(cell, "name"),
            "kind": KINDS.get(_plain(kind), kind),
            "pose": {short: vectors[key] for short, key in zip("oxyz", ("origin", *AXES)) if vectors[key]},
            "bodies": [{"id": body, "name": body, "meshKey": body} for body in bodies],
            "grounded": fixed,
            "flexible": not parent,
        }
        if parent:
            self._check_single(row, parent, ids)
            component["parent"] = ids.of_name.get(parent, parent)
        return component

    def _freedoms(self, row: Row, cell: dict[str, list[str]]) -> dict[str, list[list[float]]]:
        found: dict[str, list[list[float]]] = {"translations": [], "rotations": []}
        for entry in _entries(cell, "dof"):
            match = FREEDOM.fullmatch(entry)
            vector = self._vector(match[2]) if match else None
            if match is None or vector is None:
                self._unreadable(row, "dof", entry, "T or R and three numbers, as in R 0 0 1")
            else:
                found["translations" if match[1][0] in "tT" else "rotations"].append(vector)
        return found

    def _axes(self, row: Row, cell: dict[str, list[str]], name: str, ids: _Ids) -> None:
        points = _entries(cell, "points")
        for i, entry in enumerate(_entries(cell, "axes")):
            *partner, x, y, z = ["", "", "", *re.split(r"[\s;()]+", entry.rstrip(" )"))]
            direction = self._vector(f"{x} {y} {z}")
            point = self._vector(points[i]) if i < len(points) else None
            if direction is None or i < len(points) and point is None:
                self._unreadable(row, "axes", entry, "a part's name and three numbers, as in Shaft:1 0 0 1")
            elif partner_id := self._partner(row, " ".join(partner).strip(), ids):
                self.axes.append(
                    Axis(
                        name,
                        partner_id,
                        _three(direction),
                        None if point is None else _three(point),
                        row.line,
                    )
                )

    def _partner(self, row: Row, name: str, ids: _Ids) -> str | None:
        """The id that a bare name stands for; None, after a report, when that is not clear."""
        if name not in ids.of_name:
            near = ", ".join(get_close_matches(name, ids.of_name)) or "none"
            self.report.add("PARTNER_UNKNOWN", f"{self.path.name}:{row.line}", name=shown(name), near=near)
        return ids.of_name.get(name) if self._check_single(row, name, ids) else None

    def _check_single(self, row: Row, name: str, ids: _Ids) -> bool:
        if name in ids.twice:
            self.report.add("NAME_AMBIGUOUS", f"{self.path.name}:{row.line}", name=shown(name))
        return name not in ids.twice

    def _numbers(self, row: Row, cell: dict[str, list[str]], key: str) -> list[float] | None:
        text = " ".join(cell.get(key, ()))
        if not text.strip():
            return None
        vector = self._vector(text)
        if vector is None:
            self._unreadable(row, key, text, "three numbers, as in 0 0 1")
        return vector

    def _vector(self, text: str) -> list[float] | None:
        numbers = [self.table.number(part) for part in re.split(r"[\s;()]+", text) if part]
        usable = [n for n in numbers if isinstance(n, float) and abs(n) <= MAX_NUMBER]
        return usable if len(usable) == len(numbers) == 3 else None

    def _unreadable(self, row: Row, column: str, text: str, wanted: str) -> None:
        place = f"{self.path.name}:{row.line}"
        self.report.add("CSV_CELL", place, column=column, text=shown(text), wanted=wanted)


@dataclass(frozen=True, slots=True)
class _Ids:
    """of_row: id of each row.  of_name: id by bare name.  twice: names that more than one row has."""

    of_row: list[str]
    of_name: dict[str, str]
    twice: frozenset[str]


def _three(numbers: list[float]) -> Numbers:
    x, y, z = numbers
    return x, y, z


def _plain(text: str) -> str:
    """A heading without blanks, signs and umlauts."""
    text = text.casefold()
    for umlaut, letters in (("ä", "ae"), ("ö", "oe"), ("ü", "ue")):
        text = text.replace(umlaut, letters)
    return re.sub(r"[^a-z]", "", text)


def _text(cell: dict[str, list[str]], key: str) -> str:
    return cell[key][0] if cell.get(key) else ""


def _entries(cell: dict[str, list[str]], key: str) -> list[str]:
    return [entry.strip() for entry in _text(cell, key).split("|") if entry.strip()]
