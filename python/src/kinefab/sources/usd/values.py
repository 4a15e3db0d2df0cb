"""Attribute values by name, finite and typed; what is not is a diagnostic with its place.

By name because vendor schemas (Physx*, Newton*, Mjc*) are not registered in plain usd-core, which then hides them.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...diagnostics import Report, named, printable, readable
from ...spatial import Array, matrix_from_quaternion
from .api import Usd, UsdGeom, UsdPhysics
from .stage import OpenStage

UNBOUNDED = 0.99e30
"""From here on a bound is none (physics:lowerLimit and the like): FLT_MAX in files, 1e30 where infinity is not allowed."""

VENDORS = ("physx", "omniphysics:", "newton:", "mjc:", "urdf:", "state:")
"""Beginnings of the names of vendors' properties."""
KNOWN = ("physxTendon",)
"""Of those that are told with their schemas."""
WHOLE = ("Physx", "Newton", "Mjc")
"""Beginnings of types that vendors make; what is not read of them is told as a whole."""

RANKS: dict[str, Any] = {
    "Scene": UsdPhysics.Scene,
    "CollisionGroup": UsdPhysics.CollisionGroup,
    "Joint": UsdPhysics.Joint,
    "Gprim": UsdGeom.Gprim,
    "Xformable": UsdGeom.Xformable,
}
"""Schemas that many a type is a kind of: asking pxr for each prim would be a tenth of reading a large stage."""
DRESSING = ("material:binding", "primvars:displayColor", "primvars:displayOpacity")
"""Beginnings of the names by which a prim says how it looks."""


@dataclass(frozen=True, slots=True, eq=False)
class Traits:
    """What is asked of prims again and again; prims that agree in it share it.

    kind: name of the type.  ranks: what it is a kind of, of ``RANKS``; "Known" where pxr knows the type.  schemas: as ``schemas`` has them.  names: of properties with an opinion of their own.
    fallbacks: what other properties give, by name: that of the type and its schemas.
    dressed: it states a material or colours, which what lies below inherits.
    """

    kind: str
    ranks: frozenset[str]
    schemas: tuple[str, ...]
    names: frozenset[str]
    fallbacks: dict[str, Any]
    dressed: bool


