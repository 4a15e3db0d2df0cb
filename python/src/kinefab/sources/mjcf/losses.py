"""What a model holds beside mechanism and shape: left out by name, with the numbers that a script would need."""

from __future__ import annotations

from ...diagnostics import Report
from .engine import Compiled
from .equalities import Equalities

UNREAD = (
    ("sensor", "nsensor"),
    ("light", "nlight"),
    ("skin", "nskin"),
    ("flex", "nflex"),
    ("plugin", "nplugin"),
)
"""Kinds that have no place in a scene, and where MuJoCo counts them."""


def tell_losses(compiled: Compiled, equalities: Equalities, report: Report) -> None:
    m = compiled.model
    for kind, count in UNREAD:
        for i in range(int(getattr(m, count))):
            named = callable(getattr(m, kind, None))  # of plug-ins the model has numbers alone
            name = compiled.name(kind, i) if named else ""
            report.dropped(f"{kind} {name or i}", "MJCF_LEFT_OUT", compiled.where(kind, name))
    for i in range(m.ntendon):
        _tell_tendon(compiled, equalities, i, report)


def _tell_tendon(compiled: Compiled, equalities: Equalities, i: int, report: Report) -> None:
    """A tendon moves nothing by itself: its range, spring, friction and actuators do."""
    m = compiled.model
    name = compiled.name("tendon", i) or f"tendon {i}"
    spatial = equalities.fixed_terms(i) is None
    numbers: list[str] = []
    if m.tendon_limited[i]:
        numbers.append(f"range {m.tendon_range[i][0]:g} {m.tendon_range[i][1]:g}")
    for word in ("stiffness", "damping", "frictionloss"):
        if (value := float(getattr(m, f"tendon_{word}")[i])) != 0.0:
            numbers.append(f"{word} {value:g}")
    if not (numbers or spatial):
        return  # a sum that only an equality, an actuator or a sensor speaks of: told there
    kind = "spatial" if spatial else "fixed"
    report.dropped(
        f"tendon {name}",
        "MJCF_TENDON",
        compiled.where("tendon", name),
        tendon=name,
        kind=kind,
        numbers=", ".join(numbers) or "no range or spring",
    )
