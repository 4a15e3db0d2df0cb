"""The joints that were found, and the bodies they join."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

from ...findings import JointFinding
from ...model import RX, TX, Joint, Node, Scene
from ...spatial import Array
from ..pairs.relations import Relation

ALONG = 1.0 - 1e-6
"""Cosine above which two directions are one."""


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

    def freedom_along(
        self, direction: Array, turning: bool, body: int, scene: Scene
    ) -> tuple[int, float] | None:
        """The freedom TX..RZ along or (``turning``) about a direction of the WORLD, and the sign by which it counts the
        motion of ``body``, one of the two; None where it has none."""
        axes = (scene.pose(self.joint.a) @ self.joint.frame_a).rotation
        first = RX if turning else TX
        for i in range(3):
            cosine = float(direction @ axes[:, i])
            if abs(cosine) > ALONG and first + i in self.joint.unlocked:
                return first + i, math.copysign(1.0, cosine) * (1.0 if self.b == body else -1.0)
        return None

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
