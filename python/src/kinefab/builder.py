"""Building a scene in a script: parts from meshes, and joints between them.

    lid = scene.add_part("Lid", trimesh.creation.box((0.4, 0.02, 0.3)), translation=(0, 0.21, 0))
    scene.add_hinge(box, lid, point=(0, 0.2, -0.15), axis=(1, 0, 0), limits=(0, 110))

Positions are world positions of the exported pose, right-handed, +Y up, +Z forward, metres and degrees.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import replace
from typing import Any, Sequence

import numpy as np

from . import model
from .model import Body, Freedom, Joint, JointKind, MassProperties, Mesh, Motion, Node, NodeKind, freedoms_of
from .spatial import Array, Pose, frame_from_axes, vector

Vector = Sequence[float]
ROUNDED = 1e-4
"""Largest entry of R'R - 1 that is the rounding of typed digits; the nearest rotation is taken then."""
EXACT = 1e-12
"""Up to here a rotation matrix is taken as it is."""
LARGEST = 1e9
"""Metres; beyond, single precision has no millimetres, and far beyond no numbers."""

_numbers = itertools.count()


class PartIndex(int):
    """What ``add_part`` and ``add_assembly`` return: an index that knows which scene's it is (``scene``: a number)."""

    scene: int


class Scene(model.Scene):
    """A scene that a script fills.  Every ``add_*`` of a part returns its index, for parents and joints.

    A wrong call raises TypeError (a name where an index is wanted) or ValueError (no such index, an axis without
    length, a number that is not finite, limits in the wrong order) and adds nothing; the message says what to pass.
    """

    __slots__ = ("_copies", "_counted", "_given", "_number")

    def __init__(self, *args: Any, **fields: Any) -> None:
        super().__init__(*args, **fields)
        self._copies: dict[str, int] = {}
        self._counted = 0
        self._given = len(self.nodes)
        self._number = next(_numbers)

    def add_part(
        self,
        name: str,
        mesh: Any = None,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Any = None,
        parent: int | None = None,
        grounded: bool = False,
        density: float | None = None,
        mass: MassProperties | None = None,
        color: Vector | None = None,
    ) -> int:
        """Add a part at a world pose and return its index.

        mesh: a trimesh.Trimesh, or anything with ``vertices`` and ``faces``, in the part's own frame, metres.
        rotation: proper rotation matrix, shape (3, 3), of at least four digits; None for none.
        parent: index of an assembly, or None.  grounded: fixed to the world.
        density: kg/m^3, None for the export's default.  mass: given instead of computed.
        color: linear red green blue (alpha), 0..1.
        Raises ValueError for a rotation that is none (a reflection, a scale, a quaternion), a number that is not
        finite, a mesh without triangles, a density not above zero or a colour outside 0..1.
        """
        if density is not None and not 0.0 < density < math.inf:
            raise ValueError(f"the density of {name} is {density}; it must be a number above zero")
        shape = None if mesh is None else _checked_mesh(name, mesh)
        paint = None if color is None else _checked_color(name, color)
        index = self._add_node(name, NodeKind.PART, parent, translation, rotation, mass=mass, grounded=grounded)
        if shape is not None:
            materials: tuple[int, ...] = ()
            if paint is not None:
                self.materials.append(model.Material(name, paint))
                materials = (len(self.materials) - 1,)
            self.meshes.append(shape)
            body = Body(name, len(self.meshes) - 1, materials, density)
            self.nodes[-1] = replace(self.nodes[-1], bodies=(body,))
        return index

    def add_assembly(
        self,
        name: str,
        *,
        translation: Vector = (0.0, 0.0, 0.0),
        rotation: Any = None,
        parent: int | None = None,
        flexible: bool = True,
    ) -> int:
        """Add an assembly to put parts under, and return its index.  flexible: whether its parts may move
        against each other; otherwise they are one rigid body."""
        return self._add_node(name, NodeKind.ASSEMBLY, parent, translation, rotation, flexible=flexible)

    def _add_node(
        self, name: str, kind: NodeKind, parent: int | None, translation: Vector, rotation: Any, **fields: Any
    ) -> int:
        if parent is not None:
            self._check_index(parent, "parent")
            parent = int(parent)
        turn = np.eye(3) if rotation is None else _checked_rotation(name, rotation)
        pose = Pose(turn, _checked_vector(f"the translation of {name}", translation))
        node_id = self._unused(name if parent is None else f"{self.nodes[parent].id}/{name}")
        self.nodes.append(Node(node_id, name, kind, parent, pose, **fields))
        index = PartIndex(len(self.nodes) - 1)
        index.scene = self._number
        return index

    def _unused(self, path: str) -> str:
        """The path, with the first number that makes it an id of its own; nodes may come from elsewhere too."""
        self._copies.update((node.id, 1) for node in self.nodes[self._counted :] if node.id not in self._copies)
        self._counted = len(self.nodes)
        node_id, copy = path, self._copies.get(path, 0)
        while node_id in self._copies:
            copy += 1
            node_id = f"{path}:{copy}"
        self._copies[path] = max(copy, 1)
        return node_id

    def _check_index(self, node: object, argument: str) -> None:
        """Raise unless ``node`` is what an ``add_part`` or ``add_assembly`` returned."""
        if isinstance(node, bool) or not isinstance(node, (int, np.integer)):
            raise TypeError(
                f"{argument} is {node!r}; pass the index that add_part or add_assembly returned"
                + ("" if argument == "b" else ", or None")
            )
        if not 0 <= node < len(self.nodes):
            raise ValueError(f"{argument} is {node}; the scene has nodes 0 to {len(self.nodes) - 1}")
        if isinstance(node, PartIndex) and node.scene != self._number and node >= self._given:
            raise ValueError(f"{argument} is {node} of another scene; pass an index that this one returned")

    def add_joint(
        self,
        kind: JointKind,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector = (1.0, 0.0, 0.0),
        secondary: Vector | None = None,
        name: str = "",
        lead: float = 0.0,
        **freedoms: Freedom,
    ) -> Joint:
        """Add a joint between part ``b`` and part ``a`` (None: the world), both where they stand now.

        point, axis, secondary: origin, X and (near) Y of the joint's frame in the WORLD.
        lead: of a screw, metres a turn.
        freedoms: ``tx`` .. ``rz``, replacing those that the kind leaves (SI, radians).
        Raises TypeError for a side that is no index, ValueError for one that no node of this scene has, for an axis
        without length, for a number that is not finite (but for the ends of a range), and for a part joined to itself.
        """
        if a is not None:
            self._check_index(a, "a")
        self._check_index(b, "b")
        if a == b:
            raise ValueError(f"a and b are both {a}; pass two different parts, or None for the world as a")
        main = _checked_vector("the axis", axis)
        if not np.linalg.norm(main) > 0.0:
            raise ValueError(f"the axis {axis!r} has no direction; pass a direction in the world, such as (0, 0, 1)")
        near = None if secondary is None else _checked_vector("the secondary axis", secondary)
        if not math.isfinite(lead):
            raise ValueError(f"the lead is {lead}; pass metres a turn")
        for key, freedom in freedoms.items():
            _check_freedom(key, freedom)
        world = Pose(frame_from_axes(main, near), _checked_vector("the point", point))
        frames = [self.pose(side).inverse() @ world for side in (a, b)]
        joint_id = name or f"{kind.value}:{len(self.joints) + 1}"
        a, b = None if a is None else int(a), int(b)
        joint = Joint(joint_id, kind, a, b, *frames, freedoms_of(kind, **freedoms), name=name, lead=lead)
        self.joints.append(joint)
        return joint

    def add_hinge(
        self,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector,
        limits: tuple[float, float] | None = None,
        name: str = "",
    ) -> Joint:
        """Add a hinge: ``b`` turns against ``a`` about ``axis`` through ``point``, right-hand rule.

        limits: (lower, upper) in degrees from the present pose, or None.
        Raises ValueError for limits in the wrong order, and what ``add_joint`` raises.
        """
        turn = _limited(limits, math.radians(1.0)) if limits is not None else model.FREE
        return self.add_joint(JointKind.REVOLUTE, a, b, point=point, axis=axis, name=name, rx=turn)

    def add_slider(
        self,
        a: int | None,
        b: int,
        *,
        point: Vector,
        axis: Vector,
        limits: tuple[float, float] | None = None,
        name: str = "",
    ) -> Joint:
        """Add a slider: ``b`` moves against ``a`` along ``axis``.  limits: (lower, upper) in metres from the
        present pose, or None.  Raises what ``add_hinge`` raises."""
        slide = _limited(limits) if limits is not None else model.FREE
        return self.add_joint(JointKind.PRISMATIC, a, b, point=point, axis=axis, name=name, tx=slide)

    def add_fixed(self, a: int | None, b: int, *, name: str = "") -> Joint:
        """Fix ``b`` to ``a`` where they stand now.  Raises what ``add_joint`` raises."""
        self._check_index(b, "b")
        return self.add_joint(JointKind.FIXED, a, b, point=self.nodes[b].pose.translation, name=name)