@dataclass(frozen=True, slots=True, eq=False)
class Values:
    """Reads prims of one stage, which does not change meanwhile."""

    opened: OpenStage
    report: Report
    _of_prim: dict[Any, Traits] = field(default_factory=dict[Any, Traits])
    _traits: dict[tuple[Any, ...], Traits] = field(default_factory=dict[tuple[Any, ...], Traits])
    _fallbacks: dict[tuple[Any, ...], dict[str, Any]] = field(
        default_factory=dict[tuple[Any, ...], dict[str, Any]]
    )
    _asked: set[str] = field(default_factory=set[str])
    _told: set[str] = field(default_factory=set[str])

    def traits(self, prim: Any) -> Traits:
        found = self._of_prim.get(prim)
        if found is None:
            shared = prim.IsInstanceProxy()
            found = self.traits(prim.GetPrimInPrototype()) if shared else self._traits_of(prim)
            self._of_prim[prim] = found
        return found

    def _traits_of(self, prim: Any) -> Traits:
        kind, applied = str(prim.GetTypeName()), schemas(prim)
        names = tuple(prim.GetAuthoredPropertyNames())
        found = self._traits.get((kind, applied, names))
        if found is None:
            fallbacks = self._fallbacks.setdefault((kind, applied), {})
            ranks = frozenset(rank for rank, schema in RANKS.items() if prim.IsA(schema))
            if prim.GetPrimTypeInfo().GetSchemaTypeName():
                ranks |= {"Known"}
            dressed = any(name.startswith(DRESSING) for name in names)
            found = Traits(kind, ranks, applied, frozenset(names), fallbacks, dressed)
            self._traits[kind, applied, names] = found
        return found

    def alike(self, prim: Any, names: frozenset[str]) -> Traits | None:
        """What it shares with all prims that these attributes tell the same of; None where it states one of them itself."""
        traits = self.traits(prim)
        return traits if traits.names.isdisjoint(names) else None

    def get(self, prim: Any, name: str) -> Any:
        """The raw value at the exported time, None where the attribute is missing, blocked or empty."""
        traits = self._of_prim.get(prim) or self.traits(prim)
        if name in traits.names:
            self._asked.add(name)
            attribute = prim.GetAttribute(name)
            return self.current(attribute) if attribute else None
        if name not in traits.fallbacks:
            attribute = prim.GetAttribute(name)
            traits.fallbacks[name] = attribute.Get() if attribute else None
        return traits.fallbacks[name]

    def current(self, attribute: Any) -> Any:
        """The raw value of an attribute at the exported time; that it changes over time is told."""
        value, moves = value_of(attribute)
        if moves:
            self.tell_samples(attribute.GetPrim(), str(attribute.GetName()))
        return value

    def authored(self, prim: Any, name: str) -> bool:
        self._asked.add(name)
        return name in self.traits(prim).names and prim.GetAttribute(name).HasAuthoredValue()

    def number(self, prim: Any, name: str, default: float, open_ended: bool = False) -> float:
        """A finite number.  open_ended: infinity is allowed, and what is as good as infinite becomes it."""
        value = self.get(prim, name)
        if value is None:
            return default
        if isinstance(value, bool) or not isinstance(value, (float, int)):
            self.wrong(prim, name, value)
            return default
        found = float(value)
        if open_ended and abs(found) >= UNBOUNDED:
            return math.copysign(math.inf, found)
        if not math.isfinite(found):
            self.wrong(prim, name, value)
            return default
        return found

    def flag(self, prim: Any, name: str, default: bool) -> bool:
        """A bool, or an int that is 0 or 1; the default, told, for anything else."""
        value = self.get(prim, name)
        if value is None:
            return default
        if not isinstance(value, int) or value not in (0, 1):  # a bool is an int; old files have ints
            self.wrong(prim, name, value)
            return default
        return bool(value)

    def word(self, prim: Any, name: str, default: str) -> str:
        """A string or token; the default, told, for anything else."""
        value = self.get(prim, name)
        if value is None:
            return default
        if not isinstance(value, str):
            self.wrong(prim, name, value)
            return default
        return value

    def token(self, prim: Any, name: str, known: Sequence[str], default: str) -> str:
        """One of the words that the schema knows."""
        found = self.word(prim, name, default)
        if found not in known:
            self.wrong(prim, name, found)
            return default
        return found

    def vector(self, prim: Any, name: str, default: Sequence[float]) -> Array:
        """Three finite numbers."""
        value = self.get(prim, name)
        if value is None:
            return np.array(default, dtype=np.float64)
        found = _numbers(value)
        if found.shape != (3,) or not all(map(math.isfinite, found.tolist())):
            self.wrong(prim, name, value)
            return np.array(default, dtype=np.float64)
        return found

    def array(self, prim: Any, name: str, width: int = 1) -> Array | None:
        """Numbers of an array or vector, finite or not, shape (n, width) or (n,); None where there are none."""
        value = self.get(prim, name)
        if value is None:
            return None
        found = _numbers(value)
        if found.size == 0 or found.size % width:
            if found.size or isinstance(value, str) or len(str(value)) > 2:  # an empty array is none
                self.wrong(prim, name, value)
            return None
        return found.reshape(-1, width) if width > 1 else found.ravel()

    def rotation(self, prim: Any, name: str) -> Array | None:
        """Rotation matrix of a quaternion, None where it is missing or has no length."""
        value = self.get(prim, name)
        if value is None:
            return None
        try:
            turning = value.GetImaginary()  # by number: pxr's vectors are slow to iterate
            parts = (float(turning[0]), float(turning[1]), float(turning[2]), float(value.GetReal()))
        except AttributeError:
            self.wrong(prim, name, value)
            return None
        if not all(map(math.isfinite, parts)):
            self.wrong(prim, name, value)
            return None
        return matrix_from_quaternion(np.array(parts)) if math.hypot(*parts) > 1e-6 else None

    def targets(self, prim: Any, name: str) -> list[Any]:
        """Paths that a relationship leads to, forwarded."""
        self._asked.add(name)
        relationship = prim.GetRelationship(name)
        return list(relationship.GetForwardedTargets()) if relationship else []

    def pass_over(self, names: Iterable[str]) -> None:
        """Names of what is stated once more in other words, so that nobody asks for it."""
        self._asked.update(names)

    def tell_unasked(self) -> None:
        """What vendors state of prims and nobody asked for, each attribute once."""
        found: dict[str, list[str]] = {}
        for prim, traits in self._of_prim.items():
            if not traits.kind.startswith(WHOLE):
                for name in traits.names:
                    if name.startswith(VENDORS) and name not in self._asked and not name.startswith(KNOWN):
                        shared = prim.IsInPrototype()  # whose own path is another at each run
                        path = prim.GetPrimStack()[0].path if shared else prim.GetPath()
                        found.setdefault(name, []).append(str(path))
        for name in sorted(found):
            paths = sorted(found[name])
            self.report.dropped(
                f"{name} of {named(paths, 1)[1:]}", "USD_FEATURE_DROPPED", self.opened.place(paths[0], name),
                detail="nothing of the scene is like it",
            )  # fmt: skip

    def title(self, prim: Any) -> str:
        """The name that a user sees; once, that it is not the one that the stage gives."""
        name, own = prim.GetDisplayName(), prim.GetName()
        if not name or readable(name):
            return name or own
        place = self.opened.place(prim, "displayName")
        if place not in self._told:
            self._told.add(place)
            self.report.approximated(
                f"name of {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", place,
                detail=f"'{printable(name)}' would steer the line that it stands in; it is called {own}",
            )  # fmt: skip
        return own

    def tell_samples(self, prim: Any, name: str) -> None:
        """Once, that a value changes over time, which only places may."""
        place = self.opened.place(prim, name)
        if place not in self._told:
            self._told.add(place)
            path = prim if isinstance(prim, str) else str(prim.GetPath())
            self.report.dropped(
                f"animation of {path[1:]}.{name}", "USD_FEATURE_DROPPED", place,
                detail="it stays as at the exported time",
            )  # fmt: skip

    def tell_unusable(self, prim: Any, name: str, value: object) -> None:
        """That a value is passed over which the rest can do without.  name: of the attribute."""
        self.report.dropped(
            f"{name.removeprefix('inputs:')} of {prim.GetPath()}", "USD_FEATURE_DROPPED", self.opened.place(prim, name),
            detail=f"it cannot be {shown(value)}",
        )  # fmt: skip

    def wrong(self, prim: Any, name: str, value: object) -> None:
        self.report.add(
            "USD_VALUE_IMPOSSIBLE",
            self.opened.place(prim, name),
            field=name,
            value=shown(value),
        )


