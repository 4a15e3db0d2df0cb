"""What an analysis finds, as plain data."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

from ...diagnostics import Report
from ...findings import JointFinding
from ...model import Coupling, Joint, Node, Scene
from ...rigid import RigidGroups
from ...spatial import Pose
from ..assembly.assemble import Assembly
from ..assembly.closing import Gap
from ..driving.drive import Drive
from ..freedom.finite import Candidate
from ..ranges.limits import JointRange
from .effective import Effective, effective
from .freedoms import NodeFreedom, node_freedoms
from .idle import IdleFreedom
from .islands import Island


@dataclass(eq=False)
class Analysis:
    """A mechanism, understood.

    source: the scene as given.  mobility: freedoms of finite motion; first_order: of the velocities at the
    closed pose.  rows, rank, redundant: of all constraint equations between the source's bodies.
    groups: the rigid groups, with what the constraints fix.  fixed: pairs of nodes that constraints fix to
    each other (None: ground).  built: see ``built_together``.  joints, couplings: what to export.  findings: of each joint, by its id.  nodes: middle bodies, to be appended to
    the scene's.  poses: of the scene's own nodes with every constraint closed.
    ranges: of hinges and slides that close no loop, when asked for.  singular: see ``singular_joints``.
    held: of the same mechanism with the bodies that scripts lead standing still, where there are any: what mobility,
    first_order, rows, rank, islands, idle and freedoms are those of.
    """

    source: Scene
    mobility: int
    first_order: int
    rows: int
    rank: int
    groups: RigidGroups
    fixed: tuple[tuple[int | None, int], ...]
    built: tuple[tuple[int, int], ...]
    islands: list[Island]
    idle: list[IdleFreedom]
    joints: list[Joint]
    findings: Mapping[str, JointFinding]
    couplings: list[Coupling]
    nodes: list[Node]
    poses: list[Pose]
    ranges: list[JointRange]
    gaps: list[Gap]
    worst_gap: tuple[float, float]
    contradictory: list[str]
    report: Report
    assembly: Assembly = field(repr=False)
    singular: Mapping[int, Candidate] = field(repr=False)
    held: Analysis | None = field(default=None, repr=False)

    @property
    def redundant(self) -> int:
        return self.rows - self.rank

    @cached_property
    def stated_joints(self) -> frozenset[str]:
        """Ids of the source's own joints."""
        return frozenset(joint.id for joint in self.source.joints)

    @cached_property
    def freedoms(self) -> list[NodeFreedom]:
        """Of every part, in scene order."""
        if self.held is not None:
            return self.held.freedoms
        return node_freedoms(self.assembly, self.singular)

    def between(self, a: int, b: int) -> Effective:
        """The effective joint of node ``b`` against node ``a``."""
        return effective(self.assembly, *(int(self.assembly.body[node + 1]) for node in (a, b)))

    def drive(self, *coordinates: tuple[str, int]) -> Drive:
        """The mechanism held by coordinates of its joints: (joint id, TX..RZ)."""
        joints = {joint.id: joint for joint in self.joints}
        return Drive(self.assembly, [(joints[name], freedom) for name, freedom in coordinates])

    def scene(self, solved: bool = False) -> Scene:
        """The scene to export: the found joints instead of the given ones, middle bodies added.

        solved: with every part moved to the closed pose.
        """
        base = self.source.with_poses(self.poses) if solved else self.source
        return replace(base, nodes=[*base.nodes, *self.nodes], joints=self.joints, couplings=self.couplings)
