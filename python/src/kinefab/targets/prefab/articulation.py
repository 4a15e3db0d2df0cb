"""A scene whose bodies are ArticulationBodies: the tree of its joints becomes the tree of its objects.

Unity holds a link to the nearest ArticulationBody above it, so bodies move below the ones they are joined to; what closes
a loop stays a joint, on a helper body that is fixed to one of the two links.
"""

from __future__ import annotations

import math
from collections import defaultdict, deque
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from ...diagnostics import Report
from ...model import Joint as ModelJoint
from ...spatial import Pose, matrix_from_quaternion, quaternion_from_matrix
from ...unity.scene import (
    ArticulationBody,
    ArticulationDrive,
    Component,
    ConfigurableJoint,
    FixedJoint,
    GameObject,
    HingeJoint,
    Joint,
    JointDrive,
    Rigidbody,
    Transform,
    UnityScene,
    Vector3,
)
from ...unity.scene.joints.joint import AnchoredJoint
from ...unity.scene.vectors import quaternion4, vector3

GROUND_ID = "kinefab:articulation ground"
MOTOR_DAMPING = 1e7
"""N m s/rad of the drive that stands for a motor: its force is then the motor's largest."""
HELPER_MASS = 0.05
"""Of the link that a helper body is fixed to."""

Edge = tuple[int, int]
"""A joint: its object, and its place among the object's components."""


class NotArticulated(Exception):
    """Why a joint cannot be one of an articulation."""


def articulated(scene: UnityScene, joints: Mapping[str, ModelJoint], report: Report) -> UnityScene:
    """The scene with links for Rigidbodies.  joints: of the model, by id.  The report gets an error for each joint that no
    articulation has."""
    return _Articulation(scene, joints, report).scene_of_links()


