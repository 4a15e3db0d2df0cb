"""Delimited text as CAD macros and spreadsheets write it: any of ; tab and comma, or what a first line ``sep=`` states;
decimal point or comma; UTF-8, Windows-1252, or UTF-16 with its byte order mark."""

from __future__ import annotations

import codecs
import csv
import io
import re
from dataclasses import dataclass

from ...diagnostics import Report

DELIMITERS = (";", "\t", ",")
"""In the order they are looked for: a comma may also be a decimal sign, the others mean nothing else."""

STATED = re.compile(r'"?sep=([^\w"\s]|\t)"?[;,\t ]*\r?$', re.IGNORECASE | re.MULTILINE)
"""A first line that tells Excel the delimiter, and is no record; a spreadsheet that wrote it again may have quoted it."""

COMMA_NUMBER = re.compile(r"(?:^|\s)[-+]?\d+,\d+(?:[eE][-+]?\d+)?(?:\s|$)")


@dataclass(frozen=True, slots=True)
class Row:
    """line: where the row begins, from 1.  cells: stripped of blanks around them."""

    line: int
    cells: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Table:
    """rows: those with content.  comments: lines that begin with #, without it.  decimal: '.', or ',' beside
    '.'."""

    rows: tuple[Row, ...]
    comments: tuple[Row, ...]
    decimal: str

    def number(self, cell: str) -> float | str:
        """The cell as a number; the cell itself where it is none (whoever reads it reports the type)."""
        try:
            return float(cell.replace(",", ".") if self.decimal == "," else cell)
        except ValueError:
            return cell


def read_table(data: bytes, name: str, report: Report) -> Table:
    """The rows of a delimited text.  name: of the file.  Raises KinefabError when it cannot be taken
    apart."""
    text = _decode(data, name, report)
    rows: list[Row] = []
    comments: list[Row] = []
    if stated := STATED.match(text):
        delimiter, text = stated[1], text[stated.end() :]
    else:
        delimiter = _delimiter(text)
    lines = csv.reader(io.StringIO(text, newline=""), delimiter=delimiter, strict=True, skipinitialspace=True)
    line = 1
    try:
        for cells in lines:
            stripped = tuple(cell.strip() for cell in cells)
            if any(stripped):
                if stripped[0].startswith("#"):
                    comments.append(Row(line, (stripped[0][1:].strip(), *stripped[1:])))
                else:
                    rows.append(Row(line, stripped))
            line = lines.line_num + 1
    except csv.Error as error:
        report.add("CSV_SYNTAX", f"{name}:{line}", detail=error)
        report.raise_for_errors()
    cells = [cell for row in rows for cell in row.cells]
    # Between digits a comma that is no delimiter is a decimal sign; a version like 1.0 may stand beside it.
    comma = delimiter != "," and any(map(COMMA_NUMBER.search, cells))
    return Table(tuple(rows), tuple(comments), "," if comma else ".")


def encodings(data: bytes) -> tuple[str, ...]:
    """What a table that begins so may be encoded in, in the order to be tried."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return ("utf-16",)
    # A NUL is text in either of these, but no table holds one: it is the other half of UTF-16.
    return () if b"\0" in data else ("utf-8-sig", "cp1252")


def _decode(data: bytes, name: str, report: Report) -> str:
    for encoding in encodings(data):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text
    report.add("CSV_ENCODING", name)
    report.raise_for_errors()
    raise AssertionError("an error was just reported")


def _delimiter(text: str) -> str:
    """The first kind of delimiter found in the first line with content."""
    for line in io.StringIO(text):
        outside_quotes = "".join(line.split('"')[::2])
        if outside_quotes.strip() and not outside_quotes.lstrip().startswith("#"):
            return next((mark for mark in DELIMITERS if mark in outside_quotes), ";")
    return ";"
