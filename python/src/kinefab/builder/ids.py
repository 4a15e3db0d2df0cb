"""Ids that are given out once."""

from __future__ import annotations

from collections.abc import Sequence

from ..model import Constraint, Joint, Node


class Ids:
    """The ids of a list that a scene's scripts may change too; each new entry is looked at once."""

    def __init__(self) -> None:
        self._copies: dict[str, int] = {}
        self._counted = 0

    def free(self, wanted: str, entries: Sequence[Node] | Sequence[Joint] | Sequence[Constraint]) -> str:
        """The wanted id, with the first number that makes it one that no entry has."""
        if len(entries) < self._counted:
            self._copies, self._counted = {}, 0
        for entry in entries[self._counted :]:
            self._copies.setdefault(entry.id, 1)
        self._counted = len(entries)
        found, copy = wanted, self._copies.get(wanted, 0)
        while found in self._copies:
            copy += 1
            found = f"{wanted}:{copy}"
        if copy:
            self._copies[wanted] = copy
        return found
