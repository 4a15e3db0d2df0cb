"""A joint between two bodies as far as it is decided, and all that is decided of an assembly."""

from __future__ import annotations

from dataclasses import dataclass

from ...spatial import Array
from ..touching.contact import Contact
from .bodies import Bodies
from .freedom import Scale


@dataclass(frozen=True, slots=True, eq=False)
class Twin:
    """Two parts whose joint is sure, and the copies of them that take theirs from it.  contacts: of the sure ones."""

    part: int
    other: int
    copy: int
    other_copy: int
    contacts: tuple[Contact, ...]


@dataclass(slots=True, eq=False)
class Edge:
    """A pair of bodies with its contacts.  space: twists left free, chosen.  otherwise: what it would be as the doubtful
    case, None where there is no doubt.  one_sided: nothing in it holds both ways.

    parts: a part of either body, where contacts do not say which.  twin: what the joint was taken from; with ``otherwise``
    in its place, from nothing."""

    pair: tuple[int, int]
    contacts: list[Contact]
    scale: Scale
    space: Array
    confidence: float
    reason: str
    otherwise: Array | None = None
    one_sided: bool = False
    area: float = 0.0
    parts: tuple[int, int] = (-1, -1)
    twin: Twin | None = None
    swapped: bool = False


@dataclass(slots=True, eq=False)
class Decided:
    """bodies: with all fixings.  edges: the joints between them, without the seats that turned out to be stops."""

    bodies: Bodies
    edges: list[Edge]
