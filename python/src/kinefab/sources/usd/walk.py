"""One walk over the stage: what is a body, what hangs on it, what is a joint, and where everything stands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...spatial import Array
from .api import UsdPhysics
from .instancer import instances
from .prims import Prims, Seen
from .stage import OpenStage
from .transforms import placed
from .values import Values, schemas

MAX_PRIMS = 5_000_000
"""Most prims that are looked at: a small file may multiply itself by nested instances."""
LOOKS = frozenset("Material Shader NodeGraph GeomSubset RenderSettings RenderProduct RenderVar".split())
BODIES = ("physics:body0", "physics:body1")
WEIGHTS = ("physics:mass", "physics:density")
SKIPPED = frozenset("Skeleton SkelAnimation BlendShape".split())
LIGHTS = frozenset(
    "DistantLight DomeLight DomeLight_1 SphereLight RectLight DiskLight CylinderLight PortalLight".split()
)


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


@dataclass(slots=True, eq=False)
class _Context:
    """What a prim inherits.  path: of the prim above, "" for the root.  pending: prims above without a group yet, from the outermost.  group: number of the
    innermost group that exists.  dressed: see ``Piece``; of a prototype's copies always, as its own place is elsewhere."""

    path: str
    world: Array
    pending: tuple[tuple[Any, str, Array], ...]
    group: int
    part: int
    visible: bool
    purpose: str
    dressed: bool
    id: str
    copies: tuple[Copy, ...] = ()


def walk(opened: OpenStage, values: Values, report: Report) -> Found:
    """Look at every prim below the root that is asked for.  Raises KinefabError when there are too many."""
    found, prims = Found(), Prims(values)
    root = opened.root
    above, dressed = np.eye(4), False
    for prim in reversed(list(_ancestors(root))):
        seen = prims.seen(prim)
        dressed |= seen.traits.dressed
        seen.tell(str(prim.GetPath()), values)
        above = placed(above, seen.local)
    _beside(opened, found, report)
    path = "" if root.IsPseudoRoot() else _path(root.GetParent())
    start = _Context(path, above, (), -1, -1, True, "default", dressed, "")
    seen = prims.seen(root)
    chosen = prims.below(seen) if root.IsPseudoRoot() else (seen,)
    pending = [(each, start) for each in reversed(chosen)]
    count = 0
    groups_of: dict[str, int] = {}
    while pending:
        seen, context = pending.pop()
        count += 1
        if count > MAX_PRIMS:
            report.add("USD_TOO_MANY_PRIMS", opened.name, limit=MAX_PRIMS)
            report.raise_for_errors()
        below = _look(seen, context, found, groups_of, prims, opened, values, report)
        if below is None:
            continue
        if seen.traits.kind == "PointInstancer":  # what lies below it is prototypes
            pending += _instanced(seen, below, found, prims, opened, report)
        else:
            pending += [(child, below) for child in reversed(prims.below(seen))]
    return found


def _beside(opened: OpenStage, found: Found, report: Report) -> None:
    """Scenes and collision groups hold for the whole stage, also those that do not lie below the root.  Joints that lie
    there are told where they hold what is read."""
    if opened.root.IsPseudoRoot():
        return
    root = opened.root.GetPath()
    for prim in opened.stage.Traverse():
        if prim.GetPath().HasPrefix(root):
            continue
        if prim.IsA(UsdPhysics.Scene):
            found.scenes.append(prim)
        elif prim.IsA(UsdPhysics.CollisionGroup):
            found.collision_groups.append(prim)
        elif prim.IsA(UsdPhysics.Joint):
            held = [path for name in BODIES for path in prim.GetRelationship(name).GetForwardedTargets()]
            if inside := [path for path in held if path.HasPrefix(root)]:
                report.dropped(
                    f"joint {prim.GetPath()}", "USD_FEATURE_DROPPED", opened.place(prim),
                    detail=f"it lies beside {root}, which alone is read, and holds {inside[0]}",
                )  # fmt: skip


def _path(prim: Any) -> str:
    """Of a prim, "" for the root of all."""
    return "" if prim.IsPseudoRoot() else str(prim.GetPath())


def _ancestors(prim: Any) -> Iterator[Any]:
    """Above a prim, from the nearest."""
    while not prim.IsPseudoRoot() and not (prim := prim.GetParent()).IsPseudoRoot():
        yield prim


