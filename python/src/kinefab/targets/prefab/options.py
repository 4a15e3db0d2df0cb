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
        """asked: as ``check_target`` lets it pass."""
        dialect, pipeline = asked.get("unity") or DEFAULT_DIALECT, asked.get("pipeline") or Pipeline.BUILTIN
        scripts, articulation = bool(asked.get("scripts")), asked.get("physics") == "articulation"
        return PrefabOptions(DIALECTS[str(dialect)], Pipeline(pipeline), scripts, articulation)
