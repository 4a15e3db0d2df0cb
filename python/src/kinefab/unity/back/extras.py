"""What other programs have written into a scene, which a program that rewrites it must keep, on whatever object it stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, cast

Item = tuple[int, str]
"""An item's index in its list, and what it is called there."""
Way = tuple["str | Item", ...]
"""The keys and items that lead from a document to an object in it."""


def extras_in(value: Any, way: Way = ()) -> Iterator[tuple[Way, Mapping[str, Any]]]:
    """The extras of every object below a document, each with the way to its object; those of the document are its own."""
    if isinstance(value, dict):
        for key, item in cast("dict[str, Any]", value).items():
            if key != "extras":
                yield from extras_in(item, (*way, key))
            elif way and isinstance(item, dict) and item:
                yield way, cast("dict[str, Any]", item)
    elif isinstance(value, list):
        for index, item in enumerate(cast("list[Any]", value)):
            yield from extras_in(item, (*way, (index, _called(item))))


def put_extras(document: dict[str, Any], way: Way, extras: Mapping[str, Any]) -> None:
    """On the object that a way leads to, where it is still there; one that was left out as empty is there again.  What leads to it is
    copied, since objects share what is alike in them."""
    at: Any = document
    for step, after in zip(way, (*way[1:], "")):
        if isinstance(step, tuple):
            key, called = step
            if key >= len(at) or _called(at[key]) != called:
                return
        else:
            key = step
            if key not in at:
                if isinstance(after, tuple):
                    return
                at[key] = {}
        at[key] = at[key].copy()
        at = at[key]
    at["extras"] = extras


def _called(item: Any) -> str:
    if not isinstance(item, dict):
        return ""
    entry = cast("dict[str, Any]", item)
    return next((str(entry[key]) for key in ("id", "name", "feature", "type") if key in entry), "")
