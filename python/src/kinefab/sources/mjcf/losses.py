"""What a model holds beside mechanism and shape: left out by name, with the numbers that a script would need."""

from __future__ import annotations

import numpy as np

from ...diagnostics import Report
from .engine import Compiled
from .equalities import Equalities

UNREAD = (
    ("sensor", "nsensor"),
    ("light", "nlight"),
    ("skin", "nskin"),
    ("flex", "nflex"),
    ("plugin", "nplugin"),
    ("numeric", "nnumeric"),
    ("tuple", "ntuple"),
)
"""Kinds that have no place in a scene, and where MuJoCo counts them."""


KEPT_ALL_THE_SAME = (
    "constraint",
    "equality",
    "frictionloss",
    "limit",
    "contact",
    "passive",
    "spring",
    "damper",
    "actuation",
)


def tell_losses(compiled: Compiled, equalities: Equalities, report: Report) -> None:
    """Tell what the compiled model holds that nothing reads."""
    m = compiled.model
    for kind, count in UNREAD:
        for i in range(int(getattr(m, count))):
            named = callable(getattr(m, kind, None))  # of plug-ins the model has numbers alone
            name = compiled.name(kind, i) if named else ""
            where = compiled.files.nth(kind, i, m.nsensor) if kind == "sensor" else compiled.where(kind, name)
            report.dropped(f"{kind} {name or i}", "MJCF_LEFT_OUT", where)
    _tell_options(compiled, report)
    for i in range(m.ntendon):
        _tell_tendon(compiled, equalities, i, report)


def _tell_options(compiled: Compiled, report: Report) -> None:
    """What surrounds the bodies, and what MuJoCo is asked to leave away that the scene has all the same."""
    options, flags = compiled.model.opt, compiled.mujoco.mjtDisableBit
    where = next((e.where for e in compiled.files.all("option")), compiled.files.path.name)
    for word, plain in (("wind", 0.0), ("density", 0.0), ("viscosity", 0.0)):
        value = np.atleast_1d(getattr(options, word))
        if np.any(value != plain):
            numbers = " ".join(f"{v:g}" for v in value)
            report.dropped(f"{word} {numbers}", "MJCF_LEFT_OUT", where)
    for word in KEPT_ALL_THE_SAME:
        bit = getattr(flags, f"mjDSBL_{word.upper()}", None)  # 3.3 has one for springs and dampers together
        if bit is not None and int(options.disableflags) & int(bit):
            report.dropped(f"flag {word}='disable'", "MJCF_LEFT_OUT", where)


def _tell_tendon(compiled: Compiled, equalities: Equalities, i: int, report: Report) -> None:
    """A tendon moves nothing by itself: its range, spring, friction and actuators do."""
    m = compiled.model
    name = compiled.name("tendon", i) or f"tendon {i}"
    spatial = equalities.fixed_terms(i) is None
    numbers: list[str] = []
    if m.tendon_limited[i]:
        numbers.append(f"range {m.tendon_range[i][0]:g} {m.tendon_range[i][1]:g}")
    for word in ("stiffness", "damping", "frictionloss", "armature"):
        if (value := float(getattr(m, f"tendon_{word}")[i])) != 0.0:
            numbers.append(f"{word} {value:g}")
    if m.tendon_stiffness[i]:
        numbers.append("springlength " + " ".join(f"{v:g}" for v in m.tendon_lengthspring[i]))
    if not (numbers or spatial):
        return  # a sum that only an equality, an actuator or a sensor speaks of: told there
    kind = "spatial" if spatial else "fixed"
    report.dropped(
        f"tendon {name}",
        "MJCF_TENDON",
        compiled.files.nth("tendon", i, m.ntendon),
        tendon=name,
        kind=kind,
        numbers=", ".join(numbers) or "no range or spring",
    )
