"""A scene: everything read from a source."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Mapping, Sequence

from ..spatial import Pose
from .constraints import Constraint, DofRecord
from .joints import Coupling, Joint
from .parts import Material, Mesh, Node


@dataclass(frozen=True, slots=True)
class Source:
    """Where a scene came from: uri relative to the file, upAxis 'X'|'Y'|'Z', metres per source unit."""

    uri: str = ""
    up_axis: str = "Y"
    meters_per_unit: float = 1.0
    sha256: str = ""


@dataclass(frozen=True, slots=True)
class Physics:
    """Project settings the mechanism was made for; Unity's defaults.  gravity: m/s^2, along -Y."""

    gravity: float = 9.81
    fixed_timestep: float = 0.02
    solver_iterations: int = 6
    solver_velocity_iterations: int = 1


MOST_NAMES = 12
"""Parts of a loop that a message lists."""


@dataclass(slots=True, eq=False)
class Scene:
    """Everything read from a source.  Nodes stand after their parents; references are list indices."""

    nodes: list[Node] = field(default_factory=list)
    meshes: list[Mesh] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    couplings: list[Coupling] = field(default_factory=list)
    constraints: list[Constraint] = field(default_factory=list)
    dof_records: list[DofRecord] = field(default_factory=list)
    source: Source = field(default_factory=Source)
    physics: Physics = field(default_factory=Physics)
    extras: Mapping[str, object] = field(default_factory=dict)

    def pose(self, node: int | None) -> Pose:
        """World pose of a node; the identity for ground."""
        return Pose() if node is None else self.nodes[node].pose

    def name(self, node: int | None) -> str:
        """Id of a node, or 'ground'."""
        return "ground" if node is None else self.nodes[node].id

    def loop(self, joint: Joint) -> str:
        """The parts of the loop that a joint closes, for a message."""
        names = [self.name(node) for node in joint.loop]
        if len(names) > MOST_NAMES:
            half = MOST_NAMES // 2
            names[half:-half] = [f"({len(names) - 2 * half} more)"]
        return " - ".join(names)

    def with_poses(self, poses: Sequence[Pose]) -> "Scene":
        """The same scene with other node poses (same order as ``nodes``)."""
        moved = [replace(node, pose=pose) for node, pose in zip(self.nodes, poses, strict=True)]
        return replace(self, nodes=moved)
