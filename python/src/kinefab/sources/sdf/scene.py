"""The scene of SDF models: nodes for models and rigid groups of links, joints, gearboxes and mimics."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...diagnostics import Report
from ...model import (
    LOCKED,
    RX,
    RZ,
    TX,
    Coupling,
    CouplingKind,
    Freedom,
    Joint,
    JointKind,
    Motion,
    Node,
    NodeKind,
    Scene,
    Term,
    freedoms_of,
)
from ...spatial import Array, Pose, frame_from_axes
from ..robots.rigid_links import Carrier, Link, add_links, unique
from ..robots.robot_frame import TURN, placed
from .contacts import keep_apart
from .joints import SdfJoint, read_joint
from .links import Links
from .materials import Materials
from .scopes import Entry, Scope, entry_world_pose, link_of, visible, world_pose

SQUARE = 1e-6
"""Cosine up to which two axes are at right angles."""
ALONG = 1.0 - 1e-9
"""Cosine from which two axes are one."""


def fill_scene(scene: Scene, root: Scope, report: Report) -> None:
    """Add everything below a scope (the world, or what holds one model) to an empty scene.

    Raises KinefabError with every error found.
    """
    assembly = _add_assemblies(scene, root)
    links = Links(Materials(scene.surfaces), report)
    entries = root.all_entries("link")
    made = [links.link(entry, assembly.get(visible(entry.owner))) for entry in entries]
    number = {entry: i for i, entry in enumerate(entries)}
    joints = [j for e in root.all_entries("joint") if (j := read_joint(e, report)) is not None]
    report.raise_for_errors()
    _place_frames(root, made, number)
    for joint in joints:
        _settle_ends(joint, made, number, report)
        if joint.kind == "revolute2" and not _square(joint):
            _add_middle(joint, made, number, entries)
    report.raise_for_errors()
    ends = [
        (j, number.get(j.parent) if j.parent else None, number.get(j.child) if j.child else None)
        for j in joints
    ]
    fixed = [(a, b) for j, a, b in ends if j.kind == "fixed" and a is not None and b is not None]
    joined = [
        (a, b) for j, a, b in ends if j.kind not in ("fixed", "gearbox") and a is not None and b is not None
    ]
    carriers = add_links(scene, made, fixed, joined, report)
    keep_apart(scene, entries, made, carriers, joined, report)
    writer = _Joints(scene, made, carriers, number, report)
    for joint in joints:
        writer.add(joint)
    for joint in joints:
        writer.couple(joint)


def _add_assemblies(scene: Scene, root: Scope) -> dict[Scope, int]:
    """A node for each scope below the root; their indices."""
    assembly: dict[Scope, int] = {}
    for scope in root.scopes():
        if scope is root:
            continue
        above = scope.above
        while above is not None and above.merged:
            above = above.above
        assembly[scope] = len(scene.nodes)
        parent = None if above is None else assembly.get(above)
        pose, where = placed(world_pose(scope)), scope.element.where
        scene.nodes.append(
            Node(scope.path, scope.name, NodeKind.ASSEMBLY, parent, pose, flexible=True, where=where)
        )
    return assembly


def _place_frames(root: Scope, made: list[Link], number: dict[Entry, int]) -> None:
    """Give each link the frames that are fixed to it."""
    for entry in root.all_entries("frame"):
        link = link_of(entry, f"frame {entry.name}")
        if link is not None:
            frames = made[number[link]].frames
            frames[unique(frames, entry.name)] = entry_world_pose(link).inverse() @ entry_world_pose(entry)


def _settle_ends(joint: SdfJoint, made: list[Link], number: dict[Entry, int], report: Report) -> None:
    """What a joint says of its links: fixed to the world one stands still, and none is kinematic, since a kinematic body
    of Unity's would not let the joint move it."""
    ends = [end for end in (joint.parent, joint.child) if end is not None]
    if joint.kind == "fixed" and len(ends) == 1:
        made[number[ends[0]]].grounded = True
    for end in ends:
        if made[number[end]].kinematic:
            made[number[end]].kinematic = False
            report.dropped(f"kinematic of link {end.name}", "ELEMENT_DROPPED", end.element.where)


def _square(joint: SdfJoint) -> bool:
    first, second = joint.axes
    return abs(float(first.direction @ second.direction)) <= SQUARE


