"""What MassAPIs say of bodies and colliders: once for all that say the same."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from ....diagnostics import Report
from ....geometry.mass import are_possible, nearest_possible, principal
from ....model import MassProperties
from ....spatial import Array
from ..stage import OpenStage
from ..transforms import EXACT, Stand, rotation_of
from ..values import Values, identity

UNIT = np.eye(3)
NAMES = (
    "physics:mass", "physics:density", "physics:centerOfMass", "physics:diagonalInertia", "physics:principalAxes",
    "newton:inertia",
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Stated:
    """What a MassAPI says, SI; None for nothing.  axes: of the principal frame in the prim's, scene axes.
    whole: where it leaves nothing open."""

    mass: float | None = None
    density: float | None = None
    center: Array | None = None
    moments: Array | None = None
    axes: Array | None = None
    whole: MassProperties | None = None


NOTHING = Stated()


class MassApis:
    """Reads them."""

    def __init__(self, opened: OpenStage, values: Values, report: Report):
        self._opened, self._values, self._report = opened, values, report
        self._known: dict[tuple[object, ...], Stated] = {}

    def of(self, prim: Any, world: Array, stand: Stand | None = None) -> Stated:
        """stand: of the prim's matrix ``world``, where it is known."""
        if "PhysicsMassAPI" not in self._values.traits(prim).schemas:
            return NOTHING
        if stand is None or not stand.rigid:
            linear = world[:3, :3]
            return self._read(prim, (rotation_of(linear) if stand is None else stand.rotation).T @ linear)
        given = [self._values.get(prim, name) for name in NAMES]
        key = (*given, *map(type, given))  # True is 1 and no mass
        found = self._known.get(key)
        if found is None:
            told = len(self._report.diagnostics)
            found = self._read(prim, UNIT)
            if len(self._report.diagnostics) == told:  # else each prim is told of
                self._known[key] = found
        return found

    def _read(self, prim: Any, scale: Array) -> Stated:
        """scale: of the prim's own space."""
        frame = self._opened.frame
        mass = self._values.number(prim, "physics:mass", 0.0)
        density = self._values.number(prim, "physics:density", 0.0)
        moments = self._values.vector(prim, "physics:diagonalInertia", (0.0, 0.0, 0.0))
        least, *_, largest = sorted(moments.tolist())
        negative = least if largest <= 0.0 else 0.0
        for name, found in (
            ("physics:mass", mass),
            ("physics:density", density),
            ("physics:diagonalInertia", negative),
        ):
            if found < 0.0:
                self._values.wrong(prim, name, f"{found:g}")
        center = None
        raw = self._values.array(prim, "physics:centerOfMass")
        if raw is not None and len(raw) == 3 and all(map(math.isfinite, raw.tolist())):
            # In the prim's own space, its scale too.
            if np.abs(scale - UNIT).max() > EXACT:  # else copies of a part differ in their last digits
                raw = scale @ raw
            center = frame.turn @ raw * frame.length
        elif raw is not None and (len(raw) != 3 or np.isnan(raw).any()):
            self._values.wrong(prim, "physics:centerOfMass", raw)
        axes = self._values.rotation(prim, "physics:principalAxes")
        inertia = None
        if largest > 0.0:  # pxr takes what is below 1e-5 for unset, which small bodies in metres are
            inertia = moments * frame.mass * frame.length**2
        tensor = self._values.array(prim, "newton:inertia")
        if tensor is not None and len(tensor) == 6 and np.isfinite(tensor).all():
            xx, yy, zz, xy, xz, yz = (float(v) for v in tensor)
            inertia, axes = principal(
                np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) * frame.mass * frame.length**2
            )
        if inertia is not None and not are_possible(np.sort(inertia)) and inertia.max() > 0.0:
            inertia = nearest_possible(inertia)
            name = identity(prim)
            self._report.approximated(
                f"inertia {name}", "INERTIA_MENDED", self._opened.place(prim), link=name
            )
        stated = (
            mass * frame.mass if mass > 0.0 else None,
            density * frame.mass / frame.length**3 if density > 0.0 else None,
            center,
            inertia,
            None if axes is None else frame.turn @ axes,
        )
        return Stated(*stated, self._whole(*stated))

    def _whole(
        self, mass: float | None, _: float | None, center: Array | None, moments: Array | None, axes: Array | None
    ) -> MassProperties | None:  # fmt: skip
        """Without principal axes along the prim's own."""
        if mass is None or center is None or moments is None:
            return None
        turn = self._opened.frame.turn if axes is None else axes
        return MassProperties(mass, center, (turn * moments) @ turn.T)
