"""One walk over the stage: what is a body, what hangs on it, what is a joint, and where everything stands."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...diagnostics import Report, named
from ...spatial import Array
from .api import UsdPhysics
from .found import Copy, CopyAt, Found, Group, JointPrim, Part, Piece
from .instancer import instances
from .prims import Prims, Seen
from .stage import OpenStage
from .transforms import placed
from .values import WHOLE, Values

MAX_PRIMS = 5_000_000
"""Most prims that are looked at: a small file may multiply itself by nested instances."""
LOOKS = frozenset("Material Shader NodeGraph GeomSubset RenderSettings RenderProduct RenderVar".split())
BODIES = ("physics:body0", "physics:body1")
WEIGHTS = ("physics:mass", "physics:density")
SKIPPED = frozenset("Skeleton SkelAnimation BlendShape".split())
HOLDERS = frozenset("Xform SkelRoot PointInstancer Camera".split())
"""Types that stand somewhere and are no geometry, of which all is read or told."""
SOFT = ("Deformable", "PhysxParticle")
"""A part of the names of schemas for soft bodies, and the beginning of those for particles."""
ARKIT = "Preliminary_Physics"
"""The beginning of the names of Apple's schemas from before UsdPhysics."""
SHINING = frozenset(("LightAPI", "MeshLightAPI", "VolumeLightAPI"))
"""Schemas that make a light of a prim."""
UNKNOWN = "OpenUSD knows no such type; only what lies below it was read"
UNLIKE = "nothing of the scene is like it"
LIGHTS = frozenset(
    "DistantLight DomeLight DomeLight_1 SphereLight RectLight DiskLight CylinderLight PortalLight GeometryLight PluginLight".split()
)


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
    look = _Look(opened, values, report)
    root = opened.root
    above, dressed = np.eye(4), False
    for prim in reversed(list(_ancestors(root))):
        seen = look.prims.seen(prim)
        dressed |= seen.traits.dressed
        seen.tell(str(prim.GetPath()), values)
        above = placed(above, seen.local)
    _beside(opened, look.found, report)
    path = "" if root.IsPseudoRoot() else _path(root.GetParent())
    start = _Context(path, above, (), -1, -1, True, "default", dressed, "")
    seen = look.prims.seen(root)
    chosen = look.prims.below(seen) if root.IsPseudoRoot() else (seen,)
    pending = [(each, start) for each in reversed(chosen)]
    count = 0
    while pending:
        seen, context = pending.pop()
        count += 1
        if count > MAX_PRIMS:
            report.add("USD_TOO_MANY_PRIMS", opened.name, limit=MAX_PRIMS)
            report.raise_for_errors()
        below = look.at(seen, context)
        if below is None:
            continue
        if seen.traits.kind == "PointInstancer":  # what lies below it is prototypes
            pending += look.instanced(seen, below)
        else:
            pending += [(child, below) for child in reversed(look.prims.below(seen))]
    look.tell_strange()
    return look.found


