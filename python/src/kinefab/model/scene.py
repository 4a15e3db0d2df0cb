"""A scene: everything read from a source."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from ..spatial import Pose
from .animation import AnimationClip
from .constraints import Constraint, DofRecord
from .couplings import Coupling
from .joints import Joint
from .meshes import Mesh
from .pairs import Apart, Colliding
from .parts import Node
from .surfaces import Surface


@dataclass(frozen=True, slots=True)
class SourceFile:
    """A further file that was read.  uri: relative to the source's folder, with forward slashes."""

    uri: str
    sha256: str = ""


@dataclass(frozen=True, slots=True)
class Source:
    """Where a scene came from: uri relative to the file, upAxis 'X'|'Y'|'Z', metres per source unit.

    files: everything else that was read (references, includes, meshes), where the reader knows.
    configuration: which of several states of it was asked for (variants, keyframe), as the source names them; "" for the usual one.
    """

    uri: str = ""
    up_axis: str = "Y"
    meters_per_unit: float = 1.0
    sha256: str = ""
    files: tuple[SourceFile, ...] = ()
    configuration: str = ""


EARTH = (0.0, -9.81, 0.0)
"""m/s^2: Unity's own."""


@dataclass(frozen=True, slots=True)
class Physics:
    """Project settings the mechanism was made for; Unity's defaults.  gravity: m/s^2, vector in the scene's frame."""

    gravity: tuple[float, float, float] = EARTH
    fixed_timestep: float = 0.02
    solver_iterations: int = 6
    solver_velocity_iterations: int = 1


@dataclass(slots=True, eq=False)
class Scene:
    """Everything read from a source.  Nodes stand after their parents; references are list indices.

    offers: what else the source can give, by the name of the option that asks for it: names of its variants
        (``variant``: "set=name"), of its keyframes (``keyframe``).
    apart: pairs of bodies that pass through each other by the source's own rule, beside those that joints keep from colliding.
    colliding: pairs of bodies that collide by the source's own rule, whatever their groups; a joint between such two has ``collide``.
    identities: by the id of a node, joint, constraint or coupling, where ids are made of names that people change: what it is in
        the source whatever it is called there.  By it a prefab knows its objects again.
    counted: ids that say nothing of the one that has them, as the source has no name for it and its reader counted: of nodes and
        joints, of a node's bodies ``NODE/body:NAME``, of its colliders ``NODE/collider:NAME``.
    switched_off: joints that hold nothing.  A reader, or a script, leaves them in ``joints``, not ``enabled``; they come here before
        anything is counted (``with_disabled_apart``).
    """

    nodes: list[Node] = field(default_factory=list[Node])
    meshes: list[Mesh] = field(default_factory=list[Mesh])
    surfaces: list[Surface] = field(default_factory=list[Surface])
    joints: list[Joint] = field(default_factory=list[Joint])
    couplings: list[Coupling] = field(default_factory=list[Coupling])
    constraints: list[Constraint] = field(default_factory=list[Constraint])
    dof_records: list[DofRecord] = field(default_factory=list[DofRecord])
    animations: list[AnimationClip] = field(default_factory=list[AnimationClip])
    source: Source = field(default_factory=Source)
    physics: Physics = field(default_factory=Physics)
    offers: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    extras: Mapping[str, object] = field(default_factory=dict[str, object])
    apart: list[Apart] = field(default_factory=list[Apart])
    colliding: list[Colliding] = field(default_factory=list[Colliding])
    identities: Mapping[str, str] = field(default_factory=dict[str, str])
    counted: set[str] = field(default_factory=set[str])
    switched_off: list[Joint] = field(default_factory=list[Joint])

    def __repr__(self) -> str:
        """In one line: all its parts and meshes are in it."""
        counts = ("nodes", "meshes", "joints", "couplings")
        return f"<Scene: {', '.join(f'{len(getattr(self, name))} {name}' for name in counts)}>"

    def pose(self, node: int | None) -> Pose:
        """World pose of a node; the identity for ground.

        >>> scene = kinefab.Scene()
        >>> scene.pose(scene.add_part("Lid", translation=(0, 0.2, 0))).translation.tolist()
        [0.0, 0.2, 0.0]
        """
        return Pose() if node is None else self.nodes[node].pose

    def name(self, node: int | None) -> str:
        """Id of a node, or 'ground'.

        >>> scene = kinefab.Scene()
        >>> scene.name(scene.add_part("Lid")), scene.name(None)
        ('Lid', 'ground')
        """
        return "ground" if node is None else self.nodes[node].id

    def with_disabled_apart(self) -> Scene:
        """The same scene with the joints that are not enabled in ``switched_off``.

        >>> import dataclasses
        >>> scene = kinefab.Scene()
        >>> hinge = scene.add_hinge(None, scene.add_part("Door"), point=(0, 0, 0), axis=(0, 1, 0))
        >>> scene.joints[0] = dataclasses.replace(scene.joints[0], enabled=False)
        >>> apart = scene.with_disabled_apart()
        >>> len(apart.joints), len(apart.switched_off)
        (0, 1)
        """
        off = [joint for joint in self.joints if not joint.enabled]
        if not off:
            return self
        on = [joint for joint in self.joints if joint.enabled]
        return replace(self, joints=on, switched_off=[*self.switched_off, *off])

    def with_poses(self, poses: Sequence[Pose]) -> Scene:
        """The same scene with other node poses (same order as ``nodes``).

        >>> scene = kinefab.Scene()
        >>> lid = scene.add_part("Lid")
        >>> scene.with_poses([kinefab.Pose()]).name(lid)
        'Lid'
        """
        moved = [replace(node, pose=pose) for node, pose in zip(self.nodes, poses, strict=True)]
        return replace(self, nodes=moved)
