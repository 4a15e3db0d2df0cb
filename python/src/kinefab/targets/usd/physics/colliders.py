"""CollisionAPI: shapes that the source states, and what is chosen for a mesh whose source states none."""

from __future__ import annotations

from dataclasses import dataclass

from ....geometry.contact.decomposition import SOLID, solid_share
from ....geometry.hulls import hull_of_points
from ....model import Collider, ColliderKind, Combine, Mesh, PhysicsMaterial
from ....options import ColliderShape
from ..prims import Prim

MESH, HULL, PIECES, BOX = "none", "convexHull", "convexDecomposition", "boundingCube"
"""Approximations of a mesh, as UsdPhysics names them."""
COMBINE = {
    Combine.AVERAGE: "average",
    Combine.MINIMUM: "min",
    Combine.MULTIPLY: "multiply",
    Combine.MAXIMUM: "max",
}


@dataclass(frozen=True, slots=True)
class Contact:
    """What touches on a prim.  approximation: of a mesh, "" for another shape.  material: path of its physics material."""

    approximation: str = ""
    material: str = ""
    trigger: bool = False
    enabled: bool = True


def write_contact(prim: Prim, contact: Contact) -> None:
    prim.apply("PhysicsCollisionAPI")
    if contact.approximation:
        prim.apply("PhysicsMeshCollisionAPI")
        prim.attribute("physics:approximation", "Token", contact.approximation, uniform=True)
    if contact.trigger:
        prim.apply("PhysxTriggerAPI")
    if not contact.enabled:
        prim.attribute("physics:collisionEnabled", "Bool", False)
    if contact.material:
        prim.apply("MaterialBindingAPI")
        prim.relation("material:binding:physics", contact.material)


def write_shape(prim: Prim, collider: Collider) -> None:
    """Sizes of a box, ball, capsule or cylinder whose prim has their type; round ones lie along Z."""
    sizes: dict[ColliderKind, dict[str, float]] = {
        ColliderKind.BOX: {"size": 1.0},
        ColliderKind.SPHERE: {"radius": collider.radius},
        ColliderKind.CAPSULE: {"radius": collider.radius, "height": collider.length},
        ColliderKind.CYLINDER: {"radius": collider.radius, "height": collider.length},
    }
    for name, value in sizes[collider.kind].items():
        prim.attribute(name, "Double", float(value))
    if collider.kind in (ColliderKind.CAPSULE, ColliderKind.CYLINDER):
        prim.attribute("axis", "Token", "Z", uniform=True)


SHAPES = {
    ColliderKind.BOX: "Cube",
    ColliderKind.SPHERE: "Sphere",
    ColliderKind.CAPSULE: "Capsule",
    ColliderKind.CYLINDER: "Cylinder",
}
"""Types of prims."""


class Chosen:
    """The approximation of a mesh whose source states no colliders, as the exports into Unity choose it."""

    def __init__(self) -> None:
        self._hollow: dict[int, bool | None] = {}

    def approximation(self, shape: ColliderShape, number: int, mesh: Mesh, still: bool, body: bool) -> str:
        """ "" for none.  still: no force moves it.  body: it is one all the same, whose mesh no engine takes as it is."""
        if shape is ColliderShape.NONE:
            return ""
        if shape in (ColliderShape.MESH, ColliderShape.AUTO) and still:
            return PIECES if body else MESH
        hollow = self._is_hollow(number, mesh)
        if shape is ColliderShape.BOX or hollow is None:
            return BOX
        if hollow and shape is not ColliderShape.HULL and not (shape is ColliderShape.MESH and not still):
            return PIECES
        return HULL

    def _is_hollow(self, number: int, mesh: Mesh) -> bool | None:
        """Whether its hull is no good picture of a mesh; None where it is flat and has no hull."""
        if number not in self._hollow:
            hull = hull_of_points(mesh.vertices)
            self._hollow[number] = None if hull is None else solid_share(mesh, Mesh("", *hull)) < SOLID
        return self._hollow[number]


def write_physics_material(prim: Prim, material: PhysicsMaterial) -> None:
    prim.apply("PhysicsMaterialAPI")
    prim.numbers(
        {
            "physics:staticFriction": material.static_friction,
            "physics:dynamicFriction": material.dynamic_friction,
            "physics:restitution": material.restitution,
        }
    )
    combine = {"friction": material.friction_combine, "restitution": material.restitution_combine}
    stated = {name: COMBINE[value] for name, value in combine.items() if value is not Combine.AVERAGE}
    if stated:
        prim.apply("PhysxMaterialAPI")
        for name, word in stated.items():
            prim.attribute(f"physxMaterial:{name}CombineMode", "Token", word, uniform=True)
