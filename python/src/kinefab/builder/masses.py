"""What a script says of a part's mass, as the model's."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..model import MassProperties
from .arguments import ROUNDED, checked_number, checked_positive, checked_vector, numbers_in, shown


def weight_of(name: str, mass: Any, density: Any) -> dict[str, Any]:
    """The fields of a part's node that say what it weighs; a density is its bodies'.

    mass: kg, ``MassProperties``, or None.  density: kg/m^3, or None.  Raises ValueError for both, and for what is not above zero.
    """
    if density is not None:
        checked_positive(f"the density of {name}", density)
    if mass is None:
        return {}
    if density is not None:
        raise ValueError(
            f"{name} has a mass, {shown(mass)}, and a density, {shown(density)}; pass one of them"
        )
    if isinstance(mass, MassProperties):
        return {"mass": _checked(name, mass)}
    return {"kilograms": checked_positive(f"the mass of {name}", mass)}


def _checked(name: str, mass: MassProperties) -> MassProperties:
    """With arrays for what may be lists.  Raises ValueError for one whose center or inertia has another shape, or whose
    inertia is not symmetric."""
    number = checked_number(f"the mass of {name}", mass.mass)
    inertia = numbers_in(mass.inertia)
    if inertia is None or inertia.shape != (3, 3) or not np.isfinite(inertia).all():
        raise ValueError(f"the inertia of {name} is {shown(mass.inertia)}; pass a matrix of numbers, 3 x 3")
    if np.abs(inertia - inertia.T).max() > ROUNDED * np.abs(inertia).max():
        raise ValueError(f"the inertia of {name} is not symmetric; pass each product in both its places")
    return MassProperties(number, checked_vector(f"the center of {name}'s mass", mass.center), inertia)
