"""The scene that a script fills: joints and couplings between its parts, beside what ``Constraints`` has."""

from __future__ import annotations

import math
from typing import Any

from ..model import Coupling, Joint, JointKind
from ..spatial import Pose
from .arguments import Vector, checked_flag, checked_name, checked_positive, checked_vector
from .axes import joint_axes
from .constraints import Constraints
from .couplings import JointLike, coupling_between
from .ids import Ids
from .motions import FreedomLike, Range, checked_lead, freedoms_asked, kind_of_word


class Scene(Constraints):
    """A scene that a script fills.  Every ``add_*`` of a part returns its index, for parents and joints.

    A wrong call raises TypeError (a name where an index is wanted) or ValueError (no such index, an axis without length,
    limits in the wrong order) and adds nothing; the message says what to pass.  Frame: right-handed, +Y up, metres, degrees.

    >>> import kinefab, trimesh
    >>> scene = kinefab.Scene()
    >>> door = scene.add_part("Door", trimesh.creation.box((0.8, 2.0, 0.04)), translation=(0.4, 1.0, 0.0))
    >>> hinge = scene.add_hinge(None, door, point=(0, 1, 0), axis=(0, 1, 0), limits=(0, 110), name="Hinge")
    >>> handle = scene.add_part("Handle", trimesh.creation.box((0.1, 0.02, 0.02)), translation=(0.75, 1.0, 0.05))
    >>> latch = scene.add_hinge(door, handle, point=(0.75, 1, 0.05), axis=(0, 0, 1), limits=(-45, 0), name="Latch")
    >>> kinefab.motion(scene).mobility
    2
    """

    __slots__ = ("_joint_ids",)

    def __init__(self, *args: Any, **fields: Any) -> None:
        super().__init__(*args, **fields)
        self._joint_ids = Ids()

    def add_joint(
        self,
        kind: JointKind | str,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector = (1.0, 0.0, 0.0),
        secondary: Vector | None = None,
        name: str = "",
        lead: float = 0.0,
        limits: Any = None,
        drive: Any = None,
        spring: Any = None,
        damping: Any = None,
        collide: bool = False,
        break_force: float = math.inf,
        break_torque: float = math.inf,
        **freedoms: FreedomLike,
    ) -> Joint:
        """Add a joint between part ``b`` and part ``a`` (None: the world), both where they stand now.

        kind: a JointKind or its word (``revolute``); ``hinge``, ``slider`` and ``ball`` too.  ``help(kinefab.JointKind)`` has
        what each leaves, about which axis of its frame.
        point: origin of the joint's frame, in the WORLD.
        axis: direction that the joint turns about, slides along or is normal to, in the WORLD: the frame's X.
        secondary: where the kind has two axes, the second one, square to the first.  A universal joint turns about both:
        ``axis`` is on b (``rx``), ``secondary`` on a (``rz``); so are the two lines of ``perpendicular``, and the line and
        the plane's normal of ``line_in_plane``.  A pin in a slot has the pin as axis, the slot on a as secondary (``ty``).
        Of any other kind the frame's Y is near it.  Without it one is chosen that is square to the axis.
        A point on a plane has the plane's normal as axis, the frame's Z; X is near secondary.
        lead: of a screw, metres a turn.
        limits: (lower, upper) in degrees or metres from the present pose.
        drive: a dict with ``target``, ``target_velocity`` (degrees or metres, a second), ``stiffness``, ``damping``,
        ``max_force`` (newtons, metres, radians), ``acceleration``, ``motor``.
        spring, damping: of the joint itself: stiffness or (stiffness, rest in degrees or metres); newtons, metres, radians.
        Each of these four is for the one freedom that the kind leaves, or a dict by the names of several.
        collide: whether the two parts touch each other.
        break_force, break_torque: newtons, newton metres at which the joint breaks and is gone.
        freedoms: ``tx`` .. ``rz``, replacing those that the kind leaves: a range in degrees or metres, True (free), False
        (locked), or a model ``Freedom``, whose angles are radians.
        Raises TypeError for a side that is no index, ValueError for one that no node of this scene has, for an axis without
        length, for two axes that have to be square and are not, for a number that is not finite (but for the ends of a range), for a freedom that the kind does not leave,
        for a screw without a lead, and for a part joined to itself.

        >>> scene = kinefab.Scene()
        >>> bolt = scene.add_part("Bolt")
        >>> screw = scene.add_joint("screw", None, bolt, point=(0, 0, 0), axis=(0, 1, 0), lead=0.002, rx=(-10, 80))
        >>> screw.freedoms[3].motion.value, screw.freedoms[0].motion.value
        ('limited', 'free')
        >>> yoke = scene.add_part("Yoke")
        >>> cross = scene.add_joint("universal", None, yoke, point=(0, 1, 0), axis=(0, 0, 1), secondary=(1, 0, 0), name="Cross")
        >>> [c.name for c in kinefab.motion(scene).coordinates if c.joint == "Cross"]  # about (0, 0, 1), about (1, 0, 0)
        ['Cross.rx', 'Cross.rz']
        """
        kind = kind_of_word(kind)
        if a is not None:
            self._check_index(a, "a")
        self._check_index(b, "b")
        if a == b:
            raise ValueError(f"a and b are both {a}; pass two different parts, or None for the world as a")
        axes = joint_axes(kind, axis, secondary)
        pitch = checked_lead(kind, lead)
        checked_name(name)
        checked_flag("collide", collide)
        force = checked_positive("the break_force", break_force, infinite=True)
        torque = checked_positive("the break_torque", break_torque, infinite=True)
        asked = freedoms_asked(kind, freedoms, limits, drive, spring, damping)
        world = Pose(axes, checked_vector("the point", point))
        frame_a, frame_b = (self.pose(side).inverse() @ world for side in (a, b))
        joint = Joint(
            self._joint_ids.free(name or f"{kind.value}:{len(self.joints) + 1}", self.joints),
            kind,
            None if a is None else int(a),
            int(b),
            frame_a,
            frame_b,
            asked,
            name=name,
            lead=pitch,
            break_force=force,
            break_torque=torque,
            collide=bool(collide),
        )
        self.joints.append(joint)
        return joint

    def add_hinge(
        self,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector,
        limits: Range | None = None,
        drive: Any = None,
        spring: Any = None,
        damping: float | None = None,
        collide: bool = False,
        break_force: float = math.inf,
        break_torque: float = math.inf,
        name: str = "",
    ) -> Joint:
        """Add a hinge: ``b`` turns against ``a`` about ``axis`` through ``point``, right-hand rule.

        limits: (lower, upper) in degrees from the present pose, or None.  The rest: see ``add_joint``.
        Raises ValueError for limits in the wrong order, and what ``add_joint`` raises.

        >>> scene = kinefab.Scene()
        >>> lid = scene.add_part("Lid")
        >>> scene.add_hinge(None, lid, point=(0, 0.2, -0.15), axis=(-1, 0, 0), limits=(-10, 80), name="Hinge").id
        'Hinge'
        """
        return self.add_joint(
            JointKind.REVOLUTE, a, b, point=point, axis=axis, limits=limits, drive=drive, spring=spring, damping=damping,
            collide=collide, break_force=break_force, break_torque=break_torque, name=name,
        )  # fmt: skip

    def add_slider(
        self,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector,
        limits: Range | None = None,
        drive: Any = None,
        spring: Any = None,
        damping: float | None = None,
        collide: bool = False,
        break_force: float = math.inf,
        break_torque: float = math.inf,
        name: str = "",
    ) -> Joint:
        """Add a slider: ``b`` moves against ``a`` along ``axis``.  limits: (lower, upper) in metres from the
        present pose, or None.  The rest as ``add_hinge`` has it.

        >>> scene = kinefab.Scene()
        >>> table = scene.add_part("Table")
        >>> drive = {"target": 0.2, "stiffness": 5000, "damping": 300}
        >>> scene.add_slider(None, table, point=(0, 0, 0), axis=(1, 0, 0), limits=(0, 0.4), drive=drive).unlocked  # TX
        (0,)
        """
        return self.add_joint(
            JointKind.PRISMATIC, a, b, point=point, axis=axis, limits=limits, drive=drive, spring=spring, damping=damping,
            collide=collide, break_force=break_force, break_torque=break_torque, name=name,
        )  # fmt: skip

    def add_ball(
        self,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector = (1.0, 0.0, 0.0),
        limits: Any = None,
        drive: Any = None,
        spring: Any = None,
        damping: Any = None,
        collide: bool = False,
        break_force: float = math.inf,
        break_torque: float = math.inf,
        name: str = "",
    ) -> Joint:
        """Add a ball joint: ``b`` turns against ``a`` about ``point``.

        axis: that ``rx`` turns about.  limits and the rest: by ``rx``, ``ry``, ``rz``; see ``add_joint``.

        >>> scene = kinefab.Scene()
        >>> arm = scene.add_part("Arm")
        >>> scene.add_ball(None, arm, point=(0, 1.4, 0), limits={"rx": (-10, 80)}).unlocked  # RX, RY, RZ
        (3, 4, 5)
        """
        return self.add_joint(
            JointKind.SPHERICAL, a, b, point=point, axis=axis, limits=limits, drive=drive, spring=spring, damping=damping,
            collide=collide, break_force=break_force, break_torque=break_torque, name=name,
        )  # fmt: skip

    def add_fixed(
        self,
        a: int | None,
        b: int,
        *,
        collide: bool = False,
        break_force: float = math.inf,
        break_torque: float = math.inf,
        name: str = "",
    ) -> Joint:
        """Fix ``b`` to ``a`` where they stand now; they are one body, unless it may break.  Raises what ``add_joint`` raises.

        >>> scene = kinefab.Scene()
        >>> scene.add_fixed(scene.add_part("Plate"), scene.add_part("Bracket")).unlocked
        ()
        """
        self._check_index(b, "b")
        point = tuple(self.nodes[b].pose.translation.tolist())
        return self.add_joint(
            JointKind.FIXED, a, b, point=point,
            collide=collide, break_force=break_force, break_torque=break_torque, name=name,
        )  # fmt: skip

    def add_coupling(
        self, a: JointLike, b: JointLike, ratio: float, *, offset: float = 0.0, name: str = ""
    ) -> Coupling:
        """Let joint ``b`` follow joint ``a``: q_b = ratio q_a + offset, in degrees and metres from the present pose.

        a, b: a joint, its id, or (joint, "rx") where it has several freedoms.
        Raises ValueError for a joint of another scene, a freedom that is locked, and a ratio of 0 or that is no number.

        >>> scene = kinefab.Scene()
        >>> sun, gear = (
        ...     scene.add_hinge(None, scene.add_part(name), point=(x, 0, 0), axis=(0, 0, 1))
        ...     for name, x in (("Sun", 0), ("Gear", 0.06))
        ... )
        >>> scene.add_coupling(sun, gear, ratio=-0.5).kind.value  # 20 teeth drive 40
        'gear'
        """
        checked_name(name)
        number = len(self.couplings) + 1
        coupling = coupling_between(self.joints, a, b, ratio, offset, name, number)
        self.couplings.append(coupling)
        return coupling