def _add_middle(joint: SdfJoint, made: list[Link], number: dict[Entry, int], entries: list[Entry]) -> None:
    """A body between two hinges whose axes no universal joint has."""
    entry = Entry("link", f"{joint.name}::middle", joint.entry.element, joint.entry.owner)
    child = joint.child or joint.parent
    assert child is not None
    link = Link(
        f"{joint.id}::middle",
        f"{joint.name} middle",
        joint.pose,
        joint.where,
        parent=made[number[child]].parent,
        helps=number[child],
    )
    number[entry] = len(made)
    made.append(link)
    entries.append(entry)
    joint.reference = entry


@dataclass(slots=True)
class _Joints:
    """Writes joints of the model.  of: for each joint and axis the id and freedom that it became, and its sense.
    hinges: by the links that they join.  places: index in the scene of each joint by its id."""

    scene: Scene
    links: Sequence[Link]
    carriers: Sequence[Carrier]
    number: dict[Entry, int]
    report: Report
    of: dict[tuple[Entry, int], tuple[str, int, float]] = field(
        default_factory=dict[tuple[Entry, int], tuple[str, int, float]]
    )
    hinges: dict[frozenset[Entry | None], list[SdfJoint]] = field(
        default_factory=dict[frozenset["Entry | None"], list[SdfJoint]]
    )
    places: dict[str, int] = field(default_factory=dict[str, int])

    def add(self, joint: SdfJoint) -> None:
        if joint.kind == "gearbox":
            return
        if joint.kind == "fixed":
            self.report.kept(f"joint {joint.name}", joint.where)
            return
        if joint.kind in ("revolute", "continuous", "prismatic", "screw"):
            axis = joint.axes[0]
            kinds = {"prismatic": JointKind.PRISMATIC, "screw": JointKind.SCREW}
            kind = kinds.get(joint.kind, JointKind.REVOLUTE)
            name = "tx" if kind is JointKind.PRISMATIC else "rx"
            self._write(
                joint,
                kind,
                frame_from_axes(axis.direction),
                {name: axis.freedom},
                sides=(joint.parent, joint.child),
            )
            if kind is JointKind.REVOLUTE:
                self.hinges.setdefault(frozenset((joint.parent, joint.child)), []).append(joint)
            sense = -1.0 if joint.child is None else 1.0
            self.of[joint.entry, 0] = (joint.id, TX if name == "tx" else RX, sense)
        elif joint.kind == "ball":
            self._write(
                joint, JointKind.SPHERICAL, joint.pose.rotation, {}, sides=(joint.parent, joint.child)
            )
        elif _square(joint) and joint.reference is None:
            self._universal(joint)
        elif joint.reference is not None:
            self._in_series(joint)
        else:
            self.report.approximated(
                f"joint {joint.name}", "UNIVERSAL_NOT_SQUARE", joint.where, joint=joint.name
            )
            self._universal(joint)

    def _universal(self, joint: SdfJoint) -> None:
        """The first axis stands in the parent, the second in the child."""
        first, second = joint.axes
        z = first.direction
        x = second.direction - z * (z @ second.direction)
        x = x / np.linalg.norm(x) if np.linalg.norm(x) > 1e-9 else frame_from_axes(z)[:, 1]
        axes = np.column_stack([x, np.cross(z, x), z])
        given = {"rz": first.freedom, "rx": second.freedom}
        if joint.child is None:  # seen from the world the axes change places
            axes = axes[:, [2, 1, 0]] * [-1.0, 1.0, -1.0]
            axes[:, 1] = np.cross(axes[:, 2], axes[:, 0])
            given = {"rx": first.freedom, "rz": second.freedom}
        self._write(joint, JointKind.UNIVERSAL, axes, given, sides=(joint.parent, joint.child), turned=True)
        indices = (RX, RZ) if joint.child is None else (RZ, RX)
        for i, index in enumerate(indices):
            self.of[joint.entry, i] = (joint.id, index, -1.0 if joint.child is None else 1.0)

    def _in_series(self, joint: SdfJoint) -> None:
        middle = joint.reference
        pairs = ((joint.parent, middle, ""), (middle, joint.child, "::axis2"))
        for i, (axis, (a, b, ending)) in enumerate(zip(joint.axes, pairs)):
            frame = frame_from_axes(axis.direction)
            self._write(joint, JointKind.REVOLUTE, frame, {"rx": axis.freedom}, sides=(a, b), ending=ending)
            self.of[joint.entry, i] = (f"{joint.id}{ending}", RX, -1.0 if b is None else 1.0)

    def _write(
        self,
        joint: SdfJoint,
        kind: JointKind,
        axes: Array,
        given: dict[str, Freedom],
        sides: tuple[Entry | None, Entry | None],
        ending: str = "",
        turned: bool = False,
    ) -> None:
        """axes: columns are the joint's X Y Z in the world, source axes.  turned: they fit a swap of the sides already."""
        parent, child = sides
        if child is None:  # the world must be the first side, and the other one moves the other way
            parent, child = child, parent
            if not turned:
                axes = axes * [-1.0, -1.0, 1.0]
        assert child is not None
        world = Pose(TURN @ axes, TURN @ joint.pose.translation)
        frame_a = world if parent is None else self._inside(parent, world)
        a = None if parent is None else self.carriers[self.number[parent]].node
        self.places[f"{joint.id}{ending}"] = len(self.scene.joints)
        self.scene.joints.append(
            Joint(
                f"{joint.id}{ending}",
                kind,
                a,
                self.carriers[self.number[child]].node,
                frame_a,
                self._inside(child, world),
                freedoms_of(kind, **given),
                name=joint.name,
                lead=joint.lead if kind is JointKind.SCREW else 0.0,
                because=(joint.name,),
                where=joint.where,
                extras={"sdf": {"type": joint.kind}},
            )
        )

    def _inside(self, entry: Entry, world: Pose) -> Pose:
        return self.scene.nodes[self.carriers[self.number[entry]].node].pose.inverse() @ world

    def couple(self, joint: SdfJoint) -> None:
        if joint.kind == "gearbox":
            self._gearbox(joint)
        for i, axis in enumerate(joint.axes):
            if (mimic := axis.mimic) is None or joint.kind == "gearbox":
                continue
            leader = self.of.get((mimic.joint, 1 if mimic.axis == "axis2" else 0))
            own = self.of.get((joint.entry, i))
            if leader is None or own is None or leader[:2] == own[:2]:
                problem = "itself" if leader == own else "a joint without such an axis"
                names = {"joint": mimic.joint.name, "problem": problem}
                self.report.add("MIMIC_UNKNOWN", mimic.where, feature=f"joint {joint.name}", **names)
                continue
            offset = mimic.offset - mimic.multiplier * mimic.reference
            self._add(
                f"mimic:{joint.id}" + ("" if i == 0 else ":2"),
                own,
                leader,
                mimic.multiplier,
                offset,
                mimic.where,
            )

    def _gearbox(self, joint: SdfJoint) -> None:
        """theta_2 = -ratio theta_1, each the turn of a side against the reference body."""
        feature = f"joint {joint.name}"
        ends = [self._turn(joint, i, side) for i, side in enumerate((joint.parent, joint.child))]
        if ends[0] is None or ends[1] is None:
            self.report.dropped(feature, "GEARBOX_WITHOUT_JOINT", joint.where, joint=joint.name)
            return
        self._add(joint.id, ends[1], ends[0], -joint.ratio, 0.0, joint.where)

    def _turn(self, joint: SdfJoint, axis: int, side: Entry | None) -> tuple[str, int, float] | None:
        """The coordinate by which a side turns against the reference body about the gearbox's axis."""
        for other in self.hinges.get(frozenset((side, joint.reference)), ()):
            along = float(other.axes[0].direction @ joint.axes[axis].direction)
            if abs(along) > ALONG:
                name, freedom, sense = self.of[other.entry, 0]
                forward = 1.0 if other.child is side else -1.0
                return name, freedom, sense * forward * float(np.sign(along))
        return None

    def _add(
        self,
        id: str,
        own: tuple[str, int, float],
        leader: tuple[str, int, float],
        ratio: float,
        offset: float,
        where: str,
    ) -> None:
        """own, leader: joint, freedom and the sense in which the file's coordinate is the joint's."""
        if ratio == 0.0:
            self._hold(own, own[2] * offset)
            return
        kind = CouplingKind.GEAR if own[1] >= RX and leader[1] >= RX and not offset else CouplingKind.LINEAR
        if id.startswith("mimic:"):
            kind = CouplingKind.LINEAR
        term = Term(leader[0], leader[1], own[2] * ratio * leader[2])
        # An offset that the stated pose misses stays: Gazebo and Drake begin at that pose too, and the analysis tells it.
        self.scene.couplings.append(Coupling(id, kind, own[0], own[1], (term,), own[2] * offset, where))

    def _hold(self, own: tuple[str, int, float], value: float) -> None:
        joint = self.scene.joints[self.places[own[0]]]
        freedoms = list(joint.freedoms)
        freedoms[own[1]] = LOCKED if value == 0.0 else Freedom(Motion.LIMITED, value, value)
        self.scene.joints[self.places[own[0]]] = replace(joint, freedoms=tuple(freedoms))
