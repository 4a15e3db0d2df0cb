"""What the walk over a stage finds: groups, parts with their pieces, joints, and where everything stands."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...spatial import Array
from .prims import Prims, Seen
from .stage import OpenStage
from .transforms import placed
from .values import Values, schemas


@dataclass(slots=True, eq=False)
class Piece:
    """A drawn or colliding prim.  path: its own, which instances of a PointInstancer share.  world: its matrix.
    visible: whether it and all above it are shown.  purpose: default, render, proxy or guide.
    dressed: it, or a prim above, states a material or colours."""

    seen: Seen
    path: str
    id: str
    world: Array
    visible: bool
    purpose: str
    collides: bool
    dressed: bool

    @property
    def prim(self) -> Any:
        """What stands at the path: of an instance's content a proxy, made anew, as most are never asked for."""
        return self.seen.at(self.path)


@dataclass(slots=True, eq=False)
class Part:
    """What becomes one node: a rigid body with all below it, or a static prim.

    path: the prim's.  body: it has a RigidBodyAPI.  enabled: the API is switched on.  parent: of the assemblies, -1 for none.
    """

    prim: Any
    path: str
    id: str
    world: Array
    parent: int
    body: bool
    enabled: bool = True
    visible: bool = True
    pieces: list[Piece] = field(default_factory=list[Piece])
    sites: list[tuple[Any, Array]] = field(default_factory=list[tuple[Any, Array]])


@dataclass(slots=True, eq=False)
class Group:
    """A prim above parts: an Xform or Scope.  parent: an earlier group, -1 for none."""

    prim: Any
    id: str
    world: Array
    parent: int


@dataclass(frozen=True, slots=True)
class Copy:
    """An instance of a PointInstancer.  prototype: path of its prototype.  path: what stands for it, ``/World/I[3]/Proto``."""

    prototype: str
    path: str


@dataclass(frozen=True, slots=True, eq=False)
class CopyAt:
    """Where such an instance stands.  instancer: path.  prototype: prim.  placing: between the two, shape (4, 4)."""

    instancer: str
    prototype: Any
    placing: Array


@dataclass(frozen=True, slots=True, eq=False)
class JointPrim:
    """A joint as often as it is there: once for each instance of the prototype that it lies in.

    id: as nodes have them.  copies: the instances that it lies in, from the outermost.
    """

    prim: Any
    id: str
    copies: tuple[Copy, ...] = ()

    def meant(self, path: str) -> str:
        """What a path of the joint names: within its own instance where it leads into the prototype."""
        for copy in reversed(self.copies):
            if path == copy.prototype or path.startswith(f"{copy.prototype}/"):
                return copy.path + path[len(copy.prototype) :]
        return path


@dataclass(slots=True, eq=False)
class Found:
    """Everything of interest, in the order of the stage.

    animated: prims whose transform has several time samples, by path.  worlds: matrix of each prim by its path, that of
    each instance by ``Copy.path``, which ``copies`` has too.  body_of: for each path below or at a body the part's number.  Of a prototype itself
    both have its first instance.
    """

    groups: list[Group] = field(default_factory=list[Group])
    parts: list[Part] = field(default_factory=list[Part])
    joints: list[JointPrim] = field(default_factory=list[JointPrim])
    scenes: list[Any] = field(default_factory=list[Any])
    collision_groups: list[Any] = field(default_factory=list[Any])
    filtered: list[Any] = field(default_factory=list[Any])
    articulations: list[Any] = field(default_factory=list[Any])
    vendor: list[Any] = field(default_factory=list[Any])
    worlds: dict[str, Array] = field(default_factory=dict[str, Array])
    body_of: dict[str, int] = field(default_factory=dict[str, int])
    animated: dict[str, Any] = field(default_factory=dict[str, Any])
    copies: dict[str, CopyAt] = field(default_factory=dict[str, CopyAt])


def body_above(path: str, found: Found) -> int:
    """The part of the nearest body at or above a path, -1 for none."""
    while len(path) > 1:
        if (part := found.body_of.get(path)) is not None:
            return part
        path = path.rpartition("/")[0]
    return -1


def moves_beside(prim: Any, root: Any) -> bool:
    """Whether a prim is of a body that does not lie below the root."""
    while prim and not root.GetPath().HasPrefix(prim.GetPath()):
        if "PhysicsRigidBodyAPI" in schemas(prim):
            return not prim.GetPath().HasPrefix(root.GetPath())
        prim = prim.GetParent()
    return False


def world_of(path: Any, found: Found, opened: OpenStage, values: Values) -> Array:
    """The matrix of what stands at an Sdf path, also of what was not walked over."""
    known = found.worlds.get(str(path))
    if known is not None:
        return known
    if path.isEmpty or path.IsAbsoluteRootPath():
        return np.eye(4)
    prim = opened.stage.GetPrimAtPath(path)
    above = world_of(path.GetParentPath(), found, opened, values)
    if not prim:
        return above
    seen = Prims(values).seen(prim)
    seen.tell(str(path), values)
    return placed(above, seen.local)
