"""Inventor's occurrence patterns: the first element holds what is repeated, every other one its copies."""

from __future__ import annotations

from typing import cast

from ..patterns import follow, free, paired
from .api import Definition, Occurrence, OccurrencePattern, PatternElement
from .constraints import Owner


def read_patterns(owner: Owner, definition: Definition) -> None:
    """Fix the copies of an assembly's patterns to their seeds; those that no element lists are told."""
    draft = owner.draft
    listed: set[str] = set()
    with draft.safely(f"patterns of {owner.id}"):
        patterns = definition.OccurrencePatterns
        for feature, pattern in draft.each(patterns.Count, patterns.Item, "pattern", owner.id):
            with draft.safely(feature):
                listed |= _pattern(owner, cast(OccurrencePattern, pattern))
    flagged = [
        c["id"] for c in draft.components
        if c.get("parent") == owner.id and c.get("extras", {}).get("patternElement") and c["id"] not in listed
    ]  # fmt: skip
    free(draft, f"of {owner.id}", flagged)


def _pattern(owner: Owner, pattern: OccurrencePattern) -> set[str]:
    """The occurrences that its elements list."""
    name, elements = pattern.Name, pattern.OccurrencePatternElements
    seeds = _members(owner, cast(PatternElement, elements.Item(1)))
    listed = set(seeds)
    ties: dict[str, str] = {}
    lost: list[str] = []
    for index in range(2, elements.Count + 1):
        element = cast(PatternElement, elements.Item(index))
        if element.Suppressed:
            continue
        copies = _members(owner, element)
        listed.update(copies)
        if not element.Independent:  # one that is stands as it is constrained
            found, alone = paired(owner.draft, seeds, copies)
            ties |= found
            lost += alone
    follow(owner.draft, name, ties)
    free(owner.draft, name, lost)
    return listed


def _members(owner: Owner, element: PatternElement) -> list[str]:
    occurrences = element.Occurrences
    return [owner.component(cast(Occurrence, occurrences.Item(i))) for i in range(1, occurrences.Count + 1)]
