"""The way back: the bodies and joints of a written scene as the model has them, so that they can be analysed and driven.

The mirror is its own inverse, so every quantity goes through the same function of ``frames`` as on the way out.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model import (
    FREE,
    LOCKED,
    RX,
    TX,
    Coupling,
    CouplingKind,
    Freedom,
    Joint,
    JointKind,
    Motion,
    Node,
    Scene,
    Source,
    Term,
    alike_from_both_sides,
    freedoms_of,
    kind_of,
    unlocked_of,
)
from ...spatial import Array, Pose, frame_from_axes, matrix_from_quaternion
from .. import frames
from ..scene.joints.configurable_joint import MOTION_FIELDS
from .drives import COORDINATES, breaks, driven, hinge_turn, slerp_of
from .links import LINK, link_basis, link_freedoms
from .terms import terms_of

WORLD = "the world"
"""Id of the node that stands for the world, on which joints without a connected body hang."""
_WORDS = {"Locked": Motion.LOCKED, "Limited": Motion.LIMITED, "Free": Motion.FREE}

Entry = Mapping[str, Any]


class _Reading:
    """The objects of a scene in the right-handed world, and the node that each moves with."""

    def __init__(self, document: Entry):
        self.objects: Sequence[Entry] = document["gameObjects"]
        self.poses: list[Pose] = []
        self.scales: list[Array] = []
        self.active: list[bool] = []
        self.nodes: list[Node] = [Node(WORLD, WORLD, grounded=True, visible=False)]
        self.node_of: list[int] = []
        """The node of each object: its own body's or that of the next one above it, 0 for the world's."""
        self.above: list[int | None] = []
        """Of each object with a link the one that its link is held to, None of a root and of all others."""
        for entry in self.objects:
            self._add(entry)

    def _add(self, entry: Entry) -> None:
        local: Entry = entry.get("transform", {})
        turn = matrix_from_quaternion(_vector(local, "localRotation", (0, 0, 0, 1)))
        scale = _vector(local, "localScale", (1, 1, 1))
        pose = Pose(frames.rotation(turn), frames.point(_vector(local, "localPosition", (0, 0, 0))))
        parent: int | None = entry.get("parent")
        active, node = bool(entry.get("active", True)), 0
        if parent is not None:
            above = Pose(pose.rotation, self.scales[parent] * pose.translation)
            pose, scale = self.poses[parent] @ above, scale * self.scales[parent]
            active, node = active and self.active[parent], self.node_of[parent]
        self.poses.append(pose)
        self.scales.append(scale)
        self.active.append(active)
        body = next((c for c in entry.get("components", ()) if c["type"] in ("Rigidbody", LINK)), None)
        above = None
        if body is not None and active:
            if body["type"] == LINK:
                above = self._link_above(parent)
            node = len(self.nodes)
            held = bool(body.get("isKinematic", False) or (body.get("immovable", False) and above is None))
            self.nodes.append(Node(entry["id"], entry["name"], pose=pose, grounded=held))
        self.node_of.append(node)
        self.above.append(above)

    def _link_above(self, index: int | None) -> int | None:
        """The nearest object with a link, from one upwards."""
        while index is not None and not any(
            c["type"] == LINK for c in self.objects[index].get("components", ())
        ):
            index = self.objects[index].get("parent")
        return index

    def anchor(self, which: int | None, local: Array) -> Array:
        """An anchor of an object (None: the world) in the world."""
        if which is None:
            return frames.point(local)
        return self.poses[which].point(self.scales[which] * frames.point(local))


@dataclass(frozen=True, slots=True, eq=False)
class Restored:
    """scene: the Rigidbodies and links as parts, with joints and couplings; right-handed, SI, radians.

    node_of: for each GameObject the node that it moves with.  poses: of the GameObjects, scales their sizes, WORLD.
    joints: the joint of each component, by (GameObject, component).
    switched_off: of those that hold nothing, which the scene leaves out, and ``idle`` the couplings that count by them.
    """

    scene: Scene
    node_of: Sequence[int]
    poses: Sequence[Pose]
    scales: Sequence[Array]
    joints: Mapping[tuple[int, int], Joint]
    switched_off: Mapping[tuple[int, int], Joint]
    idle: Sequence[Coupling]


def restored(document: Entry) -> Restored:
    """The mechanism of a parsed ``.kinefab``.

    The first node stands for the world.  A joint is named by its object's id, with ``[component]`` behind it where the
    object carries several, as the C# tool names them, and keeps the name that the source gave it.  Its coordinate is that of
    the own body against the connected one, or the other way round where ``extras.counts`` says so, as in the source, and
    zero at the pose in the file; where slides and turns mix axes, Unity counts in the own body, and so is it here: the
    connected one against the own, from the anchors.
    """
    reading = _Reading(document)
    joints: list[Joint] = []
    place: dict[tuple[int, int], Joint] = {}
    off: dict[tuple[int, int], Joint] = {}
    for index, entry in enumerate(reading.objects):
        components: Sequence[Entry] = entry.get("components", ())
        held = reading.above[index] is not None
        own = [
            i for i, c in enumerate(components) if c["type"].endswith("Joint") or (held and c["type"] == LINK)
        ]
        several = sum(components[i].get("enabled", True) for i in own) > 1
        for i in own:
            if not reading.active[index] or reading.node_of[index] == 0:
                continue
            name = entry["id"] + (f"[{i}]" if several or not components[i].get("enabled", True) else "")
            joint = _joint(name, components[i], index, reading)
            if joint.a != joint.b and joint.enabled:
                joints.append(joint)
                place[index, i] = joint
            elif joint.a != joint.b:
                off[index, i] = joint
    source = Source(str(document.get("source", {}).get("uri", "")))
    scene = Scene(nodes=reading.nodes, joints=joints, source=source)
    idle: list[Coupling] = []
    counted = {joint.id for joint in joints}
    for i, entry in enumerate(document.get("couplings", ())):
        if (coupling := _coupling(entry, f"coupling:{i}", place | off, reading, scene)) is not None:
            (scene.couplings if coupling.joints <= counted else idle).append(coupling)
    return Restored(scene, reading.node_of, reading.poses, reading.scales, place, off, idle)


def _link_joint(name: str, link: Entry, index: int, reading: _Reading) -> Joint:
    """Between a link and the one above it; both its frames are the one at the link's anchor."""
    above = reading.above[index]
    assert above is not None
    a, b = reading.node_of[above], reading.node_of[index]
    at = reading.anchor(index, _vector(link, "anchorPosition", (0, 0, 0)))
    world = Pose(reading.poses[index].rotation @ link_basis(link), at)
    frame_a, frame_b = (reading.nodes[node].pose.inverse() @ world for node in (a, b))
    freedoms = link_freedoms(link)
    because = tuple(str(source) for source in link.get("because", ()))
    own = str(link.get("extras", {}).get("name", ""))
    return Joint(name, kind_of(unlocked_of(freedoms)), a, b, frame_a, frame_b, freedoms, own, because=because)


