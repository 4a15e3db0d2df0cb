"""Rigidbodies and colliders."""

from __future__ import annotations

from ....unity.scene import BoxCollider, CapsuleCollider, Collider, MeshCollider, Rigidbody, SphereCollider
from ..text.dialects import Dialect
from ..text.documents import component_head, layers, version
from ..text.yaml import Fields, Plain, placed, vector

INTERPOLATION = {"None": 0, "Interpolate": 1, "Extrapolate": 2}
DETECTION = {"Discrete": 0, "Continuous": 1, "ContinuousDynamic": 2, "ContinuousSpeculative": 3}
CONSTRAINTS = {
    "FreezePositionX": 2,
    "FreezePositionY": 4,
    "FreezePositionZ": 8,
    "FreezePosition": 14,
    "FreezeRotationX": 16,
    "FreezeRotationY": 32,
    "FreezeRotationZ": 64,
    "FreezeRotation": 112,
    "FreezeAll": 126,
}
COOKING = 30
"""MeshColliderCookingOptions: all four, as a new MeshCollider has them."""
LEAST_INERTIA = 1e-9
"""kg m^2: Unity refuses moments that are not above zero."""

ColliderClass = tuple[int, str]


def rigidbody_fields(body: Rigidbody, owner: int, dialect: Dialect) -> Fields:
    mass: Fields = {}
    if dialect.mass_properties:
        mass = {
            "m_CenterOfMass": placed(body.centerOfMass),
            "m_InertiaTensor": vector(
                [moment if moment > 0.0 else LEAST_INERTIA for moment in body.inertiaTensor]
            ),
            "m_InertiaRotation": placed(body.inertiaTensorRotation),
            **layers(True),
            "m_ImplicitCom": 0,
            "m_ImplicitTensor": 0,
        }
    frozen = 0
    for word in body.constraints:
        frozen |= CONSTRAINTS[word]
    return {
        **component_head(owner),
        **version(dialect.rigidbody),
        "m_Mass": body.mass,
        "m_Drag": body.linearDamping,
        "m_AngularDrag": body.angularDamping,
        **mass,
        "m_UseGravity": body.useGravity,
        "m_IsKinematic": body.isKinematic,
        "m_Interpolate": INTERPOLATION[body.interpolation],
        "m_Constraints": frozen,
        "m_CollisionDetection": DETECTION[body.collisionDetectionMode],
    }


def collider_class(collider: Collider) -> ColliderClass:
    """Unity's number and name."""
    kinds: dict[type[Collider], ColliderClass] = {
        BoxCollider: (65, "BoxCollider"),
        SphereCollider: (135, "SphereCollider"),
        CapsuleCollider: (136, "CapsuleCollider"),
        MeshCollider: (64, "MeshCollider"),
    }
    return kinds[type(collider)]


def collider_fields(collider: Collider, owner: int, material: Plain, mesh: Plain, dialect: Dialect) -> Fields:
    """material, mesh: references, of the mesh where the collider has one."""
    priority: Fields = {"m_LayerOverridePriority": 0} if dialect.layer_overrides else {}
    contacts: Fields = {"m_ProvidesContacts": 0} if dialect.layer_overrides else {}
    head = {
        **component_head(owner),
        "m_Material": material,
        **layers(dialect.layer_overrides),
        **priority,
        "m_IsTrigger": collider.isTrigger,
        **contacts,
        "m_Enabled": collider.enabled,
    }
    if isinstance(collider, BoxCollider):
        shape: Fields = {"m_Size": placed(collider.size), "m_Center": placed(collider.center)}
        return {**head, **version(dialect.box), **shape}
    if isinstance(collider, SphereCollider):
        shape = {"m_Radius": collider.radius, "m_Center": placed(collider.center)}
        return {**head, **version(dialect.sphere), **shape}
    if isinstance(collider, CapsuleCollider):
        shape = {
            "m_Radius": collider.radius,
            "m_Height": collider.height,
            "m_Direction": "XYZ".index(collider.direction),
            "m_Center": placed(collider.center),
        }
        return {**head, **version(dialect.capsule), **shape}
    assert isinstance(collider, MeshCollider)
    shape = {"m_Convex": collider.convex, "m_CookingOptions": COOKING, "m_Mesh": mesh}
    return {**head, **version(dialect.mesh_collider), **shape}
