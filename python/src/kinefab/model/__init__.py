"""The scene between source and Unity: the nouns every stage speaks in.

Frame of every ``Scene``: right-handed, +Y up, +Z forward, metres, kilograms, seconds, radians.
A reader in ``sources`` turns and scales its source into this frame (mirroring only what is left-handed);
``unity/frames.py`` holds the one mirror on the way out.

Twists and freedoms are ordered linear first: (tx, ty, tz, rx, ry, rz).
"Ground" is the world and everything fixed to it; it is written ``None`` where a node index is asked for.
"""

from .animation import AnimationClip, Repeat, Track
from .boundary import Face, FaceKind
from .colliders import Collider, ColliderKind, Combine, PhysicsMaterial
from .constraints import Constraint, ConstraintKind, DofRecord, Feature, FeatureKind, Sense, Side
from .couplings import Coupling, CouplingKind, Term
from .freedoms import (
    FREE,
    FREEDOM_NAMES,
    LOCKED,
    MOTOR_DAMPING,
    RX,
    RY,
    RZ,
    TX,
    TY,
    TZ,
    Drive,
    Freedom,
    Motion,
    Passive,
    SphericalDrive,
)
from .ids import IN_BRACKETS, FreeIds
from .joints import UNLOCKED, Joint, JointKind, alike_from_both_sides, freedoms_of, kind_of, unlocked_of
from .meshes import Mesh, MeshKey, MeshReference
from .pairs import Apart, Colliding, ignored_groups
from .parts import Body, Dynamics, MassProperties, Node, NodeKind, Site
from .scene import EARTH, Physics, Scene, Source, SourceFile
from .sides import Exchange, exchange_of, is_same_from_both_sides
from .surfaces import PLAIN, AlphaMode, Surface, Texture, Wrap

__all__ = [
    "AlphaMode",
    "AnimationClip",
    "Apart",
    "Body",
    "Collider",
    "ColliderKind",
    "Colliding",
    "Combine",
    "Constraint",
    "ConstraintKind",
    "Coupling",
    "CouplingKind",
    "DofRecord",
    "Drive",
    "Dynamics",
    "EARTH",
    "Exchange",
    "FREE",
    "FREEDOM_NAMES",
    "Face",
    "FaceKind",
    "Feature",
    "FeatureKind",
    "FreeIds",
    "Freedom",
    "IN_BRACKETS",
    "Joint",
    "JointKind",
    "LOCKED",
    "MOTOR_DAMPING",
    "MassProperties",
    "Mesh",
    "MeshKey",
    "MeshReference",
    "Motion",
    "PLAIN",
    "Node",
    "NodeKind",
    "Passive",
    "Physics",
    "PhysicsMaterial",
    "RX",
    "RY",
    "RZ",
    "Repeat",
    "Scene",
    "Sense",
    "Side",
    "Site",
    "Source",
    "SourceFile",
    "SphericalDrive",
    "Surface",
    "TX",
    "TY",
    "TZ",
    "Term",
    "Texture",
    "Track",
    "UNLOCKED",
    "Wrap",
    "alike_from_both_sides",
    "exchange_of",
    "freedoms_of",
    "ignored_groups",
    "is_same_from_both_sides",
    "kind_of",
    "unlocked_of",
]
