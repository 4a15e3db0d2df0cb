"""Typed access to the raw values of a bundle; a wrong type becomes a diagnostic at its place.

Every accessor returns a harmless value (0, "", a zero vector) after it has reported a fault and marks the
record as not ``sound``, so that a reader goes on to find everything else that is wrong.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any, TypeGuard, TypeVar, cast, overload

from ...diagnostics import Report, Severity, diagnostic_table, is_encodable
from .near import near_words

T = TypeVar("T")
Vector = tuple[float, float, float]

REQUIRED: Any = object()
"""Default of a field that must be there."""

MAX_NUMBER = 1e15
"""Largest magnitude of a number: its cube is still far from overflow, and no length comes near it."""
MIN_DIRECTION = 1e-9
"""Shortest vector that still says where it points to: CAD programs write unit vectors."""


@dataclass(slots=True)
class Log:
    """Where diagnostics go, and how a place in the raw values is written.

    name: of the source file.  lines: where each record stands by its JSON pointer, for a source that is no bundle: a line,
    or a pointer of its own.
    """

    report: Report
    name: str
    lines: Mapping[str, int | str] = field(default_factory=dict[str, int | str])

    def place(self, pointer: str) -> str:
        if not self.lines:
            return f"{self.name}#{pointer}"
        while pointer and pointer not in self.lines:
            pointer = pointer.rpartition("/")[0]
        if not pointer:
            return self.name
        place = self.lines[pointer]
        return f"{self.name}#{place}" if isinstance(place, str) else f"{self.name}:{place}"

    def add(self, code: str, pointer: str, **values: object) -> None:
        self.report.add(code, self.place(pointer), **values)

    def dropped(self, feature: str, code: str, pointer: str, **values: object) -> None:
        self.report.dropped(feature, code, self.place(pointer), **values)

    def approximated(self, feature: str, code: str, pointer: str, **values: object) -> None:
        self.report.approximated(feature, code, self.place(pointer), **values)


def shown(text: str) -> str:
    """A text of the source for a message: short, and printable on any terminal."""
    start = text[:60]
    return start if start.isprintable() else start.encode("unicode_escape").decode("ascii")


def kind_of(value: object) -> str:
    """The JSON name of a value's type, with the value where it is short."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return f"the text '{shown(value)}'"
    if isinstance(value, (int, float)):
        return "a number"
    if is_array(value):
        odd = next((entry for entry in value if not is_number(entry)), None)
        return f"an array of {len(value)}" if odd is None else f"an array with {kind_of(odd)}"
    return "an object"


def is_array(value: object) -> TypeGuard[list[object]]:
    return isinstance(value, list)


def is_object(value: object) -> TypeGuard[dict[str, object]]:
    """Whether it is a JSON object; its keys are texts."""
    return isinstance(value, dict)


def is_number(value: object) -> TypeGuard[int | float]:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_plain(value: object) -> bool:
    """Whether a value is a number in range, told as fast as Python can."""
    return type(value) in (float, int) and -MAX_NUMBER <= cast(float, value) <= MAX_NUMBER


def entries_in(values: dict[str, object], key: str) -> list[object]:
    """The array ``key`` of a raw object that is being put together, made where there is none."""
    return cast("list[object]", values.setdefault(key, []))


