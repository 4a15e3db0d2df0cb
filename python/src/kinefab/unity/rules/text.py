"""The text of a scene as JSON values: strict, and with the place of what is wrong."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any, cast

import numpy as np

from ..container import Damaged, OtherVersion, chunks_of, is_container
from .findings import Findings

INT = 2**31
LONG = 309
"""So many digits a double may not hold, and still more Python does not like to read."""
MAX_DEPTH = 64
"""Deepest nesting, as in C#."""

_OTHER_FORMAT = re.compile(rb"[ \t\r\n]*(?!true|false|null)[!#-,.:-Z\\^-z|}~]")
"""<robot>, #usda, ISO-10303-21, PK of a zip: what begins neither a value of JSON nor a comment."""
_HALF = re.compile(r"\\u[dD][89a-fA-F]")
_STRING = r'"(?:[^"\\]|\\.)*"?'
_TOKEN = re.compile(rf"{_STRING}|[\[\]{{}},:]|[^\s\[\]{{}},:\"]+", re.DOTALL)
_OTHERS = bytes(set(range(256)) - set(b"[]{}"))
_STEP = np.zeros(256, dtype=np.int8)
_STEP[list(b"[{")], _STEP[list(b"]}")] = 1, -1


class Twice(dict[str, Any]):
    """An object in whose text a name stands twice, or more often."""

    names: Sequence[str] = ()


class _Constant(ValueError):
    """NaN or Infinity, which Python's json takes for numbers."""


def parsed(content: bytes, found: Findings) -> Any:
    """The value of a scene file, text or binary; what no program could write again is told, and refused with what else is.

    Raises KinefabError with the place where it is no JSON.
    """
    text = _text(content, found)
    _demand_depth(text, found)
    endless: list[str] = []
    try:
        value: Any = _loads(text, endless)
    except json.JSONDecodeError as error:
        found.add("JSON_SYNTAX", place_at(text, error.pos), detail=error.msg)
    except _Constant as error:
        at = place_at(text, _offset_of_constant(text))
        found.add("JSON_SYNTAX", at, detail=f"{error} is not a JSON number")
    else:
        if endless:
            _tell_endless(value, found)
        if _HALF.search(text):
            _tell_halves(value, found)
        return value
    found.refuse()
    raise AssertionError("what is no JSON was told")


def _text(content: bytes, found: Findings) -> str:
    """The characters of a file, without the byte order mark that editors write.  Raises KinefabError."""
    try:
        data = bytes(chunks_of(content)[0]) if is_container(content) else content
    except OtherVersion as error:
        found.add("CONTAINER_VERSION_UNSUPPORTED", version=error.version)
    except Damaged as error:
        found.add("CONTAINER_INVALID", detail=error)
    else:
        data = data.removeprefix(b"\xef\xbb\xbf")
        if not data.strip(b" \t\r\n"):
            found.add("SCENE_EMPTY")
        elif _OTHER_FORMAT.match(data) and b'"gameObjects"' not in data:
            found.refuse_for("FORMAT_MISSING")
        try:
            text = data.decode("utf-8")
        except UnicodeDecodeError as error:
            before = data[: error.start].decode("utf-8")
            found.add("JSON_NOT_UTF8", place_at(f"{before}?", len(before) + 1))
        else:
            found.refuse()
            return text
    found.refuse()
    raise AssertionError("what is no text was told")


def _demand_depth(text: str, found: Findings) -> None:
    """Raises KinefabError where it is nested too deep: Python's json would end in a RecursionError."""
    if _deepest(text) <= MAX_DEPTH or _deepest(re.sub(_STRING, "", text, flags=re.DOTALL)) <= MAX_DEPTH:
        return
    depth = 0
    for token in _TOKEN.finditer(text):
        depth += (token[0] in "[{") - (token[0] in "]}")
        if depth > MAX_DEPTH:
            found.add("JSON_TOO_DEEP", place_at(text, token.end()), limit=MAX_DEPTH)
            found.refuse()


def _deepest(text: str) -> int:
    """Nesting of brackets, those within strings counted too."""
    brackets = text.encode("utf-8").translate(None, _OTHERS)
    steps = _STEP[np.frombuffer(brackets, dtype=np.uint8)]
    return int(np.cumsum(steps, dtype=np.int64).max(initial=0))


def _loads(text: str, endless: list[str]) -> Any:
    """endless: takes the numbers beyond a double."""

    def number(text: str) -> float:  # 3.0 is an index too
        value = float(text)
        if abs(value) < INT:
            return int(value) if value.is_integer() else value
        if math.isinf(value):
            endless.append(text)
        return value

    def whole(text: str) -> float:
        return int(text) if len(text) < LONG else number(text)

    return json.loads(
        text, parse_constant=_refuse, object_pairs_hook=_object, parse_float=number, parse_int=whole
    )


def _refuse(constant: str) -> float:
    raise _Constant(constant)


def _object(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    entry = dict(pairs)
    if len(entry) == len(pairs):
        return entry
    twice = Twice(reversed(pairs))  # the first of a name counts, as in C#
    counts = Counter(name for name, _ in pairs)
    twice.names = [name for name, count in counts.items() for _ in range(count - 1)]
    return twice


def _offset_of_constant(text: str) -> int:
    return next(t.start() for t in _TOKEN.finditer(text) if t[0] in ("NaN", "Infinity", "-Infinity"))


def _tell_endless(value: object, found: Findings) -> None:
    """In extras too: written again they would be no JSON."""
    for pointer, inner in leaves(value):
        if isinstance(inner, float) and math.isinf(inner):
            found.add("NUMBER_NOT_FINITE", pointer, number=inner)


def _tell_halves(value: object, found: Findings) -> None:
    """Half of a surrogate pair can be written in no file."""
    for pointer, inner in leaves(value):
        if isinstance(inner, str) and any("\ud800" <= character <= "\udfff" for character in inner):
            found.add("JSON_STRING_INVALID", pointer)


def leaves(value: object, pointer: str = "") -> Iterator[tuple[str, object]]:
    """The names, texts, numbers and words in a value, each with its place."""
    if isinstance(value, dict):
        for name, inner in cast("dict[str, object]", value).items():
            at = f"{pointer}/{escaped(name)}"
            yield at, name
            yield from leaves(inner, at)
    elif isinstance(value, list):
        for index, inner in enumerate(cast("list[object]", value)):
            yield from leaves(inner, f"{pointer}/{index}")
    else:
        yield pointer, value


def escaped(name: str) -> str:
    """A field's name as a JSON pointer has it (RFC 6901)."""
    return name.replace("~", "~0").replace("/", "~1")


def place_at(text: str, offset: int) -> str:
    """The JSON pointer of the innermost field or item that begins before a character; of a broken text the way there."""
    # None: an object whose first field is still to come; -1: an array whose first item is
    path: list[str | int | None] = []
    names = False
    for token in _TOKEN.finditer(text):
        if token.start() >= offset:
            break
        mark = token[0]
        if mark in "]}":
            del path[-1:]
        elif mark == ",":
            names = bool(path) and not isinstance(path[-1], int)
            continue
        elif mark == ":":
            continue
        elif names and mark[0] == '"':
            path[-1] = _name(mark)
        elif path and isinstance(last := path[-1], int):
            path[-1] = last + 1
        names = mark == "{"
        if mark in "[{":
            path.append(None if names else -1)
    found = ""
    for part in path:
        if part is None or part == -1:
            break
        found += f"/{escaped(str(part))}"
    return found


def _name(token: str) -> str:
    try:
        return str(json.loads(token))
    except ValueError:
        return token.strip('"')
