"""The scene between source and Unity: the nouns every stage speaks in.

Frame of every ``Scene``: right-handed, +Y up, +Z forward, metres, kilograms, seconds, radians.
A reader in ``sources`` turns and scales its source into this frame (a rotation and a scale, never a
mirror); ``unity/frames.py`` holds the one mirror on the way out.

Twists and freedoms are ordered linear first: (tx, ty, tz, rx, ry, rz).
"Ground" is the world and everything fixed to it; it is written ``None`` where a node index is asked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from enum import Enum
from pathlib import Path
from typing import Mapping, Sequence

import numpy as np

from .spatial import Array, Pose

TX, TY, TZ, RX, RY, RZ = range(6)
"""Indices of a freedom in a joint's frame: translation along and rotation about X, Y, Z."""


class NodeKind(str, Enum):
    PART = "part"
    ASSEMBLY = "assembly"


@dataclass(frozen=True, slots=True, eq=False)
class Material:
    """name; color: linear RGBA in 0..1; metallic and smoothness in 0..1 (Unity's Standard/Lit meaning)."""

    name: str
    color: tuple[float, float, float, float] = (0.8, 0.8, 0.8, 1.0)
    metallic: float = 0.0
    smoothness: float = 0.5


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Triangles in the frame of the node that uses them.

    vertices: shape (n, 3), metres.  faces: shape (m, 3), indices into vertices, outward side
    counter-clockwise (right-handed).  normals: shape (n, 3), unit, or None.  uv: shape (n, 2) or None.
    face_counts: number of faces of each submesh, in order; they add up to m.
    """

    name: str
    vertices: Array
    faces: np.ndarray
    normals: Array | None = None
    uv: Array | None = None
    face_counts: tuple[int, ...] = ()


class MeshKey(str, Enum):
    """What names a body inside a mesh file: OBJ's ``o`` or ``g`` (other formats: the node's name)."""

    OBJECT = "object"
    GROUP = "group"


@dataclass(frozen=True, slots=True, eq=False)
class MeshReference:
    """Where the triangles of a body are: a reader states it, the geometry stage loads them.

    path: the mesh file.  key: the body's name in it, matched by ``keyed_by``; None takes the whole file.
    to_node: affine map from the file's axes and units to the node's frame in metres, shape (4, 4).  It holds
        the unit, the turn of the axes, the inverse pose where the file is in world coordinates, and the mirror
        of a mirrored part: where its determinant is negative the winding must be reversed.
    where: place in the source, for diagnostics.
    """

    path: Path
    to_node: Array
    key: str | None = None
    keyed_by: MeshKey = MeshKey.OBJECT
    where: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """One solid or surface body of a part: a mesh with a material for each submesh.

    mesh: index into ``Scene.meshes``, or None where the geometry is not loaded or was not found.
    materials: indices into ``Scene.materials``, one for each submesh.
    density: kg/m^3, or None for the scene's default.
    reference: where the geometry is to be loaded from, or None for a body without (or with loaded) geometry.
    """

    name: str
    mesh: int | None = None
    materials: tuple[int, ...] = ()
    density: float | None = None
    reference: MeshReference | None = None


@dataclass(frozen=True, slots=True, eq=False)
class MassProperties:
    """mass: kg.  center: centre of mass, node's frame, metres, shape (3,).
    inertia: about the centre of mass, along the node's axes, kg m^2, shape (3, 3)."""

    mass: float
    center: Array
    inertia: Array


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """A component of the source: a part, or an assembly that holds others.

    id: stable path in the source, unique (``Lever/Crank:1/Shaft:1``).
    parent: index into ``Scene.nodes`` of an earlier node, or None for a root.
    pose: node frame in the WORLD at the exported pose.
    definition: id shared by all occurrences of the same part, or None.
    grounded: fixed to the world.  flexible: for an assembly, whether its parts may move against each
    other (an inflexible assembly is one rigid group).  suppressed: present in the source but inactive.
    mass: as given by the source; None means "from geometry".
    where: place in the source, for diagnostics.
    """

    id: str
    name: str
    kind: NodeKind = NodeKind.PART
    parent: int | None = None
    pose: Pose = field(default_factory=Pose)
    definition: str | None = None
    bodies: tuple[Body, ...] = ()
    mass: MassProperties | None = None
    grounded: bool = False
    flexible: bool = False
    suppressed: bool = False
    visible: bool = True
    where: str = ""
    extras: Mapping[str, object] = field(default_factory=dict)


class Motion(str, Enum):
    LOCKED = "locked"
    LIMITED = "limited"
    FREE = "free"


@dataclass(frozen=True, slots=True)
class Drive:
    """A spring, damper or motor on one freedom; metres or radians, newtons or newton metres, seconds.

    Force = stiffness * (target - q) + damping * (target_velocity - qdot), clamped to +-max_force.
    acceleration: the gains are per unit of inertia instead (rad/s^2, m/s^2).
    motor: ``target_velocity`` is held with up to ``max_force`` (stiffness and damping are not used).
    """

    target: float = 0.0
    target_velocity: float = 0.0
    stiffness: float = 0.0
    damping: float = 0.0
    max_force: float = math.inf
    acceleration: bool = False
    motor: bool = False


