"""Kinefab: carries mechanisms out of CAD into Unity, moving as they moved in CAD.

import kinefab

kinefab.export("lever.bundle.json", "lever.kinefab")
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

_HOMES = {
    "export": "pipeline",
    "ExportOptions": "options",
    "ExportResult": "pipeline",
    "ColliderShape": "options",
    "Scene": "builder",
    "JointKind": "model",
    "Freedom": "model",
    "Motion": "model",
    "Drive": "model",
    "MassProperties": "model",
    "KinefabError": "diagnostics",
    "Report": "diagnostics",
}
__all__ = [*_HOMES, "__version__"]

if TYPE_CHECKING:
    from .builder import Scene  # noqa: F401
    from .diagnostics import KinefabError, Report  # noqa: F401
    from .model import Drive, Freedom, JointKind, MassProperties, Motion  # noqa: F401
    from .options import ColliderShape, ExportOptions  # noqa: F401
    from .pipeline import ExportResult, export  # noqa: F401


def __getattr__(name: str) -> Any:
    """Import what is asked for only then, so that ``kinefab --help`` need not wait for numpy."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(f".{_HOMES[name]}", __name__), name)
    return value
