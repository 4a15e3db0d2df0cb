"""The text of ``.asmt``: one item a line, what belongs to it below it and one tab further in."""

from __future__ import annotations

import ast
import math
import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from ..reading.record import MAX_NUMBER, shown

MAX_LINES = 4_000_000
MAX_LEVEL = 40


class AsmtError(Exception):
    """Text that is no assembly.  line: from 1."""

    def __init__(self, line: int, detail: str):
        super().__init__(detail)
        self.line = line


@dataclass(slots=True, eq=False)
class Item:
    """A line, without its tabs, and the items below it.  line: from 1."""

    text: str
    line: int
    below: list[Item] = field(default_factory=list["Item"])

    def find(self, word: str) -> Item | None:
        return next((item for item in self.below if item.text == word), None)

    def all(self, *words: str) -> Iterator[Item]:
        return (item for item in self.below if item.text in words)

    def value(self, word: str) -> str:
        """The line below the item of that word, "" where there is none."""
        found = self.find(word)
        return found.below[0].text.strip() if found is not None and found.below else ""

    def number(self, word: str, default: float | None = None) -> float:
        """As ``value``, a number; ``default``, where there is one, stands for a word that is not there.  Raises AsmtError."""
        found = self.find(word)
        if found is None and default is not None:
            return default
        numbers = [] if found is None or not found.below else row(found.below[0])
        if len(numbers) != 1:
            raise AsmtError(self.line, f"'{shown(self.text)}' has no number for '{word}'")
        return numbers[0]

    def rows(self, word: str, count: int) -> list[list[float]]:
        """``count`` rows of three numbers below the item of that word.  Raises AsmtError."""
        found = self.find(word)
        rows = [] if found is None else [row(item) for item in found.below]
        if len(rows) != count or any(len(numbers) != 3 for numbers in rows):
            raise AsmtError(self.line, f"'{shown(self.text)}' has no '{word}' of {count} x 3 numbers")
        return rows


def row(item: Item) -> list[float]:
    """The numbers of a line.  Raises AsmtError for what is none, and for one that is not finite or out of range."""
    try:
        numbers = [float(word) for word in item.text.split()]
    except ValueError:
        raise AsmtError(item.line, f"'{shown(item.text)}' are no numbers") from None
    if not all(abs(number) <= MAX_NUMBER for number in numbers):
        raise AsmtError(item.line, f"'{shown(item.text)}' is not in range")
    return numbers


def parse(text: str) -> Item:
    """The assembly: the item below the heading.  Raises AsmtError."""
    root = Item("", 0)
    stack = [root]
    lines = text.split("\n")
    if len(lines) > MAX_LINES:
        raise AsmtError(MAX_LINES, f"it has more than {MAX_LINES} lines")
    for number, line in enumerate(lines[1:], 2):
        line = line.rstrip("\r")
        own = line.lstrip("\t")
        if not own.strip() and number == len(lines):
            continue
        level = len(line) - len(own)
        if level >= MAX_LEVEL:
            raise AsmtError(number, f"it is nested more than {MAX_LEVEL} levels deep")
        if level >= len(stack):
            if own.strip():
                raise AsmtError(number, "it stands further in than what it could belong to")
            continue  # an empty value
        item = Item(own, number)
        del stack[level + 1 :]
        stack[level].below.append(item)
        stack.append(item)
    found = root.find("Assembly")
    if found is None:
        raise AsmtError(1, "it has no 'Assembly'")
    return found


def linear(expression: str) -> tuple[float, float] | None:
    """(constant, rate) of an expression in ``time`` and ``pi`` that is linear in time; None for any other.

    A number may have a ``d`` behind it, as old files write it.
    """
    if len(expression) > 400:
        return None
    try:
        tree = ast.parse(re.sub(r"(?<=[0-9.])d\b", "", expression.strip()), mode="eval").body
        constant, rate = _linear(tree)
    except (SyntaxError, ValueError, RecursionError, MemoryError, ZeroDivisionError, OverflowError):
        return None
    return (constant, rate) if abs(constant) <= MAX_NUMBER and abs(rate) <= MAX_NUMBER else None


def _linear(node: ast.expr) -> tuple[float, float]:
    if isinstance(node, ast.Constant) and type(node.value) in (int, float):
        return float(node.value), 0.0  # type: ignore[arg-type]
    if isinstance(node, ast.Name) and node.id in ("pi", "time"):
        return (math.pi, 0.0) if node.id == "pi" else (0.0, 1.0)
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
        constant, rate = _linear(node.operand)
        return (-constant, -rate) if isinstance(node.op, ast.USub) else (constant, rate)
    if isinstance(node, ast.BinOp):
        (a, s), (b, t) = _linear(node.left), _linear(node.right)
        if isinstance(node.op, ast.Add):
            return a + b, s + t
        if isinstance(node.op, ast.Sub):
            return a - b, s - t
        if isinstance(node.op, ast.Mult) and 0.0 in (s, t):
            return a * b, a * t + b * s
        if isinstance(node.op, ast.Div) and t == 0.0:
            return a / b, s / b
    raise ValueError("no linear expression")
