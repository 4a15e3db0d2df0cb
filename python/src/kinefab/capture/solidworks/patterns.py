"""SolidWorks' component patterns and mirrors: their instances have no mates of their own."""

from __future__ import annotations

from contextlib import suppress

from ..channel import MemberFailed
from ..patterns import follow, free
from .api import Component, Feature, Model, PatternData
from .features import features, features_below
from .mates import Owner

PATTERNS = frozenset({
    "LocalLPattern", "LocalCirPattern", "LocalSketchPattern", "LocalCurvePattern", "LocalChainPattern",
    "DerivedLPattern", "DerivedCirPattern",
})  # fmt: skip
"""``GetTypeName2`` of the features whose sub-features are the instances of a component pattern."""
COPIED = ("patternInstance", "mirrored")


def read_patterns(owner: Owner, model: Model) -> None:
    """Fix instances of patterns and mirrors to what they repeat: the one component of their file and configuration that is none
    itself, and of several the one that the pattern names."""
    draft = owner.draft
    originals: dict[str, list[str]] = {}
    copies: list[tuple[str, str]] = []
    for c in draft.components:
        if c.get("parent") == owner.id and not c.get("suppressed"):
            if any(c.get("extras", {}).get(word) for word in COPIED):
                copies.append((c["id"], c["definition"]))
            else:
                originals.setdefault(c["definition"], []).append(c["id"])
    named = {}
    if any(len(originals.get(definition, ())) > 1 for _, definition in copies):
        named = _named(owner, model)
    ties: dict[str, str] = {}
    lost: list[str] = []
    for copy, definition in copies:
        alike = originals.get(definition, [])
        told = [seed for seed in _repeated(copy, named) if seed in alike]
        seed = alike[0] if len(alike) == 1 else told[0] if len(told) == 1 else ""
        if seed:
            ties[copy] = seed
        else:
            lost.append(copy)
    follow(draft, f"of {owner.id}", ties)
    free(draft, f"of {owner.id}", lost)


def _repeated(copy: str, named: dict[str, list[str]]) -> list[str]:
    """What the pattern of an instance names, and what the pattern of that names: patterns may repeat instances of others."""
    found: dict[str, None] = {}
    open_ = [copy]
    while open_:
        seeds = [seed for seed in named.get(open_.pop(), ()) if seed not in found]
        found |= dict.fromkeys(seeds)
        open_ += seeds
    return list(found)


def _named(owner: Owner, model: Model) -> dict[str, list[str]]:
    """The seeds that the pattern of each instance names.  Asking for them opens its definition, which is closed again."""
    found: dict[str, list[str]] = {}
    for feature in features(model):
        if feature.GetTypeName2() in PATTERNS:
            with owner.draft.safely(f"a pattern of {owner.id}"):
                instances = [_component(owner, instance) for instance in features_below(feature)]
                seeds = _seeds(owner, model, feature.GetDefinition())
                found |= dict.fromkeys(instances, seeds)
    return found


def _seeds(owner: Owner, model: Model, data: PatternData | None) -> list[str]:
    if data is None or not data.AccessSelections(model, None):
        return []
    try:
        return [_component(owner, seed) for seed in data.SeedComponentArray or ()]
    finally:
        with suppress(MemberFailed):
            data.ReleaseSelectionAccess()


def _component(owner: Owner, feature: Feature) -> str:
    component: Component | None = feature.GetSpecificFeature2()
    return "" if component is None else owner.component(component, owner.id)
