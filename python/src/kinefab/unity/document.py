"""The scene file's content as plain dicts: Unity objects and components, made from a ``Scene``.

Meshes stay arrays here; ``writer`` puts them into the buffer and adds ``buffers`` and ``meshes``.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Mapping, Sequence

from .. import __version__
from ..diagnostics import Report
from ..model import Material, Mesh, Node, Scene
from ..rigid import RigidGroups, active_nodes
from . import frames
from .colliders import Colliders, collider_fields
from .constraints import constraint_entry
from .couplings import coupling_entry, screw_couplings
from .joints import UnityJoint, map_joint
from .mobility import mobility_entry
from .numbers import rounded, without_defaults
from .rigidbodies import Rigidbodies, place_rigidbodies, rigidbody_fields
from ..spatial import Pose, quaternion_from_matrix

FORMAT_VERSION = "1.0"
PLAIN = Material("Default")
"""Stands in where the source names no material."""


@dataclass(slots=True, eq=False)
class Document:
    """head: everything before, tail: everything after the meshes, in the file's order.
    meshes: what the buffer is to hold, in the order that the components count them."""

    head: dict[str, Any]
    tail: dict[str, Any]
    meshes: list[Mesh] = field(default_factory=list)


def build_document(
    scene: Scene,
    groups: RigidGroups,
    colliders: Colliders,
    report: Report,
    analysis: Mapping[str, Any] | None = None,
    holding: Mapping[int, Sequence[str]] = MappingProxyType({}),
) -> Document:
    """Everything of the scene in Unity's terms.  ``report`` gets what became of each joint and coupling.

    analysis: what the constraints leave free, by node number (see ``mobility``).
    holding: for each node the ids of what joins it to others of its rigid group.
    """
    builder = _Builder(scene, groups, colliders, report, holding)
    builder.add_objects()
    builder.add_rigidbodies()
    builder.add_joints()
    source = {
        "uri": scene.source.uri,
        "upAxis": scene.source.up_axis,
        "metersPerUnit": rounded(scene.source.meters_per_unit),
        "sha256": scene.source.sha256,
    }
    physics = {
        "gravity": [0, -scene.physics.gravity, 0],
        "fixedTimestep": scene.physics.fixed_timestep,
        "solverIterations": scene.physics.solver_iterations,
        "solverVelocityIterations": scene.physics.solver_velocity_iterations,
    }
    head = {
        "format": "kinefab.scene",
        "version": FORMAT_VERSION,
        "generator": {"name": "kinefab", "version": __version__},
        "source": {key: value for key, value in source.items() if value != ""},
        "physics": without_defaults("physics", rounded(physics)),
    }
    tail: dict[str, Any] = {
        "materials": [_material_entry(m) for m in builder.materials],
        "gameObjects": builder.objects,
        "couplings": builder.couplings(),
        "constraints": [constraint_entry(c, builder.object_of) for c in scene.constraints],
    }
    if analysis is not None:
        tail["analysis"] = mobility_entry(analysis, builder.object_of)
    tail["report"] = report_entries(report)
    if scene.extras:
        tail["extras"] = dict(scene.extras)
    keep = ("format", "version", "generator", "gameObjects")
    return Document(
        {key: value for key, value in head.items() if value or key in keep},
        {key: value for key, value in tail.items() if value or key in keep},
        [*scene.meshes, *colliders.hulls],
    )


def report_entries(report: Report) -> list[dict[str, Any]]:
    """The loss report as the scene format holds it."""
    entries = []
    for o in report.outcomes:
        entry = {"feature": o.feature, "outcome": o.outcome.value}
        if o.code:
            entry |= {"severity": o.severity.value, "code": o.code, "message": o.message}
        if o.where:
            entry["source"] = o.where
        entries.append(entry)
    return entries


def _material_entry(material: Material) -> dict[str, Any]:
    fields = {
        "name": material.name,
        "color": list(material.color),
        "metallic": material.metallic,
        "smoothness": material.smoothness,
    }
    return without_defaults("material", rounded(fields))


@dataclass(slots=True, eq=False)
class _Builder:
    """Fills the list of GameObjects.  object_of: for each node the index of its GameObject."""

    scene: Scene
    groups: RigidGroups
    colliders: Colliders
    report: Report
    holding: Mapping[int, Sequence[str]]
    objects: list[dict[str, Any]] = field(default_factory=list)
    object_of: list[int] = field(default_factory=list)
    materials: list[Material] = field(default_factory=list)
    joints: dict[str, tuple[UnityJoint, int]] = field(default_factory=dict)
    rigidbodies: Rigidbodies | None = None

    def add_objects(self) -> None:
        self.materials = list(self.scene.materials)
        active = active_nodes(self.scene)
        for i, node in enumerate(self.scene.nodes):
            self.object_of.append(len(self.objects))
            parent = node.parent
            outer = self.scene.pose(parent)
            local = outer.inverse() @ node.pose
            entry = self._object(
                node.id, node.name, None if parent is None else self.object_of[parent], local
            )
            if not active[i]:
                entry["active"] = False
            if node.extras:
                entry["extras"] = dict(node.extras)
            self._add_bodies(i, node, entry)

    def _object(self, id: str, name: str, parent: int | None, local: Pose) -> dict[str, Any]:
        placed = frames.pose(local)
        entry: dict[str, Any] = {"id": id, "name": name}
        if parent is not None:
            entry["parent"] = parent
        transform = {
            "localPosition": placed.translation,
            "localRotation": quaternion_from_matrix(placed.rotation),
        }
        if fields := without_defaults("transform", rounded(transform)):
            entry["transform"] = fields
        entry["components"] = []
        self.objects.append(entry)
        return entry

    def _add_bodies(self, index: int, node: Node, entry: dict[str, Any]) -> None:
        """One body is the object's own mesh; several are children, so that each keeps its collider."""
        bodies = [body for body in node.bodies if body.mesh is not None]
        parent = self.object_of[index]
        group = self.groups.group_of[index]
        dynamic = group is not None and not self.groups.grounded[group]
        taken: set[str] = set()
        for body in bodies:
            holder = entry
            if len(bodies) > 1:
                suffix, count = body.name, 1
                while suffix in taken:
                    count += 1
                    suffix = f"{body.name}#{count}"
                taken.add(suffix)
                holder = self._object(f"{node.id}/body:{suffix}", body.name, parent, Pose())
            mesh = self.scene.meshes[body.mesh]
            materials = list(body.materials) or [self._plain_material()] * max(1, len(mesh.face_counts))
            renderer = {"type": "MeshRenderer", "enabled": node.visible, "materials": materials}
            holder["components"] += [
                {"type": "MeshFilter", "mesh": body.mesh},
                without_defaults("MeshRenderer", renderer),
                *collider_fields(self.colliders, body.mesh, mesh, dynamic),
            ]

    def _plain_material(self) -> int:
        if PLAIN not in self.materials:
            self.materials.append(PLAIN)
        return self.materials.index(PLAIN)

    def add_rigidbodies(self) -> None:
        self.rigidbodies = place_rigidbodies(self.scene, self.groups)
        for carrier, members in self.rigidbodies.carriers.items():
            fields = rigidbody_fields(self.scene, carrier, members, self.report)
            components = self.objects[self.object_of[carrier]]["components"]
            components.append(without_defaults("Rigidbody", fields))
        for own, connected in self.rigidbodies.fixed:
            group: dict[str, Any] = {"type": "FixedJoint", "connectedBody": self.object_of[connected]}
            if own in self.holding:
                group["because"] = list(self.holding[own])
            self.objects[self.object_of[own]]["components"].append(group)

    def add_joints(self) -> None:
        for joint in self.scene.joints:
            mapped = map_joint(joint, self.scene, self.groups, self._carrier, self.report)
            if mapped is None:
                continue
            fields = dict(mapped.component)
            if mapped.connected is not None:
                fields["connectedBody"] = self.object_of[mapped.connected]
            components = self.objects[self.object_of[mapped.owner]]["components"]
            components.append(without_defaults(fields["type"], rounded(fields)))
            self.joints[joint.id] = (mapped, len(components) - 1)

    def _carrier(self, node: int) -> int:
        carrier = self.rigidbodies.carrier_of[node]
        assert carrier is not None, "map_joint asks for bodies only"
        return carrier

    def couplings(self) -> list[dict[str, Any]]:
        stated = self.scene.couplings
        screws = screw_couplings((mapped for mapped, _ in self.joints.values()), stated)
        entries = (coupling_entry(c, self.joints, self.object_of, self.report) for c in [*stated, *screws])
        return [entry for entry in entries if entry is not None]
