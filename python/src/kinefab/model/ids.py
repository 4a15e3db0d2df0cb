"""Ids that are given out once."""

from __future__ import annotations


def free_id(wanted: str, taken: set[str]) -> str:
    """The wanted id, or it with the first number from 2 on that makes it one of its own; taken from then on."""
    found, count = wanted, 2
    while found in taken:
        found, count = f"{wanted}#{count}", count + 1
    taken.add(found)
    return found
