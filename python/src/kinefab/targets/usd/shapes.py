"""What is drawn and what touches on each node: its bodies' meshes, and the colliders that the source states."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from ...diagnostics import Report
from ...model import Body, Collider, ColliderKind, Node, PhysicsMaterial, Scene
from ...options import ColliderShape
from ...spatial import Pose
from .bodies import Bodies
from .looks.materials import Materials
from .looks.meshes import INSTANCED, Meshes, Use
from .physics.colliders import (
    HULL,
    MESH,
    PIECES,
    SHAPES,
    Chosen,
    Contact,
    write_contact,
    write_physics_material,
    write_shape,
)
from .prims import Prim, Scale


@dataclass(frozen=True, slots=True, eq=False)
class Shape:
    """use: of a mesh, None for a shape of its own.  collider: that is stated, None for a body."""

    name: str
    pose: Pose
    scale: Scale
    visible: bool = True
    use: Use | None = None
    collider: Collider | None = None
    contact: Contact | None = None


@dataclass(slots=True, eq=False)
class Shapes:
    """drawn: the scene with normals.  scope: of physics materials.  shape: asked for where the source states no colliders.
    target: ending, for the report.
    groups: paths of colliders by their collision group, as they are written.
    colliders: for each node the paths of its colliders."""

    scene: Scene
    drawn: Scene
    bodies: Bodies
    scope: Prim
    shape: ColliderShape
    report: Report
    target: str
    groups: dict[str, list[str]] = field(default_factory=dict[str, "list[str]"])
    colliders: list[list[str]] = field(default_factory=list["list[str]"])
    _chosen: Chosen = field(default_factory=Chosen)
    _materials: dict[PhysicsMaterial, str] = field(default_factory=dict[PhysicsMaterial, str])

    def write(
        self, prims: Sequence[Prim], prototypes: Prim, materials: Materials, active: Sequence[bool]
    ) -> Any:
        """Below each node's prim what is on the node; yields as often as there are nodes."""
        found = [self._of(i, node, active[i]) for i, node in enumerate(self.scene.nodes)]
        uses = [shape.use for shapes in found for shape in shapes if shape.use is not None]
        meshes = Meshes(self.drawn, prototypes, materials, uses)
        for prim, shapes in zip(prims, found):
            self.colliders.append([])
            for shape in shapes:
                path = _write(prim, shape, meshes)
                if shape.collider is not None and shape.collider.group:
                    self.groups.setdefault(shape.collider.group, []).append(path)
                use = shape.use
                if (shape.contact if use is None else use.contact) is not None:
                    instanced = use is not None and meshes.instanced(use)
                    self.colliders[-1].append(f"{path}/{INSTANCED}" if instanced else path)
            yield

    def _of(self, number: int, node: Node, active: bool) -> list[Shape]:
        found = [self._body(number, node, body, active) for body in node.bodies if body.mesh is not None]
        if active:
            stated = (self._collider(number, node, collider) for collider in node.colliders or ())
            found += [shape for shape in stated if shape is not None]
        return found

    def _body(self, number: int, node: Node, body: Body, active: bool) -> Shape:
        assert body.mesh is not None
        mesh, contact = self.scene.meshes[body.mesh], None
        if active and node.colliders is None:
            shape, still = node.collision or self.shape, not self.bodies.dynamic(number)
            wanted = self._chosen.approximation(shape, body.mesh, mesh, still, self._fixed(number))
            contact = Contact(wanted) if wanted else None
        use = Use(body.mesh, tuple(body.surfaces), contact)
        return Shape(body.name or mesh.name, body.pose, body.scale, node.visible and body.visible, use)

    def _fixed(self, number: int) -> bool:
        """Whether a node is part of a body that is fixed to the world."""
        return self.bodies.inside[number] in self.bodies.grounded

    def _collider(self, number: int, node: Node, collider: Collider) -> Shape | None:
        name = collider.name.rpartition("/")[2] or collider.kind.value
        feature = f"collider {node.id}/{collider.name or collider.kind.value}"
        if collider.is_empty:
            self.report.dropped(feature, "COLLIDER_EMPTY", collider.where, object=node.id)
            return None
        material = "" if collider.material is None else self._material(collider.material)
        kind = collider.kind
        if kind in SHAPES:
            contact = Contact("", material, collider.trigger, collider.enabled)
            scale = collider.size if kind is ColliderKind.BOX else (1.0, 1.0, 1.0)
            pose = Pose(translation=collider.pose.translation) if kind is ColliderKind.SPHERE else collider.pose
            return Shape(name, pose, scale, True, None, collider, contact)
        assert collider.mesh is not None, "a hull or mesh collider names its mesh"
        wanted = PIECES if kind is ColliderKind.PIECES else HULL
        if kind is ColliderKind.MESH:
            if self.bodies.dynamic(number):
                self.report.approximated(
                    feature, "TARGET_FEATURE_APPROXIMATED", collider.where, target=self.target,
                    detail="what moves collides by convex shapes; it is the hull of its mesh",
                )  # fmt: skip
            else:
                wanted = PIECES if self._fixed(number) else MESH
        contact = Contact(wanted, material, collider.trigger, collider.enabled)
        return Shape(
            name, collider.pose, collider.scale, True, Use(collider.mesh, (), contact, True), collider
        )

    def _material(self, material: PhysicsMaterial) -> str:
        """Path of a physics material."""
        if material not in self._materials:
            prim = self.scope.child(material.name or "PhysicsMaterial", "Material")
            write_physics_material(prim, material)
            self._materials[material] = str(prim.path)
        return self._materials[material]


def _write(parent: Prim, shape: Shape, meshes: Meshes) -> str:
    """Returns the prim's path."""
    if shape.use is not None:
        prim = parent.child(shape.name, meshes.kind(shape.use))
        meshes.write(prim, shape.use)
    else:
        assert shape.collider is not None and shape.contact is not None
        prim = parent.child(shape.name, SHAPES[shape.collider.kind])
        write_shape(prim, shape.collider)
        prim.attribute("purpose", "Token", "guide", uniform=True)
        write_contact(prim, shape.contact)
    prim.place(shape.pose, shape.scale)
    if not shape.visible:
        prim.attribute("visibility", "Token", "invisible")
    return str(prim.path)
