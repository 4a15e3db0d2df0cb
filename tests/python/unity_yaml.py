"""A reader of the YAML that Unity writes and of nothing else: what it does not know it refuses.

Values are what stands there: ``Scalar`` (text with its quoting), dict, list; flow maps are dicts of Scalars.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

HEADER = "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n"
_DOCUMENT = re.compile(r"--- !u!(\d+) &(-?\d+)( stripped)?\n?")
_KEY = re.compile(r"( *)((?:- )*)([A-Za-z_][\w \-.]*(?:\[\d+\])?|'[^']*'|\"[^\"]*\"):(?: (.*))?$")
_ESCAPE = re.compile(r'\\(x[0-9A-Fa-f]{2}|u[0-9A-Fa-f]{4}|U[0-9A-Fa-f]{8}|[nrt"\\0abefv ])')


class UnityYamlError(ValueError):
    """What Unity does not write."""


class Scalar(str):
    """The value; ``quote`` is what stood around it."""

    quote: str = ""


@dataclass
class Document:
    class_id: int
    file_id: int
    stripped: bool
    kind: str
    fields: dict


def documents(text: str) -> list[Document]:
    """Every object of a file."""
    if not text.startswith(HEADER):
        raise UnityYamlError("not the two lines of the header")
    if "\r" in text or not text.endswith("\n") or "\t" in text:
        raise UnityYamlError("line ends")
    parts = re.split(r"^(?=--- !u!)", text[len(HEADER) :], flags=re.MULTILINE)
    return [_document(part) for part in parts if part]


def _document(part: str) -> Document:
    head, _, body = part.partition("\n")
    match = _DOCUMENT.fullmatch(head)
    if not match:
        raise UnityYamlError(head)
    lines = body.splitlines()
    if not re.fullmatch(r"[A-Za-z]+:", lines[0]):
        raise UnityYamlError(lines[0])
    fields, used = _block(lines, 1, 2)
    if used != len(lines):
        raise UnityYamlError(f"not read: {lines[used]!r}")
    return Document(int(match[1]), int(match[2]), bool(match[3]), lines[0][:-1], fields)


def mapping(text: str) -> dict:
    """A file of settings (``.meta``), without header."""
    lines = text.splitlines()
    found, used = _block(lines, 0, 0)
    if used != len(lines):
        raise UnityYamlError(f"not read: {lines[used]!r}")
    return found


def _indent(line: str) -> int:
    return len(line) - len(line.lstrip(" "))


def _block(lines: list[str], at: int, indent: int) -> tuple[dict, int]:
    found: dict = {}
    while at < len(lines) and _indent(lines[at]) == indent and not lines[at].lstrip().startswith("- "):
        match = _KEY.match(lines[at])
        if not match or match[2]:
            raise UnityYamlError(f"{lines[at]!r}")
        key = match[3].strip("'\"")
        if key in found:
            raise UnityYamlError(f"{key} stands twice")
        found[key], at = _value(lines, at, match[4], indent)
    return found, at


def _value(lines: list[str], at: int, rest: str | None, indent: int):
    if rest is not None and rest != "":
        rest, at = _unwrapped(lines, at, rest, indent)
        return _inline(rest), at
    empty = rest == "" or lines[at].endswith(": ")
    at += 1
    if at < len(lines) and not empty:
        inner = _indent(lines[at])
        if lines[at].lstrip().startswith("- ") and inner == indent:
            return _list(lines, at, indent)
        if inner == indent + 2 and not lines[at].lstrip().startswith("- "):
            return _block(lines, at, indent + 2)
    return Scalar(""), at


def _unwrapped(lines: list[str], at: int, rest: str, indent: int) -> tuple[str, int]:
    """Editors of some years break long lines; ours are never broken."""
    at += 1
    while at < len(lines) and rest[0] in "{'\"" and not _closed(rest):
        rest, at = f"{rest} {lines[at].strip()}", at + 1
    if rest[0] not in "{'\"[":
        while at < len(lines) and _indent(lines[at]) > indent and not _KEY.match(lines[at]):
            rest, at = f"{rest} {lines[at].strip()}", at + 1
    return rest, at


def _closed(text: str) -> bool:
    if text[0] == "{":
        return text.endswith("}")
    if text[0] == "'":
        return len(text) > 1 and (len(text) - len(text.rstrip("'"))) % 2 == (
            0 if len(text) == len(text) - len(text.lstrip("'")) else 1
        )
    return len(text) > 1 and text.endswith('"') and not re.search(r'(?<!\\)(\\\\)*\\"$', text)


def _list(lines: list[str], at: int, indent: int) -> tuple[list, int]:
    found: list = []
    while at < len(lines) and _indent(lines[at]) == indent and lines[at].lstrip().startswith("- "):
        rest = lines[at][indent + 2 :]
        inner = " " * (indent + 2) + rest
        if _KEY.match(inner) and not rest.startswith(("{", "'", '"')):
            lines[at] = inner
            entry, at = _block(lines, at, indent + 2)
            found.append(entry)
        else:
            rest, at = _unwrapped(lines, at, rest, indent)
            found.append(_inline(rest))
    return found, at


def _inline(text: str):
    if text == "[]":
        return []
    if text.startswith("{"):
        if not text.endswith("}"):
            raise UnityYamlError(text)
        pairs = [pair.split(": ", 1) for pair in text[1:-1].split(", ")] if text != "{}" else []
        if any(len(pair) != 2 for pair in pairs):
            raise UnityYamlError(text)
        return {key: _scalar(value) for key, value in pairs}
    return _scalar(text)


def _scalar(text: str) -> Scalar:
    quote = text[0] if text[:1] in ("'", '"') else ""
    if quote == "'":
        if len(text) < 2 or not text.endswith("'") or re.search("(?<!')'(?!')", text[1:-1].replace("''", "")):
            raise UnityYamlError(text)
        text = text[1:-1].replace("''", "'")
    elif quote:
        if len(text) < 2 or not text.endswith('"'):
            raise UnityYamlError(text)
        text = _ESCAPE.sub(_unescaped, text[1:-1])
    elif text[:1] in set("#,[]{}&*!|>%@`") or ": " in text or " #" in text or text.endswith((":", " ")):
        raise UnityYamlError(f"plain {text!r}")
    found = Scalar(text)
    found.quote = quote
    return found


def _unescaped(match: re.Match) -> str:
    told = match[1]
    if told[0] in "xuU":
        return chr(int(told[1:], 16))
    return {
        "n": "\n",
        "r": "\r",
        "t": "\t",
        "0": "\0",
        "a": "\a",
        "b": "\b",
        "e": "\x1b",
        "f": "\f",
        "v": "\v",
    }.get(told, told)
