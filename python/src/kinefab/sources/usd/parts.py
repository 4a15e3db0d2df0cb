"""Bodies, static prims and the groups above them as nodes of the scene."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import Body, Collider, Combine, Dynamics, Node, NodeKind, Physics, PhysicsMaterial, Site
from ...spatial import Array, Pose
from .api import UsdGeom, UsdShade
from .found import Found, Part, Piece
from .looks.library import Library
from .looks.materials import Materials
from .looks.surfaces import Surfaces
from .physics.colliders import Colliders
from .physics.held import held_parts
from .physics.mass import ROUND, Weighed, body_mass
from .physics.stated import MassApis
from .stage import OpenStage
from .transforms import HOME, Fit, Stand, fits, rotation_of, stands
from .values import Traits, Values

DEFAULT_PURPOSES = ("default", "render")
STILL = Dynamics()
DYNAMICS = frozenset((
    "physics:startsAsleep", "physics:velocity", "physics:angularVelocity", "physxRigidBody:disableGravity",
    "physxRigidBody:linearDamping", "physxRigidBody:angularDamping", "physxRigidBody:maxAngularVelocity",
))  # fmt: skip
"""Attributes that say how a body moves."""
COMBINE = {
    "average": Combine.AVERAGE,
    "min": Combine.MINIMUM,
    "multiply": Combine.MULTIPLY,
    "max": Combine.MAXIMUM,
}


class Parts:
    """Makes the nodes.  stands: their rigid frames in the source, by node.  nodes: for each part its node."""

    def __init__(
        self,
        opened: OpenStage,
        values: Values,
        found: Found,
        groups: dict[str, str],
        purposes: tuple[str, ...],
        report: Report,
    ):
        """groups: collision group of each collider's path.  purposes: those that are drawn."""
        self._opened, self._values, self._found, self._report = opened, values, found, report
        self._groups, self._purposes = groups, purposes or DEFAULT_PURPOSES
        self._shown = Materials(values)
        self.looks = Surfaces(values, self._shown)
        self.library = Library(values, self.looks.covers)
        self._colliders = Colliders(opened, values, self.library, report)
        self._masses = MassApis(opened, values, report)
        self._materials: dict[str, tuple[PhysicsMaterial | None, float]] = {}
        self._bound: dict[str, Any] = {}
        self._usual: dict[tuple[Traits, bool], Dynamics] = {}
        self._held = held_parts(found, values)
        self.stands: dict[int, Stand] = {}
        self.nodes: list[int] = [len(found.groups) + i for i in range(len(found.parts))]

    def read(self) -> list[Node]:
        """The nodes: groups, then parts."""
        found, frame = self._found, self._opened.frame
        nodes: list[Node] = []
        worlds = np.array([entry.world for entry in (*found.groups, *found.parts)]).reshape(-1, 4, 4)
        standing = stands(worlds, frame)
        self.stands = {number: at for number, (at, _) in enumerate(standing)}
        for group, (_, pose) in zip(found.groups, standing):
            nodes.append(
                Node(
                    group.id, self._values.title(group.prim), NodeKind.ASSEMBLY, None if group.parent < 0 else group.parent,
                    pose, flexible=True, where=self._opened.place(group.prim),
                )
            )  # fmt: skip
        self._resolve()
        pieces = [
            (piece.world, self.stands[i])
            for i, part in zip(self.nodes, found.parts)
            for piece in part.pieces
            if not self._at_home(piece, part, self.stands[i])
        ]
        fitting = iter(fits(np.array([world for world, _ in pieces]), [at for _, at in pieces]))
        for number, part in enumerate(found.parts):
            at, pose = standing[self.nodes[number]]
            nodes.append(self._node(number, part, at, pose, fitting))
        return nodes

    def _resolve(self) -> None:
        """Materials of everything at once."""
        pieces = [piece for part in self._found.parts for piece in part.pieces]
        self._shown.resolve({p.path: p.prim for p in pieces if p.dressed and self._drawn(p)})
        colliding = {p.path: p.prim for p in pieces if p.collides}
        if colliding:
            materials, _ = UsdShade.MaterialBindingAPI.ComputeBoundMaterials(
                list(colliding.values()), "physics"
            )
            for path, material in zip(colliding, materials):
                self._bound[path] = material.GetPrim() if material else None

    @staticmethod
    def _at_home(piece: Piece, part: Part, at: Stand) -> bool:
        return at.rigid and piece.world is part.world

    def _drawn(self, piece: Piece) -> bool:
        return piece.purpose in self._purposes

    def _node(self, number: int, part: Part, at: Stand, pose: Pose, fitting: Iterator[Fit | None]) -> Node:
        """fitting: of all pieces that are not at home, from this part's first one on."""
        opened, values, prim = self._opened, self._values, part.prim
        moves = part.body and part.enabled
        kinematic = moves and values.flag(prim, "physics:kinematicEnabled", False)
        pushed = moves and not kinematic and number not in self._held
        bodies: list[Body] = []
        colliders: list[Collider] = []
        weighed: list[Weighed] = []
        for piece in part.pieces:
            fit = HOME if self._at_home(piece, part, at) else next(fitting)
            if self._drawn(piece) and (body := self._body(piece, fit)) is not None:
                bodies.append(body)
            if not piece.collides:
                continue
            material, density = self._material(piece.path)
            if piece.seen.traits.kind == "Mesh":
                material = self._of_subsets(piece, material)
            group = self._groups.get(piece.path, "")
            made = self._colliders.of(piece, at, fit, pushed, material, group)
            colliders += made
            kind = piece.seen.traits.kind
            solid = values.word(piece.prim, "physics:approximation", "none") if kind == "Mesh" else ""
            weighed += [
                Weighed(c, piece.prim, piece.world, density, kind if kind in ROUND else solid) for c in made
            ]
        mass = None
        if moves:
            meshes, apis = self.library.meshes, self._masses
            mass = body_mass(prim, part.world, at, weighed, meshes, apis, values)
        return Node(
            part.id, values.title(prim), NodeKind.PART, None if part.parent < 0 else part.parent, pose,
            bodies=tuple(bodies), mass=mass, grounded=not moves, colliders=tuple(colliders),
            dynamics=self._dynamics(prim, at, kinematic) if moves else STILL,
            sites=tuple(
                Site(values.title(p), Pose(at.axes(rotation_of(w[:3, :3]) @ opened.frame.turn.T), at.point(w[:3, 3])), opened.place(p))
                for p, w in part.sites
            ),
            where=opened.place(part.path),
        )  # fmt: skip

    def _body(self, piece: Piece, fit: Fit | None) -> Body | None:
        feature, where = f"body {piece.id}", self._opened.place(piece.path)
        if fit is None:
            self._report.dropped(feature, "USD_SCALE_ZERO", where)
            return None
        stretch = fit.stretch
        shared = self.library.shared(piece, stretch.bake)
        if shared is None:
            return None
        if stretch.bake is not None:
            self._report.kept(feature, where, "USD_SHEAR_BAKED" if stretch.sheared else "USD_MIRROR_BAKED")
        colored = self.library.meshes[shared.mesh].colors is not None
        return Body(
            shared.title if "[" not in piece.id else piece.id.rpartition("/")[2],
            shared.mesh,
            self.looks.of(piece, shared.subsets, shared.uv_names, colored),
            pose=fit.pose,
            scale=fit.scale,
            visible=piece.visible,
            weighed=False,
        )

    def _material(self, path: str) -> tuple[PhysicsMaterial | None, float]:
        """The physics material bound to a prim, and its density in the stage's units, 0 for none."""
        material = self._bound.get(path)
        if material is None or "PhysicsMaterialAPI" not in self._values.traits(material).schemas:
            return None, 0.0
        key = str(material.GetPath())
        if key not in self._materials:
            self._materials[key] = self._read_material(material)
        return self._materials[key]

    def _of_subsets(self, piece: Piece, chosen: PhysicsMaterial | None) -> PhysicsMaterial | None:
        """The material of a collider whose faces may have some of their own.  chosen: that of the whole, else it is the
        first; others are told."""
        for subset in UsdGeom.Subset.GetAllGeomSubsets(UsdGeom.Mesh(piece.prim)):
            path = str(subset.GetPath())
            bound = UsdShade.MaterialBindingAPI(subset).ComputeBoundMaterial("physics")[0]
            self._bound[path] = bound.GetPrim() if bound else None
            material, _ = self._material(path)
            chosen = chosen or material
            if material is not None and chosen is not None and material != chosen:
                self._report.dropped(
                    f"physics material {material.name} of {path}", "USD_FEATURE_DROPPED", self._opened.place(path),
                    detail=f"a collider of Unity has one material, this one {chosen.name}",
                )  # fmt: skip
        return chosen

    def _read_material(self, prim: Any) -> tuple[PhysicsMaterial, float]:
        get = self._values.number
        found = {
            name: get(prim, f"physics:{name}", 0.0)
            for name in ("dynamicFriction", "staticFriction", "restitution", "density")
        }
        for name, value in found.items():
            if value < 0.0:
                self._values.wrong(prim, f"physics:{name}", f"{value:g}")
        stack = prim.GetAttribute("physics:density").GetPropertyStack()
        if found["density"] > 0.0 and stack and (word := str(stack[0].typeName)) != "float":
            self._report.approximated(
                f"physics material {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", self._opened.place(prim),
                detail=f"its density is a {word}, which OpenUSD passes over; {found['density']:g} was taken",
            )  # fmt: skip
        combine = [
            COMBINE.get(
                self._values.word(prim, f"physxMaterial:{what}CombineMode", "average"), Combine.AVERAGE
            )
            for what in ("friction", "restitution")
        ]
        bounce = found["restitution"]
        if bounce > 1.0:
            self._report.approximated(
                f"physics material {prim.GetPath()}", "USD_FEATURE_APPROXIMATED", self._opened.place(prim),
                detail=f"its restitution {bounce:g} became 1",
            )  # fmt: skip
        material = PhysicsMaterial(
            self._values.title(prim), max(0.0, found["dynamicFriction"]), max(0.0, found["staticFriction"]),
            min(1.0, max(0.0, bounce)), combine[0], combine[1],
        )  # fmt: skip
        return material, max(0.0, found["density"])

    def _dynamics(self, prim: Any, at: Stand, kinematic: bool) -> Dynamics:
        """Worked out once for all prims that state nothing of it."""
        alike = self._values.alike(prim, DYNAMICS)
        if alike is None:
            return self._read_dynamics(prim, at, kinematic)
        if (alike, kinematic) not in self._usual:
            self._usual[alike, kinematic] = self._read_dynamics(prim, at, kinematic)
        return self._usual[alike, kinematic]

    def _read_dynamics(self, prim: Any, at: Stand, kinematic: bool) -> Dynamics:
        values, frame = self._values, self._opened.frame

        def moving(name: str, unit: float) -> Array | None:
            if not values.authored(prim, name):
                return None
            given = frame.turn @ at.rotation @ (values.vector(prim, name, (0.0, 0.0, 0.0)) * unit)
            return given if np.abs(given).max() > 0.0 else None

        if values.flag(prim, "physics:startsAsleep", False):
            self._report.dropped(
                f"startsAsleep of {prim.GetPath()}", "USD_FEATURE_DROPPED", self._opened.place(prim),
                detail="Unity's Rigidbody has no such setting",
            )  # fmt: skip
        damping: list[float | None] = []
        for name in ("linearDamping", "angularDamping"):
            key = f"physxRigidBody:{name}"
            damping.append(max(0.0, values.number(prim, key, 0.0)) if values.authored(prim, key) else None)
        key = "physxRigidBody:maxAngularVelocity"
        fastest = values.number(prim, key, 0.0, open_ended=True) * self._opened.degree
        return Dynamics(
            kinematic,
            not values.flag(prim, "physxRigidBody:disableGravity", False),
            damping[0],
            damping[1],
            moving("physics:velocity", frame.length),
            moving("physics:angularVelocity", self._opened.degree),
            fastest if math.isfinite(fastest) and fastest > 0.0 else None,
        )


