"""Where prims stand over time, those of a PointInstancer's copies each at its own place."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...spatial import Array
from .api import Usd
from .found import Found
from .transforms import Local, local_of, placed


class Placing:
    """World matrices by time, shape (4, 4).  Prims are named by their keys, a slash before the id of a node."""

    def __init__(self, found: Found, stage: Any):
        self._animated, self._copies, self._stage = found.animated, found.copies, stage
        self._prims: dict[str, Any] = {}
        self._still: dict[str, Local] = {}
        self._known: dict[tuple[str, float], Array] = {}

    def moved_by(self, key: str, above: str) -> set[str]:
        """Paths of what moves a prim against one above it ("": the world), which it may be told to ignore."""
        own = self._chain(key)
        if not above:
            found = own
        elif above in own:
            found = own[: own.index(above)]
        else:
            found = [*own, *self._chain(above)]
        return {path for each in found if (path := str(self.prim(each).GetPath())) in self._animated}

    def is_finite(self, key: str, above: str, times: Array) -> bool:
        """Of both at all times."""
        return all(bool(np.isfinite(self.world(k, t)).all()) for t in times.tolist() for k in (key, above))

    def prim(self, key: str) -> Any:
        """The pseudo root for ""."""
        if key not in self._prims:
            parent, _, name = key.rpartition("/")
            if not key:
                found = self._stage.GetPseudoRoot()
            elif key in self._copies:
                found = self._copies[key].prototype
            else:
                found = self._stage.GetPrimAtPath(self.prim(parent).GetPath().AppendChild(name))
            self._prims[key] = found
        return self._prims[key]

    def world(self, key: str, time: float) -> Array:
        """World matrix of a prim at a time code, shape (4, 4), for column vectors; the identity for no key."""
        if not key:
            return np.eye(4)
        if (key, time) not in self._known:
            copy = self._copies.get(key)
            if copy is None:
                above = self.world(key.rpartition("/")[0], time)
            else:
                above = self.world(copy.instancer, time) @ copy.placing
            self._known[key, time] = placed(above, self._local(key, time))
        return self._known[key, time]

    def _local(self, key: str, time: float) -> Local:
        prim = self.prim(key)
        if str(prim.GetPath()) in self._animated:
            return local_of(prim, Usd.TimeCode(time))
        if key not in self._still:
            self._still[key] = local_of(prim)
        return self._still[key]

    def _chain(self, key: str) -> list[str]:
        """The key and those above it, up to the one that ignores what is above."""
        found: list[str] = []
        while key:
            found.append(key)
            if self._local(key, 0.0).resets:
                break
            copy = self._copies.get(key)
            key = key.rpartition("/")[0] if copy is None else copy.instancer
        return found