def shown(value: object) -> str:
    """A value as findings have it: what is long is cut."""
    text = str(value)
    return text if len(text) <= 60 else text[:57] + "..."


def _numbers(value: Any) -> Array:
    """Of an array or vector; empty where it is none of numbers: numpy would read texts as such."""
    try:
        found = np.array(value)
    except (TypeError, ValueError):
        return np.zeros(0)
    return found.astype(np.float64) if found.dtype.kind in "fiu" else np.zeros(0)


def value_of(attribute: Any) -> tuple[Any, bool]:
    """At the exported time, the default or else the first sample, and whether it changes over time."""
    value = attribute.Get()  # at the default time
    moves = attribute.ValueMightBeTimeVarying()
    if value is None or ((moves or attribute.GetNumTimeSamples()) and _is_fallback(attribute)):
        value = attribute.Get(Usd.TimeCode.EarliestTime())
    return value, moves


def _is_fallback(attribute: Any) -> bool:
    """Whether nobody but the schema says what it is at the default time."""
    return attribute.GetResolveInfo(Usd.TimeCode.Default()).GetSource() == Usd.ResolveInfoSourceFallback


def schemas(prim: Any) -> tuple[str, ...]:
    """All applied API schemas, also those that no plug-in registers."""
    return tuple(prim.GetPrimTypeInfo().GetAppliedAPISchemas())


def identity(prim: Any) -> str:
    """A node's or joint's id: the prim's path without the first slash."""
    return str(prim.GetPath())[1:]
