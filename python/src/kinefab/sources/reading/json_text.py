"""JSON bytes to Python values, strict and bounded."""

from __future__ import annotations

import json
import re
from collections import Counter

import numpy as np

from ...diagnostics import Report

MAX_CONTAINERS = 8_000_000
"""Most arrays and objects in one file: a small text of brackets must not become gigabytes of lists."""
MAX_DEPTH = 64
"""Deepest nesting; a bundle needs seven levels, the rest is for ``extras``."""

STRING = re.compile(rb'"(?:[^"\\\\]|\\\\.)*"')
STEP = np.zeros(256, dtype=np.int8)
STEP[list(b"[{")], STEP[list(b"]}")] = 1, -1


def parse_json(data: bytes, name: str, report: Report) -> object:
    """The value in ``data``.  name: of the file, for diagnostics.  Raises KinefabError when it is not
    JSON."""
    value = None
    repeated: list[str] = []

    def unique(pairs: list[tuple[str, object]]) -> dict[str, object]:
        found = dict(pairs)
        if len(found) < len(pairs):
            repeated.extend(key for key, count in Counter(key for key, _ in pairs).items() if count > 1)
        return found

    def refuse(constant: str) -> object:
        raise ValueError(f"{constant} is not a JSON number")

    if (containers := data.count(b"[") + data.count(b"{")) > MAX_CONTAINERS:
        report.add("SOURCE_TOO_MANY_BRACKETS", name, count=containers, limit=MAX_CONTAINERS)
    elif _depth(data) > MAX_DEPTH and _depth(STRING.sub(b"", data)) > MAX_DEPTH:
        report.add("SOURCE_TOO_DEEP", name, limit=MAX_DEPTH)
    report.raise_for_errors()
    try:
        value = json.loads(data.decode("utf-8-sig"), object_pairs_hook=unique, parse_constant=refuse)
    except UnicodeDecodeError as error:
        report.add("SOURCE_NOT_UTF8", name, offset=error.start)
    except json.JSONDecodeError as error:
        report.add("JSON_SYNTAX", f"{name}:{error.lineno}:{error.colno}", detail=error.msg)
    except RecursionError:  # brackets within strings hid the depth
        report.add("SOURCE_TOO_DEEP", name, limit=MAX_DEPTH)
    except ValueError as error:  # NaN, Infinity, an integer of thousands of digits
        report.add("JSON_SYNTAX", name, detail=error)
    for key in repeated:
        report.add("SOURCE_KEY_TWICE", name, key=key)
    report.raise_for_errors()
    return value


def _depth(data: bytes) -> int:
    """Deepest nesting of brackets, those within strings counted too."""
    steps = STEP[np.frombuffer(data, dtype=np.uint8)]
    return int(np.cumsum(steps[steps != 0], dtype=np.int64).max(initial=0))


_TOKEN = re.compile(r'"((?:[^"\\]|\\.)*)"|[\[\]{}:,]')


def top_keys(head: bytes) -> dict[str, str]:
    """The keys of the outermost object and how the value of each begins ("{", "[" or ""), as far as ``head`` reaches.

    Empty for what is no object.  Nothing is checked: it only tells formats apart.
    """
    text = head.decode("utf-8-sig", "replace")
    if not text.lstrip().startswith("{"):
        return {}
    found: dict[str, str] = {}
    depth, key = 0, None
    for token in _TOKEN.finditer(text):
        mark = token[0]
        if mark in "{[":
            if depth == 1 and key is not None:
                found[key], key = mark, None
            depth += 1
        elif mark in "}]":
            depth -= 1
            if depth <= 0:
                break
        elif depth == 1 and mark == ",":
            key = None
        elif depth == 1 and mark[0] == '"' and key is None:
            key = token[1]
            found.setdefault(key, "")
    return found
