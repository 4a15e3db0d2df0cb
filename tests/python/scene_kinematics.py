"""A small forward kinematics of Unity's joints, from a scene file alone.

    motion = SceneKinematics.load("arm.kinefab")
    elbow = motion.coordinate("elbow")                   # by the source's name of the joint (``because``)
    poses = motion.poses({elbow: 35.0})                  # degrees and metres, zero at the pose in the file
    motion.pose_of("arm/forearm", poses)                 # (rotation, translation) in Unity's world

Nothing of ``kinefab`` is used: the signs are those of ``schemas/SPEC.md``, section 4, written a second time.  Everything
is in Unity's frame, left-handed and evaluated component by component; a pose is a pair (rotation matrix of shape (3, 3),
translation of shape (3,)).  ``unity_pose`` and its neighbours take what an engine says of a right-handed source there.

A coordinate is one motion of the own body (which carries the component) against the connected one, by the left-hand rule
about, or along, the component's axis: ``angle`` of a HingeJoint, ``x`` ... ``angularZ`` of a ConfigurableJoint.  With two
rotations they are the Cardan angles of a universal joint, with three a rotation vector along the joint's axes.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

LINEAR = ("x", "y", "z")
ANGULAR = ("angularX", "angularY", "angularZ")
WORLD = (np.eye(3), np.zeros(3))
JOINTS = ("HingeJoint", "ConfigurableJoint", "FixedJoint")


class Coordinate(NamedTuple):
    """One motion of one component: indices of the GameObject and of its component, and the name in the format."""

    game_object: int
    component: int
    name: str

    @property
    def is_angle(self) -> bool:
        return self.name.startswith("ang")


# Poses ---------------------------------------------------------------------------------------------------------------


def compose(outer, inner):
    return outer[0] @ inner[0], outer[0] @ inner[1] + outer[1]


def inverse(pose):
    return pose[0].T, -pose[0].T @ pose[1]


def matrix_of(q) -> np.ndarray:
    """Rotation matrix of a quaternion (x, y, z, w)."""
    x, y, z, w = np.asarray(q, dtype=float) / np.linalg.norm(q)
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + 2.0 * (w * k + k @ k)


def about(axis, angle: float) -> np.ndarray:
    """Rotation matrix about a unit vector, radians."""
    x, y, z = axis
    k = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + math.sin(angle) * k + (1.0 - math.cos(angle)) * k @ k


def exp(w) -> np.ndarray:
    angle = float(np.linalg.norm(w))
    return about(np.asarray(w) / angle, angle) if angle else np.eye(3)


def angle_between(r, s) -> float:
    """Radians between two rotation matrices; exact for small angles too."""
    d = r.T @ s
    sine = 0.5 * math.hypot(d[2, 1] - d[1, 2], d[0, 2] - d[2, 0], d[1, 0] - d[0, 1])
    return math.atan2(sine, 0.5 * (np.trace(d) - 1.0))


def difference(pose, other) -> tuple[float, float]:
    """Metres and radians between two poses."""
    return float(np.linalg.norm(pose[1] - other[1])), angle_between(pose[0], other[0])


# Joints --------------------------------------------------------------------------------------------------------------


@dataclass(eq=False)
class SceneJoint:
    """A joint component after start-up: the joint's frame in its two bodies.

    own, connected: indices of GameObjects (connected None: the world).  own_frame, connected_frame: in these objects,
    unscaled.  start: c at the pose in the file; c is PhysX's "actor1 in actor0".
    """

    game_object: int
    index: int
    fields: Mapping[str, Any]
    connected: int | None
    own_frame: tuple
    connected_frame: tuple
    start: tuple = WORLD

    @property
    def kind(self) -> str:
        return self.fields["type"]

    @property
    def closure(self) -> bool:
        return bool(self.fields.get("closure", False))

    @property
    def sense(self) -> float:
        """Of a coordinate of the own body in c, which is the connected body seen from the own one unless swapped."""
        return 1.0 if self.fields.get("swapBodies", False) else -1.0

    def motion(self, name: str) -> str:
        if self.kind == "HingeJoint":
            return "Free" if name == "angularX" else "Locked"
        if self.kind == "FixedJoint":
            return "Locked"
        return self.fields.get(f"{name}Motion", "Free")

    @property
    def coordinates(self) -> list[Coordinate]:
        """Those that may change."""
        if self.kind == "HingeJoint":
            return [Coordinate(self.game_object, self.index, "angle")]
        names = [name for name in (*LINEAR, *ANGULAR) if self.motion(name) != "Locked"]
        return [Coordinate(self.game_object, self.index, name) for name in names]

    def placed(self, values: Mapping[str, float]):
        """c at coordinates by name, degrees and metres, all others zero.  Locked ones are held."""
        given = dict(values)
        if (
            "angle" in given
        ):  # a hinge's angle and c's twist have opposite senses, as every angle without swapBodies
            given["angularX"] = given.pop("angle")
        d = np.array(
            [
                self.start[1][i] + self.sense * given.get(name, 0.0) if self.motion(name) != "Locked" else 0.0
                for i, name in enumerate(LINEAR)
            ]
        )
        turns = [self.sense * math.radians(given.get(name, 0.0)) for name in ANGULAR]
        free = [i for i, name in enumerate(ANGULAR) if self.motion(name) != "Locked"]
        if len(free) == 2:  # X is fixed in actor 1 and the other one in actor 0; without X: Y in 1, Z in 0
            first, second = free
            return about(np.eye(3)[second], turns[second]) @ about(np.eye(3)[first], turns[first]), d
        return exp([turns[i] if i in free else 0.0 for i in range(3)]), d

    def range(self, name: str) -> tuple[float, float]:
        """Lower and upper end of a coordinate, degrees or metres; infinite where it has none."""
        f = self.fields
        if name == "angle":
            limits = f.get("limits", {})
            return (
                (limits.get("min", 0.0), limits.get("max", 0.0))
                if f.get("useLimits")
                else (-math.inf, math.inf)
            )
        if self.motion(name) != "Limited":
            return (-math.inf, math.inf) if self.motion(name) == "Free" else (0.0, 0.0)
        if name in LINEAR:
            limit, start = f.get("linearLimit", {}).get("limit", 0.0), self.start[1][LINEAR.index(name)]
            low, high = -limit - start, limit - start
        elif name == "angularX":
            low, high = (f.get(k, {}).get("limit", 0.0) for k in ("lowAngularXLimit", "highAngularXLimit"))
        else:
            half = f.get(f"{name}Limit", {}).get("limit", 0.0)
            low, high = -half, half
        low, high = sorted((self.sense * low, self.sense * high))
        return low, high


def joint_axes(fields: Mapping[str, Any]) -> np.ndarray:
    """x = axis, y = secondaryAxis less its part along x, z = x cross y; in the own body, columns."""
    x = np.array(fields.get("axis", (1.0, 0.0, 0.0)), dtype=float)
    x /= np.linalg.norm(x)
    second = np.array(fields.get("secondaryAxis", (0.0, 1.0, 0.0)), dtype=float)
    y = second - x * (x @ second)
    if np.linalg.norm(y) < 1e-9:  # a hinge has none, and needs none
        y = np.cross(x, np.eye(3)[np.argmin(np.abs(x))])
    y /= np.linalg.norm(y)
    return np.column_stack([x, y, np.cross(x, y)])


# The scene -----------------------------------------------------------------------------------------------------------


@dataclass(eq=False)
class SceneKinematics:
    """document: a scene file's content.  placed: world pose of each GameObject in the file.  scales: of the world.
    body_of: for each GameObject the nearest one with a Rigidbody, itself or above; None for the world.
    joints: every component of the kinds in ``JOINTS`` on an active object, in the file's order.
    """

    document: Mapping[str, Any]
    placed: list = field(default_factory=list)
    scales: list = field(default_factory=list)
    body_of: list[int | None] = field(default_factory=list)
    joints: list[SceneJoint] = field(default_factory=list)
    tree: list[tuple[SceneJoint | None, int | None, int]] = field(default_factory=list)

    @staticmethod
    def load(path: Path | str) -> SceneKinematics:
        return SceneKinematics(json.loads(Path(path).read_text(encoding="utf-8")))

    def __post_init__(self) -> None:
        active = []
        for index, entry in enumerate(self.objects):
            parent = entry.get("parent")
            local, scale = self._local(entry)
            if parent is None:
                pose, whole, body, above = local, scale, None, True
            else:
                outer, size = self.placed[parent], self.scales[parent]
                pose = compose(outer, (local[0], size * local[1]))
                whole, body, above = size * scale, self.body_of[parent], active[parent]
            active.append(above and entry.get("active", True))
            if active[-1] and any(c["type"] == "Rigidbody" for c in entry.get("components", ())):
                body = index
            self.placed.append(pose)
            self.scales.append(whole)
            self.body_of.append(body)
        for index, entry in enumerate(self.objects):
            for number, fields in enumerate(entry.get("components", ())):
                if active[index] and fields["type"] in JOINTS:
                    self.joints.append(self._started(index, number, fields))
        self.tree = self._tree()

    @property
    def objects(self) -> list[Mapping[str, Any]]:
        return self.document["gameObjects"]

    @staticmethod
    def _local(entry):
        t = entry.get("transform", {})
        rotation = matrix_of(t.get("localRotation", (0.0, 0.0, 0.0, 1.0)))
        position = np.array(t.get("localPosition", (0.0, 0.0, 0.0)), dtype=float)
        return (rotation, position), np.array(t.get("localScale", (1.0, 1.0, 1.0)), dtype=float)

    def _started(self, index: int, number: int, fields) -> SceneJoint:
        connected = fields.get("connectedBody")
        own, other = self.placed[index], WORLD if connected is None else self.placed[connected]
        size = np.ones(3) if connected is None else self.scales[connected]
        own_frame = (
            joint_axes(fields),
            self.scales[index] * np.array(fields.get("anchor", (0.0, 0.0, 0.0)), dtype=float),
        )
        world = compose(own, own_frame)
        if fields["type"] == "FixedJoint" or fields.get("autoConfigureConnectedAnchor", True):
            anchor = inverse(other)[0] @ (world[1] - other[1])
        else:
            anchor = size * np.array(fields.get("connectedAnchor", (0.0, 0.0, 0.0)), dtype=float)
        joint = SceneJoint(index, number, fields, connected, own_frame, (other[0].T @ world[0], anchor))
        joint.start = self.c(joint, self.placed)
        return joint

    # Names ...........................................................................................................

    def object(self, name: str) -> int:
        """Index of the GameObject with this id, or else with this name, or whose id ends in it, or the frame of that name
        on another (a part that was merged into it)."""
        ids = [
            entry.get("id", "").replace("::", "/") for entry in self.objects
        ]  # one nesting, two ways to write it
        found = [i for i, entry in enumerate(self.objects) if name in (ids[i], entry.get("name"))]
        # A robot and a link of it may have one name: the link is meant.
        for chosen in (
            [i for i in found if self.body_of[i] == i],
            [i for i in found if "parent" in self.objects[i]],
            found,
        ):
            if len(chosen) == 1:
                return chosen[0]
        # A frame's name is seen from the model of the part that bears it.
        bearers = [entry_id.partition("/site:") for entry_id in ids]
        found = [
            i
            for i, (bearer, is_site, site) in enumerate(bearers)
            if is_site and f"{bearer.rpartition('/')[0]}/{site}" == name
        ]
        if len(found) == 1:
            return found[0]
        words = name.split("/")
        sites = [
            f"/site:{'/'.join(words[k:])}" for k in range(len(words))
        ]  # seen from the part that bears it
        for endings in ((f"/{name}", *sites[:-1]), (sites[-1],)):
            found = [i for i, entry in enumerate(self.objects) if entry.get("id", "").endswith(endings)]
            if len(found) > 1:  # of several models: the one whose name stands first
                found = [i for i in found if self.objects[i]["id"].startswith(f"{words[0]}/")]
            if found:
                break
        if len(found) != 1:
            raise KeyError(f"{len(found)} GameObjects are called {name}")
        return found[0]

    def joints_of(self, name: str) -> list[SceneJoint]:
        """The components that come from the source's joint of this name, in the file's order."""
        return [joint for joint in self.joints if name in joint.fields.get("because", ())]

    def joint(self, name: str) -> SceneJoint:
        (found,) = self.joints_of(name)
        return found

    def coordinate(self, name: str, coordinate: str | None = None) -> Coordinate:
        """The one coordinate of the source's joint, or that of several which has this name."""
        found = [c for j in self.joints_of(name) for c in j.coordinates if coordinate in (None, c.name)]
        if len(found) != 1:
            raise KeyError(f"the joint {name} has {len(found)} coordinates: {found}")
        return found[0]

    def joint_at(self, coordinate: Coordinate) -> SceneJoint:
        return next(j for j in self.joints if (j.game_object, j.index) == coordinate[:2])

    def range_of(self, coordinate: Coordinate) -> tuple[float, float]:
        """See ``SceneJoint.range``."""
        return self.joint_at(coordinate).range(coordinate.name)

    def reading(self, name: str, axis, is_angle: bool, child: str) -> tuple[Coordinate, float] | None:
        """The coordinate that an engine's joint reads on, and +1 or -1: what the engine's positive sense is there.

        axis: of the engine's joint, a direction in Unity's world (``unity_point``) at the pose in the file, unit;
        ``child`` turns about it by the right-hand rule of the source, or slides along it.  None where no component that
        comes from the joint ``name`` moves so.
        """
        moved = self.body_of[self.object(child)]
        # Models within models may have joints of one name: those that hold the child itself come first.
        beside = sorted(
            self.joints_of(name),
            key=lambda j: moved not in (self.body_of[j.game_object], self._body(j.connected)),
        )
        for joint in beside:
            for coordinate in joint.coordinates:
                if coordinate.is_angle != is_angle:
                    continue
                column = max("XYZ".find(coordinate.name[-1].upper()), 0)
                along = float(self.placed[joint.game_object][0] @ joint.own_frame[0][:, column] @ axis)
                if abs(along) > 1.0 - 1e-6:
                    own = self.body_of[joint.game_object] == self._outer(joint, moved)
                    # A right-hand turn about an axis is a left-hand turn about the mirrored axis reversed.
                    sense = math.copysign(1.0, along) * (1.0 if own else -1.0) * (-1.0 if is_angle else 1.0)
                    return coordinate, sense
        return None

    def _outer(self, joint: SceneJoint, child: int | None) -> int | None:
        """``child``, or where bodies stand between it and the joint the one that is placed by the joint."""
        if child in (self.body_of[joint.game_object], self._body(joint.connected)):
            return child
        return next((other for by, _, other in self.tree if by is joint), child)

    def pose_of(self, name: str, poses):
        return poses[self.object(name)]

    # Motion ..........................................................................................................

    def c(self, joint: SceneJoint, poses):
        """PhysX's actor1 in actor0 of a joint with all objects at these poses."""
        own = compose(poses[joint.game_object], joint.own_frame)
        other = compose(WORLD if joint.connected is None else poses[joint.connected], joint.connected_frame)
        return compose(inverse(other), own) if joint.sense > 0.0 else compose(inverse(own), other)

    def coupled(self, values: Mapping[Coordinate, float]) -> dict[Coordinate, float]:
        """``values`` and what the file's couplings make of them, chains too: q_b = ratio q_a + offset.

        A coordinate that a coupling states and ``values`` too keeps the given value.
        """
        known = dict(values)
        rest = list(self.document.get("couplings", ()))
        while rest:
            left = []
            for entry in rest:
                b = Coordinate(entry["b"]["gameObject"], entry["b"]["component"], entry["b"]["coordinate"])
                terms = entry["terms"] if "terms" in entry else [{**entry["a"], "ratio": entry["ratio"]}]
                of = [
                    (Coordinate(t["gameObject"], t["component"], t["coordinate"]), t["ratio"]) for t in terms
                ]
                if all(a in known for a, _ in of):
                    known.setdefault(b, sum(known[a] * r for a, r in of) + entry.get("offset", 0.0))
                else:
                    left.append(entry)
            if len(left) == len(rest):
                break
            rest = left
        return known

    def poses(
        self,
        values: Mapping[Coordinate, float],
        roots: Mapping[int, tuple] | None = None,
        held: Mapping[tuple[int, int], tuple] | None = None,
    ) -> list:
        """World pose of every GameObject at these coordinates (degrees, metres; those not given are zero).

        Bodies are placed one from the other along the joints, first from the world, those that close loops last: where
        ``values`` do not close a loop, ``gap`` says by how much.  roots: poses of bodies that hang from nothing, by
        GameObject; the pose in the file otherwise.  held: c itself of components, by GameObject and number.
        """
        given: dict[tuple[int, int], dict[str, float]] = {}
        for where, value in values.items():
            given.setdefault((where.game_object, where.component), {})[where.name] = value
        placed: dict[int | None, tuple] = {None: WORLD}
        for joint, here, other in self.tree:
            if joint is None:
                placed[other] = (roots or {}).get(other, self.placed[other])
            else:
                key = (joint.game_object, joint.index)
                c = held[key] if held and key in held else joint.placed(given.get(key, {}))
                placed[other] = self._across(joint, c, here, placed[here])
        return [self._carried(index, placed) for index in range(len(self.objects))]

    def _tree(self) -> list[tuple[SceneJoint | None, int | None, int]]:
        """In which order bodies are placed: by which joint (None: as in the file), from which body, which one."""
        ends = [(j, self.body_of[j.game_object], self._body(j.connected)) for j in self.joints]
        ends = [
            e
            for e in ends
            if e[1] != e[2] and not (e[0].kind == "ConfigurableJoint" and len(e[0].coordinates) == 6)
        ]
        by_body: dict[int | None, list] = {}
        for joint, a, b in ends:
            by_body.setdefault(a, []).append((joint, a, b))
            by_body.setdefault(b, []).append((joint, b, a))
        tree: list[tuple[SceneJoint | None, int | None, int]] = []
        done: set[int | None] = {None}
        queues = {c: [e for e in by_body.get(None, ()) if e[0].closure == c] for c in (False, True)}
        bodies = iter(self.bodies)

        def add(joint, here, other) -> None:
            done.add(other)
            tree.append((joint, here, other))
            for entry in by_body.get(other, ()):
                queues[entry[0].closure].append(entry)

        while True:
            queue = queues[False] or queues[True]
            if queue:
                joint, here, other = queue.pop(0)
                if other not in done:
                    add(joint, here, other)
            elif (root := next((b for b in bodies if b not in done), None)) is not None:
                add(None, None, root)
            else:
                return tree

    def _body(self, index: int | None) -> int | None:
        return None if index is None else self.body_of[index]

    def _across(self, joint: SceneJoint, c, here: int | None, pose):
        """The pose of the joint's other body, from that of one."""
        c = c if joint.sense > 0.0 else inverse(c)  # own in connected
        own_frame, other_frame = joint.own_frame, joint.connected_frame
        own, other = self.body_of[joint.game_object], self._body(joint.connected)
        own_frame = compose(self._inside(joint.game_object, own), own_frame)
        other_frame = (
            other_frame
            if joint.connected is None
            else compose(self._inside(joint.connected, other), other_frame)
        )
        if here == other:
            return compose(compose(compose(pose, other_frame), c), inverse(own_frame))
        return compose(compose(compose(pose, own_frame), inverse(c)), inverse(other_frame))

    def _inside(self, index: int, body: int | None):
        outer = WORLD if body is None else self.placed[body]
        return compose(inverse(outer), self.placed[index])

    def _carried(self, index: int, placed):
        body = self.body_of[index]
        if body == index:
            return placed[index]
        return compose(placed[body], self._inside(index, body))

    def gap(self, joint: SceneJoint, poses) -> tuple[float, float]:
        """Metres and radians by which these poses miss what the joint holds (its limits apart)."""
        r, d = self.c(joint, poses)
        metres = np.linalg.norm([d[i] for i, n in enumerate(LINEAR) if joint.motion(n) == "Locked"])
        free = [i for i, n in enumerate(ANGULAR) if joint.motion(n) != "Locked"]
        if not free:
            radians = angle_between(np.eye(3), r)
        elif len(free) == 1:
            axis = np.eye(3)[free[0]]
            radians = math.atan2(np.linalg.norm(np.cross(axis, r @ axis)), axis @ r @ axis)
        elif len(free) == 2:
            radians = abs(math.asin(max(-1.0, min(1.0, r[free[1], free[0]]))))
        else:
            radians = 0.0
        return float(metres), float(radians)

    # Mass ............................................................................................................

    def mass(self, index: int) -> tuple[float, np.ndarray, np.ndarray]:
        """Mass, centre of mass and 3 x 3 inertia about it of a body, along its GameObject's own axes; kg, m, kg m^2."""
        (body,) = (c for c in self.objects[index].get("components", ()) if c["type"] == "Rigidbody")
        axes = matrix_of(body.get("inertiaTensorRotation", (0.0, 0.0, 0.0, 1.0)))
        moments = np.array(body.get("inertiaTensor", (1.0, 1.0, 1.0)), dtype=float)
        center = np.array(body.get("centerOfMass", (0.0, 0.0, 0.0)), dtype=float)
        return float(body.get("mass", 1.0)), center, axes @ np.diag(moments) @ axes.T

    @property
    def bodies(self) -> list[int]:
        """GameObjects with a Rigidbody."""
        return [i for i, body in enumerate(self.body_of) if body == i]

    @property
    def moving(self) -> list[int]:
        """Those that physics moves: the ground, and what else is kinematic, left out."""
        return [
            i
            for i in self.bodies
            if not any(c.get("isKinematic", False) for c in self.objects[i].get("components", ()))
        ]


