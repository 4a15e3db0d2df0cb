"""The way to a program: every answer is counted, can be written down, and can be read back without the program.

A capture asks objects of a program for members, as their documentation names them.  ``Live`` hands each question on,
``Replay`` answers it from a record.  A record is a list of objects; each holds its answers by question (``Name``,
``Cell(1, 4)``), and an answer that is an object again is ``{"object": number}``.  Standard library only: it also runs
in a CAD program's own Python.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, Protocol, cast

FORMAT, VERSION = "kinefab.capture", "1.0"
FAILURE = "failed"
SET = "="
"""Behind the name of a member that is set: ``UseSystemUnits=(true)``."""


class MemberFailed(Exception):
    """A member of the program's API that threw, or that the record does not hold."""

    def __init__(self, member: str, detail: str) -> None:
        super().__init__(f"{member}: {detail}")
        self.member, self.detail = member, detail


class NotHeld(MemberFailed):
    """A question that the record holds no answer to: it was never asked."""


class NotSaved(MemberFailed):
    """An answer that could lie in a file beside the others.  file: its name."""

    def __init__(self, member: str, file: str) -> None:
        super().__init__(member, f"{file} was not saved")
        self.file = file


class RecordBroken(Exception):
    """A record that is none."""


class Asked:
    """An object of the program: its members are asked for, and set, by attribute."""

    def __init__(self, channel: Channel, number: int) -> None:
        self._channel, self._number = channel, number

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if name in self._channel.methods:

            def called(*arguments: Any) -> Any:
                return self._channel.ask(self._number, name, arguments)

            return called
        return self._channel.ask(self._number, name, None)

    def __setattr__(self, name: str, value: Any) -> None:
        if name.startswith("_"):
            object.__setattr__(self, name, value)
        else:
            self._channel.ask(self._number, f"{name}{SET}", (value,))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Asked) and other._number == self._number

    def __hash__(self) -> int:
        return self._number


class Channel(Protocol):
    """What both ways have.  calls: questions so far.  methods: names that are called, others are read."""

    calls: int
    methods: frozenset[str]

    def ask(self, number: int, name: str, arguments: tuple[Any, ...] | None) -> Any: ...


def methods_of(api: ModuleType) -> frozenset[str]:
    """The members that the interfaces of a module declare as methods."""
    interfaces = (v for v in vars(api).values() if isinstance(v, type) and v.__module__ == api.__name__)
    return frozenset(
        name
        for interface in interfaces
        for name, member in vars(interface).items()
        if callable(member) and not name.startswith("_")
    )


def question(name: str, arguments: tuple[Any, ...] | None) -> str:
    """How a record names a question: ``Name``, ``Cell(1, 4)``; an object as an argument stands as its number."""
    if arguments is None:
        return name
    shown = [f"#{a._number}" if isinstance(a, Asked) else json.dumps(a) for a in arguments]  # pyright: ignore[reportPrivateUsage]
    return f"{name}({', '.join(shown)})"


class Live:
    """A running program; nothing is asked twice.  root: its application.  call: how a member is asked (``getattr`` and a
    call, by default); it raises whatever the program raises.  answers: what a record of them holds.
    """

    def __init__(
        self,
        root: object,
        methods: frozenset[str],
        call: Callable[[Any, str, tuple[Any, ...] | None], Any] | None = None,
    ) -> None:
        self.calls, self.methods, self._call = 0, methods, call or plainly
        self._objects: list[object] = [root]
        self.answers: list[dict[str, Any]] = [{}]

    @property
    def root(self) -> Any:
        return Asked(self, 0)

    def ask(self, number: int, name: str, arguments: tuple[Any, ...] | None) -> Any:
        key = question(name, arguments)
        known = self.answers[number]
        if key not in known:
            self.calls += 1
            given = None if arguments is None else tuple(self._raw(a) for a in arguments)
            try:
                known[key] = self._kept(self._call(self._objects[number], name, given))
            except Exception as error:  # whatever the program or the bridge to it throws
                known[key] = {FAILURE: f"{type(error).__name__}: {error}"}
        return seen(self, key, known[key], len(self._objects))

    def _raw(self, value: Any) -> Any:
        return self._objects[value._number] if isinstance(value, Asked) else value  # pyright: ignore[reportPrivateUsage]

    def _kept(self, answer: object) -> Any:
        """An answer as a record holds it."""
        if answer is None or isinstance(answer, (bool, str, int)):
            return answer
        if isinstance(answer, float):
            return answer if math.isfinite(answer) else None
        if isinstance(answer, (list, tuple)):
            return [self._kept(entry) for entry in cast("list[object]", answer)]
        self._objects.append(answer)
        self.answers.append({})
        return {"object": len(self._objects) - 1}


