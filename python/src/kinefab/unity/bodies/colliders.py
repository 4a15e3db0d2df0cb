"""Colliders of bodies: those that the source states, else what the export chooses: convex hull, box or the mesh itself."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...geometry.collision import CollisionMeshes, keeps_its_shape
from ...model import Body, Collider, ColliderKind, Mesh
from ...options import ColliderShape, Ground
from ...spatial import Array, Pose
from .. import frames
from ..scene import BoxCollider, CapsuleCollider, MeshCollider, SphereCollider
from ..scene.colliders.collider import CHOSEN
from ..scene.vectors import ONE, Vector3, vector3

UnityCollider = BoxCollider | SphereCollider | CapsuleCollider | MeshCollider

ALONG = 1e-9
"""Sine of the angle up to which a shape's axis is one of its object's."""


@dataclass(frozen=True, slots=True, eq=False)
class Colliders:
    """What geometry made for the colliders.

    shape: what was asked for where the source says nothing.
    hull_of: for each mesh of the scene that has one, the index of its hull among all meshes of the file.
    cylinder_of: for each (radius, length) the index of a mesh of it along Z.
    pieces_of: for each hollow mesh the indices of its convex pieces.
    made: those meshes, to stand behind the scene's own.
    ground: what stands for it.
    shape_of: for each mesh that is a box, ball or capsule that shape, in the mesh's frame.
    """

    shape: ColliderShape = ColliderShape.HULL
    hull_of: Mapping[int, int] = field(default_factory=dict[int, int])
    cylinder_of: Mapping[tuple[float, float], int] = field(default_factory=dict[tuple[float, float], int])
    made: tuple[Mesh, ...] = ()
    pieces_of: Mapping[int, Sequence[int]] = field(default_factory=dict[int, Sequence[int]])
    ground: Ground = Ground.WORLD
    shape_of: Mapping[int, Collider] = field(default_factory=dict[int, Collider])

    @classmethod
    def behind(cls, own: int, made: CollisionMeshes, shape: ColliderShape, ground: Ground) -> Colliders:
        """Those of a scene with ``own`` meshes, behind which the made ones stand: hulls, cylinders, pieces."""
        numbers = itertools.count(own)
        hull_of = {mesh: next(numbers) for mesh in made.hulls}
        cylinder_of = {size: next(numbers) for size in made.cylinders}
        pieces_of = {mesh: [next(numbers) for _ in pieces] for mesh, pieces in made.pieces.items()}
        pieces = itertools.chain.from_iterable(made.pieces.values())
        meshes = (*made.hulls.values(), *made.cylinders.values(), *pieces)
        return cls(shape, hull_of, cylinder_of, meshes, pieces_of, ground, made.shapes)


def box_about(mesh: Mesh, **common: Any) -> BoxCollider:
    """Along the mesh's own axes.  common: fields of every collider."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    center = vector3(frames.point(0.5 * (low + high)))
    return BoxCollider(**common, center=center, size=vector3(np.subtract(high, low)))


@dataclass(frozen=True, slots=True, eq=False)
class PlacedCollider:
    """A component, and the frame of the object that it needs: the node's own where pose is None."""

    component: UnityCollider
    pose: Pose | None = None
    scale: Vector3 = ONE


def chosen_colliders(
    colliders: Colliders, shape: ColliderShape, body: Body, mesh: Mesh, dynamic: bool, node: str, report: Report
) -> list[PlacedCollider]:
    """The colliders of a body whose source states none, in its mesh's frame.  shape: asked for.  mesh: the body's.
    dynamic: the body has a Rigidbody that is moved by forces, where Unity takes convex meshes only.  node: id, for the report."""
    index = body.mesh
    assert index is not None
    if shape is ColliderShape.NONE:
        return []
    choice = {"extras": {CHOSEN: shape.value}}
    own = colliders.shape_of.get(index) if shape is ColliderShape.AUTO else None
    if own is not None and keeps_its_shape(own, body.scale) and (placed := without_mesh(own, choice)) is not None:
        told = {"body": f"{node}/{body.name}", "shape": type(placed.component).__name__}
        report.noted(f"collider {node}/{body.name}", "COLLIDER_RECOGNISED", **told)
        return [placed]
    made = _meshes_of(colliders, shape, index, mesh, dynamic)
    return [PlacedCollider(replace(component, **choice)) for component in made]


def _meshes_of(
    colliders: Colliders, shape: ColliderShape, index: int, mesh: Mesh, dynamic: bool
) -> list[UnityCollider]:
    if shape in (ColliderShape.MESH, ColliderShape.AUTO) and not dynamic:
        return [MeshCollider(mesh=index)]
    if shape is not ColliderShape.BOX and shape is not ColliderShape.HULL and index in colliders.pieces_of:
        return [MeshCollider(mesh=piece, convex=True) for piece in colliders.pieces_of[index]]
    if shape is ColliderShape.BOX or index not in colliders.hull_of:
        return [box_about(mesh)]
    return [MeshCollider(mesh=colliders.hull_of[index], convex=True)]


