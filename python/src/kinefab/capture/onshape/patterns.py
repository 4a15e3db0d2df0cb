"""Onshape's assembly patterns: which instances each seed has."""

from __future__ import annotations

from typing import Any

from ..patterns import follow, free
from .definition import Definition


def read_patterns(definition: Definition) -> None:
    """Fix the instances of every assembly's patterns to their seeds; those without a place among the instances are told."""
    for path, assembly in definition.owners.items():
        patterns: list[dict[str, Any]] = assembly.get("patterns") or []
        for pattern in patterns:
            with definition.draft.safely(f"pattern {pattern.get('name', pattern.get('id'))}"):
                if not pattern.get("suppressed"):
                    _pattern(definition, path, pattern)


def _pattern(definition: Definition, path: tuple[str, ...], pattern: dict[str, Any]) -> None:
    name = str(pattern.get("name") or pattern.get("id"))
    ties: dict[str, str] = {}
    lost: list[str] = []
    for seed, copies in pattern["seedToPatternInstances"].items():
        known = definition.ids.get((*path, seed))
        for copy in copies:  # an id, or ids down to the instance
            own = definition.ids.get((*path, *([copy] if isinstance(copy, str) else copy)))
            if own is not None and known is not None:
                ties[own] = known
            elif own is not None:
                lost.append(own)
    follow(definition.draft, name, ties)
    free(definition.draft, name, lost)
