"""A written scene as a source: its objects as nodes, its joints as the model's, and beside them the scene as it was written.

A target in Unity's terms writes the latter, so that nothing is found anew that was found when the scene was made; a target in
the model's own terms gets the nodes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...diagnostics import FeatureOutcome, KinefabError, Outcome, Report, Severity
from ...model import (
    PLAIN,
    AnimationClip,
    Body,
    Dynamics,
    MassProperties,
    Node,
    NodeKind,
    Physics,
    Repeat,
    Scene,
    Site,
    Source,
    Surface,
    Track,
)
from ...options import Closures, ColliderShape, ExportOptions, Ground
from ...spatial import Pose, matrix_from_quaternion
from .. import frames
from ..as_stated import stated_body, stated_mass, stated_piece, without_stated
from ..assets.clips import WRAP
from ..assets.meshes import unmapped_mesh
from ..counting import led_bodies
from ..joints.passive import with_passive_drives
from ..mapping import GROUND_ID
from ..scene import ArticulationBody, Collider, GameObject, Material, MeshFilter, MeshRenderer, Rigidbody, UnityScene
from .extras import Way, extras_in
from .pairs import pairs_apart, pairs_colliding
from .restored import restored
from .scene_file import read_scene, unsound_as_finding
from .shapes import shape_of
from .stated.choices import choice_of, still_chosen
from .stated.joints import WrittenJoints
from .unity_scene import unity_scene

HELD = Rigidbody(useGravity=False, isKinematic=True)
"""Of what stands: see ``mapping``."""
_REPEATS = {word: repeat for repeat, word in WRAP.items()}


@dataclass(slots=True, eq=False)
class WrittenScene(Scene):
    """written: the same in Unity's terms, as it stands in the file.  path: the file's name.  extras_at: what other programs have
    written into its objects, by the way to each.  pieces: pairs of nodes that stand and are of one piece."""

    written: UnityScene = field(default_factory=UnityScene)
    path: str = ""
    extras_at: Mapping[Way, Mapping[str, Any]] = field(default_factory=dict[Way, Mapping[str, Any]])
    pieces: Sequence[tuple[int, int]] = ()

    def as_written(self, links: bool, options: ExportOptions, report: Report) -> UnityScene | None:
        """What is in the file, where nothing is asked for that it was not made with; None where it is to be made anew.

        links: whether bodies are to be links.
        """
        has_links = any(isinstance(c, ArticulationBody) for o in self.written.gameObjects for c in o.components)
        anew = (
            options.ground is not Ground.BODY
            or options.closures is not Closures.EXACT
            or options.limits
            or options.reading.get("mates")
        )
        if anew:
            return None
        if options.solve:
            self._tell_unused("solve", report)
        for joint in () if has_links else self.joints:  # no joint of Unity's has a field for it, as where they are made anew
            with_passive_drives(joint, report)
        return self.written

    def in_its_order(self, analysed: Scene) -> Scene:
        """The analysed scene with the joints in the order in which the analysis of the source had them."""
        place = {joint.id: i for i, joint in enumerate(self.joints)}
        return replace(analysed, joints=sorted(analysed.joints, key=lambda joint: place.get(joint.id, len(place))))

    def tell_unused(self, options: ExportOptions, report: Report) -> None:
        """What is asked of geometry and masses, which a written scene states."""
        usual = ExportOptions()
        for name in ("colliders", "density", "smooth"):
            if getattr(options, name) != getattr(usual, name):
                self._tell_unused(name, report)

    def _tell_unused(self, name: str, report: Report) -> None:
        report.add("SOURCE_OPTION_UNUSED", self.path, option=name, format="a written scene")


def read(path: Path, report: Report, request: object) -> WrittenScene:
    """A ``NAME.kinefab`` with its buffer.  The report gets what its first export told, and what of it has no place here.

    Raises KinefabError where the file or its buffer cannot be read.
    """
    try:
        document, buffers = read_scene(path)
        with unsound_as_finding(path):
            scene = unity_scene(document, buffers, report)
            made = _Nodes(document, scene).scene()
    except KinefabError as error:  # of those who know no report; it is what is told of the file
        report.diagnostics.extend(error.diagnostics)
        raise
    made.path, made.extras_at = path.name, dict(extras_in(document))
    for entry in document.get("report", ()):
        report.outcomes.append(_outcome(entry))
    return made


def _outcome(entry: Mapping[str, Any]) -> FeatureOutcome:
    return FeatureOutcome(
        str(entry["feature"]),
        Outcome(entry["outcome"]),
        str(entry.get("code", "")),
        Severity(entry.get("severity", "info")),
        str(entry.get("message", "")),
        str(entry.get("source", "")),
    )


class _Nodes:
    """Objects as nodes, but for the one that stands for the ground and those that only give a mesh, a collider or a name a place."""

    def __init__(self, document: Mapping[str, Any], scene: UnityScene):
        self.written, self.back = scene, restored(document)
        self.objects = scene.gameObjects
        self.children: list[list[int]] = [[] for _ in self.objects]
        for index, entry in enumerate(self.objects):
            if entry.parent is not None:
                self.children[entry.parent].append(index)
        self.surfaces = [_surface(material) for material in scene.materials]
        self.meshes = list(map(unmapped_mesh, scene.meshes))
        self.drawn = {c.mesh for entry in self.objects for c in entry.components if isinstance(c, MeshFilter)}
        self.ground = next((i for i, entry in enumerate(self.objects) if entry.role == "ground" or entry.id == GROUND_ID), None)
        self.placed: dict[int, str] = {}
        for index in range(len(self.objects) - 1, -1, -1):  # children, which stand behind their parent, before it
            if kind := self._place_of(index):
                self.placed[index] = kind
        self.light = led_bodies(scene)
        kept = [i for i in range(len(self.objects)) if i != self.ground and i not in self.placed and i not in self.light]
        self.node_of = {index: node for node, index in enumerate(kept)}
        self.bodies = [_body(entry.components) for entry in self.objects]
        self.moving = [
            body is not None and not self._is_held(i) and i not in self.light for i, body in enumerate(self.bodies)
        ]
        self.carried: list[bool] = []  # whether a body further up moves it
        for above in (entry.parent for entry in self.objects):
            self.carried.append(above is not None and above != self.ground and (self.bodies[above] is not None or self.carried[above]))
        self.above_moving = list(self.moving)
        for index in range(len(self.objects) - 1, -1, -1):
            parent = self.objects[index].parent
            if parent is not None and self.above_moving[index]:
                self.above_moving[parent] = True

    def scene(self) -> WrittenScene:
        written = self.written
        nodes = [self._node(index) for index in self.node_of]
        held = [self._is_held(index) for index in range(len(self.objects))]
        joints, couplings = WrittenJoints(self.objects, self.back, self.node_of, self.ground, held, self.light).named()
        extras = {key: value for key, value in written.extras.items() if key != "ignoreCollision"}
        source, physics = written.source, written.physics
        return WrittenScene(
            nodes=nodes,
            meshes=self.meshes,
            surfaces=self.surfaces,
            joints=joints,
            couplings=couplings,
            animations=self._clips(),
            source=Source(source.uri, source.upAxis, source.metersPerUnit, source.sha256, configuration=source.configuration),
            physics=Physics(
                _three(frames.direction(physics.gravity)),
                physics.fixedTimestep,
                physics.solverIterations,
                physics.solverVelocityIterations,
            ),
            extras=extras,
            apart=pairs_apart(written, self.node_of),
            colliding=pairs_colliding(written, self.node_of),
            written=written,
            pieces=self._pieces(nodes),
        )

    def _pieces(self, nodes: Sequence[Node]) -> list[tuple[int, int]]:
        place = {node.id: i for i, node in enumerate(nodes)}
        told = ((place.get(stated_piece(self.objects[index].extras)), node) for index, node in self.node_of.items())
        return [(first, node) for first, node in told if first is not None and nodes[first].grounded and nodes[node].grounded]

    def _place_of(self, index: int) -> str:
        """``body``, ``collider`` or ``site`` of an object that only gives one a place on the node above it, "" of any other."""
        entry = self.objects[index]
        if entry.parent is None or not entry.active or any(self.placed.get(i) != "collider" for i in self.children[index]):
            return ""
        if entry.role == "site":
            return "site"
        above = self.objects[entry.parent]
        kind = _kind_below(above, entry)
        if not kind and above.parent is not None and _kind_below(self.objects[above.parent], above) == "body":
            kind = _kind_below(self.objects[above.parent], entry)
        drawn = all(isinstance(c, (MeshFilter, MeshRenderer, Collider)) for c in entry.components)
        return kind if kind in ("body", "collider", "site") and drawn else ""

    def _is_held(self, index: int) -> bool:
        """Whether its own body stands: one that holds what stands, or the base of an articulation that is told to."""
        body = self.bodies[index]
        if isinstance(body, ArticulationBody):
            at = self.objects[index].parent
            while at is not None and not isinstance(self.bodies[at], ArticulationBody):
                at = self.objects[at].parent
            return body.immovable and at is None
        return body == HELD

    def _node(self, index: int) -> Node:
        entry, body = self.objects[index], self.bodies[index]
        inner = [i for i in self.children[index] if i in self.placed]
        inner += [k for i in inner for k in self.children[i]]
        bodies = [b for i in (index, *inner) for b in self._bodies(i, index)]
        shapes = [s for i in (index, *inner) for s in self._shapes(i, index)]
        choice = self._choice((index, *inner))
        stands = body is not None and self._is_held(index)
        held = stands or (body is None and not self.above_moving[index] and not self.carried[index])
        below = [i for i in self.children[index] if i in self.node_of]
        whole = self.moving[index] and bool(below) and not any(self.above_moving[i] for i in below)
        part = (bool(bodies or shapes or not below) or body is not None) and not whole
        mass = stated_mass(entry.extras) if held else None
        if body is not None and not stands:
            turn = frames.rotation(matrix_from_quaternion(np.array(body.inertiaTensorRotation)))
            inertia = turn @ np.diag(body.inertiaTensor) @ turn.T
            mass = MassProperties(body.mass, frames.point(body.centerOfMass), inertia)
        return Node(
            entry.id,
            entry.name,
            NodeKind.PART if part else NodeKind.ASSEMBLY,
            self._parent(entry),
            self.back.poses[index],
            entry.definition or None,
            bodies=tuple(bodies),
            mass=mass,
            grounded=held and part,
            flexible=not whole and not self.carried[index],
            suppressed=not entry.active,
            colliders=tuple(shapes) if choice is None else None,
            collision=choice,
            dynamics=Dynamics() if body is None or stands else _dynamics(body),
            sites=tuple(
                Site(self.objects[i].name, self.back.poses[index].inverse() @ self.back.poses[i])
                for i in inner
                if self.placed[i] == "site"
            ),
            layer=entry.layer,
            tag=entry.tag,
            extras=without_stated(entry.extras),
        )

    def _parent(self, entry: GameObject) -> int | None:
        return None if entry.parent is None else self.node_of.get(entry.parent)

    def _local(self, index: int, node: int) -> Pose:
        return self.back.poses[node].inverse() @ self.back.poses[index]

    def _bodies(self, index: int, node: int) -> list[Body]:
        entry = self.objects[index]
        components = entry.components
        renderer = next((c for c in components if isinstance(c, MeshRenderer)), None)
        scale = _three(self.back.scales[index])
        return [
            Body(
                entry.name if index != node else stated_body(entry.extras) or self.meshes[c.mesh].name,
                c.mesh,
                () if renderer is None else self._surfaces(renderer.materials),
                pose=self._local(index, node),
                scale=scale,
                visible=renderer is not None and renderer.enabled,
                weighed=False,
            )
            for c in components
            if isinstance(c, MeshFilter)
        ]

    def _surfaces(self, materials: tuple[int, ...]) -> tuple[int, ...]:
        """None where all are what a body gets of which nobody states any."""
        return () if all(self.surfaces[i] == PLAIN for i in materials) else materials

    def _shapes(self, index: int, node: int) -> list[Any]:
        place, scale = self._local(index, node), self.back.scales[index]
        materials = self.written.physicsMaterials
        return [
            shape_of(c, place, scale, materials)
            for c in self.objects[index].components
            if isinstance(c, Collider)
        ]

    def _choice(self, indices: Sequence[int]) -> ColliderShape | None:
        """Of the colliders on an object and on those that give its bodies and colliders a place, where nothing but a choice made them."""
        at = {i: [c for c in self.objects[i].components if isinstance(c, Collider)] for i in indices}
        shape, counted = choice_of([c for own in at.values() for c in own]), 0
        for holder in indices:
            for mesh in (c.mesh for c in self.objects[holder].components if isinstance(c, MeshFilter)):
                own = [(c, Pose()) for c in at[holder]]
                own += [(c, self._local(i, holder)) for i in self.children[holder] if self.placed.get(i) == "collider" for c in at[i]]
                counted += len(own)
                if shape is None or not still_chosen(shape, mesh, self.meshes[mesh], own, self.drawn):
                    return None
        return shape if counted == sum(map(len, at.values())) else None

    def _clips(self) -> list[AnimationClip]:
        return [
            AnimationClip(
                clip.name,
                np.array(clip.times, dtype=np.float64),
                tuple(
                    Track(
                        self.node_of[track.gameObject],
                        frames.point(track.localPosition) if track.localPosition else None,
                        frames.quaternion(track.localRotation) if track.localRotation else None,
                    )
                    for track in clip.tracks
                    if track.gameObject in self.node_of
                ),
                _REPEATS.get(clip.wrapMode, Repeat.ONCE),
            )
            for clip in self.written.animations
        ]


def _kind_below(above: GameObject, entry: GameObject) -> str:
    """The word behind the upper object's id in that of the lower one, "" where it does not begin with that id."""
    return entry.id.removeprefix(f"{above.id}/").partition(":")[0] if entry.id.startswith(f"{above.id}/") else ""


def _three(values: Any) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in values)
    return x, y, z


def _body(components: Sequence[object]) -> Rigidbody | ArticulationBody | None:
    return next((c for c in components if isinstance(c, (Rigidbody, ArticulationBody))), None)


def _dynamics(body: Rigidbody | ArticulationBody) -> Dynamics:
    """Damping as Unity has it by itself is none that anybody states."""
    usual = type(body)(mass=1.0)
    linear = None if body.linearDamping == usual.linearDamping else body.linearDamping
    angular = None if body.angularDamping == usual.angularDamping else body.angularDamping
    if isinstance(body, ArticulationBody):
        return Dynamics(False, body.useGravity, linear, angular)
    return Dynamics(body.isKinematic, body.useGravity, linear, angular, max_angular_velocity=body.maxAngularVelocity)


def _surface(material: Material) -> Surface:
    return Surface(
        material.name,
        material.color,
        material.metallic,
        material.smoothness,
        material.alphaMode,
        material.alphaCutoff,
        material.doubleSided,
        material.emission,
        material.colorTexture,
        material.normalTexture,
        material.metallicRoughnessTexture,
        material.occlusionTexture,
        material.emissionTexture,
    )
