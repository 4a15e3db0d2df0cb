"""Unity's own nouns: what a Unity developer would type, with every default still in place.

Frozen dataclasses, one noun a file.  Fields carry the names of Unity's C# API in its camelCase, so that a target needs no
table of names and a reader needs no manual; units and frame are Unity's: left-handed, +Y up, +Z forward, metres, kilograms,
seconds, degrees.  References between objects are indices into the lists of ``UnityScene``.  Targets leave defaults out or
write them, as their format wants; what a target has no place for it tells in the report.
"""

from .articulation_body import ArticulationBody, ArticulationDrive
from .assets.animation_clip import AnimationClip, Track
from .assets.material import Material
from .assets.mesh import Mesh
from .assets.physics_material import PhysicsMaterial
from .colliders.box_collider import BoxCollider
from .colliders.capsule_collider import CapsuleCollider
from .colliders.collider import Collider
from .colliders.mesh_collider import MeshCollider
from .colliders.sphere_collider import SphereCollider
from .constraint import Constraint, Feature
from .coupling import Coupling, CouplingTerm, JointCoordinate
from .game_object import Component, GameObject
from .ignored_collision import IgnoredCollision
from .joints.configurable_joint import (
    ConfigurableJoint,
    JointDrive,
    SoftJointLimit,
    SoftJointLimitSpring,
    StatedAxes,
    StatedAxis,
)
from .joints.fixed_joint import FixedJoint
from .joints.hinge_joint import HingeJoint, JointLimits, JointMotor, JointSpring
from .joints.joint import Joint
from .mesh_filter import MeshFilter
from .mesh_renderer import MeshRenderer
from .mobility import BodyFreedom, ClosureGap, Island, Mobility
from .physics import Physics
from .rigidbody import Rigidbody
from .scene import Source, UnityScene
from .transform import Transform
from .vectors import IDENTITY, ONE, ZERO, Color, Quaternion, Vector2, Vector3

__all__ = [
    "IDENTITY",
    "ONE",
    "ZERO",
    "AnimationClip",
    "ArticulationBody",
    "ArticulationDrive",
    "BodyFreedom",
    "BoxCollider",
    "CapsuleCollider",
    "ClosureGap",
    "Collider",
    "Color",
    "Component",
    "ConfigurableJoint",
    "Constraint",
    "Coupling",
    "CouplingTerm",
    "Feature",
    "FixedJoint",
    "GameObject",
    "HingeJoint",
    "IgnoredCollision",
    "Island",
    "Joint",
    "JointCoordinate",
    "JointDrive",
    "JointLimits",
    "JointMotor",
    "JointSpring",
    "Material",
    "Mesh",
    "MeshCollider",
    "MeshFilter",
    "MeshRenderer",
    "Mobility",
    "Physics",
    "PhysicsMaterial",
    "Quaternion",
    "Rigidbody",
    "SoftJointLimit",
    "SoftJointLimitSpring",
    "StatedAxes",
    "StatedAxis",
    "Source",
    "SphereCollider",
    "Track",
    "Transform",
    "UnityScene",
    "Vector2",
    "Vector3",
]
