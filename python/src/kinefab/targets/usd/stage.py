"""The stage: its units, its hierarchy, and in which order what is written."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ... import __version__
from ...model import Joint, NodeKind
from ...rigid import active_nodes, moves_nothing
from ...unity.joints.coordinates import removes_nothing
from ..content import Content
from .api import Sdf
from .bodies import Bodies, find_bodies
from .clips import Clips
from .looks.materials import Materials
from .looks.textures import Textures
from .names import display_name, sibling_names
from .physics.articulations import Edge, mark_articulations
from .physics.couplings import write_couplings
from .physics.filters import write_groups, write_pairs
from .physics.joints import Joints, Places
from .physics.rigid import write_grounded, write_moving
from .physics.sums import with_one_term_each
from .prims import Prim, vector3f
from .shapes import Shapes

JOINTS, MATERIALS, PHYSICS_MATERIALS = "Joints", "Materials", "PhysicsMaterials"
PROTOTYPES, GROUPS = "Prototypes", "CollisionGroups"
SCOPES = (JOINTS, MATERIALS, PHYSICS_MATERIALS, PROTOTYPES, GROUPS)
"""Scopes below the default prim, beside the nodes."""
TIMESTEP = 0.02
"""Seconds: what is not said."""


@dataclass(slots=True, eq=False)
class Stage:
    """A layer being filled.  name: of the default prim, where no single assembly holds everything.
    target: ending of the file, for the report.  prims: of each node."""

    content: Content
    name: str
    target: str
    textures: Textures
    layer: Any = field(default_factory=lambda: Sdf.Layer.CreateAnonymous(".usda"))
    prims: list[Prim] = field(default_factory=list[Prim])

    def write(self) -> None:
        """Fill the layer; the report gets what became of joints, colliders, couplings and clips."""
        counted = {name for coupling in self.content.scene.couplings for name in coupling.joints}
        joints = [joint for joint in self.content.scene.joints if self._is_written(joint, counted)]
        self.content, joints = with_one_term_each(self.content, joints)
        content = self.content
        scene, report = content.scene, content.report
        bodies = find_bodies(scene, content.groups, joints)
        with Sdf.ChangeBlock():
            clips = Clips(scene, bodies, report, self.target)
            root = self._hierarchy(bodies, clips)
            scopes = {name: root.child(name, "Scope", name=name) for name in SCOPES}
            self._metadata(root)
            shapes = Shapes(
                scene,
                content.drawn(),
                bodies,
                scopes[PHYSICS_MATERIALS],
                content.colliders,
                report,
                self.target,
            )
            materials = Materials(scopes[MATERIALS], self.textures)
            active = active_nodes(scene)
            for i, _ in enumerate(shapes.write(self.prims, scopes[PROTOTYPES], materials, active)):
                content.progress(0.8 * (i + 1) / len(self.prims))
            write_groups(scopes[GROUPS], shapes.groups, scene)
            write_pairs(content, bodies, self.prims, shapes.colliders, self.target)
            self._physics(root, scopes[JOINTS], bodies, joints)
            clips.write(self.layer, self.prims)
            for scope in scopes.values():
                scope.remove_if_empty()

    def _is_written(self, joint: Joint, counted: Collection[str]) -> bool:
        """Whether a joint moves something, or would; the report tells of the others.  counted: joints that couplings count by."""
        groups, report, feature = self.content.groups, self.content.report, f"joint {joint.id}"
        if (lost := groups.without_body(joint)) is not None:
            names = {"joint": joint.id, "node": self.content.scene.nodes[lost].id}
            report.dropped(feature, "JOINT_WITHOUT_BODY", joint.where, **names)
        elif groups.together(joint.a, joint.b):
            if not joint.enabled:
                told = {"joint": joint.id, "target": "one rigid body"}
                report.dropped(feature, "JOINT_DISABLED_DROPPED", joint.where, **told)
            elif joint.unlocked:
                report.dropped(feature, "JOINT_REDUNDANT", joint.where, joint=joint.id)
            else:
                report.kept(feature, joint.where)
        elif removes_nothing(joint) and joint.id not in counted:
            report.dropped(feature, "JOINT_REMOVES_NOTHING", joint.where, joint=joint.id)
        elif joint.enabled and moves_nothing(joint, self.content.scene, groups) and joint.id not in counted:
            report.dropped(feature, "JOINT_BETWEEN_LED", joint.where, joint=joint.id)
        else:
            return True
        return False

    def _metadata(self, root: Prim) -> None:
        head = self.layer.pseudoRoot
        for key, value in (("upAxis", "Y"), ("metersPerUnit", 1.0), ("kilogramsPerUnit", 1.0)):
            head.SetInfo(key, value)
        self.layer.defaultPrim = root.path.name
        self.layer.customLayerData = {"creator": f"kinefab {__version__}"}
        physics, taken = self.content.scene.physics, root.path.name == "PhysicsScene"
        prim = Prim(
            Sdf.PrimSpec(
                self.layer, "PhysicsScene_" if taken else "PhysicsScene", Sdf.SpecifierDef, "PhysicsScene"
            )
        )
        gravity = np.array(physics.gravity)
        size = float(np.linalg.norm(gravity))
        down = gravity / size if size > 0.0 else np.array([0.0, -1.0, 0.0])
        prim.attribute("physics:gravityDirection", "Vector3f", vector3f(down))
        prim.numbers({"physics:gravityMagnitude": size})
        if physics.fixed_timestep != TIMESTEP:
            prim.apply("PhysxSceneAPI")
            steps = max(1, round(1.0 / physics.fixed_timestep))
            prim.attribute("physxScene:timeStepsPerSecond", "UInt", steps)

    def _hierarchy(self, bodies: Bodies, clips: Clips) -> Prim:
        """A prim for each node, with its sites; returns the default prim."""
        scene, active = self.content.scene, active_nodes(self.content.scene)
        below: dict[int | None, list[int]] = {}
        for i, above in enumerate(bodies.holder):
            below.setdefault(above, []).append(i)
        tops = below.get(None, [])
        whole = len(tops) == 1 and scene.nodes[tops[0]].kind is NodeKind.ASSEMBLY
        whole = whole and active[tops[0]] and bodies.inside[tops[0]] is None
        names: dict[int, str] = {}
        for above, members in below.items():
            reserved = SCOPES if above in (None, *tops) else ()
            named = [(scene.nodes[i].name, scene.nodes[i].id) for i in members]
            names |= zip(members, sibling_names(named, reserved))
        head = Prim(self.layer.pseudoRoot)
        root = None if whole else head.child(self.name, "Xform")
        for i, node in enumerate(scene.nodes):
            above = bodies.holder[i]
            parent = (root or head) if above is None else self.prims[above]
            prim = parent.child(node.name, "Xform", name=names[i])
            if root is None:
                root = prim
            self.prims.append(prim)
            prim.tell_source(node.id)
            if display_name(node.name) != node.name != names[i]:
                told = {"object": node.id, "name": node.name, "changed": names[i]}
                self.content.report.approximated(f"name of {node.id}", "TARGET_NAME_CHANGED", **told)
            if not active[i]:
                prim.deactivate()
            prim.place(scene.pose(above).inverse() @ node.pose, moves=i in clips.moving)
            prim.reserve([names[k] for k in below.get(i, ())])
            for site in node.sites:
                prim.child(site.name, "Xform").place(site.pose)
            self._tell_words(i, bodies)
        assert root is not None
        root.reserve(SCOPES)
        root.info("kind", "component")
        return root

    def _tell_words(self, number: int, bodies: Bodies) -> None:
        node, report = self.content.scene.nodes[number], self.content.report
        for word, value in (("layer", node.layer), ("tag", node.tag)):
            if value:
                report.field_dropped(f"part {node.id}", f"the {word} '{value}'", self.target, node.where)
        if number in bodies.moving.carriers and bodies.taken_out(number):
            report.kept(f"part {node.id}", node.where, "TARGET_BODY_BESIDE", node=node.id, target=self.target)

    def _physics(self, root: Prim, scope: Prim, bodies: Bodies, joints: list[Joint]) -> None:
        """Bodies, then what joins them."""
        content, edges = self.content, list[Edge]()
        scene, report = content.scene, content.report
        for carrier, members in bodies.moving.carriers.items():
            write_moving(self.prims[carrier], scene, carrier, members, report)
        members_of: dict[int, list[int]] = {}
        for i, inside in enumerate(bodies.inside):
            if inside is not None:
                members_of.setdefault(inside, []).append(i)
        for ground in bodies.grounded:
            write_grounded(self.prims[ground], scene, ground, tuple(members_of[ground]), report)
        joints = [*joints, *(joint for joint in scene.switched_off if self._is_written(joint, ()))]
        named = sibling_names([(joint.name or joint.id, joint.id) for joint in joints])
        scope.reserve(named)
        top = next((i for i, prim in enumerate(self.prims) if prim is root), None)
        places = Places(scene, self.prims, root, scene.pose(top))
        for ground in bodies.grounded:
            on = None if ground == bodies.base else bodies.base
            edges.append(self._fixed(scope, on, ground))
        for own, connected in bodies.moving.fixed:
            edges.append(self._fixed(scope, connected, own))
        fixed = tuple(edges)
        writer = Joints(scene, bodies, scope, places, report, self.target)
        coupled = {name for coupling in scene.couplings for name in coupling.joints}
        for joint, name in zip(joints, named):
            edge = writer.begin(joint, name, content.findings.get(joint.id), joint.id in coupled)
            if joint.enabled:
                edges.append(edge)
        kinematic = {i for i in bodies.moving.carriers if not bodies.dynamic(i)}
        base = edges[0].prim if bodies.grounded else None
        trees = mark_articulations(edges, kinematic.__contains__, self.prims.__getitem__, base)
        for edge in fixed:
            places.write_fixed(edge, edge.prim.path in trees.inward)
        writer.finish(trees)
        write_couplings(scene, writer.written, trees.first, report, self.target)

    def _fixed(self, scope: Prim, a: int | None, b: int) -> Edge:
        """A joint that holds b to a (None: the world) as they stand, without its sides yet."""
        node = self.content.scene.nodes[b]
        return Edge(a, b, scope.child(f"{node.name} fixed", "PhysicsFixedJoint", node.id))
