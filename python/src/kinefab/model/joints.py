"""Joints: how two bodies may move against each other."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum

from ..spatial import Pose
from .freedoms import FREE, FREEDOM_NAMES, LOCKED, RX, RY, RZ, TX, TY, TZ, Freedom, Motion, SphericalDrive


class JointKind(str, Enum):
    """Lower pairs and their relatives, with the freedoms that each leaves and the axes of the joint's frame.

    fixed: none
    revolute: rx
    prismatic: tx
    cylindrical: tx rx
    screw: tx rx, coupled: tx = lead / 2 pi * rx
    pin_slot: ty rx; X the pin, Y the slot (in a)
    planar: ty tz rx; X the normal
    spherical: rx ry rz
    universal: rx rz; X fixed in b, Z fixed in a
    point_on_line: tx rx ry rz; X the line (in a)
    point_on_plane: tx ty rx ry rz; Z the normal (in a)
    line_in_plane: tx ty rx rz; X the line (in b), Z the normal (in a)
    perpendicular: tx ty tz rx rz; X fixed in b, Z fixed in a
    parallel_planes: tx ty tz rx; X the normal (Schoenflies motion)
    translate_2: ty tz; X the normal
    translate_3: tx ty tz
    free: tx ty tz rx ry rz
    general: those that are stated.  With two rotations X (or Y where X is locked) is fixed in b, the other in a

    >>> import kinefab
    >>> kinefab.JointKind("revolute") is kinefab.JointKind.REVOLUTE
    True
    """

    FIXED = "fixed"
    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    CYLINDRICAL = "cylindrical"
    SCREW = "screw"
    PIN_SLOT = "pin_slot"
    PLANAR = "planar"
    SPHERICAL = "spherical"
    UNIVERSAL = "universal"
    POINT_ON_LINE = "point_on_line"
    POINT_ON_PLANE = "point_on_plane"
    LINE_IN_PLANE = "line_in_plane"
    PERPENDICULAR = "perpendicular"
    PARALLEL_PLANES = "parallel_planes"
    TRANSLATE_2 = "translate_2"
    TRANSLATE_3 = "translate_3"
    FREE = "free"
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


def alike_from_both_sides(unlocked: Sequence[int]) -> bool:
    """Whether either body counts the other's motion along the same axes: slides alone, or a turn about the one that slides."""
    slides = {i for i in unlocked if i < RX}
    turns = {i - RX for i in unlocked if i >= RX}
    return bool(slides) and (not turns or slides == turns and len(turns) == 1)


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
    """A joint between node ``b`` and node ``a``, one of which may be ground (None).

    frame_a: joint frame in a's frame (in the world when a is ground); frame_b: in b's frame.
    Coordinates are those of b's frame seen from a's: q is zero where the two frames coincide,
    translations are measured along a's axes, rotations are positive by the right-hand rule.
    Which body carries an axis matters for pin-slot, universal and the point-on kinds (see JointKind);
    for all translations it is a.
    freedoms: six, in the order tx ty tz rx ry rz.  lead: of a SCREW, metres a turn, right-handed.
    enabled: False for a joint that the source has and switches off: it holds nothing.  collide: whether the two bodies collide.
    closes: the source says that it closes a loop, so others carry the bodies where they can.
    slerp: one drive about all three rotations, instead of single ones.
    because: ids of the source's constraints or joints that this one comes from.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> drawer = scene.add_part("Drawer", trimesh.creation.box((0.4, 0.1, 0.4)))
    >>> slide = scene.add_slider(None, drawer, point=(0, 0, 0), axis=(0, 0, 1), limits=(0, 0.4))
    >>> slide.kind.value, slide.unlocked, slide.freedoms[0].upper  # TX, metres
    ('prismatic', (0,), 0.4)
    """

    id: str
    kind: JointKind
    a: int | None
    b: int | None
    frame_a: Pose
    frame_b: Pose
    freedoms: tuple[Freedom, ...]
    name: str = ""
    lead: float = 0.0
    break_force: float = math.inf
    break_torque: float = math.inf
    enabled: bool = True
    collide: bool = False
    closes: bool = False
    slerp: SphericalDrive | None = None
    because: tuple[str, ...] = ()
    where: str = ""
    extras: Mapping[str, object] = field(default_factory=dict[str, object])

    def __repr__(self) -> str:
        """In one line: two frames and six freedoms are in it."""
        return f"<Joint {self.id}: {self.kind.value}; a {self.a}, b {self.b}>"

    @property
    def unlocked(self) -> tuple[int, ...]:
        """The freedoms TX..RZ that may move.

        >>> scene = kinefab.Scene()
        >>> scene.add_joint("cylindrical", None, scene.add_part("Rod"), point=(0, 0, 0)).unlocked
        (0, 3)
        """
        return unlocked_of(self.freedoms)

    def freedom_name(self, freedom: int) -> str:
        """What the source calls a freedom TX..RZ, or its name in the joint's own frame.

        >>> scene = kinefab.Scene()
        >>> scene.add_hinge(None, scene.add_part("Door"), point=(0, 0, 0), axis=(0, 1, 0)).freedom_name(3)
        'rx'
        """
        return self.freedoms[freedom].name or FREEDOM_NAMES[freedom]

    @property
    def locked(self) -> tuple[int, ...]:
        """The freedoms TX..RZ that may not.

        >>> scene = kinefab.Scene()
        >>> scene.add_hinge(None, scene.add_part("Door"), point=(0, 0, 0), axis=(0, 1, 0)).locked
        (0, 1, 2, 4, 5)
        """
        return tuple(i for i, f in enumerate(self.freedoms) if f.motion is Motion.LOCKED)
