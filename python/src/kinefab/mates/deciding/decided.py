"""What was decided of an assembly."""

from __future__ import annotations

from dataclasses import dataclass, field

from .bodies import Bodies
from .edge import Edge


@dataclass(slots=True, eq=False)
class Decided:
    """bodies: with all fixings.  edges: the joints between them, those left out not among them."""

    bodies: Bodies
    edges: list[Edge]
    stops: list[Edge] = field(default_factory=list[Edge])