def _limited(limits: Sequence[float], unit: float = 1.0) -> Freedom:
    """unit: radians or metres in one of the limits'."""
    try:
        lower, upper = () if isinstance(limits, str) else (float(end) for end in limits)
    except (TypeError, ValueError):
        raise TypeError(f"limits are {limits!r}; pass two numbers, (lower, upper), or None") from None
    if not lower <= upper:
        raise ValueError(f"limits are {limits!r}; pass (lower, upper) with lower not above upper")
    return Freedom(Motion.LIMITED, lower * unit, upper * unit)


def _checked_vector(what: str, values: Any) -> Array:
    try:
        array = vector(values)
    except (TypeError, ValueError):
        array = None
    if array is None or not np.abs(array).max() <= LARGEST:
        raise ValueError(f"{what} is {values!r}; pass three numbers, none beyond {LARGEST:g}")
    return array


def _checked_rotation(name: str, rotation: Any) -> Array:
    """The rotation matrix, freed from the rounding of typed digits."""
    advice = f"the rotation of {name} {{}}; pass a rotation matrix, 3 x 3, such as scipy's Rotation.as_matrix() gives"
    try:
        turn = np.asarray(rotation, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(advice.format("is no matrix of numbers")) from None
    if turn.shape != (3, 3):
        raise ValueError(advice.format(f"has the shape {turn.shape}"))
    off = float(np.abs(turn.T @ turn - np.eye(3)).max()) if np.isfinite(turn).all() else math.nan
    if not off <= ROUNDED:
        raise ValueError(advice.format(f"is no rotation, R'R is off the identity by {off:.3g}"))
    if np.linalg.det(turn) < 0.0:
        raise ValueError(advice.format("is a reflection") + "; mirror the mesh instead")
    if off <= EXACT:
        return turn
    left, _, right = np.linalg.svd(turn)
    return left @ right


def _checked_mesh(name: str, mesh: Any) -> Mesh:
    vertices, faces = np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)
    if len(faces) == 0:
        raise ValueError(f"the mesh of {name} has no triangles")
    if vertices.shape[1:] != (3,) or faces.shape[1:] != (3,):
        raise ValueError(f"the mesh of {name} has shapes {vertices.shape}, {faces.shape}; pass triangles, (n, 3) and (m, 3)")
    if not len(vertices) or not np.abs(vertices).max() <= LARGEST:
        raise ValueError(f"the mesh of {name} has a vertex that is not finite, beyond {LARGEST:g} m, or none at all")
    if faces.min() < 0 or faces.max() >= len(vertices):
        raise ValueError(f"the mesh of {name} names vertex {faces.max()}; it has {len(vertices)}, counted from 0")
    return Mesh(name, vertices, faces)


def _checked_color(name: str, color: Any) -> tuple[float, float, float, float]:
    try:
        values = () if isinstance(color, str) else tuple(float(c) for c in color)
    except (TypeError, ValueError):
        values = ()
    if len(values) not in (3, 4) or not all(0.0 <= c <= 1.0 for c in values):
        raise ValueError(f"the color of {name} is {color!r}; pass three or four numbers from 0 to 1")
    red, green, blue, alpha = (*values, 1.0)[:4]
    return red, green, blue, alpha


def _check_freedom(key: str, freedom: Freedom) -> None:
    """A range and a largest force may be infinite, nothing else, and nothing may be NaN."""
    open_ended, finite = [freedom.lower, freedom.upper], [freedom.stiffness, freedom.damping, freedom.restitution]
    if (drive := freedom.drive) is not None:
        open_ended.append(drive.max_force)
        finite += [drive.target, drive.target_velocity, drive.stiffness, drive.damping]
    if any(map(math.isnan, open_ended)) or not all(map(math.isfinite, finite)):
        raise ValueError(f"{key} is {freedom!r}; only a range and a largest force may be infinite, and none NaN")
