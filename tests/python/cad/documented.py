"""Records of a program, built member by member, and of Onshape field by field, as ``members.csv`` documents them.

Every object of such a record carries its class: what is asked of it that the table does not list is refused, whoever asks, and what
is asked is kept in ``TOUCHED``.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from kinefab.capture import run
from kinefab.capture.channel import SET, Replay, question
from kinefab.capture.onshape import answers as onshape

TABLE = Path(__file__).with_name("members.csv")


@cache
def members(program: str) -> dict[tuple[str, str], dict[str, str]]:
    with TABLE.open(encoding="utf-8") as stream:
        rows = list(csv.DictReader(stream, delimiter=";"))
    return {(row["class"], row["member"]): row for row in rows if row["program"] == program}


KIND = "#kind"
"""Where an object of a record says its program and class; no capture asks for it."""
TOUCHED: set[tuple[str, str, str]] = set()
"""Program, class and member of everything that was asked of a double."""


SHAPES = frozenset({"Plane", "Line", "Circle", "Cylinder", "Sphere", "Point"})
"""Inventor's geometry has no kind that all versions name alike: it is told by which of these members it has."""


class Refused(BaseException):
    """A question that the documentation's table does not list; no capture catches it."""


def watch(answers: dict[str, Any], name: str) -> None:
    """Note that a member is asked of an object.  Raises Refused where its class has none of the name."""
    if tag := dict.get(answers, KIND):
        program, kind = tag.split(".")
        name = name.removesuffix(SET)
        if (kind, name) in members(program):
            TOUCHED.add((program, kind, name))
        elif kind not in SHAPES or not any((other, name) in members(program) for other in SHAPES):
            raise Refused(f"{program} documents no {kind}.{name}")


class Watched(Replay):
    """A replay that holds the capture to the table."""

    def ask(self, number: int, name: str, arguments: tuple[Any, ...] | None) -> Any:
        watch(self._answers[number], name)
        return super().ask(number, name, arguments)


run.Replay = Watched


class Fields(dict[str, Any]):
    """An object of an answer in JSON: whoever asks for a field that its class does not list is refused."""

    def __getitem__(self, name: str) -> Any:
        watch(self, name)
        return super().__getitem__(name)

    def get(self, name: str, default: Any = None) -> Any:
        watch(self, name)
        return super().get(name, default)

    def __contains__(self, name: object) -> bool:
        if name != KIND:
            watch(self, str(name))
        return super().__contains__(name)


def fields(value: Any) -> Any:
    """An answer whose tagged objects are watched."""
    if isinstance(value, dict):
        kept = {key: fields(entry) for key, entry in value.items()}
        return Fields(kept) if KIND in kept else kept
    return [fields(entry) for entry in value] if isinstance(value, list) else value


def untagged(value: Any) -> Any:
    """The same without its classes: what is exchanged at random is of none."""
    if isinstance(value, dict):
        return {key: untagged(entry) for key, entry in value.items() if key != KIND}
    return [untagged(entry) for entry in value] if isinstance(value, list) else value


_ask = onshape.Answers.ask
onshape.Answers.ask = lambda self, question: fields(_ask(self, question))


def of_onshape(kind: str, **values: Any) -> dict[str, Any]:
    """An object of Onshape's answers.  It may hold more than the capture asks for, as the documented ones do."""
    if not any(name == kind for name, _ in members("onshape")):
        raise KeyError(kind)
    return {KIND: f"onshape.{kind}", **values}


@dataclass(frozen=True)
class Metres:
    """A length of the description; the record has it in the unit that the member documents."""

    value: Any


class Answers:
    """The objects of a record.  Index 0 is the application, set last."""

    def __init__(self, program: str) -> None:
        self.program = program
        self.objects: list[dict[str, Any]] = [{}]

    def made(self, kind: str, **answers: Any) -> dict[str, int]:
        """A new object of a documented class; an answer of a method is given as ``name__arguments`` or a dict."""
        self.objects.append(self._checked(kind, answers))
        return {"object": len(self.objects) - 1}

    def application(self, kind: str, **answers: Any) -> None:
        self.objects[0] = self._checked(kind, answers)

    def _checked(self, kind: str, answers: dict[str, Any]) -> dict[str, Any]:
        found: dict[str, Any] = {KIND: f"{self.program}.{kind}"}
        table = members(self.program)
        for name, answer in answers.items():
            row = table[kind, name.removesuffix(SET)]
            if name.endswith(SET):  # a list of what it may be set to
                found |= {question(name, (value,)): None for value in answer}
            elif row["kind"] == "property":
                found[name] = scaled(answer, row["unit"])
            elif isinstance(answer, dict) and "object" not in answer and "failed" not in answer:
                found |= {f"{name}({key})": scaled(value, row["unit"]) for key, value in answer.items()}
            else:
                found[f"{name}()"] = scaled(answer, row["unit"])
        return found

    def listed(
        self,
        entries: list[Any],
        kind: str = "Collection",
        count: str = "Count",
        item: str = "Item",
        first: int = 1,
    ):
        return self.made(
            kind, **{count: len(entries), item: {str(i + first): e for i, e in enumerate(entries)}}
        )


def scaled(answer: Any, unit: str) -> Any:
    if isinstance(answer, Metres):
        factor = 100.0 if "cm" in unit else 1.0
        assert "cm" in unit or unit.startswith("m"), f"a length of a member in {unit!r}"
        value = answer.value
        return [float(v) * factor for v in value] if hasattr(value, "__len__") else float(value) * factor
    if hasattr(answer, "tolist"):
        return answer.tolist()
    if isinstance(answer, (list, tuple)):
        return [scaled(entry, unit) for entry in answer]
    return answer
