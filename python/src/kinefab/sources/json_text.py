"""JSON bytes to Python values, strict and bounded."""

from __future__ import annotations

import json

from ..diagnostics import Report

MAX_CONTAINERS = 8_000_000
"""Most arrays and objects in one file: a small text of brackets must not become gigabytes of lists."""


def parse_json(data: bytes, name: str, report: Report) -> object:
    """The value in ``data``.  name: of the file, for diagnostics.  Raises KinefabError when it is not JSON."""
    value = None
    repeated: list[str] = []

    def unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
        found = dict(pairs)
        if len(found) < len(pairs):
            seen: set[str] = set()
            repeated.extend(key for key, _ in pairs if key in seen or seen.add(key))
        return found

    def refuse(constant: str) -> object:
        raise ValueError(f"{constant} is not a JSON number")

    if (containers := data.count(b"[") + data.count(b"{")) > MAX_CONTAINERS:
        report.add("JSON_TOO_MANY_CONTAINERS", name, count=containers, limit=MAX_CONTAINERS)
        report.raise_for_errors()
    try:
        value = json.loads(data.decode("utf-8-sig"), object_pairs_hook=unique, parse_constant=refuse)
    except UnicodeDecodeError as error:
        report.add("JSON_ENCODING", name, offset=error.start)
    except json.JSONDecodeError as error:
        report.add("JSON_SYNTAX", f"{name}:{error.lineno}:{error.colno}", detail=error.msg)
    except RecursionError:
        report.add("SOURCE_TOO_DEEP", name)
    except ValueError as error:  # NaN, Infinity, an integer of thousands of digits
        report.add("JSON_SYNTAX", name, detail=error)
    for key in repeated:
        report.add("JSON_DUPLICATE_KEY", name, key=key)
    report.raise_for_errors()
    return value
