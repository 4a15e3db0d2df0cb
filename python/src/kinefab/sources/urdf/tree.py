"""The tree of a robot's links: one root, no cycles, and the pose of every link where all joints stand at zero."""

from __future__ import annotations

from ...diagnostics import Report, chained, named
from ...spatial import Pose, rotation_about
from .robot import Robot, UrdfJoint


def root_of(robot: Robot, report: Report) -> str:
    """The name of the link without a parent.  Raises KinefabError where the joints make no tree."""
    parent_of: dict[str, UrdfJoint] = {}
    for joint in robot.joints.values():
        if (first := parent_of.setdefault(joint.child, joint)) is not joint:
            report.add(
                "LINK_PARENTS", joint.where, link=joint.child, first=f"joint {first.name}", second=f"joint {joint.name}",
                format="URDF",
            )  # fmt: skip
    roots = [name for name in robot.links if name not in parent_of]
    if len(roots) > 1:
        where = robot.links[roots[1]].where
        report.add("LINK_ROOTS", where, count=len(roots), names=named(roots))
    reached = set(roots)
    for name in robot.links:
        line = [name]
        while line[-1] not in reached and line[-1] in parent_of:
            above = parent_of[line[-1]].parent
            if above in line:
                path = chained([*line[line.index(above) :], above][::-1], " -> ")
                report.add("LINK_CYCLE", parent_of[above].where, path=path)
                break
            line.append(above)
        reached.update(line)
    report.raise_for_errors()
    return roots[0]


def from_the_root(robot: Robot, root: str) -> list[UrdfJoint]:
    """All joints, each after the one that leads to its parent; otherwise in the file's order."""
    below: dict[str, list[UrdfJoint]] = {}
    for joint in robot.joints.values():
        below.setdefault(joint.parent, []).append(joint)
    ordered: list[UrdfJoint] = []
    waiting = list(reversed(below.get(root, [])))
    while waiting:
        ordered.append(joint := waiting.pop())
        waiting += reversed(below.get(joint.child, []))
    return ordered


def start_of(joint: UrdfJoint, robot: Robot) -> float:
    """The joint's coordinate at the exported pose, radians or metres: zero, or the end of its range next to zero; of one
    that follows another what that makes of it."""
    line = [joint]
    while line[-1].name not in robot.starts and (mimic := line[-1].mimic) is not None:
        line.append(robot.joints[mimic.joint])
    last = line[-1]
    value = robot.starts.setdefault(last.name, min(max(0.0, last.lower), last.upper))
    for follower in reversed(line[:-1]):
        assert follower.mimic is not None
        value = follower.mimic.multiplier * value + follower.mimic.offset
        robot.starts[follower.name] = value
    return value


def hold_followers(robot: Robot) -> None:
    """A joint that follows one which never moves stands still too."""
    known: dict[str, bool] = {}
    for joint in robot.joints.values():
        if joint.mimic is not None and _stands(joint, robot, known):
            value = start_of(joint, robot)
            joint.lower = joint.upper = value
    for joint in robot.joints.values():
        if joint.mimic is not None and not joint.moves:
            joint.mimic = None


def _stands(joint: UrdfJoint, robot: Robot, known: dict[str, bool]) -> bool:
    line: list[str] = []
    stands: bool | None = None
    while stands is None:
        line.append(joint.name)
        if joint.name in known:
            stands = known[joint.name]
        elif (mimic := joint.mimic) is None:
            stands = not joint.moves
        elif mimic.multiplier == 0.0:
            stands = True
        else:
            joint = robot.joints[mimic.joint]
    known.update(dict.fromkeys(line, stands))
    return stands


def place_links(robot: Robot, root: str, ordered: list[UrdfJoint]) -> None:
    """Fill in ``Link.pose``."""
    robot.links[root].pose = Pose()
    for joint in ordered:
        start, moved = start_of(joint, robot), Pose()
        if start and joint.kind == "prismatic":
            moved = Pose(translation=start * joint.axis)
        elif start:
            moved = Pose(rotation_about(joint.axis, start))
        robot.links[joint.child].pose = robot.links[joint.parent].pose @ joint.origin @ moved
