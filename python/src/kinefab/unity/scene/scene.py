from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from .assets.animation_clip import AnimationClip
from .assets.material import Material
from .assets.mesh import Mesh
from .assets.physics_material import PhysicsMaterial
from .constraint import Constraint
from .coupling import Coupling
from .game_object import GameObject
from .ignored_collision import IgnoredCollision
from .mobility import Mobility
from .physics import Physics


@dataclass(frozen=True, slots=True)
class Source:
    """uri: relative.  upAxis: ``X``, ``Y`` or ``Z`` of the source; metersPerUnit: metres a unit of it.  configuration: which of
    several states of it was asked for; "" for the usual one."""

    uri: str = ""
    upAxis: str = "Y"
    metersPerUnit: float = 1.0
    sha256: str = ""
    configuration: str = ""


@dataclass(frozen=True, slots=True)
class UnityScene:
    """gameObjects: flat, a parent before its children.  meshes: mapped when asked for, so that a large scene is not there
    twice; ask for each once."""

    source: Source = Source()
    physics: Physics = Physics()
    gameObjects: tuple[GameObject, ...] = ()
    meshes: Sequence[Mesh] = ()
    materials: tuple[Material, ...] = ()
    physicsMaterials: tuple[PhysicsMaterial, ...] = ()
    couplings: tuple[Coupling, ...] = ()
    ignoredCollisions: tuple[IgnoredCollision, ...] = ()
    animations: tuple[AnimationClip, ...] = ()
    constraints: tuple[Constraint, ...] = ()
    analysis: Mobility | None = None
    extras: Mapping[str, object] = field(default_factory=dict[str, object])
