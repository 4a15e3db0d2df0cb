"""Patterns and mirrors: copies that have no mates of their own follow the component that they repeat.

A program places copy k by a transform P of its seed: it moves as P * motion * P^-1.  Fixed to its seed it moves as the seed does.
Both are one where P and the motion commute: at rest, along a line, about the pattern's own axis; ``comparing`` tells which.
Autodesk's and SolidWorks' pages say that a pattern moves with what it repeats, not whether each copy turns about an axis of its own:
where that makes a difference the copies are told as approximated.
Standard library only: it also runs in a CAD program's own Python.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from .draft import Draft, Pattern, Record

STATES = ("suppressed", "grounded")


def paired(draft: Draft, seeds: Sequence[str], copies: Sequence[str]) -> tuple[dict[str, str], list[str]]:
    """The seed of each copy of one element of a pattern, and the copies that have none: a copy has its seed's definition;
    of several seeds of one definition the order decides."""
    definitions = {c["id"]: c.get("definition", "") for c in draft.components}
    found: dict[str, str] = {}
    lost: list[str] = []
    counts: Counter[str] = Counter()
    for copy in copies:
        alike = [seed for seed in seeds if definitions.get(seed, "") == definitions.get(copy, "")]
        number = counts[definitions.get(copy, "")]
        counts[definitions.get(copy, "")] += 1
        if number < len(alike):
            found[copy] = alike[number]
        else:
            lost.append(copy)
    return found, lost


def follow(draft: Draft, name: str, seeds: dict[str, str]) -> None:
    """Fix copies to their seeds.  seeds: of each copy its seed; of flexible assemblies each part follows its like."""
    by_seed: dict[str, list[str]] = {}
    for copy, seed in seeds.items():
        by_seed.setdefault(seed, []).append(copy)
    known = {c["id"]: c for c in draft.components}
    for seed, copies in by_seed.items():
        for one, others in _moving(known, draft.components, seed, copies):
            others = [copy for copy in others if not any(known[copy].get(state) for state in STATES)]
            for copy in others:
                own = draft.unique(f"{name}: {copy.rpartition('/')[2]}")
                record: Record = {"id": own, "name": name, "type": "rigid", "a": one, "b": copy}
                draft.joints.append(record)
            if others:
                draft.patterns.append(Pattern(name, one, tuple(others)))


def _moving(
    known: dict[str, Record], components: list[Record], seed: str, copies: list[str]
) -> Iterable[tuple[str, list[str]]]:
    """The seed with its copies; of a flexible assembly, which is no body, what is in it."""
    if seed not in known or known[seed].get("suppressed"):
        return
    there = [copy for copy in copies if copy in known and copy != seed]
    if known[seed]["kind"] == "part" or not known[seed].get("flexible"):
        yield seed, there
        return
    for child in [c["id"] for c in components if c.get("parent") == seed]:
        inner = [copy + child[len(seed) :] for copy in there]
        yield from _moving(known, components, child, inner)


def free(draft: Draft, name: str, copies: Sequence[str]) -> None:
    """Tell of copies that nothing is known to hold."""
    if copies:
        draft.report.approximated(
            f"pattern {name}", "CAPTURE_PATTERN_FREE", count=len(copies), first=copies[0], program=draft.program
        )  # fmt: skip