def physics_of(found: Found, opened: OpenStage, values: Values, report: Report) -> Physics:
    """Gravity and the step of time, as PhysX has it, of the first PhysicsScene."""
    down = np.zeros(3)
    down["XYZ".index(opened.up)] = -1.0
    magnitude = 9.81 / opened.frame.length
    for number, prim in enumerate(found.scenes):
        if number:
            report.dropped(
                f"scene {prim.GetPath()}", "USD_FEATURE_DROPPED", opened.place(prim),
                detail="Unity has one physics scene; the first was taken",
            )  # fmt: skip
            continue
        direction = values.vector(prim, "physics:gravityDirection", (0.0, 0.0, 0.0))
        stated = values.number(prim, "physics:gravityMagnitude", -math.inf, open_ended=True)
        if (length := float(np.linalg.norm(direction))) > 0.0:
            down = direction / length
        if stated >= 0.0:
            magnitude = stated
    vector = opened.frame.turn @ down * (magnitude * opened.frame.length)
    gravity = (float(vector[0]) + 0.0, float(vector[1]) + 0.0, float(vector[2]) + 0.0)
    steps = values.number(found.scenes[0], "physxScene:timeStepsPerSecond", 0.0) if found.scenes else 0.0
    return Physics(gravity, 1.0 / steps) if steps > 0.0 else Physics(gravity)
