"""What the scene format says of Unity's nouns: of each its definition in the schema, by which it is written and read back."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any, ClassVar, Protocol

from ..diagnostics import schema_directory

RENAMED = {"Mobility": "analysis", "AnimationClip": "animation"}
"""Nouns whose definition in the schema has another name than their own with a small initial."""

UV_SETS = ("uv", *(f"uv{i}" for i in range(2, 9)))
"""A mesh's sets of texture coordinates, by their names in Unity and in the file."""


class Noun(Protocol):
    """Any of ``unity.scene``'s dataclasses."""

    __dataclass_fields__: ClassVar[dict[str, Any]]


NONE = object()
"""The default of a field that has none."""


@dataclass(frozen=True, slots=True)
class Property:
    """nested: it holds an object that may be left out when empty.  newer: format 1.0 has no such field."""

    key: str
    default: Any
    required: bool
    nested: bool
    newer: bool = False


@cache
def scene_schema() -> Mapping[str, Any]:
    """Of a scene, whole."""
    return json.loads((schema_directory() / "scene.schema.json").read_text(encoding="utf-8"))


def definitions() -> Mapping[str, Any]:
    return scene_schema()["$defs"]


@cache
def definition_of(noun: type[Noun]) -> str:
    """The schema's definition of a noun: of a component its own name, of others with a small initial."""
    name = RENAMED.get(noun.__name__, noun.__name__)
    return name if name in definitions() else name[0].lower() + name[1:]


@cache
def properties(definition: str) -> tuple[Property, ...]:
    """Of a definition by its name, in its order."""
    rules = definitions()[definition]
    required = set(rules.get("required", ()))
    found: list[Property] = []
    for key, rule in rules["properties"].items():
        reference = rule.get("$ref", "").removeprefix("#/$defs/")
        nested = definitions().get(reference, {}).get("type") == "object"
        found.append(Property(key, rule.get("default", NONE), key in required, nested, "since" in rule))
    return tuple(found)
