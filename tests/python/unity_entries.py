"""Unity's nouns as dicts of what is not at its default, with all motions and targets, in full precision: what the tests
of mappings look at."""

from __future__ import annotations

from dataclasses import fields, is_dataclass
from typing import Any


def entry_of(noun: Any) -> dict[str, Any]:
    """A component with its type, or a part of one, by the names of the scene file."""
    found: dict[str, Any] = {}
    if "Joint" in type(noun).__name__ and hasattr(noun, "connectedBody"):
        found["type"] = type(noun).__name__
    for field in fields(noun):
        value = getattr(noun, field.name)
        told = field.name.startswith("target") or field.name.endswith("Motion")
        if field.name in ("id", "extras") or (value == field.default and not told):
            continue
        found[field.name] = (
            entry_of(value) if is_dataclass(value) else list(value) if isinstance(value, tuple) else value
        )
    return found
