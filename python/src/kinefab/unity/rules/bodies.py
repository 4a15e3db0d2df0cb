"""Rigidbodies, and what an ArticulationBody has like one."""

from __future__ import annotations

from .findings import Entry, Findings
from .shape import NOTHING

ROUNDED = 1e-4
"""By how much a flat body's largest moment may exceed the sum of the others, which it equals but for rounding."""


def check_body(body: Entry, at: str, found: Findings) -> None:
    """Positive mass and moments; and no real body has a moment that exceeds the sum of the others."""
    mass = body.get("mass", 1)
    if not mass > 0:
        found.add("BODY_MASS_NOT_POSITIVE", f"{at}/mass", mass=mass)
    elif mass <= NOTHING:
        found.add("NUMBER_BELOW_FLOAT32", f"{at}/mass", number=mass)
    moments = body.get("inertiaTensor", (1, 1, 1))
    least, largest = min(moments), max(moments)
    if not least > 0:
        found.add("BODY_INERTIA_NOT_POSITIVE", f"{at}/inertiaTensor", inertia=_listed(moments))
    elif largest > (sum(moments) - largest) * (1 + ROUNDED):
        found.add("BODY_INERTIA_TRIANGLE", f"{at}/inertiaTensor", inertia=_listed(moments))
    elif least <= NOTHING:
        found.add("NUMBER_BELOW_FLOAT32", f"{at}/inertiaTensor", number=least)


def _listed(moments: object) -> str:
    return ", ".join(map(str, moments)) if isinstance(moments, (list, tuple)) else ""
