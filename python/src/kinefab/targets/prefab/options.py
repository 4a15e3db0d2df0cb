"""What a user may ask of a prefab; the same of the package that holds it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from .text.dialects import DIALECTS, Dialect, Pipeline

DEFAULT_DIALECT = "2022"


@dataclass(frozen=True, slots=True)
class PrefabOptions:
    """articulation: bodies are ArticulationBodies where the mechanism is a tree.  scripts: couplings are kept by a script."""

    dialect: Dialect = DIALECTS[DEFAULT_DIALECT]
    pipeline: Pipeline = Pipeline.BUILTIN
    scripts: bool = False
    articulation: bool = False

    @staticmethod
    def of(asked: Mapping[str, Any]) -> PrefabOptions:
        """Raises ValueError for a word that is none."""
        dialect, pipeline = asked.get("unity") or DEFAULT_DIALECT, asked.get("pipeline") or Pipeline.BUILTIN
        physics = asked.get("physics") or "rigidbody"
        for name, value, words in (
            ("unity", str(dialect), list(DIALECTS)),
            ("pipeline", str(getattr(pipeline, "value", pipeline)), [p.value for p in Pipeline]),
            ("physics", str(physics), ["rigidbody", "articulation"]),
        ):
            if value not in words:
                raise ValueError(f"{name} is {value!r}; pass one of: {', '.join(words)}")
        scripts = bool(asked.get("scripts", False))
        return PrefabOptions(DIALECTS[str(dialect)], Pipeline(pipeline), scripts, physics == "articulation")
