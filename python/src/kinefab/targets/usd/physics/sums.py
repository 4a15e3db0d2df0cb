"""Couplings of several terms, for mimics, which follow one coordinate each: light links whose motions add up.

Of ``q = r1 q1 + r2 q2`` a light link turns by r1 q1 on body a of the coupling's joint, and its body b on that link by r2 q2.
All of it are hinges or slides, which an articulation can have; the coupling's own joint, with its range and drive, closes the loop.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ....diagnostics import Report
from ....findings import JointFinding
from ....geometry.mass import principal
from ....model import RX, TX, Coupling, Dynamics, FreeIds, Joint, JointKind, MassProperties, Node, freedoms_of
from ....rigid import RigidGroups
from ....spatial import Pose
from ....unity.bodies.rigidbodies import body_mass
from ....unity.counting import SHARE
from ...content import Content
from .couplings import standing


def with_one_term_each(content: Content, joints: Sequence[Joint]) -> tuple[Content, list[Joint]]:
    """The content and the joints to be written with light links for its couplings of several terms, each told.

    joints: those that are written.  A coupling stays as it is where it names other joints, or where the joint that follows
    moves otherwise than along and about the one axis: then turns and shifts of the links do not add up.
    """
    scene = content.scene
    written = {joint.id: joint for joint in joints}
    links, couplings = _Links(content), list[Coupling]()
    for coupling in scene.couplings:
        axis, follower = coupling.freedom % RX, written.get(coupling.joint)
        one_axis = follower is not None and {coupling.freedom} <= set(follower.unlocked) <= {axis, axis + RX}
        if (
            follower is None
            or not one_axis
            or len(coupling.terms) < 2
            or not coupling.joints <= written.keys()
        ):
            couplings.append(coupling)
            continue
        couplings += links.chain(coupling, follower, written)
        told = {"coupling": coupling.id, "count": len(coupling.terms)}
        content.report.kept(f"coupling {coupling.id}", coupling.where, "COUPLING_BY_MIDDLE_BODIES", **told)
    if not links.joints:
        return content, [*joints]
    whole = replace(scene, nodes=links.nodes, joints=[*scene.joints, *links.joints], couplings=couplings)
    more = len(links.nodes) - len(scene.nodes)
    return (
        replace(content, scene=whole, groups=_with_bodies(content.groups, more), findings=links.findings),
        [*joints, *links.joints],
    )


class _Links:
    """nodes: the scene's and the light links.  joints: the links'.  findings: the content's, what closes the loops among them."""

    def __init__(self, content: Content):
        self._scene, self._groups = content.scene, content.groups
        self.nodes, self.joints = [*content.scene.nodes], list[Joint]()
        self.findings = {**content.findings}
        self._free_ids = FreeIds(one.id for one in (*self.nodes, *content.scene.joints, *content.scene.couplings))

    def chain(self, coupling: Coupling, follower: Joint, written: dict[str, Joint]) -> list[Coupling]:
        """Append the links of a coupling; returns what ties them to the terms' joints."""
        turns, axis = coupling.freedom >= RX, coupling.freedom % RX
        main = RX if turns else TX
        order = [axis, (axis + 1) % 3, (axis + 2) % 3]
        first, last = (
            Pose(f.rotation[:, order], f.translation) for f in (follower.frame_a, follower.frame_b)
        )
        kind = JointKind.REVOLUTE if turns else JointKind.PRISMATIC
        place, mass, ties = self._scene.pose(follower.a) @ first, self._light(follower), list[Coupling]()
        on, frame, shifted = follower.a, first, 0.0
        carried = follower.a if self._groups.is_ground(follower.b) else follower.b
        assert carried is not None, "a joint of the ground with itself is not written"
        for number, term in enumerate(coupling.terms[:-1], 1):
            id = self._free_ids.take(f"{coupling.id}:{number}")
            dynamics = Dynamics(gravity=False, angular_damping=0.0)
            parent = self._scene.nodes[carried].parent
            self.nodes.append(
                Node(id, id, parent=parent, pose=place, mass=mass, colliders=(), dynamics=dynamics)
            )
            link = len(self.nodes) - 1
            self.joints.append(Joint(id, kind, on, link, frame, Pose(), freedoms_of(kind)))
            here = term.ratio * standing(self._scene, written[term.joint], term.freedom)
            ties.append(Coupling(id, coupling.kind, id, main, (term,), -here, coupling.where))
            on, frame, shifted = link, Pose(), shifted + here
        both = len(follower.unlocked) == 2
        id = self._free_ids.take(f"{coupling.id}:{len(coupling.terms)}")
        kind = JointKind.CYLINDRICAL if both else kind
        self.joints.append(Joint(id, kind, on, follower.b, frame, last, freedoms_of(kind)))
        found = self.findings.get(follower.id, JointFinding(follower.id))
        self.findings[follower.id] = replace(found, closure=True)
        whole = replace(coupling, joint=id, freedom=main, terms=coupling.terms[-1:])
        return [*ties, replace(whole, offset=coupling.offset + shifted)]

    def _light(self, follower: Joint) -> MassProperties:
        """A share of what the joint moves."""
        node = follower.a if self._groups.is_ground(follower.b) else follower.b
        group = None if node is None else self._groups.group_of[node]
        assert node is not None and group is not None, "a joint of the ground with itself is not written"
        mass = body_mass(self._scene, node, self._groups.members[group], Report())
        return MassProperties(SHARE * mass.mass, np.zeros(3), SHARE * np.diag(principal(mass.inertia)[0]))


def _with_bodies(groups: RigidGroups, more: int) -> RigidGroups:
    """With as many further nodes, each a group of its own that nothing holds."""
    nodes, count = len(groups.group_of), len(groups.members)
    return RigidGroups(
        (*groups.group_of, *range(count, count + more)),
        (*groups.members, *((nodes + i,) for i in range(more))),
        (*groups.grounded, *[False] * more),
        (*groups.standing, *[None] * more),
    )
