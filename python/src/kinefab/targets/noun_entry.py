"""Unity's nouns as entries of the scene file: by the schema's order, without what Unity would assume anyway."""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from typing import Any, ClassVar, Protocol, cast

from ..diagnostics import schema_directory
from .numbers import plain_value, significant

SIGNIFICANT = frozenset({"mass", "inertiaTensor", "ratio"})
"""Fields whose size says nothing about their precision; all others are lengths, directions and angles."""

RENAMED = {"Mobility": "analysis", "AnimationClip": "animation"}
"""Nouns whose definition in the schema has another name than their own with a small initial."""

LEFT_OUT_EMPTY = frozenset({"because", "localPosition", "localRotation"})
"""Lists that are not written when there is nothing in them."""


class Noun(Protocol):
    """Any of ``unity.scene``'s dataclasses."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


_NONE = object()
"""The default of a field that has none."""


@dataclass(frozen=True, slots=True)
class _Property:
    """nested: it holds an object that may be left out when empty."""

    key: str
    default: Any
    required: bool
    nested: bool


@cache
def _definitions() -> Mapping[str, Any]:
    schema = json.loads((schema_directory() / "scene.schema.json").read_text(encoding="utf-8"))
    return schema["$defs"]


@cache
def definition_of(noun: type[Noun]) -> str:
    """The schema's definition of a noun: of a component its own name, of others with a small initial."""
    name = RENAMED.get(noun.__name__, noun.__name__)
    return name if name in _definitions() else name[0].lower() + name[1:]


@cache
def _properties(definition: str) -> tuple[_Property, ...]:
    rules = _definitions()[definition]
    required = set(rules.get("required", ()))
    found: list[_Property] = []
    for key, rule in rules["properties"].items():
        reference = rule.get("$ref", "").removeprefix("#/$defs/")
        nested = _definitions().get(reference, {}).get("type") == "object"
        found.append(_Property(key, rule.get("default", _NONE), key in required, nested))
    return tuple(found)


@cache
def _defaults(noun: type[Noun]) -> Mapping[str, Any]:
    """Of each field that its definition lets be left out at the noun's own default, that default: known again by identity."""
    rules = {rule.key: rule for rule in _properties(definition_of(noun))}
    return {
        field.name: field.default
        for field in fields(noun)
        if (rule := rules.get(field.name)) is not None
        and rule.default is not _NONE
        and field.default is not MISSING
        and _written(rule.key, field.default) == rule.default
    }


@cache
def unsaid(noun: type[Noun]) -> Mapping[str, Any]:
    """Fields of a noun that the format has no place for, each with the value that says nothing; its id is not one."""
    known = {"id", *(rule.key for rule in _properties(definition_of(noun)))}
    return {field.name: field.default for field in fields(noun) if field.name not in known}


@cache
def _said(noun: type[Noun]) -> tuple[tuple[str, Any, _Property], ...]:
    """What is written of a noun, each with the noun's own default where it may be left out, in the schema's order.

    Of one that the schema states where it is used: all its fields, which are always written.
    """
    if definition_of(noun) not in _definitions():
        return tuple((f.name, _NONE, _Property(f.name, _NONE, True, False)) for f in fields(noun))
    names, usual = {field.name for field in fields(noun)}, _defaults(noun)
    rules = [rule for rule in _properties(definition_of(noun)) if rule.key in names]
    return tuple((rule.key, usual.get(rule.key, _NONE), rule) for rule in rules)


def entry(noun: Noun, of_item: Callable[[Any], dict[str, Any]] | None = None) -> dict[str, Any]:
    """A noun in the order of its definition, less the fields at the default that the definition states.

    of_item: makes the entries of the nouns in its lists; None for this function itself.
    """
    definition = definition_of(type(noun))
    found: dict[str, Any] = {"type": definition} if definition[0].isupper() else {}
    for key, usual, rule in _said(type(noun)):
        value = getattr(noun, key)
        if value is None or value is usual:
            continue
        if not value and not rule.required and (isinstance(value, (str, Mapping)) or key in LEFT_OUT_EMPTY):
            continue
        value = _written(key, value, of_item or entry)
        if value is None or (rule.nested and not value):
            continue
        if rule.default is not _NONE and value == rule.default:
            continue
        found[key] = value
    return found


@cache
def _is_noun(kind: Any) -> bool:
    return is_dataclass(kind)


def _written(key: str, value: Any, of_item: Callable[[Any], dict[str, Any]] = entry) -> Any:
    if key == "extras" or isinstance(value, (str, bool)):
        return value
    if isinstance(value, tuple):
        items = cast(tuple[Any, ...], value)
        if items and _is_noun(items[0].__class__):
            return [of_item(item) for item in items]
    elif _is_noun(value.__class__):
        return entry(cast(Noun, value))
    return significant(value) if key in SIGNIFICANT else plain_value(value)