def _is_flat(collider: Collider, dynamic: bool) -> bool:
    """Whether a cylinder or a scaled mesh has no volume, of which no hull can be made; a mesh that stands still may be a sheet."""
    if collider.kind is ColliderKind.CYLINDER:
        return min(collider.radius, collider.length) <= 0.0
    nothing = sum(stretch == 0.0 for stretch in collider.scale)
    return nothing > (1 if collider.kind is ColliderKind.MESH and not dynamic else 0)


def stated_collider(
    collider: Collider,
    colliders: Colliders,
    meshes: Sequence[Mesh],
    dynamic: bool,
    material: int | None,
    node: str,
    report: Report,
) -> list[PlacedCollider]:
    """A collider that the source states, of several parts where it is convex pieces; the report tells what Unity has no
    shape for.

    meshes: of the scene.  material: index of its physics material.  node: id, for the report.
    """
    feature = f"collider {node}/{collider.name or collider.kind.value}"
    common: dict[str, Any] = {
        "isTrigger": collider.trigger,
        "enabled": collider.enabled,
        "material": material,
        "group": collider.group,
        "id": collider.name,
    }
    if (simple := without_mesh(collider, common)) is not None:
        report.kept(feature, collider.where)
        return [simple]
    if _is_flat(collider, dynamic):
        report.dropped(feature, "COLLIDER_FLAT_DROPPED", collider.where, collider=feature)
        return []
    if collider.kind is ColliderKind.CYLINDER:
        mesh = colliders.cylinder_of[collider.radius, collider.length]
        report.approximated(feature, "COLLIDER_CYLINDER_AS_MESH", collider.where, collider=feature)
        return [_meshed(MeshCollider(**common, mesh=mesh, convex=True), collider)]
    assert collider.mesh is not None, "a hull or mesh collider names its mesh"
    if collider.kind is ColliderKind.MESH and not dynamic:
        report.kept(feature, collider.where)
        return [_meshed(MeshCollider(**common, mesh=collider.mesh), collider)]
    if collider.mesh not in colliders.hull_of:
        report.approximated(feature, "COLLIDER_FLAT_AS_BOX", collider.where, collider=feature)
        return [_meshed(box_about(meshes[collider.mesh], **common), collider)]
    if collider.kind is ColliderKind.MESH:
        report.approximated(feature, "COLLIDER_MESH_AS_HULL", collider.where, collider=feature)
    else:
        report.kept(feature, collider.where)
    convex: Sequence[int] = (colliders.hull_of[collider.mesh],)
    if collider.kind is ColliderKind.PIECES:
        convex = colliders.pieces_of.get(collider.mesh, convex)
    return [_meshed(MeshCollider(**common, mesh=mesh, convex=True), collider) for mesh in convex]


def without_mesh(collider: Collider, common: Mapping[str, Any]) -> PlacedCollider | None:
    """A ball, box or capsule, on an object of its own where its axes are not the node's; None for any other shape."""
    center, turn = vector3(frames.point(collider.pose.translation)), collider.pose.rotation
    if collider.kind is ColliderKind.SPHERE:
        return PlacedCollider(SphereCollider(**common, center=center, radius=collider.radius))
    if collider.kind is ColliderKind.BOX:
        size = _along_axes(np.array(collider.size), turn)
        if size is None:
            return PlacedCollider(BoxCollider(**common, size=collider.size), collider.pose)
        return PlacedCollider(BoxCollider(**common, center=center, size=vector3(size)))
    if collider.kind is ColliderKind.CAPSULE:
        along = _along_axes(np.array([0.0, 0.0, 1.0]), turn)
        height = collider.length + 2.0 * collider.radius
        shape: dict[str, Any] = {**common, "radius": collider.radius, "height": height}
        if along is None:
            return PlacedCollider(CapsuleCollider(**shape, direction="Z"), collider.pose)
        direction = "XYZ"[int(along.argmax())]
        return PlacedCollider(CapsuleCollider(**shape, center=center, direction=direction))
    return None


def _meshed(component: MeshCollider | BoxCollider, collider: Collider) -> PlacedCollider:
    pose, scale = collider.pose, collider.scale
    at_home = not pose.translation.any() and np.abs(pose.rotation - np.eye(3)).max() < ALONG
    return PlacedCollider(component, None if at_home and scale == ONE else pose, scale)


def _along_axes(size: Array, turn: Array) -> Array | None:
    """Extents along the outer axes of a shape turned by right angles only; None for any other turn."""
    spread = np.abs(turn)
    if np.minimum(spread, np.abs(1.0 - spread)).max() > ALONG:
        return None
    return spread.round() @ size
