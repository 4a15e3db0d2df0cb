"""The joints of a written scene between its nodes: as the source had them where the file still says so, else as the components say."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

from ....model import Coupling, Joint
from ....spatial import Pose
from ...joints.source_joint import number_of, source_joint
from ...scene import FixedJoint, GameObject
from ...scene import Joint as JointComponent
from ...scene.joints.configurable_joint import APART
from ..restored import Restored
from .as_in_source import Counted, Ends, as_in_source, in_source_terms


@dataclass(frozen=True, eq=False)
class WrittenJoints:
    """node_of: the nodes of those objects that are one.  ground: the object that stands for the ground.
    held: of each object whether its own body stands.  light: of each light body that counts for a led one the object of that."""

    objects: Sequence[GameObject]
    back: Restored
    node_of: Mapping[int, int]
    ground: int | None
    held: Sequence[bool]
    light: Mapping[int, int]

    @cached_property
    def _index_of(self) -> Mapping[str, int]:
        return {entry.id: index for index, entry in enumerate(self.objects)}

    @cached_property
    def _object_of(self) -> Mapping[int, int]:
        return {node: index for index, node in self.node_of.items()}

    def named(self) -> tuple[list[Joint], list[Coupling]]:
        """The joints, and the couplings that count by them, by the source's own ids where the file tells them."""
        counted = self._counted()
        joints = self._joints(counted)
        ids = {joint.id for joint in joints}
        couplings = [c for c in (*self.back.scene.couplings, *self.back.idle) if c.joints <= ids]
        return self._named(joints, [in_source_terms(coupling, counted) for coupling in couplings])

    def _counted(self) -> dict[str, Counted]:
        """Of the joints that are what their source had, by the ids of the restored ones."""
        found: dict[str, Counted] = {}
        for (index, k), joint in (self.back.joints | self.back.switched_off).items():
            component = self.objects[index].components[k]
            if not isinstance(component, JointComponent):
                continue
            own = self._node(component.part, self.light.get(index, index))
            connected = self._node(component.connectedPart, component.connectedBody)
            stated = source_joint(component.extras, joint.id, own, connected)
            if stated is not None and (counted := self._as_stated(stated, joint, component, index)) is not None:
                found[joint.id] = counted
        return found

    def _node(self, part: str, body: int | None) -> int | None:
        """The node of a side.  part: the id of its part, "" for the object with the body."""
        index = self._index_of.get(part) if part else body
        return None if index is None else self.node_of.get(index)

    def _as_stated(self, stated: Joint, joint: Joint, component: JointComponent, owner: int) -> Counted | None:
        back, poses = self.back, self.back.poses
        carrier = self.light.get(owner, owner)
        sides = [None if n is None else self._object_of[n] for n in (stated.a, stated.b)]
        a, b = (self._body_of(index) for index in sides)
        own = back.node_of[carrier]
        other = component.connectedBody
        connected = 0 if other is None or other == self.ground else back.node_of[other]
        if {a, b} != {own, connected} or a == b:
            return None
        at = [Pose() if index is None else poses[index] for index in sides]
        ends = Ends(
            at[0], at[1], poses[owner], Pose() if other is None else poses[other], a == own,
            (self._stands(a), self._stands(b)), (joint.a == back.node_of[owner]) != (a == own),
            component.enabled and all(node == 0 or back.scene.nodes[node].grounded for node in (a, b)),
        )  # fmt: skip
        frames_there = [back.scene.pose(n) @ frame for n, frame in ((joint.a, joint.frame_a), (joint.b, joint.frame_b))]
        return as_in_source(stated, component, ends, joint, (frames_there[0], frames_there[1]))

    def _joints(self, counted: Mapping[str, Counted]) -> list[Joint]:
        """Between the nodes, in the source's order: the restored ones are between Rigidbodies, and the world is one of them."""
        index_of = self._index_of
        bodies = [None if i == 0 else index_of[node.id] for i, node in enumerate(self.back.scene.nodes)]
        carrier = [None if index is None else self.light.get(index, index) for index in bodies]
        found: list[Joint] = []
        numbers: dict[str, float] = {}
        for (index, k), joint in (self.back.joints | self.back.switched_off).items():
            component = self.objects[index].components[k]
            numbers[joint.id] = number_of(getattr(component, "extras", {}))
            if APART in getattr(component, "extras", {}) or (index in self.light and isinstance(component, FixedJoint)):
                continue
            if (known := counted.get(joint.id)) is not None:
                found.append(known.joint)
                continue
            ends = [(joint.a or 0, joint.frame_a), (joint.b or 0, joint.frame_b)]
            own = self.back.node_of[index]
            parts = [
                index_of.get(getattr(component, "part" if node == own else "connectedPart", "")) for node, _ in ends
            ]
            (a, frame_a), (b, frame_b) = (
                self._side(carrier[node], part, frame) for (node, frame), part in zip(ends, parts)
            )
            if a != b:
                found.append(replace(joint, a=a, b=b, frame_a=frame_a, frame_b=frame_b))
        return sorted(found, key=lambda joint: numbers[joint.id])

    def _body_of(self, index: int | None) -> int:
        """The restored node that an object moves with, 0 for what stands with the ground's."""
        node = 0 if index is None else self.back.node_of[index]
        return 0 if self.ground is not None and node == self.back.node_of[self.ground] else node

    def _stands(self, node: int) -> bool:
        return node == 0 or self.held[self._index_of[self.back.scene.nodes[node].id]]

    def _named(
        self, joints: Sequence[Joint], couplings: Sequence[Coupling]
    ) -> tuple[list[Joint], list[Coupling]]:
        """By the source's own ids, where the file tells them: by those other targets and the report name them."""
        place = {joint.id: at for at, joint in (self.back.joints | self.back.switched_off).items()}
        told = {
            joint.id: str(getattr(self.objects[place[joint.id][0]].components[place[joint.id][1]], "id", ""))
            for joint in joints
        }
        counts = Counter(told.values())
        name = {own: id if id and counts[id] == 1 and id not in told else own for own, id in told.items()}
        return [replace(joint, id=name[joint.id]) for joint in joints], [
            replace(
                coupling,
                joint=name[coupling.joint],
                terms=tuple(replace(term, joint=name[term.joint]) for term in coupling.terms),
            )
            for coupling in couplings
        ]

    def _side(self, body: int | None, part: int | None, frame: Pose) -> tuple[int | None, Pose]:
        """The node of one end of a joint, and the frame in it.  body: the object with the Rigidbody, None for the world.
        part: the object that is joined, where it is another one that moves with that body."""
        stands = body is None or body == self.ground
        if part in self.node_of and self.back.node_of[part] == (0 if body is None else self.back.node_of[body]):
            from_body = frame if body is None else self.back.poses[body] @ frame
            return self.node_of[part], self.back.poses[part].inverse() @ from_body
        if body is None:
            return None, frame
        return (None, self.back.poses[body] @ frame) if stands else (self.node_of[body], frame)
