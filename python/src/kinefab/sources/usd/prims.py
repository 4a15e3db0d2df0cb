"""What prims say by themselves, wherever they stand: of a prototype once for all its instances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from .api import Usd, UsdGeom
from .transforms import IDENTITY, Local, local_of
from .values import Traits, Values, value_of

PREDICATE = Usd.TraverseInstanceProxies()
PROTOTYPED = Usd.TraverseInstanceProxies(Usd.PrimIsActive & Usd.PrimIsLoaded & Usd.PrimHasDefiningSpecifier)
"""Below prototypes that lie in an ``over`` or a ``class``, so that nothing but their instancers draws them."""


@dataclass(slots=True, eq=False)
class Seen:
    """prim: of an instance's content that of the prototype.  local: its own transform; what is wrong with it does not
    count, and is ``faults``: names of attributes with their values.
    hidden: it is invisible itself.  flickers: that changes over time.  purpose: that it states.  children: once somebody asked ``Prims.below``.
    """

    prim: Any
    name: str
    traits: Traits
    local: Local
    faults: tuple[tuple[str, object], ...] = ()
    hidden: bool = False
    flickers: bool = False
    purpose: str | None = None
    children: tuple[Seen, ...] | None = None
    _source: str = ""

    @property
    def source(self) -> str:
        """The path that all instances of the prim share."""
        if not self._source:
            self._source = source_path(self.prim)
        return self._source

    def at(self, path: str) -> Any:
        """The prim that stands at a path and looks so: what lies in a prototype stands at its instances."""
        return self.prim.GetStage().GetPrimAtPath(path) if self.prim.IsInPrototype() else self.prim

    def tell(self, path: str, values: Values) -> None:
        """What is wrong with the transform of the prim at a path, and what of it changes over time unseen."""
        for name, value in self.faults:
            values.wrong(path, name, value)
        if self.flickers:
            values.tell_samples(path, "visibility")


class Prims:
    """Looks at prims, at what instances share once."""

    def __init__(self, values: Values):
        self._values = values
        self._shared: dict[Any, Seen] = {}

    def seen(self, prim: Any) -> Seen:
        traits = self._values.traits(prim)
        names = traits.names
        local, faults = _local(prim) if "xformOpOrder" in names else (IDENTITY, ())
        found = Seen(prim, prim.GetName(), traits, local, faults)
        if "visibility" in names and (imageable := UsdGeom.Imageable(prim)):
            value, found.flickers = value_of(imageable.GetVisibilityAttr())
            found.hidden = value == "invisible"
        if "purpose" in names and (imageable := UsdGeom.Imageable(prim)):
            attribute = imageable.GetPurposeAttr()
            found.purpose = str(attribute.Get()) if attribute.HasAuthoredValue() else None
        return found

    def shared(self, prim: Any) -> Seen:
        """As ``seen``, of what stands in many places."""
        found = self._shared.get(prim)
        if found is None:
            found = self._shared[prim] = self.seen(prim)
        return found

    def below(self, seen: Seen) -> tuple[Seen, ...]:
        """A prim's children, those of an instance in its prototype."""
        if seen.children is None:
            if seen.prim.IsInstance():
                seen.children = self.below(self.shared(seen.prim.GetPrototype()))
            else:
                drawn = seen.prim.IsDefined() and not seen.prim.IsAbstract()
                children = seen.prim.GetFilteredChildren(PREDICATE if drawn else PROTOTYPED)
                seen.children = tuple(map(self.seen, children))
        return seen.children


def source_path(prim: Any) -> str:
    """The path that all instances of a prim share."""
    if prim.IsInstanceProxy():
        return str(prim.GetPrimInPrototype().GetPath())
    return str(prim.GetPath())


def _local(prim: Any) -> tuple[Local, tuple[tuple[str, object], ...]]:
    """A prim's own transform and its faults, as ``Seen`` has them."""
    local = local_of(prim)
    faults: tuple[tuple[str, object], ...] = ()
    if local.mistyped:
        faults = ((local.mistyped, prim.GetAttribute(local.mistyped).Get()),)
    if not np.isfinite(local.matrix).all():
        local = Local(np.eye(4), local.resets, local.moves)
        faults = (*faults, ("xformOpOrder", "a transform that is not finite"))
    return local, faults