# What an engine says of a source, in Unity's frame ---------------------------------------------------------------------

ROS = np.array([[0.0, -1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])
"""X forward, Z up (URDF, SDF, MJCF) to Unity: (-y, z, x), as Unity's own URDF importer has it."""
CAD = np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
"""Z up, looked at along +Y: (-x, z, -y)."""
Y_UP = np.diag([-1.0, 1.0, 1.0])
"""Y up, Z forward (glTF, USD with Y up): (-x, y, z)."""


def unity_pose(rotation, translation, turn=ROS, length: float = 1.0):
    """A right-handed pose in Unity's world.  turn: one of the matrices above.  length: metres in a unit.

    A frame's own axes are turned with the world's, so an unrotated frame stays unrotated.
    """
    return turn @ np.asarray(rotation) @ turn.T, turn @ np.asarray(translation, dtype=float) * length


def unity_point(p, turn=ROS, length: float = 1.0) -> np.ndarray:
    return turn @ np.asarray(p, dtype=float) * length


def unity_inertia(inertia, turn=ROS) -> np.ndarray:
    """Of a 3 x 3 inertia, kg m^2."""
    return turn @ np.asarray(inertia, dtype=float) @ turn.T


def random_values(
    ranges: Iterable[tuple[Coordinate, tuple[float, float]]], rng: np.random.Generator
) -> dict[Coordinate, float]:
    """One configuration inside the ranges; where there is no end, half a turn or half a metre from zero."""
    values = {}
    for coordinate, (low, high) in ranges:
        reach = 180.0 if coordinate.is_angle else 0.5
        low = min(-reach, high - reach) if math.isinf(low) else low
        high = max(reach, low + reach) if math.isinf(high) else high
        values[coordinate] = float(rng.uniform(low, high))
    return values
