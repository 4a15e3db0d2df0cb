"""A written scene as Unity's nouns: what ``targets.noun_entry`` writes, read again, and what of it no noun has a place for."""

from __future__ import annotations

import types
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import MISSING, fields, is_dataclass
from enum import Enum
from functools import cache
from typing import Any, TypeVar, Union, cast, get_args, get_origin, get_type_hints

from ...diagnostics import Report
from ..definitions import NONE, Noun, definition_of, definitions, properties
from ..scene import (
    ArticulationBody,
    BoxCollider,
    CapsuleCollider,
    ConfigurableJoint,
    FixedJoint,
    HingeJoint,
    MeshCollider,
    MeshFilter,
    MeshRenderer,
    Rigidbody,
    SphereCollider,
)

Entry = Mapping[str, Any]
TARGET = "what reads a .kinefab"
N = TypeVar("N", bound=Noun)

COMPONENTS: Mapping[str, type[Noun]] = {
    kind.__name__: kind
    for kind in (
        ArticulationBody,
        BoxCollider,
        CapsuleCollider,
        ConfigurableJoint,
        FixedJoint,
        HingeJoint,
        MeshCollider,
        MeshFilter,
        MeshRenderer,
        Rigidbody,
        SphereCollider,
    )
}


def noun(kind: type[N], entry: Entry) -> N:
    """An entry as the noun that it was written of: what it leaves out is at the default of its definition, else at the noun's own."""
    values: dict[str, Any] = {}
    usual = _usual(kind)
    for name, hint in _hints(kind).items():
        if name in entry:
            values[name] = _value(hint, entry[name])
        elif name in usual:
            values[name] = usual[name]
    return kind(**values)


def component(entry: Entry) -> Noun:
    """A component by its type.  Raises LookupError for one that no scene of this version has."""
    return noun(COMPONENTS[entry["type"]], entry)


def unheld(kind: type[Noun], entry: Entry) -> Iterator[str]:
    """What an entry says that its noun has no field for, ``drive.extras`` of a noun in it."""
    hints = _hints(kind)
    for key, value in entry.items():
        inner = _noun_in(hints.get(key))
        if key not in hints and key not in ("type", "extras"):  # which stay with the document
            yield key
        elif inner is not None and isinstance(value, Mapping):
            yield from (f"{key}.{name}" for name in unheld(inner, cast(Entry, value)))


@cache
def _hints(kind: type[Noun]) -> Mapping[str, Any]:
    hints = get_type_hints(kind)
    return {field.name: hints[field.name] for field in fields(kind)}


@cache
def _usual(kind: type[Noun]) -> Mapping[str, Any]:
    """Of each field that may be left out, what it then is; without those whose noun knows it."""
    definition = definition_of(kind)
    if definition not in definitions():
        return {}
    stated = {rule.key: rule.default for rule in properties(definition) if rule.default is not NONE}
    hints = _hints(kind)
    return {
        field.name: _value(hints[field.name], stated[field.name])
        for field in fields(kind)
        if field.name in stated and (field.default is MISSING or field.default != stated[field.name])
    }


def _value(hint: Any, value: Any) -> Any:
    """A JSON value as a field of this type has it."""
    if value is None:
        return None
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        (hint,) = (each for each in get_args(hint) if each is not type(None))
        return _value(hint, value)
    if origin is tuple:
        inner, last = get_args(hint)[0], get_args(hint)[-1]
        items = cast(Sequence[Any], value)
        if last is not Ellipsis and len(items) != len(get_args(hint)):
            raise ValueError(f"{len(items)} numbers")
        return tuple(_value(inner, item) for item in items)
    if hint is float:
        return float(value)
    if is_dataclass(hint):
        return noun(cast("type[Noun]", hint), value)
    if isinstance(hint, type) and issubclass(hint, Enum):
        return hint(value)
    if hint in (int, bool, str) and type(value) is not hint:
        raise TypeError(f"{value!r} is no {hint.__name__}")
    return value


def _noun_in(hint: Any) -> type[Noun] | None:
    return hint if isinstance(hint, type) and is_dataclass(hint) else None


def told(kind: Any, entry: Entry, name: str, report: Report) -> Any:
    """The noun; the report gets what it has no field for."""
    tell(kind, entry, name, report)
    return noun(kind, entry)


def tell(kind: type[Noun], entry: Entry, name: str, report: Report) -> None:
    """The report gets what an entry says that its noun has no field for."""
    for field in unheld(kind, entry):
        report.field_dropped(name, field, TARGET)
