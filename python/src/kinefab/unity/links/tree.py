"""A scene whose bodies are ArticulationBodies: the tree of its joints becomes the tree of its objects.

Unity holds a link to the nearest ArticulationBody above it, so bodies move below the ones they are joined to; what closes
a loop stays a joint, on a helper body that is fixed to one of the two links.
"""

from __future__ import annotations

from collections import Counter, defaultdict, deque
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ...diagnostics import Report
from ...model import Joint as ModelJoint
from ...model import FreeIds, Scene
from ...rigid import RigidGroups
from ...spatial import Pose, matrix_from_quaternion, quaternion_from_matrix
from ..contact.overlaps import check_overlaps
from ..mapping import GROUND_ID
from ..scene import (
    AnimationClip,
    ArticulationBody,
    Component,
    ConfigurableJoint,
    Coupling,
    FixedJoint,
    GameObject,
    Joint,
    JointCoordinate,
    Rigidbody,
    Transform,
    UnityScene,
    Vector3,
)
from ..scene.joints.joint import AnchoredJoint
from ..scene.vectors import Quaternion, quaternion4, vector3
from .bounds import bounded
from .convex import with_convex_colliders
from .motions import (
    ARTICULATION,
    NotArticulated,
    counts_as_link,
    link_motion,
    swung,
    tell_link_losses,
    twist_range,
)
from .order import with_parents_first

ARTICULATION_GROUND_ID = "kinefab:articulation ground"
"""Of the root that stands for the world where no object does."""
ALIKE = 1e-6
"""Below it a component of a direction or a rotation may be one of rounding, which decides nothing."""
HELPER_MASS = 0.05
"""Of the link that a helper body is fixed to."""

MOST_LINKS = 64
"""Of one articulation: DY_ARTICULATION_MAX_SIZE of PhysX 4.1, whose arrays have that size."""

Edge = tuple[int, int]
"""A joint: its object, and its place among the object's components."""


def articulated(scene: UnityScene, model: Scene, groups: RigidGroups, report: Report) -> UnityScene:
    """The scene with links for Rigidbodies, or as it is where it has links; its couplings are those of the links' coordinates.
    model: what the scene was made of, or was read as.  The report gets an error for each joint that no articulation has."""
    if any(isinstance(c, ArticulationBody) for entry in scene.gameObjects for c in entry.components):
        return scene
    made = _Articulation(scene, model, groups, report).scene_of_links()
    check_overlaps(made, report)  # a joint that is a link now, or on a helper body, keeps other pairs from colliding
    return made


