"""Kinefab: carries mechanisms out of CAD into Unity, moving as they moved in CAD.

import kinefab

kinefab.export("lever.bundle.json", "lever.kinefab")

A script's own mechanism: ``Scene`` (``add_part``, ``add_hinge``, ``add_constraint`` ...).  ``motion`` drives one, ``view`` and ``report`` write its page,
``batch`` exports many files; ``help(kinefab.Scene)`` and so on tell more, ``kinefab.__all__`` names everything.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "export": "pipeline",
    "motion": "mechanism",
    "view": "showing",
    "report": "showing",
    "Mechanism": "mechanism",
    "Coordinate": "mechanism",
    "Trajectory": "mechanism",
    "Stop": "mechanism",
    "Branching": "mechanism",
    "ExportOptions": "options",
    "ExportResult": "pipeline",
    "batch": "batching.run",
    "BatchResult": "batching.run",
    "Record": "batching.job",
    "ColliderShape": "options",
    "Closures": "options",
    "Ground": "options",
    "Scene": "builder",
    "Joint": "model",
    "JointKind": "model",
    "Freedom": "model",
    "Motion": "model",
    "Drive": "model",
    "Coupling": "model",
    "Constraint": "model",
    "ConstraintKind": "model",
    "Feature": "model",
    "MassProperties": "model",
    "Surface": "model",
    "PhysicsMaterial": "model",
    "Collider": "model",
    "ColliderKind": "model",
    "Pose": "spatial",
    "KinefabError": "diagnostics",
    "Report": "diagnostics",
    "Diagnostic": "diagnostics",
    "Severity": "diagnostics",
    "FeatureOutcome": "diagnostics",
    "Outcome": "diagnostics",
}
__all__ = [*_HOMES, "__version__"]  # pyright: ignore[reportUnsupportedDunderAll]

if TYPE_CHECKING:  # "as" tells type checkers that the name is for others too
    from .batching.job import Record as Record
    from .batching.run import BatchResult as BatchResult
    from .batching.run import batch as batch
    from .builder import Scene as Scene
    from .diagnostics import Diagnostic as Diagnostic
    from .diagnostics import FeatureOutcome as FeatureOutcome
    from .diagnostics import KinefabError as KinefabError
    from .diagnostics import Outcome as Outcome
    from .diagnostics import Report as Report
    from .diagnostics import Severity as Severity
    from .mechanism import Branching as Branching
    from .mechanism import Coordinate as Coordinate
    from .mechanism import Mechanism as Mechanism
    from .mechanism import Stop as Stop
    from .mechanism import Trajectory as Trajectory
    from .mechanism import motion as motion
    from .model import Collider as Collider
    from .model import ColliderKind as ColliderKind
    from .model import Constraint as Constraint
    from .model import ConstraintKind as ConstraintKind
    from .model import Coupling as Coupling
    from .model import Drive as Drive
    from .model import Feature as Feature
    from .model import Freedom as Freedom
    from .model import Joint as Joint
    from .model import JointKind as JointKind
    from .model import MassProperties as MassProperties
    from .model import Motion as Motion
    from .model import PhysicsMaterial as PhysicsMaterial
    from .model import Surface as Surface
    from .options import Closures as Closures
    from .options import ColliderShape as ColliderShape
    from .options import ExportOptions as ExportOptions
    from .options import Ground as Ground
    from .pipeline import ExportResult as ExportResult
    from .pipeline import export as export
    from .showing import report as report
    from .showing import view as view
    from .spatial import Pose as Pose


def __dir__() -> list[str]:
    """What a shell offers to complete and ``help(kinefab)`` tells of; imported or not."""
    return list(__all__)


def __getattr__(name: str) -> Any:
    """Import what is asked for only then, so that ``kinefab --help`` need not wait for numpy."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    return value
