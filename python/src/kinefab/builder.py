"""Building a scene in a script: parts from meshes, and joints between them.

    lid = scene.add_part("Lid", trimesh.creation.box((0.4, 0.02, 0.3)), translation=(0, 0.21, 0))
    scene.add_hinge(box, lid, point=(0, 0.2, -0.15), axis=(1, 0, 0), limits=(0, 110))

Positions are world positions of the exported pose, right-handed, +Y up, +Z forward, metres and degrees.
"""

from __future__ import annotations

import math
from typing import Any, Sequence

import numpy as np

from . import model
from .model import Body, Freedom, Joint, JointKind, MassProperties, Mesh, Motion, Node, NodeKind, freedoms_of
from .spatial import Pose, frame_from_axes, vector

Vector = Sequence[float]


class Scene(model.Scene):
    """A scene that a script fills.  Every ``add_*`` of a part returns its index, for parents and joints.

    A wrong call raises TypeError (a name where an index is wanted) or ValueError (no such index, an axis
    without length, limits in the wrong order); the message says what to pass.
    """

    __slots__ = ("_copies", "_counted")

    def __init__(self, *args: Any, **fields: Any) -> None:
        super().__init__(*args, **fields)
        self._copies: dict[str, int] = {}
        self._counted = 0

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
        rotation: proper rotation matrix, shape (3, 3); None for none.
        parent: index of an assembly, or None.  grounded: fixed to the world.
        density: kg/m^3, None for the export's default.  mass: given instead of computed.
        color: linear red green blue (alpha), 0..1.
        Raises ValueError for a mesh without triangles or a density that is not above zero.
        """
        if density is not None and not density > 0.0:
            raise ValueError(f"the density of {name} is {density}; it must be above zero")
        bodies: tuple[Body, ...] = ()
        if mesh is not None:
            faces = np.asarray(mesh.faces, dtype=np.int64)
            if len(faces) == 0:
                raise ValueError(f"the mesh of {name} has no triangles")
            materials: tuple[int, ...] = ()
            if color is not None:
                red, green, blue, alpha = (*map(float, color), 1.0)[:4]
                self.materials.append(model.Material(name, (red, green, blue, alpha)))
                materials = (len(self.materials) - 1,)
            self.meshes.append(Mesh(name, np.asarray(mesh.vertices, dtype=np.float64), faces))
            bodies = (Body(name, len(self.meshes) - 1, materials, density),)
        fields = {"bodies": bodies, "mass": mass, "grounded": grounded}
        return self._add_node(name, NodeKind.PART, parent, translation, rotation, **fields)

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
        node_id = self._unused(name if parent is None else f"{self.nodes[parent].id}/{name}")
        turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=np.float64)
        self.nodes.append(Node(node_id, name, kind, parent, Pose(turn, vector(translation)), **fields))
        return len(self.nodes) - 1

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
        Raises TypeError for a side that is no index, ValueError for one that no node has, for an axis
        without length, and for a part joined to itself.
        """
        if a is not None:
            self._check_index(a, "a")
        self._check_index(b, "b")
        if a == b:
            raise ValueError(f"a and b are both {a}; pass two different parts, or None for the world as a")
        if not np.linalg.norm(vector(axis)) > 0.0:
            raise ValueError(f"the axis {axis!r} has no direction; pass a direction in the world, such as (0, 0, 1)")
        world = Pose(
            frame_from_axes(vector(axis), None if secondary is None else vector(secondary)), vector(point)
        )
        frames = [self.pose(side).inverse() @ world for side in (a, b)]
        joint_id = name or f"{kind.value}:{len(self.joints) + 1}"
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
    if isinstance(limits, str) or not hasattr(limits, "__len__") or len(limits) != 2:
        raise TypeError(f"limits are {limits!r}; pass two numbers, (lower, upper), or None")
    lower, upper = (float(end) for end in limits)
    if not lower <= upper:
        raise ValueError(f"limits are {limits!r}; pass (lower, upper) with lower not above upper")
    return Freedom(Motion.LIMITED, lower * unit, upper * unit)
