"""What other programs have written into a scene, which a program that rewrites it must keep, on whatever object it stands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, cast

Path = tuple["str | int", ...]
"""The keys and indices that lead from a document to an object in it."""


def extras_in(value: Any, path: Path = ()) -> Iterator[tuple[Path, Mapping[str, Any]]]:
    """The extras of every object below a document, each with the way to its object; those of the document are its own."""
    if isinstance(value, dict):
        for key, item in cast("dict[str, Any]", value).items():
            if key != "extras":
                yield from extras_in(item, (*path, key))
            elif path and isinstance(item, dict) and item:
                yield path, cast("dict[str, Any]", item)
    elif isinstance(value, list):
        for index, item in enumerate(cast("list[Any]", value)):
            yield from extras_in(item, (*path, index))


def put_extras(document: dict[str, Any], path: Path, extras: Mapping[str, Any]) -> None:
    """On the object at a path, where there is one; one that was left out as empty is there again.  What leads to it is copied, since
    objects share what is alike in them."""
    at: Any = document
    for key, after in zip(path, (*path[1:], "")):
        if isinstance(key, int):
            if not isinstance(at, list) or key >= len(cast("list[Any]", at)):
                return
        elif key not in at:
            if isinstance(after, int):
                return
            at[key] = {}
        at[key] = at[key].copy()
        at = at[key]
    at["extras"] = extras
