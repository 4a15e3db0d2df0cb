"""Unity's nouns as entries of the scene file: by the schema's order, without what Unity would assume anyway."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields, is_dataclass
from functools import cache
from typing import Any, cast

from ..unity.definitions import NONE, Noun, Property, definition_of, definitions, properties
from .numbers import plain_value, significant, whole_numbers

SIGNIFICANT = frozenset({"mass", "inertiaTensor", "ratio", "armature"})
"""Fields whose size says nothing about their precision; all others are lengths, directions and angles."""

LEFT_OUT_EMPTY = frozenset({"because", "localPosition", "localRotation"})
"""Lists that are not written when there is nothing in them."""


@cache
def _defaults(noun: type[Noun]) -> Mapping[str, Any]:
    """Of each field that its definition lets be left out at the noun's own default, that default: known again by identity."""
    rules = {rule.key: rule for rule in properties(definition_of(noun))}
    return {
        field.name: field.default
        for field in fields(noun)
        if (rule := rules.get(field.name)) is not None
        and rule.default is not NONE
        and field.default is not MISSING
        and _written(rule.key, field.default) == rule.default
    }


@cache
def unsaid(noun: type[Noun]) -> Mapping[str, Any]:
    """Fields of a noun that the format has no place for, each with the value that says nothing; its id is not one."""
    known = {"id", *(rule.key for rule in properties(definition_of(noun)))}
    return {field.name: field.default for field in fields(noun) if field.name not in known}


@cache
def newer_keys(definition: str) -> frozenset[str]:
    """Fields of a definition that format 1.0 lacks."""
    return frozenset(rule.key for rule in properties(definition) if rule.newer)


@cache
def _newer(noun: type[Noun]) -> Mapping[str, Any] | None:
    """Fields of a noun that format 1.0 lacks, each with the value that is not written; None for a noun that it lacks."""
    definition = definition_of(noun)
    if "since" in definitions()[definition]:
        return None
    keys = newer_keys(definition)
    return {field.name: field.default for field in fields(noun) if field.name in keys}


def needs_newer(noun: Noun) -> bool:
    """Whether it says what format 1.0 has no field for."""
    found = _newer(type(noun))
    return found is None or any(getattr(noun, name) != usual for name, usual in found.items())


@cache
def _said(noun: type[Noun]) -> tuple[tuple[str, Any, Property], ...]:
    """What is written of a noun, each with the noun's own default where it may be left out, in the schema's order.

    Of one that the schema states where it is used: all its fields, which are always written.
    """
    if definition_of(noun) not in definitions():
        return tuple((f.name, NONE, Property(f.name, NONE, True, False)) for f in fields(noun))
    names, usual = {field.name for field in fields(noun)}, _defaults(noun)
    rules = [rule for rule in properties(definition_of(noun)) if rule.key in names]
    return tuple((rule.key, usual.get(rule.key, NONE), rule) for rule in rules)


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
        if rule.default is not NONE and value == rule.default:
            continue
        found[key] = value
    return found


@cache
def _is_noun(kind: Any) -> bool:
    return is_dataclass(kind)


def _written(key: str, value: Any, of_item: Callable[[Any], dict[str, Any]] = entry) -> Any:
    if isinstance(value, (str, bool)):
        return value
    if key == "extras":
        return whole_numbers(value)
    if isinstance(value, tuple):
        items = cast(tuple[Any, ...], value)
        if items and _is_noun(items[0].__class__):
            return [of_item(item) for item in items]
    elif _is_noun(value.__class__):
        return entry(cast(Noun, value))
    return significant(value) if key in SIGNIFICANT else plain_value(value)
