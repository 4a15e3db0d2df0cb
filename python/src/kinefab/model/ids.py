"""Ids that are given out once."""

from __future__ import annotations

from collections.abc import Iterable

IN_BRACKETS = "{} ({})"
"""A name and its number as CAD programs write them."""


class FreeIds:
    """Ids that are not taken yet: what is wanted, else with the first number from 2 on that makes it one of its own."""

    def __init__(self, taken: Iterable[str] = (), form: str = "{}#{}"):
        """taken: from the start. form: of an id and its number."""
        self._taken = set(taken)
        self._form = form
        # The number to try next, of each id that was wanted; all below it are taken. Thousands of joints may be called alike.
        self._next: dict[str, int] = {}

    def take(self, wanted: str) -> str:
        """It is taken from now on."""
        found, count = wanted, self._next.get(wanted, 2)
        while found in self._taken:
            found, count = self._form.format(wanted, count), count + 1
        self._taken.add(found)
        self._next[wanted] = count
        return found
