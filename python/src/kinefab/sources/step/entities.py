"""Entities of a STEP file by their arguments, as the text has them (ISO 10303-21): internal and external mapping alike."""

from __future__ import annotations

import contextlib
import re
from dataclasses import dataclass

from ..reading.record import MAX_NUMBER
from .part21 import Part21

_TOKEN = re.compile(
    rb"\s*(?:(?P<text>'(?:[^']|'')*')|#\s*(?P<ref>\d+)|\.(?P<word>\w+)\.|(?P<number>[-+]?\d+\.?\d*(?:[eE][-+]?\d+)?)"
    rb"|(?P<name>[A-Za-z_]\w*)|(?P<mark>[(),$*])|/\*.*?\*/)",
    re.DOTALL,
)
_DIRECTIVE = re.compile(
    r"\\X(?P<size>[24])\\(?P<long>[0-9A-Fa-f]*)\\X0\\|\\X\\(?P<short>[0-9A-Fa-f]{2})|\\S\\(?P<shifted>[ -~])|\\\\"
)
MOST_LEVELS = 40


class EntityError(ValueError):
    """Text that is no entity, or not of the form that was asked for."""


@dataclass(frozen=True, slots=True)
class Ref:
    """``#number``."""

    number: int


@dataclass(frozen=True, slots=True)
class Word:
    """``.T.``, ``.METRE.``"""

    text: str


Value = Ref | Word | str | float | None | list["Value"]
"""``$`` and ``*`` are None."""


def entity(text: Part21, number: int) -> dict[str, list[Value]]:
    """Arguments of an instance by the names of its entities: one, or several of an external mapping.  Raises EntityError."""
    if number not in text.instances:
        raise EntityError(f"#{number} is not in the file")
    return parsed(text.text(number))


def parsed(content: bytes) -> dict[str, list[Value]]:
    """As ``entity``, of the text behind the ``=``."""
    tokens = _tokens(content)
    if not tokens:
        raise EntityError("an instance is empty")
    found: dict[str, list[Value]] = {}
    at = 1 if tokens[0] == ("mark", "(") else 0
    while at < len(tokens) and tokens[at][0] == "name":
        name = str(tokens[at][1]).upper()
        if at + 1 >= len(tokens) or tokens[at + 1] != ("mark", "("):
            raise EntityError(f"{name} has no arguments")
        found[name], at = _list(tokens, at + 2, 0)
    if not found:
        raise EntityError("an instance has no name")
    return found


def _tokens(content: bytes) -> list[tuple[str, str]]:
    found: list[tuple[str, str]] = []
    at = 0
    while at < len(content.rstrip()):
        match = _TOKEN.match(content, at)
        if match is None:
            raise EntityError("an instance is damaged")
        kind = match.lastgroup
        if kind is not None:
            found.append((kind, match[kind].decode("latin-1")))
        at = match.end()
    return found


def _list(tokens: list[tuple[str, str]], at: int, level: int) -> tuple[list[Value], int]:
    """The values up to the closing bracket, and where what follows it begins."""
    if level > MOST_LEVELS:
        raise EntityError("an instance is nested too deep")
    found: list[Value] = []
    while at < len(tokens):
        kind, text = tokens[at]
        at += 1
        if (kind, text) == ("mark", ")"):
            return found, at
        if (kind, text) == ("mark", ","):
            continue
        if (kind, text) == ("mark", "("):
            inner, at = _list(tokens, at, level + 1)
            found.append(inner)
        elif kind == "name":  # a typed value, LENGTH_MEASURE(1.): the value counts
            if at >= len(tokens) or tokens[at] != ("mark", "("):
                raise EntityError("an instance is damaged")
            inner, at = _list(tokens, at + 1, level + 1)
            found.append(inner[0] if len(inner) == 1 else inner)
        else:
            found.append(_value(kind, text))
    raise EntityError("an instance has no end")


def _value(kind: str, text: str) -> Value:
    if kind == "ref":
        return Ref(int(text))
    if kind == "word":
        return Word(text.upper())
    if kind == "text":
        return _decoded(text[1:-1].replace("''", "'"))
    if kind == "number":
        value = float(text)
        if not abs(value) <= MAX_NUMBER:
            raise EntityError(f"{text} is out of range")
        return value
    return None


def _decoded(text: str) -> str:
    """A text, given byte for byte, as it reads: UTF-8, or the directives of ISO 10303-21 (``\\X2\\00E4\\X0\\``, ``\\X\\E4``, ``\\S\\d``)."""
    with contextlib.suppress(UnicodeError):
        text = text.encode("latin-1").decode("utf-8")
    return _DIRECTIVE.sub(_directed, text) if "\\" in text else text


def _directed(found: re.Match[str]) -> str:
    if found["long"] is not None:
        try:
            return bytes.fromhex(found["long"]).decode("utf-16-be" if found["size"] == "2" else "utf-32-be")
        except ValueError:  # half a character: as it stands
            return found[0]
    if found["short"] is not None:
        return chr(int(found["short"], 16))
    return chr(ord(found["shifted"]) + 128) if found["shifted"] is not None else "\\"


def ref(arguments: list[Value], index: int) -> int:
    """The number that an argument refers to.  Raises EntityError."""
    value = arguments[index] if index < len(arguments) else None
    if not isinstance(value, Ref):
        raise EntityError(f"argument {index + 1} refers to nothing")
    return value.number


def number(arguments: list[Value], index: int) -> float | None:
    """A number, None where the file leaves it open.  Raises EntityError."""
    value = arguments[index] if index < len(arguments) else None
    if value is not None and not isinstance(value, float):
        raise EntityError(f"argument {index + 1} is no number")
    return value


def text_of(arguments: list[Value], index: int) -> str:
    value = arguments[index] if index < len(arguments) else None
    return value if isinstance(value, str) else ""
