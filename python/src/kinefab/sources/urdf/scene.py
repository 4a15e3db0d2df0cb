"""The scene of a URDF robot: a node for each rigid group of links, joints between them, mimics as couplings."""

from __future__ import annotations

import math

from ...diagnostics import Report
from ...model import (
    FREE,
    RX,
    TX,
    Coupling,
    CouplingKind,
    Freedom,
    Joint,
    JointKind,
    Motion,
    Node,
    NodeKind,
    Passive,
    Scene,
    Term,
    freedoms_of,
)
from ...spatial import Pose, frame_from_axes
from ..robots.rigid_links import Carrier, add_links
from ..robots.robot_frame import direction, placed
from .joints import WORLD
from .robot import Robot, UrdfJoint
from .tree import from_the_root, hold_followers, place_links, root_of, start_of

KINDS = {
    "revolute": JointKind.REVOLUTE,
    "continuous": JointKind.REVOLUTE,
    "prismatic": JointKind.PRISMATIC,
    "planar": JointKind.PLANAR,
    "floating": JointKind.FREE,
}
COORDINATE = {"revolute": "rx", "continuous": "rx", "prismatic": "tx"}
INDEX = {"rx": RX, "tx": TX}


def fill_scene(scene: Scene, robot: Robot, floating_base: bool, report: Report) -> None:
    """Add the robot to an empty scene.  floating_base: whether its root is free instead of fixed to the world.

    Raises KinefabError where the joints make no tree.
    """
    root = root_of(robot, report)
    hold_followers(robot)
    ordered = from_the_root(robot, root)
    place_links(robot, root, ordered)
    scene.nodes.append(
        Node(robot.name, robot.name, NodeKind.ASSEMBLY, flexible=True, where=robot.element.where)
    )
    names = [root, *(joint.child for joint in ordered)]
    number = {name: i for i, name in enumerate(names)}
    links = [robot.links[name] for name in names]
    for link in links:
        link.parent = 0
    # A link that is called world stands in for it, whatever else is to be free.
    links[0].grounded = not floating_base or root == WORLD
    fixed = [(number[j.parent], number[j.child]) for j in ordered if not j.moves]
    joined = [(number[j.parent], number[j.child]) for j in ordered if j.moves]
    carriers = add_links(scene, links, fixed, joined, report)
    for joint in ordered:
        a, b = carriers[number[joint.parent]], carriers[number[joint.child]]
        if not joint.moves:
            report.kept(f"joint {joint.name}", joint.where)
            _note_fixed(scene, a, joint)
        else:
            scene.joints.append(_joint(joint, a, b))
            if start := start_of(joint, robot) if joint.mimic is None else 0.0:
                report.add("START_AT_END", joint.where, joint=joint.name, value=f"{start:g}")
    for joint in ordered:
        if joint.mimic is not None:
            _couple(scene, joint, robot)


def _note_fixed(scene: Scene, carrier: Carrier, joint: UrdfJoint) -> None:
    from dataclasses import replace

    node = scene.nodes[carrier.node]
    known = dict(node.extras)
    merged = known.get("fixedJoints")
    known["fixedJoints"] = {**(merged if isinstance(merged, dict) else {}), joint.name: joint.child}
    scene.nodes[carrier.node] = replace(node, extras=known)


def _joint(joint: UrdfJoint, a: Carrier, b: Carrier) -> Joint:
    axes = Pose(frame_from_axes(direction(joint.axis)))
    kind = KINDS[joint.kind]
    freedoms = freedoms_of(kind)
    if (name := COORDINATE.get(joint.kind)) is not None:
        freedoms = freedoms_of(kind, **{name: _freedom(joint)})
    return Joint(
        joint.name,
        kind,
        a.node,
        b.node,
        a.pose @ placed(joint.origin) @ axes,
        b.pose @ axes,
        freedoms,
        name=joint.name,
        because=(joint.name,),
        where=joint.where,
        extras={"urdf": {"type": joint.kind, **joint.extras}},
    )


def _freedom(joint: UrdfJoint) -> Freedom:
    passive = Passive(
        damping=joint.damping, friction=joint.friction, effort=joint.effort, speed=joint.velocity
    )
    stated = None if passive == Passive() else passive
    if math.isinf(joint.lower) and math.isinf(joint.upper):
        return Freedom(FREE.motion, passive=stated)
    return Freedom(Motion.LIMITED, joint.lower, joint.upper, passive=stated)


def _couple(scene: Scene, joint: UrdfJoint, robot: Robot) -> None:
    mimic = joint.mimic
    assert mimic is not None
    leader = robot.joints[mimic.joint]
    scene.couplings.append(
        Coupling(
            f"mimic:{joint.name}",
            CouplingKind.LINEAR,
            joint.name,
            INDEX[COORDINATE[joint.kind]],
            (Term(leader.name, INDEX[COORDINATE[leader.kind]], mimic.multiplier),),
            mimic.offset,
            mimic.where,
        )
    )
