"""An Onshape assembly: definition, features, mate values and meshes."""

from __future__ import annotations

from typing import Any, cast

from ..draft import Draft, at_origin
from .answers import Answers, limits_question, replayed, unnamed
from .definition import Definition
from .mates import Limits, Mates, limits_of
from .parts import Parts
from .patterns import read_patterns

NAME = "Onshape"
METHODS: frozenset[str] = frozenset()


def capture(root: Answers, draft: Draft) -> None:
    """Fill the draft; errors that end the capture are in its report."""
    values: Any = root.ask("definition")
    if not isinstance(values, dict) or "rootAssembly" not in values:
        draft.report.add("CAPTURE_NO_ASSEMBLY", program=NAME)
        return
    name = "Assembly"
    if root.fetch is not None or "name" in root.answers:
        with draft.safely("name of the assembly"):
            name = str(root.ask("name")[0]["name"]).replace("/", "_")
    draft.component({"id": name, "name": name, "kind": "assembly", "flexible": True, "pose": at_origin()})
    definition = Definition(Parts(root, draft), draft, name, cast("dict[str, Any]", values))
    definition.read()
    features: Limits = {}
    with draft.safely("limits of the mates"):
        features[""] = limits_of(root.ask("features"))
    _inner_limits(root, definition, features)
    shown: dict[str, Any] = {}
    with draft.safely("values of the mates"):
        shown = {entry["featureId"]: entry for entry in root.ask("matevalues").get("mateValues", [])}
    Mates(definition, features, shown).read()
    read_patterns(definition)


def _inner_limits(root: Answers, definition: Definition, features: Limits) -> None:
    """Those of the assemblies inside, each asked once; what was not saved of them is told."""
    for path, assembly in definition.owners.items():
        stated = any(feature.get("featureType") == "mate" for feature in assembly.get("features", []))
        if path and stated and (question := limits_question(assembly)) not in features:
            features[question] = {}
            with definition.draft.safely(f"limits of the mates of {definition.ids[path]}"):
                features[question] = limits_of(root.ask(question))


__all__ = ["METHODS", "NAME", "capture", "replayed", "unnamed"]
