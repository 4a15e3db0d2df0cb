"""MuJoCo's actuators on a stage (``MjcActuator``) as drives of the joints that they act on, where Unity's law is theirs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

from ....diagnostics import Report
from ....model import RX, Joint, Motion, Passive
from ...robots.actuation import APART, FORCE, GROWS, LAG, UNEVEN, Law, bounded, clipped_apart, drive_of
from ..values import Values, identity
from .couplings import Couplings
from .freedoms import Units
from .vendor import limited

KIND = "MjcActuator"
LAGGING = ("filter", "filterexact")


@dataclass(frozen=True, slots=True, eq=False)
class _Acting:
    """An actuator on the freedom of a joint.  law: SI, counted as the joint counts.  reason: what the drive is not."""

    prim: Any
    law: Law
    reason: str


class Actuators:
    """Reads actuators.  couplings: knows by which freedom a joint prim moves."""

    def __init__(self, couplings: Couplings, units: Units, values: Values, report: Report):
        self._couplings, self._units, self._values, self._report = couplings, units, values, report

    def drive(self, prims: Sequence[Any], joints: Sequence[Joint]) -> list[Joint]:
        """The joints, with the drives that the actuators make."""
        acting: dict[tuple[str, int], list[_Acting]] = {}
        for prim in prims:
            self._read(prim, acting)
        return [self._driven(joint, acting) for joint in joints]

    def _read(self, prim: Any, acting: dict[tuple[str, int], list[_Acting]]) -> None:
        targets = self._values.targets(prim, "mjc:target")
        end = self._couplings.coordinate(str(targets[0])[1:]) if len(targets) == 1 else None
        reason = self._unlike(prim)
        if end is None:
            reason = "it acts on no joint with one coordinate"
        elif end[0].freedoms[end[1]].drive is not None:
            reason = "its joint has a DriveAPI, which was taken"
        if end is None or reason:
            self._tell(prim, reason, dropped=True)
            return
        joint, freedom, sense = end
        owner = self._values.opened.stage.GetPrimAtPath(targets[0])
        law, reason = self._law(joint, freedom, sense, prim, owner)
        acting.setdefault((joint.id, freedom), []).append(_Acting(prim, law, reason))

    def _law(self, joint: Joint, freedom: int, sense: float, prim: Any, owner: Any) -> tuple[Law, str]:
        """owner: the joint's prim."""
        turns = freedom >= RX
        gear, gain, bias = self._first(prim, "gear", 1.0), self._first(prim, "gainPrm", 1.0), self._bias(prim)
        reason = LAG if self._values.word(prim, "mjc:dynType", "none") in LAGGING else ""
        low, high = limited(prim, "mjc:forceRange", "mjc:forceLimited", self._values)
        if low != -high:
            reason = UNEVEN
        most = abs(gear) * max(abs(low), abs(high)) if gear else 0.0
        low, high = self._control(prim, joint, freedom, sense)
        control = min(max(0.0, low), high)
        unit, angle = self._units.force(turns), self._units.mujoco_gain(turns)
        # MuJoCo counts from the joint's reference, which the bodies stand at where the stage counts zero.
        zero = self._values.number(owner, "mjc:ref", 0.0) * self._units.mujoco_coordinate(turns)
        stiffness, damping = -bias[1] * gear * gear * angle, -bias[2] * gear * gear * angle
        constant = gear * (gain * control + bias[0]) * unit - stiffness * zero
        law = Law(sense * constant, stiffness, damping, most * unit)
        if law.is_force:
            reach = max(abs(low), abs(high)) if gear * gain else 0.0
            law = replace(law, most=min(most, abs(gear * gain) * reach if reach else 0.0) * unit)
            return law, FORCE
        return law, reason

    def _control(self, prim: Any, joint: Joint, freedom: int, sense: float) -> tuple[float, float]:
        """The range of the control."""
        share = self._values.number(prim, "mjc:inheritRange", 0.0)
        own = joint.freedoms[freedom]
        if share > 0.0 and own.motion is Motion.LIMITED:
            unit = 1.0 if freedom >= RX else self._units.opened.frame.length
            middle, half = 0.5 * sense * (own.lower + own.upper), 0.5 * share * (own.upper - own.lower)
            return (middle - half) / unit, (middle + half) / unit
        return limited(prim, "mjc:ctrlRange", "mjc:ctrlLimited", self._values)

    def _driven(self, joint: Joint, acting: dict[tuple[str, int], list[_Acting]]) -> Joint:
        freedoms = list(joint.freedoms)
        for i, freedom in enumerate(freedoms):
            several = acting.get((joint.id, i), [])
            laws = [one.law for one in several if not one.law.is_force]
            for one in several:
                self._tell(one.prim, one.reason or (APART if clipped_apart(laws) else ""))
            if laws:
                freedoms[i] = replace(freedom, drive=bounded(drive_of(laws), freedom.passive))
            elif several:
                passive = freedom.passive or Passive()
                effort = min(passive.effort, math.fsum(one.law.most for one in several))
                freedoms[i] = replace(freedom, passive=replace(passive, effort=effort))
        return replace(joint, freedoms=tuple(freedoms))

    def _unlike(self, prim: Any) -> str:
        """Why no drive of Unity acts so, "" where one does."""
        for name, default, known in (
            ("dynType", "none", ("none", *LAGGING)),
            ("gainType", "fixed", ("fixed",)),
            ("biasType", "none", ("none", "affine")),
        ):
            word = self._values.word(prim, f"mjc:{name}", default)
            if word not in known:
                return f"its {name} is '{word}'"
        if self._bias(prim)[2] > 0.0:
            return "its damping is a ratio, which MuJoCo alone works out"
        return GROWS if self._bias(prim)[1] > 0.0 else ""

    def _bias(self, prim: Any) -> tuple[float, float, float]:
        values = self._values.array(prim, "mjc:biasPrm")
        if self._values.word(prim, "mjc:biasType", "none") != "affine" or values is None:
            return 0.0, 0.0, 0.0
        a, b, c = (*values[:3].tolist(), 0.0, 0.0, 0.0)[:3]
        if not all(map(math.isfinite, (a, b, c))):
            self._values.wrong(prim, "mjc:biasPrm", values)
            return 0.0, 0.0, 0.0
        return a, b, c

    def _first(self, prim: Any, name: str, default: float) -> float:
        values = self._values.array(prim, f"mjc:{name}")
        if values is None:
            return default
        if not math.isfinite(values[0]):
            self._values.wrong(prim, f"mjc:{name}", values)
            return default
        return float(values[0])

    def _tell(self, prim: Any, reason: str, dropped: bool = False) -> None:
        feature, where = f"{KIND} {identity(prim)}", self._values.opened.place(prim)
        gear, gain = (self._first(prim, name, 1.0) for name in ("gear", "gainPrm"))
        numbers = f"gear {gear:g}, gain {gain:g}, bias {' '.join(f'{b:g}' for b in self._bias(prim))}"
        reason = reason and f"{reason} ({numbers})"
        if dropped:
            self._report.dropped(feature, "USD_FEATURE_DROPPED", where, detail=reason)
        elif reason:
            self._report.approximated(feature, "USD_FEATURE_APPROXIMATED", where, detail=reason)
        else:
            self._report.kept(feature, where)
