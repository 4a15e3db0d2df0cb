"""Ids that are given out once."""

from __future__ import annotations

IN_BRACKETS = "{} ({})"
"""A name and its number as CAD programs write them."""


def free_id(wanted: str, taken: set[str], form: str = "{}#{}") -> str:
    """The wanted id, or it with the first number from 2 on that makes it one of its own; taken from then on.

    form: of an id and its number.
    """
    found, count = wanted, 2
    while found in taken:
        found, count = form.format(wanted, count), count + 1
    taken.add(found)
    return found
