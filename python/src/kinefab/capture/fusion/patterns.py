"""Fusion's patterns and mirrors of occurrences.  Their copies are occurrences like any other, which move by their own joints;
nothing in the documentation says that one follows what it repeats.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from ..draft import Draft
from ..patterns import free
from .api import Collection, Features, Occurrence, PatternElement, PatternFeature

KINDS = ("rectangularPatternFeatures", "circularPatternFeatures", "pathPatternFeatures", "mirrorFeatures")


def read_patterns(draft: Draft, features: Features, component: Callable[[Occurrence | None], str]) -> None:
    """Tell of the copies that no joint or rigid group holds.  After the joints."""
    held = {end for joint in draft.joints for end in (joint["a"], joint["b"])}
    held |= {c["id"] for c in draft.components if c.get("grounded")}
    for kind in KINDS:
        with draft.safely(kind):
            listed = cast(Collection, getattr(features, kind))
            for index in range(listed.count):
                with draft.safely(f"{kind} {index + 1}"):
                    pattern = cast(PatternFeature, listed.item(index))
                    free(draft, pattern.name, [c for c in _copies(pattern, component) if c not in held])


def _copies(pattern: PatternFeature, component: Callable[[Occurrence | None], str]) -> list[str]:
    elements = pattern.patternElements
    found: list[str] = []
    for index in range(elements.count):
        occurrences = cast(PatternElement, elements.item(index)).occurrences
        found += [component(occurrence) for occurrence in occurrences or ()]
    return found
