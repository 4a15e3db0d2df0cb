"""The joints that were found, and the bodies they join."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from ...findings import JointFinding
from ...model import RX, Joint, Node, Scene
from ..pairs.relations import Relation


@dataclass(slots=True, eq=False)
class Link:
    """A joint, the bodies it joins (numbers of the assembly; middle bodies come after them) and what was found of it."""

    a: int
    b: int
    joint: Joint
    finding: JointFinding

    def changed(self, **changes: Any) -> Link:
        """The link with its joint changed so."""
        return replace(self, joint=replace(self.joint, **changes))

    def found(self, **changes: Any) -> Link:
        """The link with what was found of its joint changed so."""
        return replace(self, finding=replace(self.finding, **changes))

    def coordinate(self, freedom: int, scene: Scene) -> float:
        """Where the joint stands on a freedom TX..RZ in a scene, metres or radians from where its frames meet.

        Zero at the closed pose for joints that were found there; a joint of the source may have its zero anywhere.
        """
        frames = [
            scene.pose(n) @ f
            for n, f in ((self.joint.a, self.joint.frame_a), (self.joint.b, self.joint.frame_b))
        ]
        relative = frames[0].inverse() @ frames[1]
        axis, across, third = freedom % 3, (freedom + 1) % 3, (freedom + 2) % 3
        if freedom < RX:
            return float(relative.translation[axis])
        turned = relative.rotation[:, across]
        return self.joint.freedoms[freedom].nearest_turn(math.atan2(turned[third], turned[across]))


@dataclass(slots=True, eq=False)
class Links:
    """All joints of an assembly.  nodes: added middle bodies.  bodies: number of bodies with them.
    aside: explicit joints inside one body or without equations, which the export reports."""

    links: list[Link]
    aside: list[Joint]
    nodes: list[Node]
    bodies: int
    relations: list[Relation]
