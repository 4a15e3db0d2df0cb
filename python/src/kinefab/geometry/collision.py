"""The meshes that colliders need beside those that are drawn: convex hulls and cylinders."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ..diagnostics import Report
from ..model import Body, Collider, ColliderKind, Mesh, Node, Scene
from ..options import ColliderShape, Ground
from ..rigid import RigidGroups, dynamic_nodes
from .contact.decomposition import convex_pieces
from .contact.neighbours import meshes_near_others
from .hulls import collision_hulls
from .recognition import recognised

SIDES = 32
"""Of the prism that stands for a cylinder: 124 triangles, half a percent of the radius off."""

Cylinder = tuple[float, float]
"""Radius and length, metres."""


@dataclass(frozen=True, slots=True, eq=False)
class CollisionMeshes:
    """hulls: by the number of the mesh that they enclose.  pieces: of hollow ones, convex, by the same.  cylinders: by
    radius and length.  shapes: of meshes that are a box, ball or capsule, by the same."""

    hulls: Mapping[int, Mesh]
    pieces: Mapping[int, tuple[Mesh, ...]]
    cylinders: Mapping[Cylinder, Mesh]
    shapes: Mapping[int, Collider]


def collision_meshes(
    scene: Scene, groups: RigidGroups, shape: ColliderShape, ground: Ground, report: Report
) -> CollisionMeshes:
    """What the colliders of a scene need.

    shape: for bodies of nodes that state neither colliders nor their shape.  ground: what stands for it.
    """
    asked = _Asked.of(scene, groups, shape)
    for body in asked.not_convex:
        report.approximated(f"collider {body}", "COLLIDER_NOT_CONVEX", body=body)
    hulls = collision_hulls(scene, asked.hulled, report)
    pieces = _pieces(scene, groups, ground, asked, hulls, report)
    return CollisionMeshes(hulls, pieces, asked.cylinders, asked.shapes.found)


def hollow_pieces(
    scene: Scene, groups: RigidGroups, shape: ColliderShape, report: Report
) -> Mapping[int, tuple[Mesh, ...]]:
    """The convex pieces alone, for a format whose readers make the hulls.  The ground is a body there."""
    asked = _Asked.of(scene, groups, shape)
    hulls = collision_hulls(scene, asked.split, Report())
    return _pieces(scene, groups, Ground.BODY, asked, hulls, report)


def _pieces(
    scene: Scene,
    groups: RigidGroups,
    ground: Ground,
    asked: _Asked,
    hulls: Mapping[int, Mesh],
    report: Report,
) -> Mapping[int, tuple[Mesh, ...]]:
    near = meshes_near_others(scene, groups, ground, hulls) if asked.split else frozenset[int]()
    return convex_pieces(scene, asked.split, hulls, near, report)


def possible(stated: Collider) -> Collider:
    """A collider that the source states, as it can be: a trigger's mesh is convex pieces, as Unity takes no other of one anywhere."""
    cut = stated.kind is ColliderKind.MESH and stated.trigger
    return replace(stated, kind=ColliderKind.PIECES) if cut else stated


class Shapes:
    """The boxes, balls and capsules among the meshes of a scene, each looked at once."""

    def __init__(self, meshes: Sequence[Mesh]):
        self._meshes = meshes
        self._looked_at: set[int] = set()
        self.found: dict[int, Collider] = {}

    def is_one(self, body: Body) -> bool:
        """Whether an engine's own shape stands for the body: not where its scale would make another of it."""
        mesh = body.mesh
        if mesh is None:
            return False
        if mesh not in self._looked_at:
            self._looked_at.add(mesh)
            if (shape := recognised(self._meshes[mesh])) is not None:
                self.found[mesh] = shape
        shape = self.found.get(mesh)
        return shape is not None and keeps_its_shape(shape, body.scale)


