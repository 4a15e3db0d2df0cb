"""The rules that ``scene.schema.json`` states by itself, as functions: which fields, of which type, how many, and the
ranges of numbers.

A rule returns None where it holds, which costs next to nothing, else what it found by the way from the value.  What is
no value of its type is an early fault: with one of them nothing else is looked at, as C# reads no document then.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, cast

from ..definitions import definitions, scene_schema
from .findings import Findings
from .text import Twice, escaped

BEYOND = 3.4028235677973366e38
"""From here on a number is infinite as a 32-bit float, in which Unity computes."""
NOTHING = 2.0**-150
"""Up to here it is nothing as one."""
UNIT = 2e-4
"""How far the squared length of a rotation may be from 1: what rounding to 32-bit floats explains."""
INT = 2**31
EXACT = 2.0**53
"""Up to here a double holds every whole number."""

LONG = {"offset", "byteLength"}
"""Whole numbers that C# keeps in 64 bits."""
ENDLESS = {"breakForce", "breakTorque", "speed"}
"""What is unlimited where it is left out; so small that it vanishes is no fault there."""
TOLD_BY_NOUNS = {
    *("parent", "connectedBody", "mesh", "material", "materials", "buffer", "image", "gameObject", "gameObjects"),
    *("component", "a", "b", "offset", "indexStart", "indexCount", "mass"),
}
"""Fields whose numbers have rules of their own: indices, places in a buffer, masses."""


@dataclass(frozen=True, slots=True)
class Fault:
    """pointer: from the value.  early: it is no value of its type."""

    pointer: str
    code: str
    values: Mapping[str, object]
    early: bool = True


Faults = Sequence[Fault]
Rule = Callable[[Any], "Faults | None"]


def check_shape(document: object, found: Findings) -> None:
    """Everything that the schema says of a document.  Raises KinefabError where that is no scene at all."""
    faults = _whole()(document) or ()
    for fault in faults:
        if fault.early:
            found.add(fault.code, fault.pointer, **fault.values)
    found.refuse()
    for fault in faults:
        found.add(fault.code, fault.pointer, **fault.values)


@cache
def _whole() -> Rule:
    return _object(scene_schema())


@cache
def _defined(name: str) -> Rule:
    return _component if name == "component" else _rule(definitions()[name], name)


def _rule(stated: Mapping[str, Any], key: str) -> Rule:
    """key: the name of the field, of an array that of its items."""
    if "$ref" in stated:
        return _defined(stated["$ref"].removeprefix("#/$defs/"))
    if "enum" in stated:
        return _word(tuple(stated["enum"]))
    kind = stated.get("type", "string")
    if kind == "number":
        return _number(stated, key)
    if kind == "integer":
        return _integer(stated, key)
    if kind == "boolean":
        return _boolean
    if kind == "array":
        length = stated.get("maxItems")
        plain = stated["items"].get("type") == "number" and "minimum" not in stated["items"]
        if length is not None and plain:
            return _vector(length, key == "quaternion")
        return _array(stated, key)
    return _object(stated) if kind == "object" else _string


def _mismatch(expected: str, value: object) -> Faults:
    if value is None or isinstance(value, bool):
        there = "null" if value is None else "a boolean"
    elif isinstance(value, (int, float)):
        there = f"the number {str(value)[:60]}"
    else:
        there = "a string" if isinstance(value, str) else "an object" if isinstance(value, dict) else "an array"
    return (Fault("", "TYPE_MISMATCH", {"expected": expected, "found": there}),)


def _unheld(value: float) -> Faults | None:
    if type(value) is float and math.isinf(value):
        return None  # the text has told it, wherever it stands
    return (Fault("", "NUMBER_BEYOND_FLOAT32", {"number": str(value)[:60]}),)


def _number(stated: Mapping[str, Any], key: str) -> Rule:
    low, high, above = (stated.get(word) for word in ("minimum", "maximum", "exclusiveMinimum"))
    if key in TOLD_BY_NOUNS:
        low = high = above = None
    least = -BEYOND if low is None else low
    most = BEYOND if high is None else high
    vanishing = key not in ENDLESS

    def rule(value: Any) -> Faults | None:
        if type(value) is not float and type(value) is not int:
            return _mismatch("a number", value)
        if not -BEYOND < value < BEYOND:
            return _unheld(value)
        if not least <= value <= most or (above is not None and not value > above):
            told = {"value": value, "range": _range(low, high, above)}
            return (Fault("", "NUMBER_OUT_OF_RANGE", told, False),)
        if above is not None and vanishing and value <= NOTHING:
            return (Fault("", "NUMBER_BELOW_FLOAT32", {"number": value}, False),)
        return None

    return rule


def _range(low: float | None, high: float | None, above: float | None) -> str:
    if above is not None:
        return f"above {above}"
    return f"{low} or above" if high is None else f"between {low} and {high}"


def _integer(stated: Mapping[str, Any], key: str) -> Rule:
    low, high = (None, None) if key in TOLD_BY_NOUNS else (stated.get("minimum"), stated.get("maximum"))
    least = -INT if low is None else low
    most = INT - 1 if high is None else high
    if key in LONG:
        most = 2**63 - 1

    def rule(value: Any) -> Faults | None:
        if type(value) is int and least <= value <= most:
            return None
        if type(value) is float and math.isinf(value):
            return None
        if not _is_whole(value):
            return _mismatch("an integer", value)
        if key not in LONG and not -INT <= value < INT:
            return (Fault("", "NUMBER_OUT_OF_RANGE", {"value": value, "range": f"below {INT}"}),)
        if low is None or least <= value <= most:
            return None
        return (Fault("", "NUMBER_OUT_OF_RANGE", {"value": value, "range": _range(low, high, None)}, False),)

    return rule


