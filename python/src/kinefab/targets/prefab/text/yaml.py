"""Unity's own YAML, line for line as the editor writes it.

A block of fields is a mapping.  Values: numbers (floats in the shortest form of their float32), text, ``Plain`` (written as
it is: references, vectors, hexadecimal), mappings (a block below the key) and lists (dashes at the key's own indent).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, cast

import numpy as np

from ...numbers import DECIMALS

HEADER = "%YAML 1.1\n%TAG !u! tag:unity3d.com,2011:\n"
NOTHING = "{fileID: 0}"
SMALLEST_POSITIONAL, LARGEST_POSITIONAL = -9, 20
"""Powers of ten between which the editor writes a number without an exponent."""

INFINITE = 2.0**128 - 2.0**103
"""From here on a number is rounded to no float32: half a step above the largest."""

WHOLE = 1e7
"""Below this a whole number is a float32 exactly."""

Fields = Mapping[str, Any]


class Plain(str):
    """Text that is written as it is."""


NULL = Plain(NOTHING)


def number(value: float) -> str:
    """A float as the editor writes it: shortest digits of the float32, no negative zero."""
    if -WHOLE < value < WHOLE and value == (whole := int(value)):
        return str(whole)
    if not -INFINITE < value < INFINITE:
        return "NaN" if math.isnan(value) else "-Infinity" if value < 0 else "Infinity"
    single = np.float32(value)
    told = str(single)
    return told if "e" not in told and not told.endswith(".0") else _digits(single)


@lru_cache(maxsize=4096)
def _digits(single: np.float32) -> str:
    if single == 0:
        return "0"
    mantissa, power = np.format_float_scientific(single, unique=True, trim="-").split("e")
    exponent = int(power)
    sign = "-" if mantissa.startswith("-") else ""
    digits = mantissa.lstrip("-").replace(".", "")
    if not SMALLEST_POSITIONAL <= exponent <= LARGEST_POSITIONAL:
        rest = f".{digits[1:]}" if len(digits) > 1 else ""
        return f"{sign}{digits[0]}{rest}e{exponent:+d}"
    if exponent < 0:
        return f"{sign}0.{'0' * (-exponent - 1)}{digits}"
    digits = digits.ljust(exponent + 1, "0")
    rest = f".{digits[exponent + 1 :]}" if len(digits) > exponent + 1 else ""
    return f"{sign}{digits[: exponent + 1]}{rest}"


def vector(values: Sequence[float], names: str = "xyzw") -> Plain:
    """``{x: 1, y: 2, z: 3}``; colours by the names ``rgba``."""
    return Plain("{" + ", ".join([f"{name}: {number(value)}" for name, value in zip(names, values)]) + "}")


def placed(values: Sequence[float]) -> Plain:
    """A vector of lengths, directions or a quaternion: without the noise below a picometre."""
    return vector([round(value, DECIMALS) for value in values])


def local(file_id: int) -> Plain:
    """A reference to an object of the same file, 0 for none."""
    return Plain(f"{{fileID: {file_id}}}")


def external(file_id: int, guid: str, kind: int) -> Plain:
    """A reference into another file.  kind: 0 built in, 2 an asset in Unity's own YAML, 3 what an importer made."""
    return Plain(f"{{fileID: {file_id}, guid: {guid}, type: {kind}}}")


def text(value: str) -> str:
    """A scalar: plain where YAML takes it so, else in single quotes, in double ones where an escape is needed."""
    if not value:
        return ""
    if not value.isascii() or not value.isprintable():
        return '"' + "".join(map(_escaped, value)) + '"'
    starts = value[0] in "#,[]{}&*!|>'\"%@`" or (value[0] in "-?:" and (len(value) == 1 or value[1] == " "))
    inside = ": " in value or " #" in value or value.endswith(":") or value.startswith(("---", "..."))
    if starts or inside or value in ("=", "<<") or value != value.strip():
        return "'" + value.replace("'", "''") + "'"
    return value


def _escaped(character: str) -> str:
    code = ord(character)
    if character in '"\\':
        return "\\" + character
    if " " <= character <= "~":
        return character
    if character in "\n\r\t":
        return {"\n": "\\n", "\r": "\\r", "\t": "\\t"}[character]
    if code < 0x100:
        return f"\\x{code:02X}"
    return f"\\u{code:04X}" if code < 0x10000 else f"\\U{code:08X}"


def lines(fields: Fields, indent: str = "  ") -> Iterator[str]:
    """The fields, a line each, without line ends."""
    for key, value in fields.items():
        if isinstance(value, Plain):
            yield f"{indent}{key}: {value}"
        elif isinstance(value, str):
            yield f"{indent}{key}: {text(value)}"
        elif isinstance(value, (bool, int)):
            yield f"{indent}{key}: {int(value)}"
        elif isinstance(value, float):
            yield f"{indent}{key}: {number(value)}"
        elif isinstance(value, Mapping):
            if value:
                yield f"{indent}{key}:"
                yield from lines(cast(Fields, value), indent + "  ")
            else:
                yield f"{indent}{key}: {{}}"
        else:
            yield from _listed(f"{indent}{key}:", value, indent)


def _listed(head: str, values: Iterable[Any], indent: str) -> Iterator[str]:
    entries = list(values)
    yield head if entries else f"{head} []"
    for entry in entries:
        if isinstance(entry, Mapping):
            block = list(lines(entry, indent + "  "))  # type: ignore[arg-type]
            yield f"{indent}- {block[0].lstrip()}"
            yield from block[1:]
        else:
            yield f"{indent}- {entry if isinstance(entry, Plain) else text(str(entry))}"


def document(class_id: int, class_name: str, file_id: int | Plain, fields: Fields) -> str:
    """One object of a file, with its line ends."""
    return "\n".join((f"--- !u!{class_id} &{file_id}", f"{class_name}:", *lines(fields))) + "\n"
