"""What Unity makes of a joint component, written a second time and apart from the exporter.

Follows PhysX 4.1's D6 joint and Unity's reading of it (schemas/SPEC.md, section 4): the joint frame from axis
and secondaryAxis, the connected frame frozen at start-up, c = "actor1 in actor0".  Numbers are Unity's own
(left-handed, evaluated component by component).  A pose is a pair (rotation matrix, translation).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

IDENTITY = (np.eye(3), np.zeros(3))
M = np.diag([-1.0, 1.0, 1.0])
LINEAR = ("xMotion", "yMotion", "zMotion")
ANGULAR = ("angularXMotion", "angularYMotion", "angularZMotion")


def mirrored(pose):
    """A right-handed pose in Unity's frame, or back."""
    return M @ pose[0] @ M, M @ pose[1]


def compose(outer, inner):
    return outer[0] @ inner[0], outer[0] @ inner[1] + outer[1]


def inverse(pose):
    return pose[0].T, -pose[0].T @ pose[1]


def turn(axis: int, angle: float) -> np.ndarray:
    """Rotation matrix about a coordinate axis; the same numbers in either handedness."""
    c, s = math.cos(angle), math.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def joint_axes(component) -> np.ndarray:
    """J: x = axis, y = secondaryAxis less its part along x, z = x cross y, in the own body."""
    x = np.array(component.get("axis", (1, 0, 0)), dtype=float)
    x /= np.linalg.norm(x)
    second = np.array(component.get("secondaryAxis", (0, 1, 0)), dtype=float)
    y = second - x * (x @ second)
    if np.linalg.norm(y) < 1e-9:  # only a hinge may come here, where y does not matter
        y = np.cross(x, np.eye(3)[np.argmin(np.abs(x))])
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])


@dataclass
class Live:
    """A component after start-up.  own0, connected0: the bodies' poses then (the world: identity)."""

    component: dict
    own0: tuple
    connected0: tuple = IDENTITY

    def __post_init__(self):
        axes = joint_axes(self.component)
        self.own_frame = (axes, np.array(self.component.get("anchor", (0, 0, 0)), dtype=float))
        world = self.own0[0] @ axes
        assert self.component["autoConfigureConnectedAnchor"] is False
        anchor = np.array(self.component.get("connectedAnchor", (0, 0, 0)), dtype=float)
        self.connected_frame = (self.connected0[0].T @ world, anchor)

    def c(self, own, connected=IDENTITY):
        """PhysX's actor1 in actor0."""
        own = compose(own, self.own_frame)
        connected = compose(connected, self.connected_frame)
        if self.component.get("swapBodies", False):
            return compose(inverse(connected), own)
        return compose(inverse(own), connected)

    def own_pose(self, c, connected=IDENTITY):
        """Where the own body is for a given c."""
        swap = self.component.get("swapBodies", False)
        frame = compose(compose(connected, self.connected_frame), c if swap else inverse(c))
        return compose(frame, inverse(self.own_frame))

    def motion(self, name: str) -> str:
        return self.component.get(name, "Free")

    def unlocked(self, names) -> list[int]:
        return [i for i, name in enumerate(names) if self.motion(name) != "Locked"]

    def violation(self, own, connected=IDENTITY) -> float:
        """By how much the pose breaks the component: metres or radians, the largest of all rows."""
        if self.component["type"] == "HingeJoint":
            return self._hinge_violation(own, connected)
        r, d = self.c(own, connected)
        rows = [abs(d[i]) for i in range(3) if self.motion(LINEAR[i]) == "Locked"]
        limited = [i for i in range(3) if self.motion(LINEAR[i]) == "Limited"]
        if limited:
            rows.append(np.linalg.norm(d[limited]) - self.limit("linearLimit"))
        return max([0.0, *rows, *self._angular_rows(r)])

    def limit(self, name: str) -> float:
        return self.component.get(name, {}).get("limit", 0.0)

    def _angular_rows(self, r) -> list[float]:
        """PhysX: all locked, two locked, one swing locked (Cardan) or only the twist locked (homokinetic)."""
        free = self.unlocked(ANGULAR)
        if not free:
            rows = [np.linalg.norm(r - np.eye(3))]
        elif len(free) == 1:
            axis = np.eye(3)[free[0]]
            rows = [np.linalg.norm(r @ axis - axis)]
        elif free == [0, 2]:
            rows = [abs(r[2, 0])]  # b's X stays across a's Z
        elif free == [0, 1]:
            rows = [abs(r[1, 0])]
        elif free == [1, 2]:
            rows = [abs(twist(r))]
        else:
            rows = []
        if self.motion("angularXMotion") == "Limited":
            t = math.degrees(twist(r))
            low, high = self.limit("lowAngularXLimit"), self.limit("highAngularXLimit")
            rows.append(math.radians(max(low - t, t - high)))
        swings = [i for i in (1, 2) if self.motion(ANGULAR[i]) == "Limited"]
        swing = rotation_vector(r @ turn(0, -twist(r)))
        limits = {i: math.radians(self.limit("angularYLimit" if i == 1 else "angularZLimit")) for i in swings}
        if len(swings) == 1 and len([i for i in free if i != 0]) == 1:
            rows.append(abs(swing[swings[0]]) - limits[swings[0]])
        elif len(swings) == 2:  # elliptic cone
            rows.append(math.hypot(swing[1] / limits[1], swing[2] / limits[2]) - 1.0)
        return rows

    def hinge_angle(self, own, connected=IDENTITY) -> float:
        """HingeJoint.angle, degrees: own against connected."""
        return -math.degrees(twist(self.c(own, connected)[0]))

    def _hinge_violation(self, own, connected) -> float:
        r, d = self.c(own, connected)
        rows = [0.0, float(np.linalg.norm(d)), float(np.linalg.norm(r[:, 0] - np.eye(3)[0]))]
        if self.component.get("useLimits", False):
            angle, limits = self.hinge_angle(own, connected), self.component.get("limits", {})
            rows.append(math.radians(max(limits.get("min", 0) - angle, angle - limits.get("max", 0))))
        return max(rows)