@dataclass(frozen=True, slots=True)
class Freedom:
    """One of a joint's six freedoms.

    lower, upper: range of the coordinate when LIMITED, metres or radians; either may be infinite.
    stiffness, damping: of the limit, 0 and 0 for a hard one.  restitution: 0..1, of a hard limit.
    """

    motion: Motion = Motion.LOCKED
    lower: float = -math.inf
    upper: float = math.inf
    drive: Drive | None = None
    stiffness: float = 0.0
    damping: float = 0.0
    restitution: float = 0.0


LOCKED = Freedom()
FREE = Freedom(Motion.FREE)


class JointKind(str, Enum):
    """Lower pairs and their relatives.  In brackets: the unlocked freedoms of the joint's frame."""

    FIXED = "fixed"
    REVOLUTE = "revolute"  # rx
    PRISMATIC = "prismatic"  # tx
    CYLINDRICAL = "cylindrical"  # tx rx
    SCREW = "screw"  # tx rx, coupled: tx = lead / 2 pi * rx
    PIN_SLOT = "pin_slot"  # ty rx: X the pin, Y the slot
    PLANAR = "planar"  # ty tz rx: X the normal
    SPHERICAL = "spherical"  # rx ry rz
    UNIVERSAL = "universal"  # rx rz: X fixed in b, Z fixed in a, ry locked
    POINT_ON_LINE = "point_on_line"  # tx rx ry rz: X the line
    POINT_ON_PLANE = "point_on_plane"  # tx ty rx ry rz: Z the normal
    LINE_IN_PLANE = "line_in_plane"  # tx ty rx rz: X the line (in b), Z the normal (in a)
    PERPENDICULAR = "perpendicular"  # tx ty tz rx rz: X fixed in b, Z fixed in a
    PARALLEL_PLANES = "parallel_planes"  # tx ty tz rx: X the normal (Schoenflies motion)
    TRANSLATE_2 = "translate_2"  # ty tz: X the normal
    TRANSLATE_3 = "translate_3"  # tx ty tz
    FREE = "free"
    # Any other set of freedoms.  With two rotations X (or Y where X is locked) is fixed in b, the other in a.
    GENERAL = "general"


UNLOCKED: Mapping[JointKind, tuple[int, ...]] = {
    JointKind.FIXED: (),
    JointKind.REVOLUTE: (RX,),
    JointKind.PRISMATIC: (TX,),
    JointKind.CYLINDRICAL: (TX, RX),
    JointKind.SCREW: (TX, RX),
    JointKind.PIN_SLOT: (TY, RX),
    JointKind.PLANAR: (TY, TZ, RX),
    JointKind.SPHERICAL: (RX, RY, RZ),
    JointKind.UNIVERSAL: (RX, RZ),
    JointKind.POINT_ON_LINE: (TX, RX, RY, RZ),
    JointKind.POINT_ON_PLANE: (TX, TY, RX, RY, RZ),
    JointKind.LINE_IN_PLANE: (TX, TY, RX, RZ),
    JointKind.PERPENDICULAR: (TX, TY, TZ, RX, RZ),
    JointKind.PARALLEL_PLANES: (TX, TY, TZ, RX),
    JointKind.TRANSLATE_2: (TY, TZ),
    JointKind.TRANSLATE_3: (TX, TY, TZ),
    JointKind.FREE: (TX, TY, TZ, RX, RY, RZ),
}
"""The freedoms each kind leaves; GENERAL has no fixed set."""


def freedoms_of(kind: JointKind, **given: Freedom) -> tuple[Freedom, ...]:
    """Six freedoms with ``kind``'s own unlocked (none of GENERAL); ``given`` (tx=..., rx=...) replaces single ones."""
    names = ("tx", "ty", "tz", "rx", "ry", "rz")
    freedoms = [FREE if i in UNLOCKED.get(kind, ()) else LOCKED for i in range(6)]
    for name, freedom in given.items():
        freedoms[names.index(name)] = freedom
    return tuple(freedoms)


@dataclass(frozen=True, slots=True, eq=False)
class Joint:
    """A joint between node ``b`` and node ``a`` (None: ground).

    frame_a: joint frame in a's frame (in the world when a is ground); frame_b: in b's frame.
    Coordinates are those of b's frame seen from a's: q is zero where the two frames coincide,
    translations are measured along a's axes, rotations are positive by the right-hand rule.
    Which body carries an axis matters for pin-slot, universal and the point-on kinds (see JointKind);
    for all translations it is a.
    freedoms: six, in the order tx ty tz rx ry rz.  lead: of a SCREW, metres a turn, right-handed.
    because: ids of the source's constraints or joints that this one comes from.
    closure: this joint closes a loop (the spanning tree does not need it).
    """

    id: str
    kind: JointKind
    a: int | None
    b: int
    frame_a: Pose
    frame_b: Pose
    freedoms: tuple[Freedom, ...]
    name: str = ""
    lead: float = 0.0
    break_force: float = math.inf
    break_torque: float = math.inf
    because: tuple[str, ...] = ()
    closure: bool = False
    where: str = ""


