"""The joints that were found, and the bodies they join."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ..model import Joint, Node
from .pairs import Relation


@dataclass(slots=True, eq=False)
class Link:
    """A joint and the bodies it joins (numbers of the assembly; middle bodies come after them)."""

    a: int
    b: int
    joint: Joint

    def changed(self, **changes) -> "Link":
        """The link with another joint, changed so."""
        return Link(self.a, self.b, replace(self.joint, **changes))


@dataclass(slots=True, eq=False)
class Links:
    """All joints of an assembly.  nodes: added middle bodies.  bodies: number of bodies with them.
    aside: explicit joints inside one body or without equations, which the export reports."""

    links: list[Link]
    aside: list[Joint]
    nodes: list[Node]
    bodies: int
    relations: list[Relation]