def twist(r) -> float:
    """Angle about X of the swing-twist split, radians, within half a turn."""
    w, x = quaternion(r)[3], quaternion(r)[0]
    angle = 2.0 * math.atan2(x, w)
    return angle - 2.0 * math.pi * round(angle / (2.0 * math.pi))


def quaternion(r) -> np.ndarray:
    """(x, y, z, w) of a rotation matrix by its eigenvector: slow and unlike the exporter's way."""
    k = np.array(
        [
            [r[0, 0] - r[1, 1] - r[2, 2], r[0, 1] + r[1, 0], r[0, 2] + r[2, 0], r[2, 1] - r[1, 2]],
            [r[0, 1] + r[1, 0], r[1, 1] - r[0, 0] - r[2, 2], r[1, 2] + r[2, 1], r[0, 2] - r[2, 0]],
            [r[0, 2] + r[2, 0], r[1, 2] + r[2, 1], r[2, 2] - r[0, 0] - r[1, 1], r[1, 0] - r[0, 1]],
            [r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1], r[0, 0] + r[1, 1] + r[2, 2]],
        ]
    )
    values, vectors = np.linalg.eigh(k)
    return vectors[:, -1] * (1.0 if vectors[3, -1] >= 0.0 else -1.0)


def rotation_vector(r) -> np.ndarray:
    q = quaternion(r)
    size = np.linalg.norm(q[:3])
    return np.zeros(3) if size < 1e-15 else q[:3] * (2.0 * math.atan2(size, q[3]) / size)


def matrix(q) -> np.ndarray:
    """Rotation matrix of a quaternion, by rotating the unit vectors: v + 2 u x (u x v + w v)."""
    u, w = np.array(q[:3], dtype=float), q[3]
    return np.column_stack([v + 2.0 * np.cross(u, np.cross(u, v) + w * v) for v in np.eye(3)])
