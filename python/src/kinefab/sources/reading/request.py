"""What a reader is asked for beside the file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ...model import MeshReference
from ...spatial import Array

Vertices = Callable[[MeshReference], Array]
"""Loads the vertices of a mesh, shape (n, 3), through its ``to_node``."""


@dataclass(frozen=True, slots=True, eq=False)
class Request:
    """options: values by the names of the format's ``options``; those that the user did not give are missing.
    vertices: for a format that leaves a point to be found in the geometry (None: that step is left out).
    progress: called with how much is read, 0 to 1.
    """

    options: Mapping[str, Any] = field(default_factory=dict[str, Any])
    vertices: Vertices | None = None
    progress: Callable[[float], None] = lambda fraction: None

    def text(self, name: str, default: str = "") -> str:
        return str(self.options.get(name, default))

    def number(self, name: str, default: float) -> float:
        return float(self.options.get(name, default))

    def flag(self, name: str) -> bool:
        return bool(self.options.get(name, False))

    def texts(self, name: str) -> tuple[str, ...]:
        """Of a repeated option."""
        return tuple(str(value) for value in self._each(name))

    def paths(self, name: str) -> tuple[Path, ...]:
        """Of a repeated option."""
        return tuple(Path(value) for value in self._each(name))

    def _each(self, name: str) -> tuple[Any, ...]:
        """A single word or path is the only one; it would be taken letter by letter."""
        value = self.options.get(name, ())
        return (value,) if isinstance(value, (str, Path)) else tuple(value)
