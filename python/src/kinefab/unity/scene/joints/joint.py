from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from ..vectors import ZERO, Vector3

UNLIMITED_FORCE = 3.4028233e38
"""What the editor writes for a force of a joint without a largest one; a link's is the largest float itself."""


@dataclass(frozen=True, slots=True)
class Joint:
    """What all joints have.  It sits on the object of one body.

    connectedBody: index of the GameObject of the other body, None for the world.
    breakForce, breakTorque: newtons, newton metres; infinite: unbreakable.
    because: ids of the source's constraints or joints that it comes from.  closure: it closes a loop.
    exact: it moves just as the source's.  enabled: False where it is switched off and holds nothing, which no joint of Unity's can be.
    id: of the joint in the source, "" for one that holds a rigid group together.  name: the user's own.
    part, connectedPart: ids of the parts that the source joins, "" where they are the objects that have the Rigidbodies.
    """

    connectedBody: int | None = None
    breakForce: float = math.inf
    breakTorque: float = math.inf
    enableCollision: bool = False
    enablePreprocessing: bool = True
    massScale: float = 1.0
    connectedMassScale: float = 1.0
    because: tuple[str, ...] = ()
    closure: bool = False
    exact: bool = True
    id: str = ""
    name: str = ""
    part: str = ""
    connectedPart: str = ""
    enabled: bool = True
    extras: Mapping[str, object] = field(default_factory=dict[str, object])


@dataclass(frozen=True, slots=True)
class AnchoredJoint(Joint):
    """A joint with a place and an axis.

    anchor, axis: in the own object's frame, metres, unit vector.  connectedAnchor: in the connected body's frame, in the
    world where there is none.
    effort, speed, friction, armature: what the source states of each coordinate that moves, newtons or newton metres, metres or
    degrees a second, kilograms or kg m^2; no joint of Unity's has them.
    """

    anchor: Vector3 = ZERO
    axis: Vector3 = (1.0, 0.0, 0.0)
    autoConfigureConnectedAnchor: bool = True
    connectedAnchor: Vector3 = ZERO
    effort: float = math.inf
    speed: float = math.inf
    friction: float = 0.0
    armature: float = 0.0
