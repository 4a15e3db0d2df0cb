"""Two parts with a joint between them, exported: what the joint tests build on."""

from __future__ import annotations

import math

import numpy as np
from kinefab.diagnostics import Report
from kinefab.model import UNLOCKED, Freedom, Joint, JointKind, Motion, Node, Scene, freedoms_of
from kinefab.rigid import rigid_groups
from kinefab.spatial import Pose, matrix_from_quaternion
from kinefab.unity.joints.mapping import map_joint
from unity_entries import entry_of
from unity_semantics import Live, mirrored, turn

NAMES = ("tx", "ty", "tz", "rx", "ry", "rz")
KINDS = [kind for kind in JointKind if kind not in (JointKind.FREE, JointKind.GENERAL, JointKind.FIXED)]
DRIVEN = [(kind, i) for kind in KINDS if kind is not JointKind.REVOLUTE for i in UNLOCKED[kind]]
GROUNDING = ("none", "a", "b", "world")


def random_pose(rng, spread=0.5) -> Pose:
    return Pose(matrix_from_quaternion(rng.normal(size=4)), rng.uniform(-spread, spread, 3))


def relative(kind_rotations, q) -> Pose:
    """b's joint frame in a's at coordinates q, as model.Joint defines them."""
    if kind_rotations == (0, 2):
        r = turn(2, q[5]) @ turn(0, q[3])
    elif kind_rotations == (0, 1):
        r = turn(1, q[4]) @ turn(0, q[3])
    elif kind_rotations == (1, 2):
        r = turn(2, q[5]) @ turn(1, q[4])
    else:
        r = turn(2, q[5]) @ turn(1, q[4]) @ turn(0, q[3])
    return Pose(r, np.array(q[:3]))


class Case:
    """Two parts in random places with a joint between them at coordinates q0, exported."""

    def __init__(
        self, seed, kind, q0=np.zeros(6), grounding="none", unlocked=None, lead=0.0, slerp=None, **freedoms
    ):
        rng = np.random.default_rng(seed)
        self.rng = rng
        frame_a, frame_b = random_pose(rng), random_pose(rng)
        a, pose_a = (None, Pose()) if grounding == "world" else (0, random_pose(rng, 2.0))
        six = freedoms_of(kind, **freedoms)
        self.rotations = tuple(i for i in range(3) if six[3 + i].motion is not Motion.LOCKED)
        self.free = [i for i in range(6) if six[i].motion is not Motion.LOCKED]
        self.q0 = np.where([i in self.free for i in range(6)], q0, 0.0)
        pose_b = pose_a @ frame_a @ relative(self.rotations, self.q0) @ frame_b.inverse()
        nodes = [
            Node("A", "A", pose=pose_a, grounded=grounding == "a"),
            Node("B", "B", pose=pose_b, grounded=grounding == "b"),
        ]
        self.scene = Scene(nodes=nodes)
        self.joint = Joint("J", kind, a, 1, frame_a, frame_b, six, lead=lead, slerp=slerp)
        self.scene.joints.append(self.joint)
        self.report = Report()
        mapped = map_joint(self.joint, self.scene, rigid_groups(self.scene), lambda node: node, self.report)
        assert mapped is not None, self.report
        self.mapped, self.component = mapped, entry_of(mapped.component)
        start = self.unity_poses(pose_a, pose_b)
        if self.component["type"] != "FixedJoint":
            self.live = Live(self.component, *start)

    def unity_poses(self, pose_a: Pose, pose_b: Pose):
        """(own, connected) in Unity's frame; the world where the side is ground."""
        a, b = (mirrored((p.rotation, p.translation)) for p in (pose_a, pose_b))
        own, other = (a, b) if self.mapped.owner == 0 else (b, a)
        return own, (np.eye(3), np.zeros(3)) if self.mapped.connected is None else other

    def poses_at(self, q):
        """Poses of a and b at coordinates q; the grounded one stays, else the pair also moves as a whole."""
        return self.poses_apart(relative(self.rotations, q))

    def poses_apart(self, between_frames: Pose):
        """The same where b's joint frame stands so in a's."""
        joint, nodes = self.joint, self.scene.nodes
        inner = joint.frame_a @ between_frames @ joint.frame_b.inverse()
        if joint.a is None:
            return Pose(), inner
        if nodes[0].grounded:
            return nodes[0].pose, nodes[0].pose @ inner
        if nodes[1].grounded:
            return nodes[1].pose @ inner.inverse(), nodes[1].pose
        pose_a = random_pose(self.rng, 2.0)
        return pose_a, pose_a @ inner

    def violation_at(self, q) -> float:
        return self.live.violation(*self.unity_poses(*self.poses_at(q)))

    def random_q(self, low=-0.7, high=0.7):
        q = np.zeros(6)
        q[self.free] = self.rng.uniform(low, high, len(self.free))
        return q


def turned(degrees: float) -> np.ndarray:
    return np.array([0, 0, 0, math.radians(degrees), 0, 0])


def between(low: float, high: float) -> Freedom:
    return Freedom(Motion.LIMITED, math.radians(low), math.radians(high))