class Replay:
    """A record instead of a program.  Raises RecordBroken where it is none."""

    def __init__(self, objects: object, methods: frozenset[str]) -> None:
        if not isinstance(objects, list) or not objects:
            raise RecordBroken("it holds no objects")
        listed = cast("list[object]", objects)
        if not all(isinstance(entry, dict) for entry in listed):
            raise RecordBroken("an object of it is none")
        self._answers = cast("list[dict[str, Any]]", listed)
        self.calls, self.methods = 0, methods

    @property
    def root(self) -> Any:
        return Asked(self, 0)

    def ask(self, number: int, name: str, arguments: tuple[Any, ...] | None) -> Any:
        self.calls += 1
        key = question(name, arguments)
        answers = self._answers[number]
        if key not in answers:
            raise NotHeld(key, "the record holds no answer")
        return seen(self, key, answers[key], len(self._answers))


def seen(channel: Channel, key: str, answer: Any, objects: int) -> Any:
    """A kept answer as the capture sees it.  objects: how many there are.  Raises MemberFailed, RecordBroken."""
    if isinstance(answer, list):
        return [seen(channel, key, entry, objects) for entry in cast("list[Any]", answer)]
    if isinstance(answer, dict):
        held = cast("dict[str, Any]", answer)
        if FAILURE in held:
            raise MemberFailed(key, str(held[FAILURE]))
        number = held.get("object")
        if not isinstance(number, int) or not 0 <= number < objects:
            raise RecordBroken(f"{key} leads to no object")
        return Asked(channel, number)
    return answer


def plainly(target: Any, name: str, arguments: tuple[Any, ...] | None) -> Any:
    """A member of a Python object."""
    if name.endswith(SET):
        return setattr(target, name[: -len(SET)], *(arguments or ()))
    member = getattr(target, name)
    return member if arguments is None else member(*arguments)


def record(program: str, answers: object, blank: bool = False) -> dict[str, Any]:
    """The record of a capture.  blank: every name of the user's is replaced by a number, alike names by alike numbers."""
    names: dict[str, str] = {}
    kept = blanked(answers, names) if blank else answers
    return {"format": FORMAT, "version": VERSION, "program": program, "answers": kept}


NAMED = frozenset(
    "Name Name2 name fullPathName FullFileName DisplayName GetPathName GetTitle ReferencedConfiguration "
    "mateName Description MaterialUserName displayName".split()
)
"""Members and fields that hold what a user or a file system named."""


def blanked(value: Any, names: dict[str, str], field: str = "") -> Any:
    """The same answers with names replaced; the parts of a path and the number of a copy stay apart."""
    if isinstance(value, dict):
        held = cast("dict[str, Any]", value)
        if isinstance(failed := held.get(FAILURE), str):  # what a program says of a failure may hold a path
            return {FAILURE: failed.partition(":")[0]}
        return {key: blanked(entry, names, key) for key, entry in held.items()}
    if isinstance(value, list):
        return [blanked(entry, names, field) for entry in cast("list[Any]", value)]
    if isinstance(value, str) and field.partition("(")[0] in NAMED and value:
        cut = next((mark for mark in ("/", "+", "\\") if mark in value), None)
        if cut:
            return cut.join(blanked(part, names, field) for part in value.split(cut))
        stem, mark, number = value.rpartition(":") if ":" in value else value.rpartition("-")
        if not (mark and number.isdigit()):
            stem, mark, number = value, "", ""
        dot = stem.rpartition(".")
        ending = f".{dot[2]}" if dot[1] and 0 < len(dot[2]) <= 8 and dot[2].isalpha() else ""
        return names.setdefault(stem, f"N{len(names) + 1}") + ending + mark + number
    return value


def opened(values: object) -> tuple[str, Any]:
    """Program and answers of a record.  Raises RecordBroken."""
    if not isinstance(values, Mapping):
        raise RecordBroken("it holds no JSON object")
    held = cast("Mapping[str, Any]", values)
    if held.get("format") != FORMAT:
        raise RecordBroken(f"its format is {held.get('format')!r}, not {FORMAT!r}")
    if str(held.get("version", "")).partition(".")[0] != VERSION.partition(".")[0]:
        raise RecordBroken(f"it has version {held.get('version')!r}; this program reads {VERSION}")
    return str(held.get("program")), held.get("answers")
