"""The parts and assemblies of a scene that a script fills."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from .. import model
from ..model import Body, Collider, MassProperties, Node, NodeKind, PhysicsMaterial, Surface
from ..options import ColliderShape
from ..spatial import Pose
from .arguments import (
    Vector,
    checked_color,
    checked_flag,
    checked_name,
    checked_pose,
    shown,
)
from .ids import Ids
from .masses import weight_of
from .materials import colliders_of, materials_of
from .shapes import Shape, shapes_of

_numbers = itertools.count()


class PartIndex(int):
    """What ``add_part`` and ``add_assembly`` return: an index that knows which scene's it is (``scene``: a number)."""

    scene: int


class Parts(model.Scene):
    """What ``Scene`` knows of its parts, before any joint."""

    __slots__ = ("_given", "_node_ids", "_number")

    def __init__(self, *args: Any, **fields: Any) -> None:
        super().__init__(*args, **fields)
        self._node_ids = Ids()
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
        mass: float | MassProperties | None = None,
        color: Vector | None = None,
        material: Surface | PhysicsMaterial | Iterable[Surface | PhysicsMaterial] | None = None,
        collider: ColliderShape | str | Collider | Iterable[Collider] | None = None,
        unit: str = "m",
    ) -> int:
        """Add a part at a world pose and return its index.

        mesh: a trimesh.Trimesh, anything with ``vertices`` and ``faces``, a trimesh.Scene, or the path of a mesh file; in
        the part's own frame.  unit: of the mesh's numbers: m, cm, mm, in, ft.
        translation: metres.  rotation: a rotation matrix (3, 3), a quaternion (x, y, z, w), Euler angles in degrees with
        their order (``("XYZ", (30, 0, 90))``), or a whole pose, ``Pose`` or (4, 4), instead of both; None for none.
        parent: index of an assembly, or None.  grounded: fixed to the world.
        density: kg/m^3, None for the export's default.  mass: instead of a density: kg, center and inertia from the mesh, or
        ``MassProperties``.
        color: linear red green blue (alpha), 0..1.
        material: how it looks (``Surface``), what it touches with (``PhysicsMaterial``), or both.
        collider: ``auto``, ``none``, ``box``, ``hull``, ``decompose`` or ``mesh`` for this part, or colliders of its own, in its frame.
        Raises TypeError for a mesh that is none, ValueError for a rotation that is none (a reflection, a scale), a number
        that is not finite, a mesh without triangles, a density not above zero or a colour outside 0..1.

        >>> scene = kinefab.Scene()
        >>> scene.add_part("Bar", trimesh.creation.box((0.4, 0.02, 0.03)), rotation=("XYZ", (30, 0, 90)), density=2700)
        0
        """
        checked_name(name, empty=False)
        checked_flag(f"grounded of {name}", grounded)
        weight = weight_of(name, mass, density)
        shapes = shapes_of(name, mesh, unit)
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
            **weight,
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
        checked_name(name, empty=False)
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
