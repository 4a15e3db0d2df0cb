"""Names of prims: letters, digits and underscores, each once below its parent, made of what the thing is and of no order."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable, Sequence

from ...diagnostics import readable

_DIGITS = 6


def prim_name(name: str) -> str:
    """The nearest name that every release of USD takes for a prim."""
    plain = re.sub(r"[^A-Za-z0-9_]", "_", name) or "_"
    return f"_{plain}" if plain[0].isdigit() else plain


def display_name(name: str) -> str:
    """What users are shown, "" where USD could not hold it."""
    return name if readable(name) and name.strip() else ""


class PrimNames:
    """The names of one prim's children."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def reserve(self, names: Iterable[str]) -> None:
        self._taken.update(names)

    def take(self, wanted: str, identity: str) -> str:
        """A name that nobody has.  identity: what the thing is in the source."""
        name, count = prim_name(wanted), 0
        found = name
        while found in self._taken:
            found = f"{name}_{_digits(identity, count)}"
            count += 1
        self._taken.add(found)
        return found


def sibling_names(named: Sequence[tuple[str, str]], reserved: Iterable[str] = ()) -> list[str]:
    """Of pairs (name, what the thing is): of several alike the first by what it is keeps the name."""
    names, found = PrimNames(), [""] * len(named)
    names.reserve(reserved)
    for i in sorted(range(len(named)), key=lambda i: named[i][1]):
        found[i] = names.take(*named[i])
    return found


def _digits(identity: str, count: int) -> str:
    text = f"{identity}#{count}" if count else identity
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()[:_DIGITS]