def _is_whole(value: Any) -> bool:
    """Whether C# takes it for an integer of 64 bits."""
    if type(value) is int:
        return -(2**63) <= value < 2**63
    return type(value) is float and value.is_integer() and abs(value) <= EXACT


def _component(value: Any) -> Faults | None:
    """By its type, which says what else it may have."""
    if not isinstance(value, dict):
        return _mismatch("an object", value)
    entry = cast("dict[str, Any]", value)
    if "type" not in entry:
        return (Fault("", "FIELD_MISSING", {"field": "type"}),)
    kind = entry["type"]
    if type(kind) is not str:
        return tuple(Fault("/type", told.code, told.values) for told in _mismatch("a string", kind))
    if kind not in _components():
        return (Fault("/type", "COMPONENT_TYPE_UNKNOWN", {"type": kind[:60]}),)
    return _defined(kind)(entry)


@cache
def _components() -> frozenset[str]:
    return frozenset(kind["$ref"].removeprefix("#/$defs/") for kind in definitions()["component"]["oneOf"])


def _boolean(value: Any) -> Faults | None:
    return None if type(value) is bool else _mismatch("true or false", value)


def _string(value: Any) -> Faults | None:
    return None if type(value) is str else _mismatch("a string", value)


def _word(words: tuple[str, ...]) -> Rule:
    known = frozenset(words)

    def rule(value: Any) -> Faults | None:
        if type(value) is not str:
            return _mismatch("a string", value)
        if value in known:
            return None
        return (Fault("", "VALUE_NOT_ALLOWED", {"value": value[:60], "allowed": ", ".join(words)}),)

    return rule


def _vector(length: int, turns: bool) -> Rule:
    """turns: it is a rotation."""
    number = _number({}, "")

    def rule(value: Any) -> Faults | None:
        if type(value) is not list:
            return _mismatch(f"an array of {length} numbers", value)
        numbers = cast("list[Any]", value)
        squared = 0.0
        for part in numbers:  # most numbers of a scene come by here
            if (type(part) is not float and type(part) is not int) or not -BEYOND < part < BEYOND:
                break
            squared += part * part
        else:
            if len(numbers) == length and (not turns or 1 - UNIT < squared < 1 + UNIT):
                return None
        faults = _of_items(numbers, number)
        if len(numbers) != length:
            return [Fault("", "ARRAY_LENGTH", {"expected": length, "found": len(numbers)}), *(faults or ())]
        return faults or (Fault("", "QUATERNION_NOT_UNIT", {"length": f"{squared**0.5:.9g}"}, False),)

    return rule


def _array(stated: Mapping[str, Any], key: str) -> Rule:
    item = _rule(stated["items"], key)
    least, length = stated.get("minItems", 0), stated.get("maxItems")
    unique: bool = stated.get("uniqueItems", False)

    def rule(value: Any) -> Faults | None:
        if type(value) is not list:
            return _mismatch("an array" if length is None else f"an array of {length} numbers", value)
        items = cast("list[Any]", value)
        faults = _of_items(items, item)
        if len(items) < least or (length is not None and len(items) > length):
            expected = f"at least {least}" if length is None else length
            return [Fault("", "ARRAY_LENGTH", {"expected": expected, "found": len(items)}), *(faults or ())]
        if unique and not faults and len(set(items)) < len(items):
            again = [i for i, word in enumerate(items) if word in items[:i]]
            return [Fault(f"/{i}", "ITEM_DUPLICATE", {"value": items[i]}) for i in again]
        return faults

    return rule


def _of_items(items: Sequence[Any], item: Rule) -> list[Fault] | None:
    faults: list[Fault] | None = None
    for index, value in enumerate(items):
        if (told := item(value)) is not None:
            faults = faults or []
            faults += (Fault(f"/{index}{f.pointer}", f.code, f.values, f.early) for f in told)
    return faults


def _object(stated: Mapping[str, Any]) -> Rule:
    fields = {key: _rule(rule, key) for key, rule in stated.get("properties", {}).items()}
    others = stated.get("additionalProperties")
    other = _rule(others, "") if isinstance(others, dict) else None
    required = tuple(stated.get("required", ()))

    def rule(value: Any) -> Faults | None:
        if not isinstance(value, dict):
            return _mismatch("an object", value)
        faults: list[Fault] | None = None
        entry = cast("dict[str, Any]", value)
        for key, inner in entry.items():
            field = fields.get(key, other)
            if field is not None and (told := field(inner)) is not None:
                faults = faults or []
                faults += (Fault(f"/{escaped(key)}{f.pointer}", f.code, f.values, f.early) for f in told)
        for key in required:
            if key not in entry:
                faults = [*(faults or ()), Fault("", "FIELD_MISSING", {"field": key})]
        if type(entry) is Twice:
            faults = faults or []
            for name in entry.names:
                if name in fields or other is not None:
                    faults.append(Fault(f"/{escaped(name)}", "FIELD_DUPLICATE", {"field": name}))
        return faults or None

    return rule