def _joint(name: str, component: Entry, index: int, reading: _Reading) -> Joint:
    if component["type"] == LINK:
        return _link_joint(name, component, index, reading)
    connected: int | None = component.get("connectedBody")
    extras: Entry = component.get("extras", {})
    if connected is not None and (not reading.active[connected] or reading.node_of[connected] == 0):
        connected = connected if reading.active[connected] else None
    hinge = component["type"] == "HingeJoint"
    freedoms = _hinge_freedoms(component) if hinge else _freedoms(component)
    unlocked = unlocked_of(freedoms)
    axis = _vector(component, "axis", (1, 0, 0))
    basis = frame_from_axes(axis, None if hinge else _vector(component, "secondaryAxis", (0, 1, 0)))
    if hinge:  # its angle keeps its sign about the axial axis
        local = frame_from_axes(frames.axial(basis[:, 0]))
    else:
        local = frames.joint_basis(basis)
    world = local if component.get("configuredInWorldSpace", False) else reading.poses[index].rotation @ local
    at_own = reading.anchor(index, _vector(component, "anchor", (0, 0, 0)))
    at_other = at_own
    if not component.get("autoConfigureConnectedAnchor", True):
        at_other = reading.anchor(connected, _vector(component, "connectedAnchor", (0, 0, 0)))
    sides = [
        (reading.node_of[index], at_own),
        (0 if connected is None else reading.node_of[connected], at_other),
    ]
    if hinge or component.get("swapBodies", False):
        sides.reverse()
    elif alike_from_both_sides(unlocked):
        if not frames.COUNTS_CONNECTED.items() <= extras.items():
            freedoms = tuple(map(Freedom.turned_round, freedoms))
            sides.reverse()
        (first, at_first), (_, at_second) = sides
        gap = np.where([i in unlocked for i in range(RX)], world.T @ (at_second - at_first), 0.0)
        freedoms = (*map(Freedom.counted_from, freedoms, gap.tolist()), *freedoms[RX:])
        sides[0] = (first, at_first + world @ gap)
    (a, at_a), (b, at_b) = sides
    kind = JointKind.REVOLUTE if hinge else kind_of(unlocked)
    frame_a, frame_b = (
        reading.nodes[node].pose.inverse() @ Pose(world, at) for node, at in ((a, at_a), (b, at_b))
    )
    because = tuple(str(source) for source in component.get("because", ()))
    own = str(component.get("name") or extras.get("name", ""))
    force, torque = breaks(component)
    return Joint(
        name, kind, a, b, frame_a, frame_b, freedoms, own,
        break_force=force,
        break_torque=torque,
        enabled=bool(component.get("enabled", True)),
        collide=bool(component.get("enableCollision", False)),
        closes=bool(component.get("closure", False)),
        slerp=slerp_of(component),
        because=because,
    )  # fmt: skip


