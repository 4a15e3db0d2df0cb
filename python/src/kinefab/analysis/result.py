"""What an analysis finds, as plain data."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Callable

from ..diagnostics import Report
from ..model import Coupling, Joint, Node, Scene
from ..rigid import RigidGroups
from ..spatial import Array, Pose
from .closing import Gap


@dataclass(frozen=True, slots=True, eq=False)
class NodeFreedom:
    """What is left of a node's six freedoms against ground, first order at the closed pose.

    translations: shape (t, 3), unit, WORLD, pure translations.  rotations: shape (r, 3), unit, WORLD.
    center: WORLD, a point of the rotation axes, or None where they have none in common.
    """

    node: int
    translations: Array
    rotations: Array
    center: Array | None = None

    @property
    def dof(self) -> int:
        return len(self.translations) + len(self.rotations)


@dataclass(frozen=True, slots=True)
class IdleFreedom:
    """Freedoms of some nodes that move nothing else, such as a rod's spin."""

    nodes: tuple[int, ...]
    count: int


@dataclass(frozen=True, slots=True)
class Island:
    """Rigid groups that hang together by joints, ground left out.

    nodes: in scene order.  floating: nothing joins it to ground, six of its freedoms are its own.
    """

    nodes: tuple[int, ...]
    mobility: int
    first_order: int
    rows: int
    redundant: int
    loops: int
    floating: bool


@dataclass(eq=False)
class Analysis:
    """A mechanism, understood.

    source: the scene as given.  mobility: freedoms of finite motion; first_order: of the velocities at the
    closed pose.  rows, rank, redundant: of all constraint equations between the source's bodies.
    groups: the rigid groups, with what the constraints fix.  fixed: pairs of nodes that constraints fix to
    each other (None: ground).  joints, couplings: what to export.  nodes: middle bodies, to be appended to
    the scene's.  poses: of the scene's own nodes with every constraint closed.
    because: for nodes fixed to others, the constraints that do it.
    """

    source: Scene
    mobility: int
    first_order: int
    rows: int
    rank: int
    groups: RigidGroups
    fixed: tuple[tuple[int | None, int], ...]
    islands: list[Island]
    idle: list[IdleFreedom]
    joints: list[Joint]
    couplings: list[Coupling]
    nodes: list[Node]
    poses: list[Pose]
    gaps: list[Gap]
    worst_gap: tuple[float, float]
    contradictory: list[str]
    report: Report
    find_freedoms: Callable[[], list[NodeFreedom]] = field(repr=False)
    find_relation: Callable[[int, int], object] = field(repr=False)

    @property
    def redundant(self) -> int:
        return self.rows - self.rank

    @cached_property
    def freedoms(self) -> list[NodeFreedom]:
        """Of every part, in scene order."""
        return self.find_freedoms()

    def between(self, a: int, b: int):
        """The effective joint of node ``b`` against node ``a`` (see ``effective.Effective``)."""
        return self.find_relation(a, b)

    def scene(self, solved: bool = False) -> Scene:
        """The scene to export: the found joints instead of the given ones, middle bodies added.

        solved: with every part moved to the closed pose.
        """
        base = self.source.with_poses(self.poses) if solved else self.source
        return replace(base, nodes=[*base.nodes, *self.nodes], joints=self.joints, couplings=self.couplings)