class CouplingKind(str, Enum):
    GEAR = "gear"
    BELT = "belt"
    RACK = "rack"
    SCREW = "screw"
    LINEAR = "linear"


@dataclass(frozen=True, slots=True, eq=False)
class Coupling:
    """``q_b = ratio * q_a + offset`` between two joint coordinates, metres and radians.

    joint_a, joint_b: ids of joints (the same for a screw).  freedom_a, freedom_b: TX..RZ.
    """

    id: str
    kind: CouplingKind
    joint_a: str
    freedom_a: int
    joint_b: str
    freedom_b: int
    ratio: float
    offset: float = 0.0
    where: str = ""


class FeatureKind(str, Enum):
    """Geometry that a constraint refers to."""

    POINT = "point"
    LINE = "line"
    PLANE = "plane"
    CIRCLE = "circle"
    CYLINDER = "cylinder"
    SPHERE = "sphere"
    CONE = "cone"
    FRAME = "frame"
    BODY = "body"


@dataclass(frozen=True, slots=True, eq=False)
class Feature:
    """A piece of geometry on a node (None: ground), in THAT NODE'S frame (the world for ground).

    point: on the point, line, plane or axis; centre of a circle or sphere; apex of a cone; shape (3,).
    direction: of a line or axis, or a plane's outward normal; unit vector; None for point and sphere.
    secondary: second direction where the geometry is a whole frame (its X), or None.
    radius, half_angle: metres, radians; 0 where they mean nothing.
    """

    node: int | None
    kind: FeatureKind
    point: Array
    direction: Array | None = None
    secondary: Array | None = None
    radius: float = 0.0
    half_angle: float = 0.0


class ConstraintKind(str, Enum):
    COINCIDENT = "coincident"
    CONCENTRIC = "concentric"
    PARALLEL = "parallel"
    PERPENDICULAR = "perpendicular"
    ANGLE = "angle"
    DISTANCE = "distance"
    TANGENT = "tangent"
    INSERT = "insert"
    SYMMETRY = "symmetry"
    LOCK = "lock"
    LOCK_ORIENTATION = "lock_orientation"
    SLIDER = "slider"
    PIN_SLOT = "pin_slot"
    UNIVERSAL = "universal"
    SCREW = "screw"
    GEAR = "gear"
    BELT = "belt"
    RACK = "rack"
    LINEAR = "linear"
    GROUND = "ground"
    OTHER = "other"  # stored and written through, never interpreted


class Sense(str, Enum):
    """How two directions stand: along each other, against each other, or either."""

    ALIGNED = "aligned"
    OPPOSED = "opposed"
    EITHER = "either"


class Side(str, Enum):
    """On which side of the other surface a tangency is; EITHER takes that of the exported pose."""

    INSIDE = "inside"
    OUTSIDE = "outside"
    EITHER = "either"


@dataclass(frozen=True, slots=True, eq=False)
class Constraint:
    """A geometric constraint as the source states it, before any analysis.

    features: the constrained geometry: a then b, and a third for symmetry (the plane).
    value: distance (m) or angle (rad), lead of a screw (m a turn), ratio of a coupling.
    lower, upper: range where the source gives one instead of a value (None: an equality).
    reading: the vendor's meaning where the same words remove different rows, for example
        ``line_line_distance: skew | parallel``; keys and values are listed in ``schemas/SPEC.md``.
    raw_kind: the source's own word for it.
    """

    id: str
    kind: ConstraintKind
    features: tuple[Feature, ...]
    value: float = 0.0
    lower: float | None = None
    upper: float | None = None
    sense: Sense = Sense.EITHER
    side: Side = Side.EITHER
    lock_rotation: bool = False
    suppressed: bool = False
    name: str = ""
    raw_kind: str = ""
    reading: Mapping[str, str] = field(default_factory=dict)
    where: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class DofRecord:
    """The source's own statement of a component's remaining freedoms to ground.

    translations: directions, unit, WORLD frame, shape (t, 3).  rotations: axes, unit, WORLD frame,
    shape (r, 3).  center: a point that the rotations pass through, WORLD frame, or None.
    """

    node: int
    translations: Array
    rotations: Array
    center: Array | None = None
    where: str = ""


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

    def with_poses(self, poses: Sequence[Pose]) -> "Scene":
        """The same scene with other node poses (same order as ``nodes``)."""
        moved = [replace(node, pose=pose) for node, pose in zip(self.nodes, poses, strict=True)]
        return replace(self, nodes=moved)