class _Look:
    """Looks at one prim after another and notes what it is."""

    def __init__(self, opened: OpenStage, values: Values, report: Report):
        self.found, self.prims = Found(), Prims(values)
        self._opened, self._values, self._report = opened, values, report
        self._groups: dict[str, int] = {}  # of those made so far, by their ids
        self._strange: dict[tuple[str, str], list[str]] = {}  # paths by type and why nothing of it is read

    def at(self, seen: Seen, context: _Context) -> _Context | None:
        """What a prim's children inherit, or None where nothing below it matters."""
        traits = seen.traits
        kind, applied, ranks = traits.kind, traits.schemas, traits.ranks
        path = f"{context.path}/{seen.name}"
        if kind in LOOKS or kind in SKIPPED:
            if kind == "Skeleton":
                self._strange.setdefault((kind, UNLIKE), []).append(path)
            return None
        joint = "Joint" in ranks or kind.endswith("Joint") or "PhysicsJoint" in kind
        if not joint and self._ends(seen, path):
            return None
        if not (joint or kind in HOLDERS or "Gprim" in ranks):
            self._look_at_type(seen, path)
        if not SHINING.isdisjoint(applied):
            self._dropped("light", path, "lights are not carried over")
        if "PhysicsFilteredPairsAPI" in applied:
            self.found.filtered.append(seen.at(path))
        if "PhysicsArticulationRootAPI" in applied:
            self.found.articulations.append(seen.at(path))
        self._tell_schemas(seen, path)
        # An instance of a PointInstancer has an id of its own beside the prototype's path.
        own = f"{context.id}/{seen.name}" if context.id else path[1:]
        if joint:
            self.found.joints.append(JointPrim(seen.at(path), own, context.copies))
            return replace(context, path=path)
        if kind == "Camera" and context.part < 0:  # of a body it is a site
            self._dropped("camera", path, "cameras are not carried over")
        below = self._placed(seen, context, path, own)
        if "PhysicsRigidBodyAPI" in applied:
            self._body(seen, context, below, own)
        if below.part >= 0:
            self.found.body_of.setdefault(path, below.part)
            if below.id:
                self.found.body_of[f"/{own}"] = below.part
        collides = "PhysicsCollisionAPI" in applied
        if "PhysicsRigidBodyAPI" not in applied and not (collides and below.part >= 0):
            self._tell_mass(seen, path)
        if "Gprim" in ranks:
            self._piece(seen, context, below, own)
            return below
        if collides and kind != "PointInstancer":
            self._dropped("collider", path, "a CollisionAPI stands on a prim without geometry of its own")
        if below.part < 0:
            below.pending = (*below.pending, (seen.at(path), own, below.world))
        elif below.part == context.part and "Xformable" in ranks and kind != "PointInstancer":
            if not self.prims.below(seen):
                self.found.parts[below.part].sites.append((seen.at(path), below.world))
        return below

    def instanced(self, seen: Seen, context: _Context) -> list[tuple[Seen, _Context]]:
        """The prototypes of a PointInstancer, once for each of its instances, last first."""
        copies: list[tuple[Seen, _Context]] = []
        prim = seen.at(context.path)
        for number, prototype, placing in instances(prim, self._opened, self._report):
            world = context.world @ placing
            own = f"{context.id or context.path[1:]}[{number}]"
            copied = self.prims.shared(prototype)
            copy = Copy(str(prototype.GetPath()), f"/{own}/{copied.name}")
            instancer = f"/{context.id}" if context.id else context.path
            self.found.copies[copy.path] = CopyAt(instancer, prototype, placing)
            above = _path(prototype.GetParent())
            below = replace(
                context, path=above, world=world, dressed=True, id=own, copies=(*context.copies, copy)
            )
            copies.append((copied, below))
        return copies[::-1]

    def _look_at_type(self, seen: Seen, path: str) -> None:
        """Note a prim of whose type nothing is read, so that what is behind it is lost."""
        kind, ranks = seen.traits.kind, seen.traits.ranks
        if kind and "Known" not in ranks:
            self._strange.setdefault((kind, UNKNOWN), []).append(path)
        elif "Xformable" in ranks:
            self._strange.setdefault((kind, UNLIKE), []).append(path)

    def tell_strange(self) -> None:
        """What types nothing is read of, each once."""
        for (kind, detail), paths in sorted(self._strange.items()):
            paths = sorted(paths)
            place = self._opened.place(paths[0])
            self._report.dropped(f"{kind} {named(paths, 1)}", "USD_FEATURE_DROPPED", place, detail=detail)

    def _tell_schemas(self, seen: Seen, path: str) -> None:
        """What moves by schemas of which nothing is read."""
        for schema in seen.traits.schemas:
            if SOFT[0] in schema or schema.startswith(SOFT[1]):
                detail = "what is soft or made of particles stands still here, as it is"
                self._dropped(f"{schema} of", path, detail)
            elif schema.startswith(ARKIT):
                self._dropped(f"{schema} of", path, "ARKit's own physics are not read, only UsdPhysics")

    def _tell_mass(self, seen: Seen, path: str) -> None:
        """That a mass is stated of what weighs nothing."""
        if "PhysicsMassAPI" in seen.traits.schemas:
            if any(self._values.get(seen.at(path), key) for key in WEIGHTS):
                detail = "only rigid bodies and colliders of theirs weigh, and it is neither"
                self._dropped("mass of", path, detail)

    def _ends(self, seen: Seen, path: str) -> bool:
        """Note what has no place in the scene's tree; whether the prim is such, and what lies below it nothing to read."""
        kind, ranks = seen.traits.kind, seen.traits.ranks
        if "Scene" in ranks:
            self.found.scenes.append(seen.at(path))
        elif "CollisionGroup" in ranks:
            self.found.collision_groups.append(seen.at(path))
        elif kind in LIGHTS:
            self._dropped("light", path, "lights are not carried over")
        elif kind.startswith(WHOLE):
            self.found.vendor.append(seen.at(path))
        else:
            return False
        return True

    def _placed(self, seen: Seen, context: _Context, path: str, own: str) -> _Context:
        """What lies below a prim inherits of its place and its looks, as far as it is no body."""
        seen.tell(path, self._values)
        world = placed(context.world, seen.local)
        self.found.worlds.setdefault(path, world)
        if context.id:
            self.found.worlds[f"/{own}"] = world
        if seen.local.moves:
            self.found.animated[path] = seen.at(path)
        return _Context(
            path, world, context.pending, context.group, context.part,
            visible=context.visible and not seen.hidden,
            purpose=context.purpose if seen.purpose is None else seen.purpose,
            dressed=context.dressed or seen.traits.dressed,
            id=own if context.id else "",
            copies=context.copies,
        )  # fmt: skip

    def _body(self, seen: Seen, context: _Context, below: _Context, own: str) -> None:
        """A part of its own for a prim with a RigidBodyAPI, which all below it belongs to."""
        prim = seen.at(below.path)
        if "Xformable" not in seen.traits.ranks:
            kind = seen.traits.kind or "prim without type"
            detail = f"a RigidBodyAPI stands on a {kind}, which has no place to move"
            self._dropped("body", below.path, detail)
            return
        enabled = self._values.flag(prim, "physics:rigidBodyEnabled", True)
        if not enabled and context.part >= 0 and self.found.parts[context.part].enabled:
            return  # it moves with the body that it lies in
        below.group, below.pending = self._outer_group(context), ()
        below.part = len(self.found.parts)
        self.found.parts.append(
            Part(prim, below.path, own, below.world, below.group, True, enabled, below.visible)
        )

    def _piece(self, seen: Seen, context: _Context, below: _Context, own: str) -> None:
        """A prim with geometry: of the part that it lies in, or one itself."""
        path, collides = below.path, "PhysicsCollisionAPI" in seen.traits.schemas
        if below.part < 0:
            outer = self._outer_group(context)
            self.found.parts.append(
                Part(seen.at(path), path, own, below.world, outer, False, True, below.visible)
            )
        holder = self.found.parts[below.part]  # the last, if it is no body's
        holder.pieces.append(
            Piece(seen, path, own, below.world, below.visible, below.purpose, collides, below.dressed)
        )

    def _outer_group(self, context: _Context) -> int:
        """The group right above a part; those that are pending are made now, as there is something below them."""
        group = context.group
        for prim, own, world in context.pending:
            if own not in self._groups:
                self.found.groups.append(Group(prim, own, world, group))
                self._groups[own] = len(self.found.groups) - 1
            group = self._groups[own]
        return group

    def _dropped(self, what: str, path: str, detail: str) -> None:
        self._report.dropped(f"{what} {path}", "USD_FEATURE_DROPPED", self._opened.place(path), detail=detail)


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
