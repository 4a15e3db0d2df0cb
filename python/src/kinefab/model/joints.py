"""Joints and what each of their six freedoms may do; couplings between joint coordinates."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Mapping

from ..spatial import Pose

TX, TY, TZ, RX, RY, RZ = range(6)
"""Indices of a freedom in a joint's frame: translation along and rotation about X, Y, Z."""
FREEDOM_NAMES = ("tx", "ty", "tz", "rx", "ry", "rz")
"""Their names, by index."""


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
    turns: whole turns by which the source displays more than the coordinate, its limits too; for messages only.
    """

    motion: Motion = Motion.LOCKED
    lower: float = -math.inf
    upper: float = math.inf
    drive: Drive | None = None
    stiffness: float = 0.0
    damping: float = 0.0
    restitution: float = 0.0
    turns: int = field(default=0, compare=False)

    def displayed(self, *values: float) -> tuple[float, ...]:
        """Values of the coordinate, radians or metres, as the source shows them."""
        return tuple(value + 2.0 * math.pi * self.turns for value in values)

    def nearest_turn(self, value: float) -> float:
        """The angle, radians, that ``value`` stands for where it is known up to whole turns: the one in the range."""
        turn = 2.0 * math.pi
        if self.motion is not Motion.LIMITED:
            return value
        if math.isinf(self.lower):
            return value - turn * max(0, math.ceil((value - self.upper) / turn - 1e-9))
        if math.isinf(self.upper):
            return value + turn * max(0, math.ceil((self.lower - value) / turn - 1e-9))
        return value + turn * round((0.5 * (self.lower + self.upper) - value) / turn)


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

_PLAIN = {k: tuple(FREE if i in UNLOCKED.get(k, ()) else LOCKED for i in range(6)) for k in JointKind}


def kind_of(free: tuple[int, ...]) -> JointKind:
    """The kind with just these freedoms, GENERAL where none has a name (a screw is not told by them)."""
    named = (k for k, unlocked in UNLOCKED.items() if unlocked == free and k is not JointKind.SCREW)
    return next(named, JointKind.GENERAL)


def unlocked_of(freedoms: tuple[Freedom, ...]) -> tuple[int, ...]:
    """Indices of the freedoms that may move."""
    return tuple(i for i, f in enumerate(freedoms) if f.motion is not Motion.LOCKED)


def freedoms_of(kind: JointKind, **given: Freedom) -> tuple[Freedom, ...]:
    """Six freedoms with ``kind``'s own unlocked (none of GENERAL); ``given`` (tx=..., rx=...) replaces single ones."""
    if not given:
        return _PLAIN[kind]
    freedoms = list(_PLAIN[kind])
    for name, freedom in given.items():
        freedoms[FREEDOM_NAMES.index(name)] = freedom
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
    loop: of a closure, the nodes (None: ground) from a to b, each joined to the next by a joint of the spanning tree.
    freed: freedoms (TX..RZ) that the joint locks by itself and that were left free, since the loop holds them.
    misfit: by how much the joint's motions miss what it stands for, at most, metres and radians; zero where exact.
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
    loop: tuple[int | None, ...] = ()
    freed: tuple[int, ...] = ()
    misfit: tuple[float, float] = (0.0, 0.0)
    where: str = ""

    @property
    def unlocked(self) -> tuple[int, ...]:
        """The freedoms TX..RZ that may move."""
        return unlocked_of(self.freedoms)

    @property
    def locked(self) -> tuple[int, ...]:
        """The freedoms TX..RZ that may not."""
        return tuple(i for i, f in enumerate(self.freedoms) if f.motion is Motion.LOCKED)

    @property
    def whole_kind(self) -> JointKind:
        """The kind with what the loop holds instead of the joint."""
        return kind_of(tuple(i for i in self.unlocked if i not in self.freed)) if self.freed else self.kind


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