@dataclass(slots=True, eq=False)
class _Articulation:
    scene: UnityScene
    model: Scene
    groups: RigidGroups
    report: Report
    joints: dict[str, ModelJoint] = field(default_factory=dict[str, ModelJoint])
    objects: list[GameObject] = field(default_factory=list[GameObject])
    poses: list[Pose] = field(default_factory=list[Pose])
    bodies: dict[int, Rigidbody] = field(default_factory=dict[int, Rigidbody])
    edges: list[Edge] = field(default_factory=list[Edge])
    ground: int | None = None
    moved: dict[Edge, Edge] = field(default_factory=dict[Edge, Edge])
    """Of each joint the component that holds it now."""
    free_ids: FreeIds = field(default_factory=FreeIds)
    """Ids of objects."""

    def scene_of_links(self) -> UnityScene:
        self.joints = {joint.id: joint for joint in self.model.joints}
        self._read()
        parents, closing = self._tree()
        self._tell_size({child: parent for child, (parent, _) in parents.items()})
        self.scene = replace(self.scene, gameObjects=tuple(self.objects))
        self.scene = with_convex_colliders(self.scene, parents.keys(), self.model, self.groups, self.report)
        self.objects = list(self.scene.gameObjects)
        links = {child: self._link(child, parent, edge) for child, (parent, edge) in parents.items()}
        gone = {*self.edges, *self._apart()}
        for index, entry in enumerate(self.objects):
            kept = tuple(c for k, c in enumerate(entry.components) if (index, k) not in gone)
            self.objects[index] = replace(entry, components=kept)
        for index, link in links.items():
            self._replace(index, link)
            self._move_below(index, parents[index][0])
            if (inner := parents[index][1]) is not None:
                kinds = [isinstance(c, ArticulationBody) for c in self.objects[index].components]
                self.moved[inner] = (index, kinds.index(True))
        self.free_ids = FreeIds(entry.id for entry in self.objects)
        for edge in closing:
            self._close(edge, links)
        animations = self._clips(links.keys())
        couplings = tuple(self._coupling(coupling) for coupling in self.scene.couplings)
        made = replace(
            self.scene, gameObjects=tuple(self.objects), couplings=couplings, animations=animations
        )
        return with_parents_first(made)

    def _coupling(self, coupling: Coupling) -> Coupling:
        """Between the same motions: a link's coordinates count as those of the joint that it stands for."""
        terms = tuple(replace(term, coordinate=self._coordinate(term.coordinate)) for term in coupling.terms)
        return replace(coupling, coordinate=self._coordinate(coupling.coordinate), terms=terms)

    def _coordinate(self, at: JointCoordinate) -> JointCoordinate:
        found = self.moved.get((at.gameObject, at.component))
        if found is None:
            return at
        held = self.objects[found[0]].components[found[1]]
        turned = isinstance(held, ArticulationBody) and at.coordinate == "angle"
        return JointCoordinate(found[0], found[1], "angularX" if turned else at.coordinate)

    def _clips(self, links: Collection[int]) -> tuple[AnimationClip, ...]:
        """Without what moves links: no Transform moves them, and they stand below other objects now."""
        found: list[AnimationClip] = []
        for clip in self.scene.animations:
            tracks = tuple(track for track in clip.tracks if track.gameObject not in links)
            for track in clip.tracks:
                if track.gameObject in links:
                    owner = self.objects[track.gameObject].id
                    told = {"field": "an animation of a link", "target": ARTICULATION}
                    self.report.dropped(f"clip {clip.name} of {owner}", "TARGET_FIELD_DROPPED", **told)
            if tracks:
                found.append(replace(clip, tracks=tracks))
        return tuple(found)

    def _read(self) -> None:
        self.objects = list(self.scene.gameObjects)
        for entry in self.objects:
            local = Pose(
                matrix_from_quaternion(np.array(entry.transform.localRotation)),
                np.array(entry.transform.localPosition),
            )
            self.poses.append(local if entry.parent is None else self.poses[entry.parent] @ local)
        for i, entry in enumerate(self.objects):
            for body in (c for c in entry.components if isinstance(c, Rigidbody)):
                self.bodies[i] = body
        self.ground = next((i for i, entry in enumerate(self.objects) if entry.id == GROUND_ID), None)
        self.edges = [
            (i, k)
            for i in self.bodies
            for k, c in enumerate(self.objects[i].components)
            if isinstance(c, Joint) and not (isinstance(c, ConfigurableJoint) and c.keeps_apart)
        ]
        if self.ground is None and any(self._joint(edge).connectedBody is None for edge in self.edges):
            self.objects.append(GameObject(ARTICULATION_GROUND_ID, "Ground"))
            self.poses.append(Pose())
            self.ground = len(self.objects) - 1
            self.bodies[self.ground] = Rigidbody(isKinematic=True, useGravity=False)

    def _apart(self) -> list[Edge]:
        """Joints that only keep bodies from colliding: between links they would hold helper bodies apart, not the links."""
        found: list[Edge] = []
        for i, entry in enumerate(self.objects):
            for k, c in enumerate(entry.components):
                if isinstance(c, ConfigurableJoint) and c.keeps_apart:
                    told = {"field": "what does not collide", "target": ARTICULATION}
                    self.report.dropped(f"pair {c.id.removeprefix('apart:')}", "TARGET_FIELD_DROPPED", **told)
                    found.append((i, k))
        return found

    def _joint(self, edge: Edge) -> Joint:
        joint = self.objects[edge[0]].components[edge[1]]
        assert isinstance(joint, Joint)
        return joint

    def _other(self, edge: Edge) -> int:
        connected = self._joint(edge).connectedBody
        found = self.ground if connected is None else connected
        assert found is not None
        return found

    def _tree(self) -> tuple[dict[int, tuple[int | None, Edge | None]], list[Edge]]:
        """Of each link the one above it and the joint between them, roots first; and the joints that close loops.

        From the ground outwards, then from what else stands or scripts move, by joints that close no loop as the analysis has it; the
        rest of what is reached is closing.
        """
        at: dict[int, list[Edge]] = defaultdict(list)
        for edge in sorted(self.edges, key=lambda e: (self._joint(e).closure, e)):
            at[edge[0]].append(edge)
            at[self._other(edge)].append(edge)
        found: dict[int, tuple[int | None, Edge | None]] = {}
        led_first = sorted(self.bodies, key=lambda i: (not self.bodies[i].isKinematic, i))
        roots = ([] if self.ground is None else [self.ground]) + led_first
        for root in roots:
            if root in found or not at[root]:
                continue
            found[root] = (None, None)
            waiting = deque([root])
            while waiting:
                body = waiting.popleft()
                for edge in at[body]:
                    other = edge[0] if edge[0] != body else self._other(edge)
                    if other not in found and not self.bodies[other].isKinematic:
                        found[other] = (body, edge)
                        waiting.append(other)
        inner = {edge for _, edge in found.values()}
        return found, [edge for edge in self.edges if edge not in inner]

    def _tell_size(self, above: Mapping[int, int | None]) -> None:
        """above: of each link the one above it, roots first."""
        roots: dict[int, int] = {}
        for link, parent in above.items():
            roots[link] = link if parent is None else roots[parent]
        for root, count in Counter(roots.values()).items():
            if count > MOST_LINKS:
                self.report.add("ARTICULATION_LINKS_MANY", object=self.objects[root].id, count=count)

    def _link(self, child: int, parent: int | None, edge: Edge | None) -> ArticulationBody:
        body = self.bodies[child]
        link = ArticulationBody(
            mass=body.mass,
            linearDamping=body.linearDamping,
            angularDamping=body.angularDamping,
            centerOfMass=body.centerOfMass,
            inertiaTensor=body.inertiaTensor,
            inertiaTensorRotation=body.inertiaTensorRotation,
            useGravity=body.useGravity,
            immovable=body.isKinematic,
            collisionDetectionMode=body.collisionDetectionMode,
        )
        if parent is None or edge is None:
            return link
        joint = self._joint(edge)
        try:
            if body.isKinematic:
                raise NotArticulated("its body is kinematic and not the root")
            moving = link_motion(joint, self._start(edge) if isinstance(joint, AnchoredJoint) else 0.0)
        except NotArticulated as reason:
            told = {"joint": joint.id or self.objects[edge[0]].id, "detail": str(reason)}
            self.report.dropped(f"joint {told['joint']}", "ARTICULATION_IMPOSSIBLE", **told)
            return link
        if moving["jointType"] == "Revolute" and twist_range(joint) is not None:
            self._tell_range(joint, "JOINT_LIMIT_BEYOND_TURN")
        if moving["jointType"] == "Spherical" and counts_as_link(joint, edge[0] == child):
            moving = swung(moving, joint, edge[0] == child)
            for code in ("JOINT_LIMIT_ASYMMETRIC", "JOINT_LIMIT_ELEVATION"):
                self._tell_range(joint, code)
        if moving["jointType"] != "Fixed" and (stated := self.joints.get(joint.id)) is not None:
            moving = bounded(moving, stated, self.report)
        named = {"name": joint.name} if joint.name else {}
        moving["because"], moving["extras"] = joint.because, {**named, **joint.extras}
        tell_link_losses(joint, body, self.objects[child].id, self.report)
        return replace(link, **moving, **self._anchors(joint, edge, child, parent))

    def _anchors(self, joint: Joint, edge: Edge, child: int, parent: int) -> dict[str, object]:
        """The joint's frame where the exported pose has it, seen from both; X so that the link's motion is the own body's."""
        own = self.poses[edge[0]]
        if isinstance(joint, AnchoredJoint):
            on_child = edge[0] == child
            point = (
                own.point(np.array(joint.anchor))
                if on_child
                else self.poses[child].point(np.array(joint.connectedAnchor))
            )
            x = own.rotation @ (np.array(joint.axis) if on_child else -np.array(joint.axis))
            second = np.array(
                joint.secondaryAxis if isinstance(joint, ConfigurableJoint) else _across(joint.axis)
            )
            z = np.cross(x, own.rotation @ second)
            z /= np.linalg.norm(z)
            world = Pose(np.column_stack([x, np.cross(z, x), z]), point)
        else:
            world = self.poses[child]
        inner, outer = self.poses[child].inverse() @ world, self.poses[parent].inverse() @ world
        return {
            "anchorPosition": vector3(inner.translation),
            "anchorRotation": _upright(inner),
            "parentAnchorPosition": vector3(outer.translation),
            "parentAnchorRotation": _upright(outer),
        }

    def _tell_range(self, joint: Joint, code: str) -> None:
        """A link holds the range that was told as lost, as no ConfigurableJoint does."""
        feature, stated = f"joint {joint.id}", self.joints.get(joint.id)
        self.report.withdraw(feature, code)
        if all(outcome.feature != feature for outcome in self.report.outcomes):
            self.report.kept(feature, "" if stated is None else stated.where)

    def _start(self, edge: Edge) -> float:
        """How far a slide stands out at the exported pose, where its anchors meet being zero."""
        own, joint = edge[0], self._joint(edge)
        assert isinstance(joint, AnchoredJoint)
        other = self.poses[self._other(edge)]
        apart = self.poses[own].point(np.array(joint.anchor)) - other.point(np.array(joint.connectedAnchor))
        return float(apart @ (self.poses[own].rotation @ np.array(joint.axis)))

    def _replace(self, index: int, link: ArticulationBody) -> None:
        kept: list[Component] = [link if isinstance(c, Rigidbody) else c for c in self.objects[index].components]
        if link not in kept:
            kept.append(link)
        self.objects[index] = replace(self.objects[index], components=tuple(kept))

    def _move_below(self, index: int, parent: int | None) -> None:
        """The same place in the world, below another object."""
        local = self.poses[index] if parent is None else self.poses[parent].inverse() @ self.poses[index]
        self.objects[index] = replace(self.objects[index], parent=parent, transform=_transform(local))

    def _close(self, edge: Edge, links: Mapping[int, ArticulationBody]) -> None:
        """The joint on a body of its own, which is fixed to the link that had it."""
        joint, own = self.scene.gameObjects[edge[0]].components[edge[1]], self.objects[edge[0]]
        assert isinstance(joint, Joint)
        link = links[edge[0]]
        share = tuple(HELPER_MASS * m for m in link.inertiaTensor)
        body = Rigidbody(
            mass=HELPER_MASS * link.mass,
            centerOfMass=link.centerOfMass,
            inertiaTensor=(share[0], share[1], share[2]),
            inertiaTensorRotation=link.inertiaTensorRotation,
            useGravity=False,
        )
        other = self._connected(joint)
        components = (
            body,
            FixedJoint(connectedBody=edge[0], id=f"{joint.id} helper"),
            replace(joint, connectedBody=other),
        )
        name = joint.id or own.name
        self.moved[edge] = (len(self.objects), len(components) - 1)
        self.objects.append(
            GameObject(
                self.free_ids.take(f"kinefab:helper {joint.id or own.id}"),
                f"{name} closure",
                None,
                transform=_transform(self.poses[edge[0]]),
                components=components,
            )
        )
        self.report.kept(
            f"joint {name}", "", "ARTICULATION_LOOP_HELPER", joint=name, object=f"{name} closure"
        )

    def _connected(self, joint: Joint) -> int | None:
        return self.ground if joint.connectedBody is None else joint.connectedBody


def _transform(pose: Pose) -> Transform:
    return Transform(vector3(pose.translation), _upright(pose))


def _upright(pose: Pose) -> Quaternion:
    """Its rotation with w not negative; about half a turn, where that hangs on rounding, with the first of x, y, z that is not 0 positive."""
    q = quaternion4(quaternion_from_matrix(pose.rotation))
    first = next((v for v in q if abs(v) > ALIKE), 1.0)
    if q[3] > ALIKE or first > 0.0:
        return q
    x, y, z, w = (-v for v in q)
    return (x, y, z, w)


def _across(axis: Vector3) -> Vector3:
    """Some direction at right angles to an axis, of equally good ones the first, whatever the axis was rounded to."""
    smallest = 0
    for i in (1, 2):
        smallest = i if abs(axis[i]) < abs(axis[smallest]) - ALIKE else smallest
    x, y, z = (float(v) for v in np.cross(axis, np.eye(3)[smallest]))
    return (x, y, z)
