"""Writes ``NAME.glb``."""

from __future__ import annotations

import json
import struct
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from ... import __version__
from ...geometry.collision import hollow_pieces, is_split
from ...model import PLAIN, Body, Collider, ColliderKind, Mesh, Physics
from ...options import ColliderShape
from ...replacing import replacing
from ...rigid import active_nodes, dynamic_nodes, moves_nothing
from ...spatial import Array, Pose, quaternion_from_matrix
from ...unity.bodies.rigidbodies import body_dynamics, body_mass, parents_beside, place_rigidbodies
from ...unity.bodies.standing import bases_of
from ...unity.joints.coordinates import removes_nothing
from ...unity.joints.passive import with_passive_drives
from ..content import Content
from ..tangents import tangents_along
from .binary import Binary
from .clips import animations
from .filters import Filters
from .looks import Looks
from .physics import BODIES, PhysicsEntries, bounding_box, motion, shape_pose

MAGIC, VERSION, JSON_CHUNK, BINARY_CHUNK = 0x46546C67, 2, 0x4E4F534A, 0x004E4942


def write(content: Content, target: Path) -> tuple[Path, ...]:
    """Write the scene; the report gets what glTF has no place for.  Raises OSError; then the old file stands."""
    document = _Document(content)
    values = document.built()
    content.refuse_losses()
    binary = document.binary
    text = json.dumps(values, ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = 12 + 8 + len(text) + (8 + binary.length if binary.length else 0)
    with replacing(target, "glb") as file:
        file.write(struct.pack("<III", MAGIC, VERSION, chunks))
        file.write(struct.pack("<II", len(text), JSON_CHUNK) + text)
        if binary.length:
            file.write(struct.pack("<II", binary.length, BINARY_CHUNK))
            for i, chunk in enumerate(binary.chunks):
                file.write(chunk)
                content.progress((i + 1) / len(binary.chunks))
    return (target,)


class _Document:
    """Fills the lists of the document.  node_of: for each node of the model its glTF node.  model_meshes: the scene's, behind them
    the convex pieces of hollow ones; pieces_of: for each of those the numbers of its pieces."""

    def __init__(self, content: Content):
        self.content, self.scene, self.report = content, content.scene, content.report
        self.binary = Binary()
        self.looks = Looks(self.binary, content.report)
        self.physics = PhysicsEntries(content.report)
        self.filters = Filters(content.scene, content.groups, content.report)
        self.nodes: list[dict[str, Any]] = []
        self.roots: list[int] = []
        self.meshes: list[dict[str, Any]] = []
        self.mesh_of: dict[tuple[int, tuple[int, ...]], int] = {}
        self.node_of: list[int] = []
        self.model_meshes = list(content.drawn().meshes)
        self.pieces_of: dict[int, range] = {}
        self.active = active_nodes(content.scene)
        self.dynamic = dynamic_nodes(content.scene, content.groups)
        self.placed = place_rigidbodies(content.scene, content.groups)

    def built(self) -> dict[str, Any]:
        self._add_pieces()
        self._add_nodes()
        self._add_bodies()
        self._add_joints()
        self._tell_rest()
        self.physics.filters = self.filters.written()
        values: dict[str, Any] = {"asset": {"version": "2.0", "generator": f"kinefab {__version__}"}}
        of_nodes = self._node_extensions()
        # Readers look here whether the document has physics at all, so it says so where no joint or material is listed, too.
        extensions = {name: dict[str, Any]() for name in sorted(of_nodes)} | self.physics.used()
        used = sorted({*extensions, *self.looks.extensions})
        lists = {
            "extensionsUsed": used,
            "extensions": extensions,
            "scenes": [{"nodes": self.roots}] if self.roots else [],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.looks.materials,
            "textures": self.looks.textures,
            "samplers": self.looks.samplers,
            "images": self.looks.images,
            "animations": animations(self.scene, self.node_of, self.binary, self.report),
            "accessors": self.binary.accessors,
            "bufferViews": self.binary.views,
            "buffers": [{"byteLength": self.binary.length}] if self.binary.length else [],
        }
        values |= {key: value for key, value in lists.items() if value}
        if self.roots:
            values["scene"] = 0
        return values

    def _add_pieces(self) -> None:
        content = self.content
        made = hollow_pieces(self.scene, content.groups, content.colliders, self.report)
        for mesh, pieces in made.items():
            first = len(self.model_meshes)
            self.model_meshes += pieces
            self.pieces_of[mesh] = range(first, len(self.model_meshes))

    def _node(
        self, name: str, parent: int | None, local: Pose, scale: tuple[float, float, float] = (1.0, 1.0, 1.0)
    ) -> int:
        entry: dict[str, Any] = {"name": name}
        if local.translation.any():
            entry["translation"] = local.translation.tolist()
        if not np.array_equal(local.rotation, np.eye(3)):
            entry["rotation"] = quaternion_from_matrix(local.rotation).tolist()
        if scale != (1.0, 1.0, 1.0):
            entry["scale"] = list(scale)
        self.nodes.append(entry)
        index = len(self.nodes) - 1
        if parent is None:
            self.roots.append(index)
        else:
            self.nodes[parent].setdefault("children", []).append(index)
        return index

    def _extend(self, node: int, key: str, value: dict[str, Any]) -> None:
        self.nodes[node].setdefault("extensions", {}).setdefault(BODIES, {})[key] = value

    def _node_extensions(self) -> set[str]:
        return {name for node in self.nodes for name in node.get("extensions", ())}

    def _add_nodes(self) -> None:
        """A grounded node below a moving body stands beside it: readers give the colliders to the next motion above them."""
        parents = parents_beside(self.scene, self.content.groups, self.placed)
        for i, (node, above) in enumerate(zip(self.scene.nodes, parents)):
            local = self.scene.pose(above).inverse() @ node.pose
            index = self._node(node.name, None if above is None else self.node_of[above], local)
            self.node_of.append(index)
            told = {"id": node.id, "layer": node.layer, "tag": node.tag}
            self.nodes[index]["extras"] = {key: value for key, value in told.items() if value or key == "id"}
            if not self.active[i]:
                self.report.dropped(
                    f"part {node.id}", "COMPONENT_SUPPRESSED_DROPPED", node.where, node=node.id
                )
                continue
            for site in node.sites:
                self._node(site.name, index, site.pose)
            for body in node.bodies:
                if body.mesh is not None:
                    self._add_body(i, index, body)
            for collider in node.colliders or ():
                self._add_collider(i, index, collider)

    def _add_body(self, node: int, parent: int, body: Body) -> None:
        assert body.mesh is not None
        own = self.scene.nodes[node]
        index = self._node(body.name, parent, body.pose, body.scale)
        if own.visible and body.visible:
            self.nodes[index]["mesh"] = self._mesh(body.mesh, body.surfaces)
        else:
            self.report.field_dropped(f"body {own.id}/{body.name}", "visibility", ".glb", own.where)
        shape = own.collision or self.content.colliders
        if own.colliders is not None or shape is ColliderShape.NONE:
            return
        if body.mesh in self.pieces_of and is_split(shape, self.dynamic[node]):
            self._collide_by_pieces(node, index, body, {})
            return
        holder = index
        if shape is ColliderShape.BOX:
            around = bounding_box(self.scene.meshes[body.mesh])
            holder, geometry = self._node("box", index, around.pose), self.physics.geometry(around)
        else:
            geometry = {"node": index if "mesh" in self.nodes[index] else self._shape(body.name, body.mesh)}
            if self.dynamic[node] or shape is ColliderShape.HULL:
                geometry["convexHull"] = True
                if shape is ColliderShape.MESH:
                    self._tell_hull(f"collider {own.id}/{body.name}", own.where)
        self._collide(node, holder, {"geometry": geometry})

    def _add_collider(self, node: int, parent: int, collider: Collider) -> None:
        own = self.scene.nodes[node]
        feature = f"collider {own.id}/{collider.name or collider.kind.value}"
        if collider.is_empty:
            self.report.dropped(feature, "COLLIDER_EMPTY", collider.where, object=own.id)
            return
        if not collider.enabled:
            told = {"field": "its being switched off", "target": ".glb"}
            self.report.dropped(feature, "TARGET_FIELD_DROPPED", collider.where, **told)
            return
        index = self._node(collider.name or collider.kind.value, parent, shape_pose(collider), collider.scale)
        entry: dict[str, Any] = {}
        if collider.material is not None and not collider.trigger:
            entry["physicsMaterial"] = self.physics.material(collider.material)
        if collider.kind is ColliderKind.PIECES and collider.mesh in self.pieces_of:
            self._collide_by_pieces(node, index, collider, entry)
            return
        if collider.kind in (ColliderKind.HULL, ColliderKind.PIECES, ColliderKind.MESH):
            assert collider.mesh is not None
            shape = self._shape(collider.name or collider.kind.value, collider.mesh)
            geometry: dict[str, Any] = {"node": shape}
            if collider.kind is not ColliderKind.MESH or self.dynamic[node]:
                geometry["convexHull"] = True
                if collider.kind is ColliderKind.MESH:
                    self._tell_hull(feature, collider.where)
        else:
            geometry = self.physics.geometry(collider)
        self._collide(node, index, {"geometry": geometry, **entry}, collider.group, collider.trigger)

    def _collide(
        self, node: int, holder: int, entry: dict[str, Any], group: str = "", trigger: bool = False
    ) -> None:
        """holder: index of the glTF node that gets the collider.  node: of the model, whose it is."""
        self.filters.add(node, group, entry)
        self._extend(holder, "trigger" if trigger else "collider", entry)

    def _collide_by_pieces(
        self, node: int, above: int, collider: Body | Collider, entry: Mapping[str, Any]
    ) -> None:
        """Several colliders below a body's or collider's own node: a reader makes one body of all that are below its motion."""
        assert collider.mesh is not None
        stated = collider if isinstance(collider, Collider) else Collider(ColliderKind.PIECES)
        for number in self.pieces_of[collider.mesh]:
            name = self.model_meshes[number].name
            geometry = {"node": self._shape(name, number), "convexHull": True}
            holder = self._node(name, above, Pose())
            self._collide(node, holder, {"geometry": geometry, **entry}, stated.group, stated.trigger)

    def _tell_hull(self, feature: str, where: str) -> None:
        detail = "one convex hull stands for its mesh"
        self.report.approximated(feature, "TARGET_FEATURE_APPROXIMATED", where, target=".glb", detail=detail)

    def _shape(self, name: str, mesh: int) -> int:
        """Index of a node that is in no scene, so that its mesh collides and is not drawn."""
        self.nodes.append({"name": f"{name} shape", "mesh": self._mesh(mesh, ())})
        return len(self.nodes) - 1

    def _mesh(self, number: int, surfaces: tuple[int, ...]) -> int:
        """Index of a mesh with these surfaces; its arrays are shared with the same mesh in others."""
        if (number, surfaces) not in self.mesh_of:
            mesh = self.model_meshes[number]
            self.meshes.append({"name": mesh.name, "primitives": self._primitives(mesh, surfaces)})
            self.mesh_of[number, surfaces] = len(self.meshes) - 1
        return self.mesh_of[number, surfaces]

    def _primitives(self, mesh: Mesh, surfaces: tuple[int, ...]) -> list[dict[str, Any]]:
        attributes = {"POSITION": self.binary.floats(mesh.vertices, bounded=True)}
        normals, tangents = _unit(mesh.normals), mesh.tangents
        if normals is not None:
            attributes["NORMAL"] = self.binary.floats(normals)
            if tangents is None and mesh.uvs and any(self.scene.surfaces[s].normal_texture for s in surfaces):
                tangents = tangents_along(mesh.vertices, normals, mesh.uvs[0], mesh.faces)
            if tangents is not None:
                attributes["TANGENT"] = self.binary.floats(tangents)
        for i, uv in enumerate(mesh.uvs):
            attributes[f"TEXCOORD_{i}"] = self.binary.floats(np.column_stack([uv[:, 0], 1.0 - uv[:, 1]]))
        if mesh.colors is not None:
            attributes["COLOR_0"] = self.binary.floats(mesh.colors)
        found: list[dict[str, Any]] = []
        first = 0
        for k, count in enumerate(mesh.face_counts or (len(mesh.faces),)):
            if count == 0:
                continue
            indices = self.binary.indices(mesh.faces[first : first + count], len(mesh.vertices))
            surface = self.scene.surfaces[surfaces[k]] if k < len(surfaces) else PLAIN
            found.append(
                {
                    "attributes": attributes,
                    "indices": indices,
                    "material": self.looks.material(surface, len(mesh.uvs)),
                }
            )
            first += count
        return found

    def _add_bodies(self) -> None:
        for carrier, members in self.placed.carriers.items():
            mass = body_mass(self.scene, carrier, members, self.report)
            dynamics = body_dynamics(self.scene, carrier, members)
            entry = motion(mass, kinematic=dynamics.kinematic, gravity=dynamics.gravity)
            turned = self.scene.nodes[carrier].pose.rotation.T
            for key, value in (
                ("linearVelocity", dynamics.velocity),
                ("angularVelocity", dynamics.angular_velocity),
            ):
                if value is not None:
                    entry[key] = (turned @ value).tolist()
            own = self.scene.nodes[carrier]
            for field, there in (
                ("damping", dynamics.linear_damping or dynamics.angular_damping),
                ("the largest angular velocity", dynamics.max_angular_velocity is not None),
            ):
                if there:
                    self.report.field_dropped(f"body {own.id}", field, ".glb", own.where)
            self._extend(self.node_of[carrier], "motion", entry)
        for own, connected in self.placed.fixed:
            frame = self._node("fixed", self.node_of[own], Pose())
            local = self.scene.pose(own).inverse() @ self.scene.pose(connected)
            other = self._node("fixed", self.node_of[connected], local.inverse())
            locked = {
                "limits": [
                    {"linearAxes": [0, 1, 2], "min": 0.0, "max": 0.0},
                    {"angularAxes": [0, 1, 2], "min": 0.0, "max": 0.0},
                ]
            }
            self.physics.joints.append(locked)
            self._extend(frame, "joint", {"connectedNode": other, "joint": len(self.physics.joints) - 1})

    def _add_joints(self) -> None:
        groups = self.content.groups
        for joint in self.scene.switched_off:
            told = {"joint": joint.id, "target": ".glb"}
            self.report.dropped(f"joint {joint.id}", "JOINT_DISABLED_DROPPED", joint.where, **told)
        for joint in self.scene.joints:
            if groups.together(joint.a, joint.b):
                self.report.kept(f"joint {joint.id}", joint.where)
                continue
            if (lost := groups.without_body(joint)) is not None:
                names = {"joint": joint.id, "node": self.scene.nodes[lost].id}
                self.report.dropped(f"joint {joint.id}", "JOINT_WITHOUT_BODY", joint.where, **names)
                continue
            if removes_nothing(joint):
                self.report.dropped(f"joint {joint.id}", "JOINT_REMOVES_NOTHING", joint.where, joint=joint.id)
                continue
            if moves_nothing(joint, self.scene, groups):
                self.report.dropped(f"joint {joint.id}", "JOINT_BETWEEN_LED", joint.where, joint=joint.id)
                continue
            driven = with_passive_drives(joint, self.report)
            a, b = (None if n is None else self.node_of[n] for n in (joint.a, joint.b))
            frame = self._node(f"{joint.name or joint.id} a", a, joint.frame_a)
            other = self._node(f"{joint.name or joint.id} b", b, joint.frame_b)
            for own, at in ((joint.a, frame), (joint.b, other)):
                self._stand(own, at)
            entry: dict[str, Any] = {"connectedNode": other, "joint": self.physics.joint(driven)}
            if joint.collide:
                entry["enableCollision"] = True
            self._extend(frame, "joint", entry)
        self._part_bases()

    def _stand(self, own: int | None, frame: int) -> None:
        """Make a side of a joint that is the ground a kinematic body, as Unity's Ground is: what is joined then does not collide,
        and Babylon.js, which joins bodies alone, reads it.  frame: the side's node, by itself where it is in the world."""
        if own is None:
            self._extend(frame, "motion", {"isKinematic": True})
        elif self.content.groups.is_ground(own) and own not in self.placed.carriers:
            self._extend(self.node_of[own], "motion", {"isKinematic": True})

    def _part_bases(self) -> None:
        """Make what stands below a base a body of its own where it is no part of that, whose body would take its colliders: parts of
        another base, and what stands beside a moving body above it."""
        groups, bases = self.content.groups, bases_of(self.scene, self.content.groups)
        ends = [side for joint in self.scene.joints for side in (joint.a, joint.b)]
        named = {bases[side] for side in ends if side is not None and groups.is_ground(side)}
        parents = parents_beside(self.scene, groups, self.placed)
        for i, (node, base, parent) in enumerate(zip(self.scene.nodes, bases, parents)):
            above = None if parent is None else bases[parent]
            if above in named and above != base and (base in named or parent != node.parent):
                self._stand(i, self.node_of[i])

    def _tell_rest(self) -> None:
        for setting in fields(Physics):
            if getattr(self.scene.physics, setting.name) != getattr(Physics(), setting.name):
                told = {"field": setting.name, "target": ".glb"}
                self.report.dropped(f"project setting {setting.name}", "TARGET_FIELD_DROPPED", **told)
        for coupling in self.scene.couplings:
            self.report.dropped(
                f"coupling {coupling.id}",
                "COUPLING_DROPPED",
                coupling.where,
                coupling=coupling.id,
                target=".glb",
            )


def _unit(normals: Array | None) -> Array | None:
    """None where one has no length, and there is none to be said."""
    if normals is None:
        return None
    lengths = np.linalg.norm(normals, axis=1, keepdims=True)
    return normals / lengths if (lengths > 0.0).all() else None
