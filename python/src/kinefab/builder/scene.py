"""The scene that a script fills."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from .. import model
from ..model import (
    Body,
    Collider,
    Coupling,
    Joint,
    JointKind,
    MassProperties,
    Node,
    NodeKind,
    PhysicsMaterial,
    Surface,
)
from ..options import ColliderShape
from ..spatial import Pose, frame_from_axes
from .arguments import (
    Vector,
    checked_axes,
    checked_color,
    checked_flag,
    checked_mass,
    checked_name,
    checked_number,
    checked_pose,
    checked_vector,
    shown,
)
from .couplings import JointLike, coupling_between
from .ids import Ids
from .materials import colliders_of, materials_of
from .motions import FreedomLike, Range, checked_lead, freedoms_asked, kind_of_word
from .shapes import Shape, shapes_of

_numbers = itertools.count()


class PartIndex(int):
    """What ``add_part`` and ``add_assembly`` return: an index that knows which scene's it is (``scene``: a number)."""

    scene: int


class Scene(model.Scene):
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

    __slots__ = ("_given", "_joint_ids", "_node_ids", "_number")

    def __init__(self, *args: Any, **fields: Any) -> None:
        super().__init__(*args, **fields)
        self._node_ids, self._joint_ids = Ids(), Ids()
        self._given = len(self.nodes)
        self._number = next(_numbers)

    def add_part(
        self,
        name: str,
        mesh: Any = None,
        *,
        translation: Vector | None = None,
        rotation: Any = None,
        parent: int | None = None,
        grounded: bool = False,
        density: float | None = None,
        mass: MassProperties | None = None,
        color: Vector | None = None,
        material: Surface | PhysicsMaterial | Iterable[Surface | PhysicsMaterial] | None = None,
        collider: ColliderShape | str | Collider | Iterable[Collider] | None = None,
        unit: str = "m",
    ) -> int:
        """Add a part at a world pose and return its index.

        mesh: a trimesh.Trimesh, anything with ``vertices`` and ``faces``, a trimesh.Scene, or the path of a mesh file; in
        the part's own frame.  unit: of the mesh's numbers: m, cm, mm, in, ft.
        translation: metres.  rotation: a rotation matrix (3, 3), a quaternion (x, y, z, w), Euler angles in degrees with
        their order (``("XYZ", (30, 0, 90))``), or a whole pose (4, 4) instead of both; None for none.
        parent: index of an assembly, or None.  grounded: fixed to the world.
        density: kg/m^3, None for the export's default.  mass: given instead of computed.
        color: linear red green blue (alpha), 0..1.
        material: how it looks (``Surface``), what it touches with (``PhysicsMaterial``), or both.
        collider: ``auto``, ``none``, ``box``, ``hull``, ``decompose`` or ``mesh`` for this part, or colliders of its own, in its frame.
        Raises TypeError for a mesh that is none, ValueError for a rotation that is none (a reflection, a scale), a number
        that is not finite, a mesh without triangles, a density not above zero or a colour outside 0..1.

        >>> scene = kinefab.Scene()
        >>> scene.add_part("Bar", trimesh.creation.box((0.4, 0.02, 0.03)), rotation=("XYZ", (30, 0, 90)), density=2700)
        0
        """
        weighs = f"the density of {name}"
        if density is not None and not 0.0 < checked_number(weighs, density, infinite=True) < math.inf:
            raise ValueError(f"{weighs} is {density}; it must be a number above zero")
        checked_name("the name", name, empty=False)
        checked_flag(f"grounded of {name}", grounded)
        weight = checked_mass(name, mass)
        shapes = [] if mesh is None else shapes_of(name, mesh, unit)
        looks, touch = materials_of(name, material)
        if color is not None:
            looks = replace(looks or Surface(name), color=checked_color(name, color))
        known = len(self.meshes) + sum(each.mesh is not None for each in shapes)
        shape, own = colliders_of(name, collider, touch, known)
        index = self._add_node(
            name,
            NodeKind.PART,
            parent,
            translation,
            rotation,
            mass=weight,
            grounded=bool(grounded),
            colliders=own,
            collision=shape,
        )
        if shapes:  # the node is there first, as a wrong parent or pose adds nothing
            self.nodes[-1] = replace(self.nodes[-1], bodies=tuple(self._bodies(shapes, looks, density)))
        return index

    def _bodies(self, shapes: list[Shape], looks: Surface | None, density: float | None) -> list[Body]:
        """Bodies of a part, once their meshes and surfaces are added.  looks: of all of them, in the place of their own."""
        surfaces = () if looks is None else (len(self.surfaces),)
        self.surfaces += () if looks is None else (looks,)
        bodies: list[Body] = []
        for each in shapes:
            number = None
            if each.mesh is not None:
                self.meshes.append(each.mesh)
                number = len(self.meshes) - 1
            own = surfaces * max(1, len(each.surfaces)) or tuple(map(self._surface, each.surfaces))
            bodies.append(Body(each.name, number, own, density, each.reference))
        return bodies

    def _surface(self, surface: Surface) -> int:
        """The index of a surface of a mesh, added where no other looks the same."""
        if surface not in self.surfaces:
            self.surfaces.append(surface)
        return self.surfaces.index(surface)

    def add_assembly(
        self,
        name: str,
        *,
        translation: Vector | None = None,
        rotation: Any = None,
        parent: int | None = None,
        flexible: bool = True,
    ) -> int:
        """Add an assembly to put parts under, and return its index.  flexible: whether its parts may move
        against each other; otherwise they are one rigid body.  The pose as ``add_part`` has it.

        >>> scene = kinefab.Scene()
        >>> gripper = scene.add_assembly("Gripper", translation=(0, 1.2, 0))
        >>> scene.nodes[scene.add_part("Finger", parent=gripper)].id
        'Gripper/Finger'
        """
        checked_name("the name", name, empty=False)
        checked_flag(f"flexible of {name}", flexible)
        return self._add_node(name, NodeKind.ASSEMBLY, parent, translation, rotation, flexible=flexible)

    def _add_node(
        self,
        name: str,
        kind: NodeKind,
        parent: int | None,
        translation: Vector | None,
        rotation: Any,
        **fields: Any,
    ) -> int:
        if parent is not None:
            self._check_index(parent, "parent")
            parent = int(parent)
        pose = Pose(*checked_pose(name, translation, rotation))
        node_id = self._node_ids.free(
            name if parent is None else f"{self.nodes[parent].id}/{name}", self.nodes
        )
        self.nodes.append(Node(node_id, name, kind, parent, pose, **fields))
        index = PartIndex(len(self.nodes) - 1)
        index.scene = self._number
        return index

    def _check_index(self, node: object, argument: str) -> None:
        """Raise unless ``node`` is what an ``add_part`` or ``add_assembly`` returned."""
        if isinstance(node, bool) or not isinstance(node, (int, np.integer)):
            raise TypeError(
                f"{argument} is {shown(node)}; pass the index that add_part or add_assembly returned"
                + ("" if argument == "b" else ", or None")
            )
        if not 0 <= node < len(self.nodes):
            raise ValueError(f"{argument} is {node}; the scene has nodes 0 to {len(self.nodes) - 1}")
        if isinstance(node, PartIndex) and node.scene != self._number and node >= self._given:
            raise ValueError(f"{argument} is {node} of another scene; pass an index that this one returned")

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
        **freedoms: FreedomLike,
    ) -> Joint:
        """Add a joint between part ``b`` and part ``a`` (None: the world), both where they stand now.

        kind: a JointKind or its word (``revolute``); ``hinge``, ``slider`` and ``ball`` too.
        point, axis, secondary: origin, X and (near) Y of the joint's frame in the WORLD; Z is across both.  A universal joint
        turns about X, which stays in ``b``, and Z, which stays in ``a``.  lead: of a screw, metres a turn.
        limits: (lower, upper) in degrees or metres from the present pose.
        drive: a dict with ``target``, ``target_velocity`` (degrees or metres, a second), ``stiffness``, ``damping``,
        ``max_force`` (newtons, metres, radians), ``acceleration``, ``motor``.
        spring, damping: of the joint itself: stiffness or (stiffness, rest in degrees or metres); newtons, metres, radians.
        Each of these four is for the one freedom that the kind leaves, or a dict by the names of several.
        collide: whether the two parts touch each other.
        freedoms: ``tx`` .. ``rz``, replacing those that the kind leaves: a range in degrees or metres, True (free), False
        (locked), or a model ``Freedom``, whose angles are radians.
        Raises TypeError for a side that is no index, ValueError for one that no node of this scene has, for an axis without
        length, for a number that is not finite (but for the ends of a range), for a freedom that the kind does not leave,
        for a screw without a lead, and for a part joined to itself.

        >>> scene = kinefab.Scene()
        >>> bolt = scene.add_part("Bolt")
        >>> screw = scene.add_joint("screw", None, bolt, point=(0, 0, 0), axis=(0, 1, 0), lead=0.002, rx=(-10, 80))
        >>> screw.freedoms[3].motion.value, screw.freedoms[0].motion.value
        ('limited', 'free')
        """
        kind = kind_of_word(kind)
        if a is not None:
            self._check_index(a, "a")
        self._check_index(b, "b")
        if a == b:
            raise ValueError(f"a and b are both {a}; pass two different parts, or None for the world as a")
        main, near = checked_axes(axis, secondary)
        pitch = checked_lead(kind, lead)
        checked_name("the name", name)
        checked_flag("collide", collide)
        asked = freedoms_asked(kind, freedoms, limits, drive, spring, damping)
        world = Pose(frame_from_axes(main, near), checked_vector("the point", point))
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
        name: str = "",
    ) -> Joint:
        """Add a hinge: ``b`` turns against ``a`` about ``axis`` through ``point``, right-hand rule.

        limits: (lower, upper) in degrees from the present pose, or None.  drive, spring, damping, collide: see ``add_joint``.
        Raises ValueError for limits in the wrong order, and what ``add_joint`` raises.

        >>> scene = kinefab.Scene()
        >>> lid = scene.add_part("Lid")
        >>> scene.add_hinge(None, lid, point=(0, 0.2, -0.15), axis=(-1, 0, 0), limits=(-10, 80), name="Hinge").id
        'Hinge'
        """
        options: dict[str, Any] = {"limits": limits, "drive": drive, "spring": spring, "damping": damping}
        return self.add_joint(
            JointKind.REVOLUTE, a, b, point=point, axis=axis, name=name, collide=collide, **options
        )

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
        options: dict[str, Any] = {"limits": limits, "drive": drive, "spring": spring, "damping": damping}
        return self.add_joint(
            JointKind.PRISMATIC, a, b, point=point, axis=axis, name=name, collide=collide, **options
        )

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
        name: str = "",
    ) -> Joint:
        """Add a ball joint: ``b`` turns against ``a`` about ``point``.

        axis: that ``rx`` turns about.  limits and the rest: by ``rx``, ``ry``, ``rz``; see ``add_joint``.

        >>> scene = kinefab.Scene()
        >>> arm = scene.add_part("Arm")
        >>> scene.add_ball(None, arm, point=(0, 1.4, 0), limits={"rx": (-10, 80)}).unlocked  # RX, RY, RZ
        (3, 4, 5)
        """
        options: dict[str, Any] = {"limits": limits, "drive": drive, "spring": spring, "damping": damping}
        return self.add_joint(
            JointKind.SPHERICAL, a, b, point=point, axis=axis, name=name, collide=collide, **options
        )

    def add_fixed(self, a: int | None, b: int, *, collide: bool = False, name: str = "") -> Joint:
        """Fix ``b`` to ``a`` where they stand now.  Raises what ``add_joint`` raises.

        >>> scene = kinefab.Scene()
        >>> scene.add_fixed(scene.add_part("Plate"), scene.add_part("Bracket")).unlocked
        ()
        """
        self._check_index(b, "b")
        point = tuple(self.nodes[b].pose.translation.tolist())
        return self.add_joint(JointKind.FIXED, a, b, point=point, name=name, collide=collide)

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
        checked_name("the name", name)
        number = len(self.couplings) + 1
        coupling = coupling_between(self.joints, a, b, ratio, offset, name, number)
        self.couplings.append(coupling)
        return coupling