def keeps_its_shape(shape: Collider, scale: tuple[float, float, float]) -> bool:
    """Whether a box, ball or capsule is one of the same kind where its mesh is scaled along the mesh's own axes."""
    even = max(map(abs, scale)) <= min(map(abs, scale)) * (1.0 + 1e-9)
    along_axes = bool((np.abs(shape.pose.rotation) == np.eye(3)).all())
    return even or (shape.kind is ColliderKind.BOX and along_axes)


def is_split(shape: ColliderShape, moves: bool) -> bool:
    """Whether a body of which no colliders are stated has convex pieces where it is hollow.  moves: whether forces move it."""
    return shape is ColliderShape.DECOMPOSE or (shape is ColliderShape.AUTO and moves)


@dataclass(slots=True, eq=False)
class _Asked:
    """hulled, split: meshes, each with its body's name.  not_convex: bodies that are asked to be their true mesh and cannot."""

    shapes: Shapes
    hulled: list[tuple[int, str]] = field(default_factory=list[tuple[int, str]])
    split: list[tuple[int, str]] = field(default_factory=list[tuple[int, str]])
    cylinders: dict[Cylinder, Mesh] = field(default_factory=dict[Cylinder, Mesh])
    not_convex: list[str] = field(default_factory=list[str])

    @classmethod
    def of(cls, scene: Scene, groups: RigidGroups, shape: ColliderShape) -> _Asked:
        asked = cls(Shapes(scene.meshes))
        for node, moves in zip(scene.nodes, dynamic_nodes(scene, groups)):
            if node.colliders is None:
                asked.add_bodies(node, node.collision or shape, moves)
            for stated in node.colliders or ():
                asked.add_collider(node, possible(stated), moves)
        return asked

    def add_bodies(self, node: Node, shape: ColliderShape, moves: bool) -> None:
        bodies = node.bodies
        if shape is ColliderShape.AUTO:
            bodies = [body for body in bodies if not self.shapes.is_one(body)]
        own = [(b.mesh, f"{node.id}/{b.name}") for b in bodies if b.mesh is not None]
        if shape in (ColliderShape.HULL, ColliderShape.DECOMPOSE) or (
            moves and shape in (ColliderShape.MESH, ColliderShape.AUTO)
        ):
            self.hulled += own
        if is_split(shape, moves):
            self.split += own
        self.not_convex += [name for _, name in own] if shape is ColliderShape.MESH and moves else []

    def add_collider(self, node: Node, collider: Collider, moves: bool) -> None:
        name = f"{node.id}/{collider.name or collider.kind.value}"
        if collider.kind is ColliderKind.CYLINDER:
            size = (collider.radius, collider.length)
            if min(size) > 0.0:
                self.cylinders.setdefault(size, prism(*size))
        elif collider.mesh is not None and (collider.kind is not ColliderKind.MESH or moves):
            self.hulled.append((collider.mesh, name))
            self.split += [(collider.mesh, name)] if collider.kind is ColliderKind.PIECES else []


def prism(radius: float, length: float) -> Mesh:
    """A cylinder along Z about the origin, as a prism that encloses half of its edge's error."""
    turn = 2.0 * math.pi * np.arange(SIDES) / SIDES
    across = 0.5 * radius * (1.0 + 1.0 / math.cos(math.pi / SIDES))
    ring = np.column_stack([across * np.cos(turn), across * np.sin(turn)])
    low, high = (np.column_stack([ring, np.full(SIDES, z)]) for z in (-0.5 * length, 0.5 * length))
    i = np.arange(SIDES)
    j = (i + 1) % SIDES
    sides = [np.column_stack([i, j, j + SIDES]), np.column_stack([i, j + SIDES, i + SIDES])]
    k = np.arange(1, SIDES - 1)
    caps = [
        np.column_stack([np.zeros_like(k), k + 1, k]),
        np.column_stack([np.zeros_like(k), k, k + 1]) + SIDES,
    ]
    faces = np.vstack([*sides, *caps]).astype(np.int64)
    return Mesh("cylinder", np.vstack([low, high]), faces, origin=f"prism {radius:.9g} {length:.9g}")
