"""The scene between source and Unity: the nouns every stage speaks in.

Frame of every ``Scene``: right-handed, +Y up, +Z forward, metres, kilograms, seconds, radians.
A reader in ``sources`` turns and scales its source into this frame (mirroring only what is left-handed);
``unity/frames.py`` holds the one mirror on the way out.

Twists and freedoms are ordered linear first: (tx, ty, tz, rx, ry, rz).
"Ground" is the world and everything fixed to it; it is written ``None`` where a node index is asked for.
"""

from .constraints import Constraint, ConstraintKind, DofRecord, Feature, FeatureKind, Sense, Side
from .joints import (
    FREE,
    FREEDOM_NAMES,
    LOCKED,
    RX,
    RY,
    RZ,
    TX,
    TY,
    TZ,
    UNLOCKED,
    Coupling,
    CouplingKind,
    Drive,
    Freedom,
    Joint,
    JointKind,
    Motion,
    freedoms_of,
    kind_of,
    unlocked_of,
)
from .parts import Body, MassProperties, Material, Mesh, MeshKey, MeshReference, Node, NodeKind
from .scene import Physics, Scene, Source

__all__ = [
    "Body",
    "Constraint",
    "ConstraintKind",
    "Coupling",
    "CouplingKind",
    "DofRecord",
    "Drive",
    "FREE",
    "FREEDOM_NAMES",
    "Feature",
    "FeatureKind",
    "Freedom",
    "Joint",
    "JointKind",
    "LOCKED",
    "MassProperties",
    "Material",
    "Mesh",
    "MeshKey",
    "MeshReference",
    "Motion",
    "Node",
    "NodeKind",
    "Physics",
    "RX",
    "RY",
    "RZ",
    "Scene",
    "Sense",
    "Side",
    "Source",
    "TX",
    "TY",
    "TZ",
    "UNLOCKED",
    "freedoms_of",
    "kind_of",
    "unlocked_of",
]
