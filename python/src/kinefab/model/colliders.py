"""Shapes that bodies touch each other with, where a source states them."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

from ..spatial import Pose
from .meshes import MeshReference


class ColliderKind(str, Enum):
    """The shape of a collider.

    >>> import kinefab
    >>> kinefab.ColliderKind("capsule") is kinefab.ColliderKind.CAPSULE
    True
    """

    BOX = "box"
    SPHERE = "sphere"
    CAPSULE = "capsule"
    CYLINDER = "cylinder"
    HULL = "hull"
    PIECES = "pieces"
    MESH = "mesh"


class Combine(str, Enum):
    """How the values of two touching materials become one."""

    AVERAGE = "average"
    MINIMUM = "minimum"
    MULTIPLY = "multiply"
    MAXIMUM = "maximum"


@dataclass(frozen=True, slots=True)
class PhysicsMaterial:
    """name; dynamic_friction, static_friction: coefficients, not negative; restitution: 0..1.

    >>> import kinefab
    >>> scene = kinefab.Scene()
    >>> tyre = scene.add_part("Tyre", material=kinefab.PhysicsMaterial("rubber", 0.9, 1.1, restitution=0.2))
    """

    name: str = ""
    dynamic_friction: float = 0.6
    static_friction: float = 0.6
    restitution: float = 0.0
    friction_combine: Combine = Combine.AVERAGE
    restitution_combine: Combine = Combine.AVERAGE


@dataclass(frozen=True, slots=True, eq=False)
class Collider:
    """One shape of a node.

    pose: the shape's frame in the node's; the shape's centre is its origin.
    size: of a box, full extents along X Y Z, metres.  radius: of a sphere, capsule or cylinder, metres.
    length: of a capsule between the centres of its caps, of a cylinder between its ends; both lie along Z.
    mesh: index into ``Scene.meshes``, of a HULL (its convex hull), of PIECES (convex ones that it is cut into) or MESH.  scale: of that mesh, along its own axes.
    reference: where that mesh is to be loaded from, or None.
    material: None for the engine's own.  trigger: tells of contacts and stops nothing.
    group: the source's collision group or layer, "" for none; what it means stands in the node's extras.

    >>> import kinefab
    >>> pin = kinefab.Collider(kinefab.ColliderKind.CAPSULE, kinefab.Pose(translation=(0, 0.1, 0)), radius=0.02, length=0.3)
    >>> kinefab.Scene().add_part("Pin", collider=pin)
    0
    """

    kind: ColliderKind
    pose: Pose = field(default_factory=Pose)
    size: tuple[float, float, float] = (0.0, 0.0, 0.0)
    radius: float = 0.0
    length: float = 0.0
    mesh: int | None = None
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    name: str = ""
    material: PhysicsMaterial | None = None
    trigger: bool = False
    enabled: bool = True
    group: str = ""
    where: str = ""
    reference: MeshReference | None = None

    @property
    def is_empty(self) -> bool:
        """Whether it has no size that anything could touch.

        >>> import kinefab
        >>> kinefab.Collider(kinefab.ColliderKind.BOX, size=(1.0, 0.0, 1.0)).is_empty
        True
        """
        sizes = {
            ColliderKind.BOX: self.size,
            ColliderKind.SPHERE: (self.radius,),
            ColliderKind.CAPSULE: (self.radius,),
            ColliderKind.CYLINDER: (self.radius, self.length),
        }
        return not all(size > 0.0 for size in sizes.get(self.kind, ())) or not all(self.scale)
