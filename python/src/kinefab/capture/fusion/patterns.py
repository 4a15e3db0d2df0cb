"""Fusion's patterns and mirrors of occurrences.  Their copies are occurrences like any other, which move by their own joints;
nothing in the documentation says that one follows what it repeats.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from typing import cast

from ..patterns import free
from .api import Collection, PatternElement, PatternFeature, RootComponent
from .occurrences import Occurrences, path_of

KINDS = ("rectangularPatternFeatures", "circularPatternFeatures", "pathPatternFeatures", "mirrorFeatures")


def read_patterns(tree: Occurrences, root: RootComponent) -> None:
    """Tell of the copies that no joint or rigid group holds.  After the joints."""
    draft = tree.draft
    held = {end for joint in draft.joints for end in (joint["a"], joint["b"])}
    held |= {c["id"] for c in draft.components if c.get("grounded")}
    for component, homes in ((root, [tree.root]), *tree.homes.values()):
        with draft.safely(f"patterns of {homes[0]}"):
            features = component.features
            for kind in KINDS:
                with draft.safely(f"{kind} of {homes[0]}"):
                    listed = cast(Collection, getattr(features, kind))
                    for feature, found in draft.each(listed.count, listed.item, kind, homes[0], 0):
                        with draft.safely(feature):
                            pattern = cast(PatternFeature, found)
                            copies = [
                                tree.body(f"{home}/{path}") for path in _copies(pattern) for home in homes
                            ]
                            free(draft, pattern.name, [copy for copy in copies if copy not in held])


def _copies(pattern: PatternFeature) -> list[str]:
    """Paths of a pattern's occurrences from the component that states it."""
    elements = pattern.patternElements
    found: list[str] = []
    for index in range(elements.count):
        occurrences = cast(PatternElement, elements.item(index)).occurrences
        found += [path_of(occurrence) for occurrence in occurrences or ()]
    return found
