"""Rigidbodies and colliders."""

from __future__ import annotations

from functools import cache, lru_cache

from ....unity.scene import BoxCollider, CapsuleCollider, Collider, MeshCollider, Rigidbody, SphereCollider
from ....unity.scene.vectors import Quaternion, Vector3
from ..text.dialects import Dialect
from ..text.documents import COMPONENT, layers, version
from ..text.forms import BLANK, Form
from ..text.yaml import Fields, Plain, local, number, placed, vector

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


@cache
def _rigidbody(dialect: Dialect) -> Form:
    mass: Fields = {}
    if dialect.mass_properties:
        mass = {
            "m_CenterOfMass": BLANK,
            "m_InertiaTensor": BLANK,
            "m_InertiaRotation": BLANK,
            **layers(True),
            "m_ImplicitCom": 0,
            "m_ImplicitTensor": 0,
        }
    fields: Fields = {
        **COMPONENT,
        **version(dialect.rigidbody),
        "m_Mass": BLANK,
        "m_Drag": BLANK,
        "m_AngularDrag": BLANK,
        **mass,
        "m_UseGravity": BLANK,
        "m_IsKinematic": BLANK,
        "m_Interpolate": BLANK,
        "m_Constraints": BLANK,
        "m_CollisionDetection": BLANK,
    }
    return Form(54, "Rigidbody", fields)


def rigidbody(body: Rigidbody, file_id: int, owner: int, dialect: Dialect) -> str:
    """The document.  owner: fileID of the GameObject."""
    mass: tuple[Plain, ...] = ()
    if dialect.mass_properties:
        mass = _mass(body.centerOfMass, body.inertiaTensor, body.inertiaTensorRotation)
    frozen = 0
    for word in body.constraints:
        frozen |= CONSTRAINTS[word]
    return _rigidbody(dialect).filled(
        file_id,
        local(owner),
        number(body.mass),
        number(body.linearDamping),
        number(body.angularDamping),
        *mass,
        int(body.useGravity),
        int(body.isKinematic),
        INTERPOLATION[body.interpolation],
        frozen,
        DETECTION[body.collisionDetectionMode],
    )


@lru_cache(maxsize=4096)
def _mass(center: Vector3, inertia: Vector3, turn: Quaternion) -> tuple[Plain, ...]:
    """As it is written: the parts of a definition have it in common."""
    moments = [moment if moment > 0.0 else LEAST_INERTIA for moment in inertia]
    return placed(center), vector(moments), placed(turn)


@cache
def _collider(kind: type[Collider], dialect: Dialect) -> Form:
    kinds: dict[type[Collider], tuple[int, int, tuple[str, ...]]] = {
        BoxCollider: (65, dialect.box, ("m_Size", "m_Center")),
        SphereCollider: (135, dialect.sphere, ("m_Radius", "m_Center")),
        CapsuleCollider: (136, dialect.capsule, ("m_Radius", "m_Height", "m_Direction", "m_Center")),
        MeshCollider: (64, dialect.mesh_collider, ("m_Convex", "m_CookingOptions", "m_Mesh")),
    }
    class_id, number_of_version, shape = kinds[kind]
    priority: Fields = {"m_LayerOverridePriority": 0} if dialect.layer_overrides else {}
    contacts: Fields = {"m_ProvidesContacts": 0} if dialect.layer_overrides else {}
    fields: Fields = {
        **COMPONENT,
        "m_Material": BLANK,
        **layers(dialect.layer_overrides),
        **priority,
        "m_IsTrigger": BLANK,
        **contacts,
        "m_Enabled": BLANK,
        **version(number_of_version),
        **dict.fromkeys(shape, BLANK),
    }
    return Form(class_id, kind.__name__, fields)


def collider(
    collider: Collider, file_id: int, owner: int, material: Plain, mesh: Plain, dialect: Dialect
) -> str:
    """The document.  material, mesh: references, of the mesh where the collider has one."""
    if isinstance(collider, BoxCollider):
        shape: tuple[str | int, ...] = (placed(collider.size), placed(collider.center))
    elif isinstance(collider, SphereCollider):
        shape = (number(collider.radius), placed(collider.center))
    elif isinstance(collider, CapsuleCollider):
        direction = "XYZ".index(collider.direction)
        lengths = (number(collider.radius), number(collider.height))
        shape = (*lengths, direction, placed(collider.center))
    else:
        assert isinstance(collider, MeshCollider)
        shape = (int(collider.convex), COOKING, mesh)
    head = (file_id, local(owner), material, int(collider.isTrigger), int(collider.enabled))
    return _collider(type(collider), dialect).filled(*head, *shape)
