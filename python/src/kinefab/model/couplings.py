"""Couplings between joint coordinates: gears, racks, screws, mimics."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class CouplingKind(str, Enum):
    GEAR = "gear"
    BELT = "belt"
    RACK = "rack"
    SCREW = "screw"
    LINEAR = "linear"


@dataclass(frozen=True, slots=True)
class Term:
    """``ratio`` times a joint coordinate.  joint: its id.  freedom: TX..RZ.  ratio: metres and radians."""

    joint: str
    freedom: int
    ratio: float


@dataclass(frozen=True, slots=True, eq=False)
class Coupling:
    """``q = sum of term.ratio * q_term + offset`` between joint coordinates, metres and radians.

    joint, freedom: the coordinate q, by the id of its joint and TX..RZ.  Ids, since the analysis orders and adds joints.
    terms: what it follows, one for a gear, a rack, a mimic (of a screw: a coordinate of the same joint).

    >>> import kinefab
    >>> scene = kinefab.Scene()
    >>> for name, x in (("Sun", 0), ("Gear", 0.06)):
    ...     hinge = scene.add_hinge(None, scene.add_part(name), point=(x, 0, 0), axis=(0, 0, 1), name=name)
    >>> gear = scene.add_coupling("Sun", "Gear", ratio=-0.5)
    >>> gear.joint, gear.terms[0].joint, gear.terms[0].ratio
    ('Gear', 'Sun', -0.5)
    """

    id: str
    kind: CouplingKind
    joint: str
    freedom: int
    terms: tuple[Term, ...]
    offset: float = 0.0
    where: str = ""

    @property
    def joints(self) -> frozenset[str]:
        """Ids of all joints that it counts from.

        >>> scene = kinefab.Scene()
        >>> for name, x in (("Sun", 0), ("Gear", 0.06)):
        ...     hinge = scene.add_hinge(None, scene.add_part(name), point=(x, 0, 0), axis=(0, 0, 1), name=name)
        >>> sorted(scene.add_coupling("Sun", "Gear", ratio=-0.5).joints)
        ['Gear', 'Sun']
        """
        return frozenset((self.joint, *(term.joint for term in self.terms)))
