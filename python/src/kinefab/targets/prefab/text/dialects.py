"""What editors of different years write differently.  Newer ones read what older ones wrote."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Pipeline(str, Enum):
    """Which render pipeline the materials are for."""

    BUILTIN = "builtin"
    URP = "urp"
    HDRP = "hdrp"


@dataclass(frozen=True, slots=True, eq=False)
class Dialect:
    """Versions of the classes (``serializedVersion``, 1 is not written) and what came with them.

    root_order: a Transform states its place among its siblings (until 2022.3.4).  mass_properties: a Rigidbody holds centre of mass and
    inertia (from 2022.2), layer_overrides: and colliders their layers.  valid_keywords: a material lists them one by one.
    urp_material: of URP's own count of changes to its materials, see ``assets.materials``.
    """

    name: str
    root_order: bool
    mass_properties: bool
    layer_overrides: bool
    valid_keywords: bool
    rigidbody: int
    box: int
    sphere: int
    capsule: int
    mesh_collider: int
    hinge: int
    configurable: int
    drive: int
    articulation: int
    transform: int
    clip: int
    animation: int
    material: int
    urp_material: int
    physics_material: int


_2021 = Dialect("2021", True, False, False, False, 2, 2, 2, 1, 4, 1, 2, 3, 3, 1, 6, 3, 6, 5, 1)
_2022 = Dialect("2022", True, True, True, True, 4, 3, 3, 2, 5, 2, 3, 4, 5, 1, 7, 3, 8, 7, 1)
_6 = Dialect("6", False, True, True, True, 4, 3, 3, 2, 5, 3, 4, 4, 5, 2, 7, 4, 8, 7, 2)

DIALECTS = {dialect.name: dialect for dialect in (_2021, _2022, _6)}
"""2021.2, 2022.2 and 6000.0, by the type trees of those editors; an articulation's of 2021.2.1, as 2021.2.0 alone has version 2, which
every later one changes in a way that is not public."""