class Record:
    """One JSON object.  known: names of its fields; others are warned about, except ``extras``."""

    __slots__ = ("values", "pointer", "log", "sound")

    def __init__(self, values: dict[str, object], pointer: str, log: Log, known: frozenset[str]):
        self.values, self.pointer, self.log, self.sound = values, pointer, log, True
        if not values.keys() <= known:
            for key in sorted(values.keys() - known - {"extras"}):
                escaped = shown(key).replace("~", "~0").replace("/", "~1")
                near = near_words(key, known, log.report)
                log.add("BUNDLE_FIELD_UNKNOWN", f"{pointer}/{escaped}", field=shown(key), near=near)

    def fault(self, code: str, key: str = "", **values: object) -> None:
        """Report ``code`` at the field ``key`` (at the record itself when empty)."""
        self.log.add(code, f"{self.pointer}/{key}" if key else self.pointer, **values)
        self.sound &= diagnostic_table()[code]["severity"] != Severity.ERROR.value

    def wrong(self, key: str, wanted: str, value: object) -> None:
        self.fault("BUNDLE_FIELD_TYPE", key, field=key, wanted=wanted, found=kind_of(value))

    def _value(self, key: str, default: object) -> Any:
        """The raw value; ``default`` when absent, and after a report when null or absent though REQUIRED."""
        value = self.values.get(key)
        if value is not None:
            return value
        if key in self.values:
            self.wrong(key, "a value", None)
        elif default is REQUIRED:
            self.fault("BUNDLE_FIELD_MISSING", "", field=key)
        return default

    def has(self, key: str) -> bool:
        return self.values.get(key) is not None

    @overload
    def text(self, key: str, default: str = REQUIRED) -> str: ...

    @overload
    def text(self, key: str, default: None) -> str | None: ...

    def text(self, key: str, default: str | None = REQUIRED) -> str | None:
        value = self.values.get(key)
        if type(value) is str and value and value.isascii() and "\0" not in value:
            return value  # nearly all of them; a bundle has half a million
        value = self._value(key, default)
        if value is default:
            return "" if default is REQUIRED else default
        if not isinstance(value, str) or not is_encodable(value) or "\0" in value:
            self.wrong(key, "a text", value)
            return ""
        if not value and default is REQUIRED:
            self.fault("BUNDLE_FIELD_MISSING", "", field=key)
        return value

    def identity(self, seen: dict[str, str]) -> str:
        """The record's own ``id``; a fault where one of ``seen``, ids and places of its kind so far, has it too."""
        name = self.text("id")
        if name and name in seen:
            self.fault("SOURCE_ID_DUPLICATE", "id", id=name, first=seen[name])
        seen[name] = self.log.place(self.pointer)
        return name

    def texts(self, key: str) -> tuple[str, ...]:
        """An array of texts; empty when absent."""
        values = self._value(key, ())
        found = [v for v in values if isinstance(v, str) and is_encodable(v)] if is_array(values) else []
        if values and not (is_array(values) and len(found) == len(values)):
            self.wrong(key, "an array of texts", values)
            return ()
        return tuple(found)

    @overload
    def number(self, key: str, default: float = REQUIRED) -> float: ...

    @overload
    def number(self, key: str, default: None) -> float | None: ...

    def number(self, key: str, default: float | None = REQUIRED) -> float | None:
        value = self._value(key, default)
        if value is default:
            return 0.0 if default is REQUIRED else default
        if not is_number(value):
            self.wrong(key, "a number", value)
            return 0.0
        return self._finite(key, value)

    def _finite(self, key: str, value: int | float, most: float = MAX_NUMBER) -> float:
        if -most <= value <= most:
            return float(value)
        self.fault("BUNDLE_NUMBER_RANGE", key, field=key, limit=f"{most:g}")
        return 0.0

    def flag(self, key: str, default: bool = False) -> bool:
        if key not in self.values:
            return default
        value = self._value(key, default)
        if not isinstance(value, bool):
            self.wrong(key, "true or false", value)
            return default
        return value

    @overload
    def numbers(
        self, key: str, count: int, default: tuple[float, ...] = REQUIRED, most: float = MAX_NUMBER
    ) -> tuple[float, ...]: ...

    @overload
    def numbers(self, key: str, count: int, default: None) -> tuple[float, ...] | None: ...

    def numbers(
        self, key: str, count: int, default: tuple[float, ...] | None = REQUIRED, most: float = MAX_NUMBER
    ) -> tuple[float, ...] | None:
        """``count`` numbers of a magnitude of at most ``most``."""
        value = self.values.get(key)
        if is_array(value) and len(value) == count and all(map(_is_plain, value)):
            return tuple(map(float, cast("list[float]", value)))
        value = self._value(key, default)
        if value is default:
            return (0.0,) * count if default is REQUIRED else default
        found = [entry for entry in value if is_number(entry)] if is_array(value) else []
        if not is_array(value) or len(value) != count or len(found) != count:
            self.wrong(key, f"{count} numbers", value)
            return (0.0,) * count
        return tuple(self._finite(key, number, most) for number in found)

    @overload
    def vector(self, key: str, default: Vector = REQUIRED) -> Vector: ...

    @overload
    def vector(self, key: str, default: Vector | None) -> Vector | None: ...

    def vector(self, key: str, default: Vector | None = REQUIRED) -> Vector | None:
        return cast("Vector | None", self.numbers(key, 3, default))

    @overload
    def direction(self, key: str, default: Vector = REQUIRED) -> Vector: ...

    @overload
    def direction(self, key: str, default: Vector | None) -> Vector | None: ...

    def direction(self, key: str, default: Vector | None = REQUIRED) -> Vector | None:
        """A direction as a unit vector; it must have a length."""
        if default is not REQUIRED and not self.has(key):
            return default
        before, self.sound = self.sound, True
        x, y, z = value = self.vector(key)
        length = math.hypot(x, y, z)
        if self.sound and not MIN_DIRECTION < length < math.inf:
            self.fault("AXIS_ZERO", key, field=key)
        usable, self.sound = self.sound, self.sound and before
        return value if length == 1.0 or not usable else (x / length, y / length, z / length)

    def vectors(self, key: str) -> list[Vector]:
        """An array of vectors; empty when absent."""
        values = self._value(key, [])
        if not is_array(values):
            self.wrong(key, "an array of vectors", values)
            return []
        by_index = {str(index): value for index, value in enumerate(values)}
        entries = Record(by_index, f"{self.pointer}/{key}", self.log, frozenset(by_index))
        found = [entries.direction(index) for index in entries.values]
        self.sound &= entries.sound
        return found

    def choice(
        self, key: str, words: Mapping[str, T], default: T = REQUIRED, code: str = "BUNDLE_WORD_UNKNOWN"
    ) -> T:
        """What the field's word stands for in ``words``; the first entry's after a fault."""
        value = self._value(key, default)
        if value is default and default is not REQUIRED:
            return default
        if isinstance(value, str) and value in words:
            return words[value]
        if isinstance(value, str):
            self.fault(code, key, field=key, word=shown(value), known=", ".join(words))
        elif value is not REQUIRED:
            self.wrong(key, "a text", value)
        return next(iter(words.values()))

    def record(self, key: str, known: frozenset[str], default: object = None) -> Record | None:
        """An object within this one; None when absent or not an object."""
        value = self._value(key, default)
        if is_object(value):
            return Record(value, f"{self.pointer}/{key}", self.log, known)
        if value is not default:
            self.wrong(key, "an object", value)
        return None

    def records(self, key: str, known: frozenset[str]) -> Iterator[Record]:
        """The objects of an array, in order; an entry that is no object is reported and passed over."""
        values = self._value(key, [])
        if not is_array(values):
            self.wrong(key, "an array", values)
            return
        for index, value in enumerate(values):
            if is_object(value):
                yield Record(value, f"{self.pointer}/{key}/{index}", self.log, known)
            else:
                self.wrong(f"{key}/{index}", "an object", value)

    def extras(self) -> dict[str, object]:
        """The free room; checked only for what no JSON file can hold again."""
        value = self._value("extras", {})
        if not is_object(value):
            self.wrong("extras", "an object", value)
            return {}
        open_values: list[object] = [value]
        while open_values:
            entry = open_values.pop()
            if is_object(entry):
                open_values += [*entry, *entry.values()]
            elif is_array(entry):
                open_values += entry
            broken_text = isinstance(entry, str) and not is_encodable(entry)
            if broken_text or isinstance(entry, float) and not math.isfinite(entry):
                self.fault("BUNDLE_EXTRAS", "extras")
                return {}
        return value
