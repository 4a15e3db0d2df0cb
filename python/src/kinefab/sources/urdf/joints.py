"""Joints: types, axes, limits, dynamics, mimics."""

from __future__ import annotations

import difflib
import math
from collections.abc import Mapping

import numpy as np

from ...diagnostics import Report
from ...spatial import Array, Pose
from ..reading.near import near_matches
from ..robots.rigid_links import Link
from ..robots.xml_elements import Element
from .links import origin
from .robot import Mimic, Robot, UrdfJoint

TYPES = ("revolute", "continuous", "prismatic", "fixed", "floating", "planar")
AXIAL = frozenset({"revolute", "continuous", "prismatic", "planar"})
X = np.array([1.0, 0.0, 0.0])
WORLD = "world"
MOVABLE = frozenset({"revolute", "continuous", "prismatic"})


def read_joints(robot: Robot, report: Report) -> None:
    """Fill ``robot.joints``; links must be there.  A joint on ``world``, where no link is called so, is on the world
    itself, as Drake and drawers of robots have it: an empty link of that name is added."""
    for element in robot.element.all("joint"):
        name = element.name()
        if not name:
            continue
        if name in robot.joints:
            element.fault("SOURCE_ID_DUPLICATE", id=name, first=robot.joints[name].where)
            continue
        if (joint := _joint(element, name, robot, report)) is not None:
            robot.joints[name] = joint
    _check_mimics(robot.joints, report)


def _joint(element: Element, name: str, robot: Robot, report: Report) -> UrdfJoint | None:
    feature = f"joint {name}"
    kind = element.attributes.get("type", "").strip()
    if not kind:
        element.fault("XML_MISSING", element="joint", field="type")
    elif kind not in TYPES:
        near = ", ".join(difflib.get_close_matches(kind, TYPES, 3)) or "none"
        element.fault("JOINT_TYPE_UNKNOWN", feature=feature, word=kind, near=near, known=", ".join(TYPES))
    ends = [_link(element, side, feature, robot) for side in ("parent", "child")]
    axis = _axis(element) if kind in AXIAL else X
    if kind not in TYPES or not all(ends):
        return None
    if ends[0] == ends[1]:
        element.fault("SAME_COMPONENT", feature=feature, component=ends[0])
        return None
    joint = UrdfJoint(
        name, kind, ends[0], ends[1], origin(element), X if axis is None else axis, element.where
    )
    if axis is None:  # what draws robots turns about it by nothing, and Pinocchio and ROS load it
        report.approximated(feature, "ROBOT_AXIS_ZERO", element.where)
        kind = joint.kind = "fixed"
    _limits(element, joint, feature, report)
    if (dynamics := element.child("dynamics")) is not None:
        joint.damping, joint.friction = (
            _not_negative(dynamics, key, feature) for key in ("damping", "friction")
        )
    if kind in ("planar", "floating"):  # which of their coordinates is meant nobody says
        for child in element.all("limit", "dynamics"):
            if any(_is_number(child, key) and float(child.attributes[key]) for key in child.attributes):
                report.dropped(f"{child.tag} of {feature}", "ELEMENT_DROPPED", child.where)
    if (mimic := element.child("mimic")) is not None:
        followed, factor, offset = (
            mimic.attributes.get("joint", "").strip(),
            mimic.number("multiplier", 1.0),
            mimic.number("offset"),
        )
        joint.mimic = Mimic(followed, factor, offset, mimic.where)
    for tag in ("limit", "safety_controller", "calibration"):
        if (child := element.child(tag)) is not None:
            joint.extras[tag] = {
                key: float(child.attributes[key]) for key in child.attributes if _is_number(child, key)
            }
    return joint


def _is_number(element: Element, key: str) -> bool:
    try:
        return math.isfinite(float(element.attributes[key]))
    except ValueError:
        return False


def _not_negative(element: Element, key: str, feature: str) -> float:
    """Zero where it is none, told: MuJoCo and ROS load that too."""
    before = len(element.report.diagnostics)
    value = element.number(key)
    if value < 0.0:
        element.wrong(key, "zero or more", element.attributes[key])
    return 0.0 if element.report.forgive(before, f"{key} of {feature}", "VALUE_UNREADABLE") else value


def _link(element: Element, side: str, feature: str, robot: Robot) -> str:
    child = element.child(side)
    if child is None:
        element.fault("XML_MISSING", element="joint", field=side)
        return ""
    name = child.name("link")
    if name == WORLD and side == "parent" and name not in robot.links:
        child.fault("LINK_WORLD_UNSTATED", feature=feature)
        robot.links[name] = Link(f"{robot.name}/{name}", name, Pose(), child.where)
    if name and name not in robot.links:
        child.fault(
            "LINK_UNKNOWN", link=name, feature=feature, near=near_matches(name, robot.links, child.report)
        )
        return ""
    return name


def _axis(element: Element) -> Array | None:
    """None where it has no length."""
    child = element.child("axis")
    if child is None:
        return X
    axis = np.array(child.numbers("xyz", 3, (1.0, 0.0, 0.0)))
    length = float(np.linalg.norm(axis))
    return axis / length if length > 1e-9 else None


def _limits(element: Element, joint: UrdfJoint, feature: str, report: Report) -> None:
    child = element.child("limit")
    ranged = joint.kind in ("revolute", "prismatic")
    if child is None:
        if ranged:
            report.add("LIMITS_MISSING", element.where, feature=feature)
        return
    joint.effort = child.number("effort", math.inf, infinite=True)
    joint.velocity = child.number("velocity", math.inf, infinite=True)
    if not ranged:
        return
    joint.lower = child.number("lower", 0.0, infinite=True)
    joint.upper = child.number("upper", 0.0, infinite=True)
    if joint.lower > joint.upper or joint.lower == math.inf or joint.upper == -math.inf:
        values = {"lower": f"{joint.lower:g}", "upper": f"{joint.upper:g}"}
        report.approximated(feature, "LIMITS_REVERSED_DROPPED", child.where, **values)
        joint.lower, joint.upper = -math.inf, math.inf
    elif joint.lower == joint.upper:
        child.fault("LIMITS_AT_ZERO", feature=feature)


def _check_mimics(joints: Mapping[str, UrdfJoint], report: Report) -> None:
    sound: set[str] = set()
    for joint in joints.values():
        if (mimic := joint.mimic) is None:
            continue
        feature = f"mimic of joint {joint.name}"
        if joint.kind not in MOVABLE:
            report.dropped(feature, "MIMIC_LEFT_OUT", mimic.where, why=f"the joint is {joint.kind}")
            joint.mimic = None
            continue
        if mimic.joint not in joints:  # programs that load robots look no further
            report.dropped(feature, "MIMIC_LEFT_OUT", mimic.where, why=f"there is no joint '{mimic.joint}'")
            joint.mimic = None
            continue
        problem = ""
        line, other = {joint.name}, mimic.joint
        while not problem and other in joints and other not in sound:
            if other in line:
                problem = (
                    "a joint that follows it in turn" if other != joint.name or len(line) > 1 else "itself"
                )
                break
            if joints[other].kind in ("floating", "planar"):
                problem = f"{joints[other].kind} and has no one coordinate"
            line.add(other)
            next_mimic = joints[other].mimic
            other = next_mimic.joint if next_mimic is not None else ""
        if problem:
            report.add(
                "MIMIC_UNKNOWN",
                mimic.where,
                feature=f"joint {joint.name}",
                joint=mimic.joint,
                problem=problem,
            )
            joint.mimic = None
        else:
            sound |= line
