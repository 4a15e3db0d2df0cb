"""The compiled model's tree of bodies as links, and by which of its joints each hangs on the one before it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from ...diagnostics import Report
from ...spatial import Pose
from ..robots.rigid_links import Link, unique
from .bodies import Bodies
from .engine import Compiled, pose_of
from .joints import is_free, planned
from .stacks import Step


@dataclass(frozen=True, slots=True, eq=False)
class Hung:
    """One step of a body's joints, from link a (None: the world) to link b.  before: the body's frame, nothing moved, in
    link a or the world, MuJoCo's axes."""

    step: Step
    before: Pose
    a: int | None
    b: int


@dataclass(slots=True)
class Tree:
    """links: of the bodies, and light ones between the steps of a body's joints.  of: each body's link, None for a world
    without anything of its own.  fixed: pairs of links that nothing moves against each other."""

    compiled: Compiled
    bodies: Bodies
    report: Report
    links: list[Link] = field(default_factory=list[Link])
    of: list[int | None] = field(default_factory=list["int | None"])
    hung: list[Hung] = field(default_factory=list[Hung])
    fixed: list[tuple[int, int]] = field(default_factory=list[tuple[int, int]])
    _labels: dict[str, str] = field(default_factory=dict[str, str])

    def __post_init__(self) -> None:
        self._labels = {name: name for name in self.compiled.bodies}
        for body in range(self.compiled.model.nbody):
            self._add(body)

    @property
    def joined(self) -> list[tuple[int, int]]:
        """Pairs of links with a joint between them."""
        return [(hung.a, hung.b) for hung in self.hung if hung.a is not None]

    def _add(self, body: int) -> None:
        if body == 0 and not _has_something(self.compiled):
            self.of.append(None)
            return
        parent = self.of[int(self.compiled.model.body_parentid[body])] if body else None
        if steps := planned(self.compiled, body):
            self._hang(body, parent, steps)
        else:
            self._place(body, parent)
        self.of.append(len(self.links) - 1)

    def _hang(self, body: int, parent: int | None, steps: Sequence[Step]) -> None:
        m = self.compiled.model
        before, last = pose_of(m.body_pos[body], m.body_quat[body]), parent
        pose = self.compiled.body_pose(int(m.body_parentid[body])) @ before
        outer = len(self.links) + len(steps) - 1
        for number, step in enumerate(steps):
            for axis in step.axes:
                pose = pose @ axis.moved()
            outermost = number == len(steps) - 1
            self.links.append(self._link(body) if outermost else self._between(body, step, pose, outer))
            here = len(self.links) - 1
            self.hung.append(Hung(step, before, last, here))
            before, last = Pose(), here

    def _place(self, body: int, parent: int | None) -> None:
        """A body without joints, or with a free one."""
        link = self._link(body)
        self.links.append(link)
        if link.kinematic or is_free(self.compiled, body):
            return
        link.grounded = int(self.compiled.model.body_parentid[body]) == 0
        if not link.grounded and parent is not None:
            self.fixed.append((parent, len(self.links) - 1))

    def _link(self, body: int) -> Link:
        return self.bodies.link(body, self.compiled.bodies[body], self.compiled.body_pose(body))

    def _between(self, body: int, step: Step, pose: Pose, helped: int) -> Link:
        """The light body behind a step that is not the last.  pose: in the world, MuJoCo's axes.
        helped: link of the body."""
        compiled = self.compiled
        own = compiled.bodies[body]
        label = unique(self._labels, f"{own} {compiled.joints[step.axes[-1].index]}")
        self._labels[label] = label
        link = Link(
            f"{self.bodies.root}/{label}", label, pose, compiled.where("body", compiled.name("body", body))
        )
        link.parent, link.helps = 0, helped
        self.report.approximated(
            f"joints of {own}", "MJCF_MIDDLE_BODY", link.where, body=own, middle=label
        )  # fmt: skip
        return link


def _has_something(compiled: Compiled) -> bool:
    """Whether the world has shapes or frames of its own."""
    m = compiled.model
    return bool(m.body_geomnum[0]) or bool(np.any(np.asarray(m.site_bodyid) == 0))
