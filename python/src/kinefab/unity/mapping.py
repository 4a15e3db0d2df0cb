"""A scene of the model as Unity's own objects and components."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from types import MappingProxyType
from typing import Any

from ..diagnostics import Report
from ..findings import JointFinding
from ..geometry.collision import possible
from ..model import PLAIN, Collider, FreeIds, PhysicsMaterial, Scene, Surface
from ..options import Ground
from ..rigid import RigidGroups, active_nodes, dynamic_nodes, is_kinematic
from . import frames
from .apart import apart_id, apart_joint
from .as_stated import with_stated
from .assets.clips import map_clip
from .assets.meshes import MappedMeshes
from .assets.surfaces import map_physics_material, map_surface
from .bodies.colliders import Colliders, chosen_colliders, stated_collider
from .bodies.rigidbodies import Rigidbodies, carried_along, held_below, map_rigidbody, parents_beside, place_rigidbodies
from .bodies.standing import Standing, find_standing
from .constraints import map_constraint
from .joints.couplings import map_coupling, screw_couplings
from .joints.mapping import UnityJoint, map_joint, with_source
from .joints.passive import with_passive_drives
from .mobility import map_mobility
from .placing import at_home, local_transforms, transform_of, with_all_below
from .scene import (
    Component,
    Coupling,
    FixedJoint,
    GameObject,
    IgnoredCollision,
    MeshFilter,
    MeshRenderer,
    Physics,
    Rigidbody,
    Source,
    UnityScene,
)
from .scene import Joint as JointComponent
from .scene.colliders.collider import Collider as UnityCollider
from .scene.vectors import vector3

GROUND_ID = "kinefab:ground"
"""Of the object that stands for the ground; no source has such an id."""


def map_scene(
    scene: Scene,
    groups: RigidGroups,
    colliders: Colliders,
    report: Report,
    analysis: Mapping[str, Any] | None = None,
    holding: Mapping[int, Sequence[str]] = MappingProxyType({}),
    findings: Mapping[str, JointFinding] = MappingProxyType({}),
) -> UnityScene:
    """Everything of the scene in Unity's terms.  ``report`` gets what became of each joint, collider and coupling.

    analysis: what the constraints leave free, by node number (see ``mobility``).
    holding: for each node the ids of what joins it to others of its rigid group.
    findings: what the analysis found of the joints, by their ids.
    """
    builder = _Builder(scene, groups, colliders, report, holding, findings)
    builder.add_ground()
    builder.add_objects()
    builder.add_rigidbodies()
    builder.set_standing()
    builder.add_joints()
    builder.keep_apart()
    physics = scene.physics
    gravity = vector3(frames.direction(physics.gravity))
    return UnityScene(
        source=Source(
            scene.source.uri,
            scene.source.up_axis,
            scene.source.meters_per_unit,
            scene.source.sha256,
            scene.source.configuration,
        ),
        physics=Physics(
            gravity, physics.fixed_timestep, physics.solver_iterations, physics.solver_velocity_iterations
        ),
        couplings=tuple(builder.couplings()),
        gameObjects=tuple(builder.finished()),
        meshes=MappedMeshes([*scene.meshes, *colliders.made]),
        materials=tuple(map_surface(s) for s in builder.surfaces),
        physicsMaterials=tuple(map_physics_material(m) for m in builder.physics_materials),
        animations=tuple(map_clip(clip, builder.object_of) for clip in scene.animations),
        constraints=tuple(map_constraint(c, builder.object_of) for c in scene.constraints),
        analysis=None if analysis is None else map_mobility(analysis, builder.object_of),
        ignoredCollisions=tuple(
            IgnoredCollision(builder.object_of[pair.a], builder.object_of[pair.b], pair.reason)
            for pair in scene.apart
            if pair.stated
        ),
        extras=dict(scene.extras),
    )


@dataclass(slots=True, eq=False)
class _Builder:
    """Fills the list of GameObjects.  objects: without their components, which are in ``components``.  ground: index of the one that stands for the ground.  object_of: for each node the index of its GameObject."""

    scene: Scene
    groups: RigidGroups
    colliders: Colliders
    report: Report
    holding: Mapping[int, Sequence[str]]
    findings: Mapping[str, JointFinding]
    objects: list[GameObject] = field(default_factory=list[GameObject])
    components: list[list[Component]] = field(default_factory=list[list[Component]])
    object_of: list[int] = field(default_factory=list[int])
    surfaces: list[Surface] = field(default_factory=list[Surface])
    physics_materials: list[PhysicsMaterial] = field(default_factory=list[PhysicsMaterial])
    joints: dict[str, tuple[UnityJoint, int]] = field(default_factory=dict[str, tuple[UnityJoint, int]])
    free_ids: FreeIds = field(default_factory=FreeIds)
    rigidbodies: Rigidbodies | None = None
    parents: list[int | None] = field(default_factory=list[int | None])
    dynamic: list[bool] = field(default_factory=list[bool])
    ground: int | None = None
    standing: Standing = Standing((), {})

    def finished(self) -> list[GameObject]:
        return [
            replace(own, components=tuple(components))
            for own, components in zip(self.objects, self.components)
        ]

    def add_ground(self) -> None:
        """The body that stands for the ground, above everything, where something stands on it."""
        joined = any(joint.a is None or joint.b is None for joint in self.scene.joints)
        if self.colliders.ground is Ground.BODY and (joined or any(self.groups.grounded)):
            self.ground = self._object(GameObject(GROUND_ID, "Ground", role="ground"))
            self.components[self.ground].append(Rigidbody(useGravity=False, isKinematic=True))

    def add_objects(self) -> None:
        self.surfaces = list(self.scene.surfaces)
        self.dynamic = dynamic_nodes(self.scene, self.groups)
        self.rigidbodies = place_rigidbodies(self.scene, self.groups)
        self.parents = parents_beside(self.scene, self.groups, self.rigidbodies)
        welded, left = carried_along(self.scene, self.rigidbodies, self.parents)
        for i in left:
            node = self.scene.nodes[i]
            self.report.approximated(f"weld of {node.id}", "WELD_STAYS", node.where, node=node.id)
        beside, self.parents = self.parents, welded
        active, placed = active_nodes(self.scene), local_transforms(self.scene, self.parents)
        for i, (node, parent) in enumerate(zip(self.scene.nodes, self.parents)):
            above = self.ground if parent is None else self.object_of[parent]
            if beside[i] != node.parent:
                self.report.kept(f"part {node.id}", node.where, "GROUNDED_STANDS_BESIDE", node=node.id)
            extras = with_stated(self.scene, i, self.groups.standing, self.rigidbodies.carrier_of[i] is None)
            index = self._object(
                GameObject(
                    node.id, node.name, above, active[i], placed[i],
                    layer=node.layer, tag=node.tag, definition=node.definition or "", extras=extras,
                )
            )  # fmt: skip
            self.object_of.append(index)
            self.free_ids = FreeIds()
            self._add_bodies(i, index)
            self._add_colliders(i, index)
            for site in node.sites:
                id = self.free_ids.take(f"{node.id}/site:{site.name}")
                self._object(GameObject(id, site.name, index, transform=transform_of(site.pose), role="site"))

    def _object(self, made: GameObject) -> int:
        """The index of a new GameObject."""
        self.objects.append(made)
        self.components.append([])
        return len(self.objects) - 1

    def _add_bodies(self, index: int, parent: int) -> None:
        """One body at home is the object's own mesh; others are children, so that each keeps its place and collider."""
        node = self.scene.nodes[index]
        bodies = [body for body in node.bodies if body.mesh is not None]
        moves = self.dynamic[index]
        for body in bodies:
            assert body.mesh is not None
            holder = parent
            if len(bodies) > 1 or not at_home(body):
                id = self.free_ids.take(f"{node.id}/body:{body.name}")
                placed = transform_of(body.pose, body.scale)
                holder = self._object(GameObject(id, body.name, parent, transform=placed))
            mesh = self.scene.meshes[body.mesh]
            materials = tuple(body.surfaces) or (self._plain(),) * max(1, len(mesh.face_counts))
            self.components[holder] += [
                MeshFilter(body.mesh),
                MeshRenderer(node.visible and body.visible, materials),
            ]
            if node.colliders is None:
                shape = node.collision or self.colliders.shape
                for chosen in chosen_colliders(self.colliders, shape, body, mesh, moves, node.id, self.report):
                    at = holder
                    if chosen.pose is not None:
                        id = self.free_ids.take(f"{node.id}/collider:{body.name}")
                        placed = transform_of(chosen.pose, chosen.scale)
                        at = self._object(GameObject(id, f"{body.name} collider", holder, transform=placed))
                    self.components[at].append(chosen.component)

    def _add_colliders(self, index: int, parent: int) -> None:
        node = self.scene.nodes[index]
        for stated in node.colliders or ():
            collider = possible(stated)
            material = self._physics_material(collider)
            for placed in stated_collider(
                collider,
                self.colliders,
                self.scene.meshes,
                self.dynamic[index],
                material,
                node.id,
                self.report,
            ):
                holder = parent
                if placed.pose is not None:
                    name = collider.name or collider.kind.value
                    id = self.free_ids.take(f"{node.id}/collider:{name}")
                    transform = transform_of(placed.pose, placed.scale)
                    holder = self._object(GameObject(id, name, parent, transform=transform))
                self.components[holder].append(placed.component)

    def _physics_material(self, collider: Collider) -> int | None:
        if collider.material is None:
            return None
        if collider.material not in self.physics_materials:
            self.physics_materials.append(collider.material)
        return self.physics_materials.index(collider.material)

    def _plain(self) -> int:
        if PLAIN not in self.surfaces:
            self.surfaces.append(PLAIN)
        return self.surfaces.index(PLAIN)

    def add_rigidbodies(self) -> None:
        assert self.rigidbodies is not None
        for carrier, members in self.rigidbodies.carriers.items():
            self.components[self.object_of[carrier]].append(
                map_rigidbody(self.scene, carrier, members, self.report)
            )
        for own, connected in self.rigidbodies.fixed:
            if self._led(own) and self._led(connected):
                continue
            because = tuple(self.holding.get(own, ()))
            joint = FixedJoint(connectedBody=self.object_of[connected], because=because)
            self.components[self.object_of[own]].append(joint)
        for held in held_below(self.scene, self.groups, self.rigidbodies):
            if self.parents[held] == self.scene.nodes[held].parent:  # a clip moves it
                self.components[self.object_of[held]].append(Rigidbody(useGravity=False, isKinematic=True))

    def set_standing(self) -> None:
        """Kinematic Rigidbodies of their own to bases and scenery that the ground's does not hold; they move with the root as that one does."""
        if self.ground is None:
            return
        node_of = {index: node for node, index in enumerate(self.object_of)}
        touched: set[int] = set()
        for index, components in enumerate(self.components):
            if any(isinstance(c, UnityCollider) for c in components):
                at: int | None = index
                while at is not None and at not in node_of:
                    at = self.objects[at].parent
                if at is not None:
                    touched.add(node_of[at])
        self.standing = find_standing(self.scene, self.groups, self.parents, touched)
        for holder in dict.fromkeys(self.standing.holder):
            own = None if holder is None else self.components[self.object_of[holder]]
            if own is not None and not any(isinstance(c, Rigidbody) for c in own):
                own.append(Rigidbody(useGravity=False, isKinematic=True))

    def add_joints(self) -> None:
        for number, joint in enumerate(self.scene.joints):
            driven = with_passive_drives(joint, self.report)
            finding = self.findings.get(joint.id)
            mapped = map_joint(
                driven, self.scene, self.groups, self._carrier, self.report, finding, self._led, self._base
            )
            if mapped is None:
                continue
            connected = self.ground if mapped.connected is None else self.object_of[mapped.connected]
            component = replace(mapped.component, connectedBody=connected, **mapped.beside(self.scene))
            component = with_source(component, mapped, joint, number)
            components = self.components[self.object_of[mapped.owner]]
            components.append(component)
            self.joints[joint.id] = (mapped, len(components) - 1)

    def keep_apart(self) -> None:
        """Joints that hold nothing between bodies that the source lets pass through each other: Unity needs no script then."""
        bodies = self._bodies()
        joined = {
            frozenset((bodies[i], c.connectedBody))
            for i, own in enumerate(self.components)
            for c in own
            if isinstance(c, JointComponent) and not c.enableCollision
        }
        free_ids = FreeIds(self.joints)

        def keep(own: int, other: int, reason: str) -> None:
            if frozenset((own, other)) in joined:
                return
            joined.add(frozenset((own, other)))
            id = free_ids.take(apart_id(self.objects[own].id, self.objects[other].id))
            self.components[own].append(apart_joint(id, other, reason))

        for own, other in self._beside_bases():
            keep(own, other, "part of the base of a joint")
        touching = {
            i: bodies[i] for i, own in enumerate(self.components) if any(isinstance(c, UnityCollider) for c in own)
        }
        for pair in self.scene.apart:
            ids = (self.scene.nodes[pair.a].id, self.scene.nodes[pair.b].id)
            feature, kept = f"{pair.reason} of {ids[0]} and {ids[1]}", True
            for a, b in product(self._bodies_of(pair.a, touching), self._bodies_of(pair.b, touching)):
                if a == b or not (self._moves(a) or self._moves(b)):
                    continue
                own, other = (a, b) if self._moves(a) else (b, a)
                whole = all(self._is_whole(body, node, touching) for body, node in ((a, pair.a), (b, pair.b)))
                if own is None or other is None or not (whole or frozenset((a, b)) in joined):
                    kept = False
                else:
                    keep(own, other, pair.reason)
            if pair.stated and kept:
                self.report.kept(feature, pair.where)
            elif pair.stated:  # what touches of the others is found where they stand
                self.report.dropped(feature, "PAIR_DROPPED", pair.where, a=ids[0], b=ids[1])

    def _beside_bases(self) -> list[tuple[int, int]]:
        """What moves, with each body of the base that a joint has it on, also where no component stands for that joint."""
        found: list[tuple[int, int]] = []
        for joint in self.scene.joints if self.ground is not None else ():
            for node, base in ((joint.a, joint.b), (joint.b, joint.a)):
                if node is None or base not in self.standing.bases or self.groups.is_ground(node) or joint.collide:
                    continue
                if self.groups.group_of[node] is not None:
                    own = self.object_of[self._carrier(node)]
                    holders = self.standing.bases[base]
                    others = [self.ground if holder is None else self.object_of[holder] for holder in holders]
                    found += [(own, other) for other in others if self._moves(own)]
        return found

    def _bodies(self) -> list[int | None]:
        """``_body`` of every object, each of which stands behind the one above it."""
        found: list[int | None] = []
        for index, (own, components) in enumerate(zip(self.objects, self.components)):
            above = None if own.parent is None else found[own.parent]
            found.append(index if any(isinstance(c, Rigidbody) for c in components) else above)
        return found

    def _body(self, index: int) -> int | None:
        """The object whose Rigidbody moves another; None for what stands in the world."""
        at: int | None = index
        while at is not None and not any(isinstance(c, Rigidbody) for c in self.components[at]):
            at = self.objects[at].parent
        return at

    def _moves(self, body: int | None) -> bool:
        return body is not None and any(
            isinstance(c, Rigidbody) and not c.isKinematic for c in self.components[body]
        )

    def _bodies_of(self, node: int, touching: Mapping[int, int | None]) -> list[int | None]:
        """The Rigidbody that moves a node; of what stands those of all that it holds, each of which may have its own.

        touching: of each object with colliders the Rigidbody that moves it.
        """
        own = self._body(self.object_of[node])
        if self._moves(own):
            return [own]
        within = with_all_below(self.objects, self.object_of[node])
        held = {body: None for i, body in touching.items() if i in within and not self._moves(body)}
        return list(held) or [own]

    def _is_whole(self, body: int | None, node: int, touching: Mapping[int, int | None]) -> bool:
        """Whether all colliders of a Rigidbody are those of a node and of what stands below it.  touching: see ``_bodies_of``."""
        within = with_all_below(self.objects, self.object_of[node])
        return all(i in within for i, its in touching.items() if its == body)

    def _carrier(self, node: int) -> int:
        assert self.rigidbodies is not None
        carrier = self.rigidbodies.carrier_of[node]
        assert carrier is not None, "map_joint asks for bodies only"
        return carrier

    def _base(self, node: int) -> int | None:
        return self.standing.holder[node] if self.standing.holder else None

    def _led(self, carrier: int) -> bool:
        """Whether scripts alone move the Rigidbody of a node that has one."""
        assert self.rigidbodies is not None
        return is_kinematic(self.scene, self.rigidbodies.carriers[carrier])

    def couplings(self) -> list[Coupling]:
        stated = self.scene.couplings
        screws = screw_couplings([mapped for mapped, _ in self.joints.values()], stated)
        mapped = (map_coupling(c, self.joints, self.object_of, self.report) for c in [*stated, *screws])
        return [coupling for coupling in mapped if coupling is not None]