def _hinge_freedoms(component: Entry) -> tuple[Freedom, ...]:
    limits: Entry = component.get("limits", {})
    turn = FREE
    if component.get("useLimits", False):
        low, high = math.radians(limits.get("min", 0.0)), math.radians(limits.get("max", 0.0))
        turn = Freedom(Motion.LIMITED, min(low, high), max(low, high))
    return freedoms_of(JointKind.REVOLUTE, rx=hinge_turn(component, turn))


def _freedoms(component: Entry) -> tuple[Freedom, ...]:
    """Of b against a: the connected body against the own one, or, with ``swapBodies``, the other way round."""
    if component["type"] == "FixedJoint":
        return (LOCKED,) * 6
    found: list[Freedom] = []
    for i, field in enumerate(MOTION_FIELDS):
        motion = _WORDS[component.get(field, "Free")]
        found.append(_limited(component, i) if motion is Motion.LIMITED else Freedom(motion))
    return driven(component, tuple(found))


def _limited(component: Entry, i: int) -> Freedom:
    if i == RX:
        low, high = (
            float(component.get(f"{end}AngularXLimit", {}).get("limit", 0.0)) for end in ("low", "high")
        )
        ends = sorted(float(frames.angle(math.radians(x))) for x in (low, high))
        return Freedom(Motion.LIMITED, ends[0], ends[1])
    field = "linearLimit" if i < RX else "angularYLimit" if i == RX + 1 else "angularZLimit"
    half = float(component.get(field, {}).get("limit", 0.0))
    half = half if i < RX else math.radians(half)
    return Freedom(Motion.LIMITED, -half, half)


def _coupling(
    entry: Entry, name: str, place: Mapping[tuple[int, int], Joint], reading: _Reading, scene: Scene
) -> Coupling | None:
    """None where one of its joints is not there."""
    stated = terms_of(entry)
    joints = [place.get((end["gameObject"], end["component"])) for end in (entry["b"], *(end for end, _ in stated))]
    driven = joints[0]
    if driven is None:
        return None
    sign, zero, freedom = _reading_of(entry["b"], driven, reading, scene)
    unit = _unit(freedom)
    offset = zero + sign * float(entry.get("offset", 0.0)) * unit
    terms: list[Term] = []
    for (end, stated_ratio), joint in zip(stated, joints[1:]):
        if joint is None:
            return None
        sign_of_term, zero_of_term, followed = _reading_of(end, joint, reading, scene)
        ratio = sign * sign_of_term * stated_ratio * unit / _unit(followed)
        offset -= ratio * zero_of_term
        terms.append(Term(joint.id, followed, ratio))
    kind = CouplingKind(entry.get("kind", "linear"))
    return Coupling(str(entry.get("id", name)), kind, driven.id, freedom, tuple(terms), offset)


def _unit(freedom: int) -> float:
    return math.radians(1.0) if freedom >= RX else 1.0


def _reading_of(end: Entry, joint: Joint, reading: _Reading, scene: Scene) -> tuple[float, float, int]:
    """Of a coordinate of the scene file, u = sign * (q - zero): sign, zero and the freedom of q."""
    owner: int = end["gameObject"]
    component: Entry = reading.objects[owner]["components"][end["component"]]
    if component["type"] == "HingeJoint":
        return 1.0, 0.0, RX
    freedom = COORDINATES.index(end["coordinate"])
    if component["type"] == LINK:
        return 1.0, 0.0, freedom
    senses = frames.Senses.of(b_in_a=joint.b == reading.node_of[owner])
    if freedom >= RX:
        return senses.angular[freedom - RX], 0.0, freedom
    a, b = (scene.pose(node) @ frame for node, frame in ((joint.a, joint.frame_a), (joint.b, joint.frame_b)))
    away = a.rotation.T @ (b.translation - a.translation)
    return senses.linear[freedom - TX], float(away[freedom]), freedom


def _vector(entry: Entry, name: str, default: tuple[float, ...]) -> Array:
    return np.array(entry.get(name, default), dtype=np.float64)
