"""Parts and assemblies: what stands where, with which geometry and mass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum

from ..options import ColliderShape
from ..spatial import Array, Pose
from .boundary import Face
from .colliders import Collider
from .meshes import MeshReference


class NodeKind(str, Enum):
    PART = "part"
    ASSEMBLY = "assembly"


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """One solid or surface body of a part: a mesh with a surface for each submesh.

    mesh: index into ``Scene.meshes``, or None where the geometry is not loaded or was not found.
    surfaces: indices into ``Scene.surfaces``, one for each submesh.
    density: kg/m^3, or None for the scene's default.
    reference: where the geometry is to be loaded from, or None for a body without (or with loaded) geometry.
    pose, scale: the mesh's frame in the node's, the scale along the mesh's own axes; no factor is zero.
    visible: whether it is drawn.  weighed: whether its volume counts for a mass that the source does not state.
    boundary: the exact faces, in the NODE's frame, where the source has them.
    """

    name: str
    mesh: int | None = None
    surfaces: tuple[int, ...] = ()
    density: float | None = None
    reference: MeshReference | None = None
    pose: Pose = field(default_factory=Pose)
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    visible: bool = True
    weighed: bool = True
    boundary: tuple[Face, ...] = ()


@dataclass(frozen=True, slots=True, eq=False)
class MassProperties:
    """mass: kg.  center: centre of mass, node's frame, metres, shape (3,).
    inertia: about the centre of mass, along the node's axes, kg m^2, shape (3, 3).

    >>> import kinefab, numpy
    >>> ball = kinefab.MassProperties(2.0, numpy.zeros(3), 0.008 * numpy.eye(3))
    >>> ball.mass, ball.center.shape, ball.inertia.shape
    (2.0, (3,), (3, 3))
    """

    mass: float
    center: Array
    inertia: Array


@dataclass(frozen=True, slots=True, eq=False)
class Site:
    """A named frame of a node: a tool's tip, a sensor, a camera.  pose: in the node's frame."""

    name: str
    pose: Pose = field(default_factory=Pose)
    where: str = ""


@dataclass(frozen=True, slots=True, eq=False)
class Dynamics:
    """How a node's body is moved, apart from its mass.

    kinematic: moved by scripts alone, pushing others.  gravity: whether it falls.
    linear_damping, angular_damping: 1/s, the share of its speed that it loses; None for the engine's own.
    velocity, angular_velocity: at the start, WORLD frame, m/s and rad/s, shape (3,), or None.
    max_angular_velocity: rad/s at which the engine stops it from turning faster; None for the engine's own.
    """

    kinematic: bool = False
    gravity: bool = True
    linear_damping: float | None = None
    angular_damping: float | None = None
    velocity: Array | None = None
    angular_velocity: Array | None = None
    max_angular_velocity: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Node:
    """A component of the source: a part, or an assembly that holds others.

    id: stable path in the source, unique (``Lever/Crank:1/Shaft:1``).
    parent: index into ``Scene.nodes`` of an earlier node, or None for a root.
    pose: node frame in the WORLD at the exported pose.
    definition: id shared by all occurrences of the same part, or None.
    grounded: fixed to the world.  flexible: for an assembly, whether its parts may move against each
    other (an inflexible assembly is one rigid group).  suppressed: present in the source but inactive.
    mass: as given by the source; None means "from geometry".
    kilograms: of a part without ``mass``, what its geometry weighs together, whatever densities say; None: by its densities.
    colliders: the shapes that the source states, () for none at all; None where it does not say, and the export chooses.
    collision: the shape that is made for its bodies where it states no colliders, None for the export's choice.
    helps: of a body that no source has, which stands between two joints of one: the node of that one, of which it takes a share
        of the mass; None for all others.
    dynamics: see ``Dynamics``.  sites: named frames.  layer, tag: the source's words for them, "" for none.
    where: place in the source, for diagnostics.
    """

    id: str
    name: str
    kind: NodeKind = NodeKind.PART
    parent: int | None = None
    pose: Pose = field(default_factory=Pose)
    definition: str | None = None
    bodies: tuple[Body, ...] = ()
    mass: MassProperties | None = None
    kilograms: float | None = None
    grounded: bool = False
    flexible: bool = False
    suppressed: bool = False
    visible: bool = True
    colliders: tuple[Collider, ...] | None = None
    collision: ColliderShape | None = None
    dynamics: Dynamics = field(default_factory=Dynamics)
    sites: tuple[Site, ...] = ()
    layer: str = ""
    tag: str = ""
    where: str = ""
    extras: Mapping[str, object] = field(default_factory=dict[str, object])
    helps: int | None = None