def _look(
    seen: Seen,
    context: _Context,
    found: Found,
    groups_of: dict[str, int],
    prims: Prims,
    opened: OpenStage,
    values: Values,
    report: Report,
) -> _Context | None:
    """Note what a prim is; what its children inherit, or None where nothing below matters."""
    traits = seen.traits
    kind, applied, ranks = traits.kind, traits.schemas, traits.ranks
    if kind in LOOKS or kind in SKIPPED:
        return None
    path = f"{context.path}/{seen.name}"
    if "Scene" in ranks:
        found.scenes.append(seen.at(path))
        return None
    if "CollisionGroup" in ranks:
        found.collision_groups.append(seen.at(path))
        return None
    if "PhysicsFilteredPairsAPI" in applied:
        found.filtered.append(seen.at(path))
    if "PhysicsArticulationRootAPI" in applied:
        found.articulations.append(seen.at(path))
    # An instance of a PointInstancer has an id of its own beside the prototype's path.
    own = f"{context.id}/{seen.name}" if context.id else path[1:]
    if "Joint" in ranks or kind.endswith("Joint") or "PhysicsJoint" in kind:
        found.joints.append(JointPrim(seen.at(path), own, context.copies))
        return replace(context, path=path)
    if kind == "Camera" and context.part < 0:  # of a body it is a site
        report.dropped(
            f"camera {path}", "USD_FEATURE_DROPPED", opened.place(path), detail="cameras are not carried over"
        )
    if kind in LIGHTS:
        report.dropped(
            f"light {path}", "USD_FEATURE_DROPPED", opened.place(path), detail="lights are not carried over"
        )
        return None
    if kind.startswith(("Mjc", "Newton", "Physx")):
        found.vendor.append(seen.at(path))
        return None
    seen.tell(path, values)
    world = placed(context.world, seen.local)
    found.worlds.setdefault(path, world)
    if context.id:
        found.worlds[f"/{own}"] = world
    if seen.local.moves:
        found.animated[path] = seen.at(path)
    visible = context.visible and not seen.hidden
    purpose = context.purpose if seen.purpose is None else seen.purpose
    dressed = context.dressed or traits.dressed
    part, pending, group = context.part, context.pending, context.group
    collides = "PhysicsCollisionAPI" in applied
    if "PhysicsRigidBodyAPI" in applied and "Xformable" in ranks:
        prim = seen.at(path)
        enabled = values.flag(prim, "physics:rigidBodyEnabled", True)
        outer = found.parts[part] if part >= 0 else None
        if enabled or outer is None or not outer.enabled:  # else it moves with the body that it lies in
            group, pending = _outer_group(context, found, groups_of), ()
            found.parts.append(Part(prim, path, own, world, group, True, enabled, visible))
            part = len(found.parts) - 1
    elif "PhysicsRigidBodyAPI" in applied:
        detail = f"a RigidBodyAPI stands on a {kind or 'prim without type'}, which has no place to move"
        report.dropped(f"body {path}", "USD_FEATURE_DROPPED", opened.place(path), detail=detail)
    if part >= 0:
        found.body_of.setdefault(path, part)
        if context.id:
            found.body_of[f"/{own}"] = part
    weighs = "PhysicsRigidBodyAPI" in applied or (collides and part >= 0)
    if "PhysicsMassAPI" in applied and not weighs and any(values.get(seen.at(path), key) for key in WEIGHTS):
        report.dropped(
            f"mass of {path}", "USD_FEATURE_DROPPED", opened.place(path),
            detail="only rigid bodies and colliders of theirs weigh, and it is neither",
        )  # fmt: skip
    if "Gprim" in ranks:
        if part < 0:
            outer = _outer_group(context, found, groups_of)
            found.parts.append(Part(seen.at(path), path, own, world, outer, False, True, visible))
        holder = found.parts[part]  # the last, if it is no body's
        holder.pieces.append(Piece(seen, path, own, world, visible, purpose, collides, dressed))
    elif collides and kind != "PointInstancer":
        report.dropped(
            f"collider {path}", "USD_FEATURE_DROPPED", opened.place(path),
            detail="a CollisionAPI stands on a prim without geometry of its own",
        )  # fmt: skip
    if "Gprim" not in ranks:
        if part < 0:
            pending = (*pending, (seen.at(path), own, world))
        elif part == context.part and "Xformable" in ranks and kind != "PointInstancer":
            if not prims.below(seen):
                found.parts[part].sites.append((seen.at(path), world))
    ident = own if context.id else ""
    return _Context(path, world, pending, group, part, visible, purpose, dressed, ident, context.copies)


def _outer_group(context: _Context, found: Found, groups_of: dict[str, int]) -> int:
    """The group right above a part; those that are pending are made now, as there is something below them."""
    group = context.group
    for prim, own, world in context.pending:
        if own not in groups_of:
            found.groups.append(Group(prim, own, world, group))
            groups_of[own] = len(found.groups) - 1
        group = groups_of[own]
    return group


def _instanced(
    seen: Seen, context: _Context, found: Found, prims: Prims, opened: OpenStage, report: Report
) -> list[tuple[Seen, _Context]]:
    """The prototypes of a PointInstancer, once for each of its instances, last first."""
    copies: list[tuple[Seen, _Context]] = []
    prim = seen.at(context.path)
    for number, prototype, placing in instances(prim, opened, report):
        world = context.world @ placing
        own = f"{context.id or context.path[1:]}[{number}]"
        copied = prims.shared(prototype)
        copy = Copy(str(prototype.GetPath()), f"/{own}/{copied.name}")
        found.copies[copy.path] = CopyAt(f"/{context.id}" if context.id else context.path, prototype, placing)
        above = _path(prototype.GetParent())
        below = replace(
            context, path=above, world=world, dressed=True, id=own, copies=(*context.copies, copy)
        )
        copies.append((copied, below))
    return copies[::-1]


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
