"""Attribute values by name, finite and typed; what is not is a diagnostic with its place.

By name because vendor schemas (Physx*, Newton*, Mjc*) are not registered in plain usd-core, which then hides them.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...spatial import Array, matrix_from_quaternion
from .api import Usd
from .stage import OpenStage

UNBOUNDED = 0.5e38
"""USD's sentinel: from here on a bound is none (physics:lowerLimit and the like, FLT_MAX in files)."""


@dataclass(frozen=True, slots=True, eq=False)
class Values:
    """Reads prims of one stage."""

    opened: OpenStage
    report: Report

    def get(self, prim: Any, name: str) -> Any:
        """The raw value at the exported time, None where the attribute is missing, blocked or empty."""
        attribute = prim.GetAttribute(name)
        if not attribute:
            return None
        value = attribute.Get(Usd.TimeCode.Default())
        return attribute.Get(Usd.TimeCode.EarliestTime()) if value is None else value

    def authored(self, prim: Any, name: str) -> bool:
        attribute = prim.GetAttribute(name)
        return bool(attribute) and attribute.HasAuthoredValue()

    def number(self, prim: Any, name: str, default: float, open_ended: bool = False) -> float:
        """A finite number.  open_ended: infinity is allowed, and what is as good as infinite becomes it."""
        value = self.get(prim, name)
        if value is None:
            return default
        try:
            found = float(value)
        except (TypeError, ValueError):
            self.wrong(prim, name, value)
            return default
        if open_ended and abs(found) >= UNBOUNDED:
            return math.copysign(math.inf, found)
        if not math.isfinite(found):
            self.wrong(prim, name, value)
            return default
        return found

    def flag(self, prim: Any, name: str, default: bool) -> bool:
        value = self.get(prim, name)
        return default if value is None else bool(value)

    def word(self, prim: Any, name: str, default: str) -> str:
        value = self.get(prim, name)
        return default if value is None else str(value)

    def vector(self, prim: Any, name: str, default: Sequence[float]) -> Array:
        """Three finite numbers."""
        value = self.get(prim, name)
        if value is None:
            return np.array(default, dtype=np.float64)
        try:
            found = np.array(value, dtype=np.float64)
        except (TypeError, ValueError):
            found = np.array([math.nan])
        if found.shape != (3,) or not np.isfinite(found).all():
            self.wrong(prim, name, value)
            return np.array(default, dtype=np.float64)
        return found

    def array(self, prim: Any, name: str, width: int = 1) -> Array | None:
        """Numbers of an array or vector, finite or not, shape (n, width) or (n,); None where there are none."""
        value = self.get(prim, name)
        if value is None:
            return None
        try:
            found = np.array(value, dtype=np.float64)
        except (TypeError, ValueError):
            found = np.zeros(0)
        if found.size == 0 or found.size % width:
            if found.size or len(str(value)) > 2:  # an empty array is none
                self.wrong(prim, name, value)
            return None
        return found.reshape(-1, width) if width > 1 else found.ravel()

    def rotation(self, prim: Any, name: str) -> Array | None:
        """Rotation matrix of a quaternion, None where it is missing or has no length."""
        value = self.get(prim, name)
        if value is None:
            return None
        try:
            parts = np.array([*value.GetImaginary(), value.GetReal()], dtype=np.float64)
        except AttributeError:
            self.wrong(prim, name, value)
            return None
        if not np.isfinite(parts).all():
            self.wrong(prim, name, value)
            return None
        return matrix_from_quaternion(parts) if np.linalg.norm(parts) > 1e-6 else None

    def targets(self, prim: Any, name: str) -> list[Any]:
        """Paths that a relationship leads to, forwarded."""
        relationship = prim.GetRelationship(name)
        return list(relationship.GetForwardedTargets()) if relationship else []

    def wrong(self, prim: Any, name: str, value: object) -> None:
        shown = str(value)
        self.report.add(
            "USD_VALUE_IMPOSSIBLE",
            self.opened.place(prim, name),
            field=name,
            value=shown if len(shown) <= 60 else shown[:57] + "...",
        )


def schemas(prim: Any) -> tuple[str, ...]:
    """All applied API schemas, also those that no plug-in registers."""
    listed = prim.GetMetadata("apiSchemas")
    return tuple(listed.GetAddedOrExplicitItems()) if listed is not None else ()


def title(prim: Any) -> str:
    """The name that a user sees."""
    shown = prim.GetDisplayName()
    return shown if shown and shown.isprintable() else prim.GetName()


def identity(prim: Any) -> str:
    """A node's or joint's id: the prim's path without the first slash."""
    return str(prim.GetPath())[1:]