@dataclass(slots=True, eq=False)
class _Articulation:
    scene: UnityScene
    joints: Mapping[str, ModelJoint]
    report: Report
    objects: list[GameObject] = field(default_factory=list[GameObject])
    poses: list[Pose] = field(default_factory=list[Pose])
    bodies: dict[int, Rigidbody] = field(default_factory=dict[int, Rigidbody])
    ground: int | None = None

    def scene_of_links(self) -> UnityScene:
        self._read()
        parents, closing = self._tree()
        links = {child: self._link(child, parent, edge) for child, (parent, edge) in parents.items()}
        used = {edge for _, edge in parents.values() if edge is not None} | set(closing)
        for index, link in links.items():
            self._replace(
                index,
                [c for k, c in enumerate(self.objects[index].components) if (index, k) not in used],
                link,
            )
            self._move_below(index, parents[index][0])
        for edge in closing:
            self._close(edge, links)
        return replace(self.scene, gameObjects=tuple(self.objects), couplings=())

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
        self.ground = next(
            (i for i, b in self.bodies.items() if b.isKinematic and self.objects[i].parent is None), None
        )
        edges = [
            (i, k)
            for i in self.bodies
            for k, c in enumerate(self.objects[i].components)
            if isinstance(c, Joint)
        ]
        if self.ground is None and any(self._joint(edge).connectedBody is None for edge in edges):
            self.objects.append(GameObject(GROUND_ID, "Ground"))
            self.poses.append(Pose())
            self.ground = len(self.objects) - 1
            self.bodies[self.ground] = Rigidbody(isKinematic=True, useGravity=False)

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

        From the ground outwards, by joints that close no loop as the analysis has it; the rest of what is reached is closing.
        """
        edges = [
            (i, k)
            for i in sorted(self.bodies)
            for k, c in enumerate(self.objects[i].components)
            if isinstance(c, Joint)
        ]
        at: dict[int, list[Edge]] = defaultdict(list)
        for edge in sorted(edges, key=lambda e: (self._joint(e).closure, e)):
            at[edge[0]].append(edge)
            at[self._other(edge)].append(edge)
        found: dict[int, tuple[int | None, Edge | None]] = {}
        roots = ([] if self.ground is None else [self.ground]) + sorted(self.bodies)
        for root in roots:
            if root in found or not at[root]:
                continue
            found[root] = (None, None)
            waiting = deque([root])
            while waiting:
                body = waiting.popleft()
                for edge in at[body]:
                    other = edge[0] if edge[0] != body else self._other(edge)
                    if other not in found:
                        found[other] = (body, edge)
                        waiting.append(other)
        inner = {edge for _, edge in found.values()}
        return found, [edge for edge in edges if edge not in inner]

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
            moving = self._moving(joint)
        except NotArticulated as reason:
            told = {"joint": joint.id or self.objects[edge[0]].id, "detail": str(reason)}
            self.report.dropped(f"joint {told['joint']}", "ARTICULATION_IMPOSSIBLE", **told)
            return link
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
            "anchorRotation": quaternion4(quaternion_from_matrix(inner.rotation)),
            "parentAnchorPosition": vector3(outer.translation),
            "parentAnchorRotation": quaternion4(quaternion_from_matrix(outer.rotation)),
        }

    def _moving(self, joint: Joint) -> dict[str, object]:
        """What the link may do.  Raises NotArticulated."""
        if math.isfinite(joint.breakForce) or math.isfinite(joint.breakTorque):
            raise NotArticulated("it can break")
        friction = {"jointFriction": self._friction(joint)}
        if isinstance(joint, FixedJoint):
            return {"jointType": "Fixed"}
        if isinstance(joint, HingeJoint):
            lock = "Limited" if joint.useLimits else "Free"
            return {"jointType": "Revolute", "twistLock": lock, "xDrive": _hinge_drive(joint), **friction}
        assert isinstance(joint, ConfigurableJoint)
        linear = (joint.xMotion, joint.yMotion, joint.zMotion)
        angular = (joint.angularXMotion, joint.angularYMotion, joint.angularZMotion)
        if linear == angular == ("Locked",) * 3:
            return {"jointType": "Fixed"}
        if angular == ("Locked",) * 3 and linear[1:] == ("Locked",) * 2:
            drive = self._slide_drive(joint)
            return {"jointType": "Prismatic", "linearLock": linear[0], "xDrive": drive, **friction}
        if linear == ("Locked",) * 3:
            return {**_turning(joint, angular), **friction}
        raise NotArticulated("an articulation has revolute, prismatic, spherical and fixed joints only")

    def _friction(self, joint: Joint) -> float:
        stated = self.joints.get(joint.id)
        passive = [f.passive.friction for f in stated.freedoms if f.passive is not None] if stated else []
        return max(passive, default=0.0)

    def _slide_drive(self, joint: ConfigurableJoint) -> ArticulationDrive:
        """Counted from the exported pose: the component counts from where its anchors meet."""
        own = next(i for i, o in enumerate(self.objects) if any(c is joint for c in o.components))
        other = self.poses[self._other((own, self._place(own, joint)))]
        apart = self.poses[own].point(np.array(joint.anchor)) - other.point(np.array(joint.connectedAnchor))
        start = float(apart @ (self.poses[own].rotation @ np.array(joint.axis)))
        sense = 1.0 if joint.swapBodies else -1.0
        reach = joint.linearLimit.limit if joint.xMotion == "Limited" else 0.0
        limits = (-reach - start, reach - start) if joint.xMotion == "Limited" else (0.0, 0.0)
        driven = _driven(
            joint.xDrive, sense * joint.targetPosition[0] - start, sense * joint.targetVelocity[0]
        )
        return replace(driven, lowerLimit=limits[0], upperLimit=limits[1])

    def _place(self, own: int, joint: Joint) -> int:
        return next(k for k, c in enumerate(self.objects[own].components) if c is joint)

    def _replace(self, index: int, components: list[Component], link: ArticulationBody) -> None:
        kept = [link if isinstance(c, Rigidbody) else c for c in components]
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
        self.objects.append(
            GameObject(
                f"kinefab:helper {joint.id or own.id}",
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
    return Transform(vector3(pose.translation), quaternion4(quaternion_from_matrix(pose.rotation)))


def _across(axis: Vector3) -> Vector3:
    """Some direction at right angles to an axis."""
    smallest = min(range(3), key=lambda i: abs(axis[i]))
    x, y, z = (float(v) for v in np.cross(axis, np.eye(3)[smallest]))
    return (x, y, z)


def _hinge_drive(joint: HingeJoint) -> ArticulationDrive:
    limits = (joint.limits.min, joint.limits.max) if joint.useLimits else (0.0, 0.0)
    if joint.useMotor:
        motor = joint.motor
        return ArticulationDrive(*limits, 0.0, MOTOR_DAMPING, motor.force, 0.0, motor.targetVelocity)
    if joint.useSpring:
        spring = joint.spring
        return ArticulationDrive(*limits, spring.spring, spring.damper, target=spring.targetPosition)
    return ArticulationDrive(*limits)


def _driven(drive: JointDrive, target: float, velocity: float) -> ArticulationDrive:
    gains = (drive.positionSpring, drive.positionDamper, drive.maximumForce)
    return ArticulationDrive(0.0, 0.0, *gains, target if drive.positionSpring else 0.0, velocity)


def _turning(joint: ConfigurableJoint, angular: tuple[str, str, str]) -> dict[str, object]:
    """A ConfigurableJoint limits and drives the connected body's twist, unless the bodies are swapped; a link turns itself."""
    sense = 1.0 if joint.swapBodies else -1.0
    low, high = sorted((sense * joint.lowAngularXLimit.limit, sense * joint.highAngularXLimit.limit))
    slerp = joint.rotationDriveMode == "Slerp"
    x, y, z, w = joint.targetRotation
    about_x = not (slerp or y or z or joint.targetAngularVelocity[1] or joint.targetAngularVelocity[2])
    if not about_x and (joint.targetRotation != (0.0, 0.0, 0.0, 1.0) or any(joint.targetAngularVelocity)):
        raise NotArticulated("its drive turns about several axes to a target")
    target = sense * math.degrees(2.0 * math.atan2(x, w))
    velocity = -sense * math.degrees(joint.targetAngularVelocity[0])
    twist = _driven(joint.slerpDrive if slerp else joint.angularXDrive, target, velocity)
    found: dict[str, object] = {
        "twistLock": angular[0],
        "xDrive": replace(twist, lowerLimit=low, upperLimit=high),
    }
    if angular[1:] == ("Locked", "Locked"):
        return {"jointType": "Revolute", **found}
    swing = _driven(joint.slerpDrive if slerp else joint.angularYZDrive, 0.0, 0.0)
    reach_y, reach_z = joint.angularYLimit.limit, joint.angularZLimit.limit
    return {
        "jointType": "Spherical",
        **found,
        "swingYLock": angular[1],
        "swingZLock": angular[2],
        "yDrive": replace(swing, lowerLimit=-reach_y, upperLimit=reach_y),
        "zDrive": replace(swing, lowerLimit=-reach_z, upperLimit=reach_z),
    }
