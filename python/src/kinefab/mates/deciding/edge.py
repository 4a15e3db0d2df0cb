"""A joint between two bodies as far as it is decided."""

from __future__ import annotations

from dataclasses import dataclass

from ...spatial import Array
from ..touching.contact import Contact
from .freedom import Scale


@dataclass(slots=True, eq=False)
class Edge:
    """A pair of bodies with its contacts.  space: twists left free, chosen.  otherwise: what it would be as the doubtful
    case, None where there is no doubt.  one_sided: nothing in it holds both ways."""

    pair: tuple[int, int]
    contacts: list[Contact]
    scale: Scale
    space: Array
    confidence: float
    reason: str
    otherwise: Array | None = None
    one_sided: bool = False
    area: float = 0.0
