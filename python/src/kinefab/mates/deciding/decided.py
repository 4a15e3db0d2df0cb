"""What was decided of an assembly."""

from __future__ import annotations

from dataclasses import dataclass

from .bodies import Bodies
from .edge import Edge


@dataclass(slots=True, eq=False)
class Decided:
    """bodies: with all fixings.  edges: the joints between them, without the seats that turned out to be stops."""

    bodies: Bodies
    edges: list[Edge]
