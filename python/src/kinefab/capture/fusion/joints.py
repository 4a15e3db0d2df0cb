"""Fusion's joints, as-built joints, motion links and rigid groups as records of a bundle.

Standard library only: it runs in Fusion's own Python.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import cast

from ..draft import Draft, Numbers, Record, exchanged, frame, freedom, reach
from .api import (
    AsBuiltJoint,
    AssemblyConstraint,
    Joint,
    Limits,
    Motion,
    MotionLink,
    Occurrence,
    Relationship,
    RigidGroup,
    Vector,
)

TYPES = ("rigid", "revolute", "slider", "cylindrical", "pin_slot", "planar", "ball")
"""JointTypes."""
HEALTH = {2: "in error", 4: "rolled back"}
SUPPRESSED = 3
LINKED = {3: "rz", 4: "tz", 5: "rz", 6: "tx", 7: "rz", 8: "tx", 9: "ty", 10: "rz", 11: "tz"}
"""MotionTypes: the coordinate of a bundle's joint."""
IDENTITY = (1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

Component = Callable[[Occurrence | None], str]


def read_joint(draft: Draft, joint: Joint, component: Component) -> None:
    """Add a joint.  The first occurrence moves against the second: it is b."""
    health = joint.healthState
    record, motion = _begun(draft, joint, component), joint.jointMotion
    if motion is None:  # an inferred one: its relationships are geometric
        raise ValueError("a joint without a motion")
    word = TYPES[motion.jointType]
    two, one = list(joint.geometryTwoTransform.asArray()), list(joint.geometryOneTransform.asArray())
    z, x = _axes(word, motion, two)
    record["type"] = word
    record["frameA"], record["frameB"] = _frame(two, z, x), _frame(one, z, x)
    _finish(draft, record, word, motion, bool(joint.isLocked))
    if word == "ball":
        _told_of_ranges(draft, record["id"], motion)
    if bool(joint.isSuppressed) or health == SUPPRESSED:
        record["suppressed"] = True
    elif health in HEALTH:
        draft.report.add("CAPTURE_SICK", id=record["id"], health=HEALTH[health], program=draft.program)
        record["suppressed"] = True
    draft.joints.append(record)


def read_as_built(draft: Draft, joint: AsBuiltJoint, component: Component) -> None:
    """Add an as-built joint: one geometry, where both sides are; its value places the other side's frame."""
    record, motion = _begun(draft, joint, component), joint.jointMotion
    geometry = joint.geometry
    word = "rigid" if motion is None else TYPES[motion.jointType]
    record["type"] = word
    if geometry is not None and motion is not None:
        z, x = list(geometry.primaryAxisVector.asArray()), list(geometry.secondaryAxisVector.asArray())
        o = list(geometry.origin.asArray())
        y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
        rows = [v for i in range(3) for v in (x[i], y[i], z[i], o[i])]
        record["frameA"] = _frame(rows, *_axes(word, motion, rows))
        _finish(draft, record, word, motion, False)
    if joint.isSuppressed:
        record["suppressed"] = True
    draft.joints.append(record)


def _begun(draft: Draft, joint: Joint | AsBuiltJoint, component: Component) -> Record:
    name = joint.name
    own = draft.unique(name)
    draft.owners[own] = "world"
    return {"id": own, "name": name, "a": component(joint.occurrenceTwo), "b": component(joint.occurrenceOne)}


def joint_id(draft: Draft, joint: Joint | AsBuiltJoint, component: Component) -> str:
    """Id of a joint that was read: names are its component's own, so of several the one between the same occurrences."""
    name = joint.name
    alike = [record for record in draft.joints if record.get("name") == name]
    if len(alike) > 1:
        ends = {component(joint.occurrenceOne), component(joint.occurrenceTwo)}
        alike = [record for record in alike if {record["a"], record["b"]} == ends] or alike
    return alike[0]["id"] if alike else name


def _finish(draft: Draft, record: Record, word: str, motion: Motion, locked: bool) -> None:
    """Coordinates; the sides changed where b is the root; a locked joint is rigid."""
    dofs = _freedoms(word, motion)
    if dofs:
        record["dof"] = dofs
    if record["b"] == "ground":
        record |= exchanged(record)
        draft.turned |= {(record["id"], d["name"]) for d in dofs}
    if locked and word != "rigid":
        draft.report.approximated(
            f"joint {record['id']}", "CAPTURE_LOCKED", id=record["id"], program=draft.program
        )
        record["type"] = "rigid"
        for key in ("dof", "frameA", "frameB"):
            record.pop(key, None)


def _freedoms(word: str, motion: Motion) -> list[Record]:
    found: list[Record] = []
    slide = {"slider": "tz", "cylindrical": "tz", "pin_slot": "tx"}.get(word)
    if slide:
        found.append(_freedom(slide, motion.slideValue, motion.slideLimits))
    if word == "planar":
        found.append(_freedom("tx", motion.primarySlideValue, motion.primarySlideLimits))
        found.append(_freedom("ty", motion.secondarySlideValue, motion.secondarySlideLimits))
    if word in ("revolute", "cylindrical", "pin_slot", "planar"):
        found.append(_freedom("rz", motion.rotationValue, motion.rotationLimits))
    return found


def _freedom(name: str, value: float, limits: Limits) -> Record:
    low = reach(bool(limits.isMinimumValueEnabled), limits.minimumValue)
    high = reach(bool(limits.isMaximumValueEnabled), limits.maximumValue)
    return freedom(name, value, low, high)


def _axes(word: str, motion: Motion, rows: Numbers) -> tuple[list[float], list[float]]:
    """The bundle's z and x of the joint in the axes of the frame that ``rows`` (4 x 4, root) is: the motion's own axis
    need not be the frame's third."""

    def inside(vector: Vector) -> list[float]:
        v = list(vector.asArray())
        return [sum(rows[4 * i + k] * v[i] for i in range(3)) for k in range(3)]

    z, x = [0.0, 0.0, 1.0], None
    if word in ("revolute", "cylindrical", "pin_slot"):
        z = inside(motion.rotationAxisVector)
    elif word == "slider":
        z = inside(motion.slideDirectionVector)
    elif word == "planar":
        z = inside(motion.normalDirectionVector)
        x = inside(motion.primarySlideDirectionVector)
    if word == "pin_slot":
        x = inside(motion.slideDirectionVector)
    if x is None:
        x = [1.0, 0.0, 0.0] if abs(z[0]) < 0.9 else [0.0, 1.0, 0.0]
    return z, x


def _told_of_ranges(draft: Draft, own: str, motion: Motion) -> None:
    """A bundle's ball has no ranges, and of Fusion's three angles the order is not documented."""
    with draft.safely(f"ranges of {own}"):
        limits = (motion.pitchLimits, motion.yawLimits, motion.rollLimits)
        if any(one.isMinimumValueEnabled or one.isMaximumValueEnabled for one in limits):
            draft.report.approximated(
                f"ranges of joint {own}", "CAPTURE_KIND_RAW", kind="range of a ball", program=draft.program
            )


def _frame(rows: Numbers, z: Numbers, x: Numbers) -> Record:
    def lifted(v: Numbers) -> list[float]:
        return [sum(rows[4 * i + k] * v[k] for k in range(3)) for i in range(3)]

    return frame("world", [rows[3], rows[7], rows[11]], lifted(z), lifted(x))


def read_link(draft: Draft, link: MotionLink, component: Component) -> None:
    """Add a motion link: the second motion goes valueTwo where the first goes valueOne."""
    one, two = link.jointOne, link.jointTwo
    names = tuple(joint_id(draft, joint, component) for joint in (one, one if two is None else two))
    ends = [
        {"joint": name, "dof": LINKED[motion]}
        for name, motion in zip(names, (link.motionOne, link.motionTwo))
    ]
    record: Record = {"id": draft.unique(link.name), "kind": "linear", "a": ends[0], "b": ends[1]}
    record |= {"ratio": link.valueTwo.value / link.valueOne.value, "reversed": bool(link.isReversed)}
    draft.couplings.append(record | ({"suppressed": True} if link.isSuppressed else {}))


def read_group(draft: Draft, group: RigidGroup, component: Component) -> None:
    """Add a rigid group: every member is held by the first.  One body may stand for several members."""
    listed = [component(cast(Occurrence, group.occurrences.item(i))) for i in range(group.occurrences.count)]
    members = list(dict.fromkeys(listed))
    for member in members[1:]:
        own = draft.unique(f"{group.name}: {member.rpartition('/')[2]}")
        record: Record = {"id": own, "type": "rigid", "a": members[0], "b": member}
        draft.joints.append(record | ({"suppressed": True} if group.isSuppressed else {}))


def read_constraint(draft: Draft, c: AssemblyConstraint, component: Component) -> None:
    """Write an assembly constraint down as it stands."""
    own = draft.unique(c.name)
    record: Record = {"id": own, "name": c.name, "kind": "other", "rawKind": "AssemblyConstraint"}
    relationships = c.geometricRelationships
    listed = [cast(Relationship, relationships.item(i)) for i in range(relationships.count)]
    for key, entity in (("a", listed[0].entityOne), ("b", listed[0].entityTwo)) if listed else ():
        if entity is not None:
            record[key] = {"component": component(entity.assemblyContext), "geometry": "body"}
    stated: list[Record] = []
    for relationship in listed:
        value = relationship.offsetOrAngle
        said: Record = {"mate": bool(relationship.isMate), "aligned": bool(relationship.isFlipped)}
        stated.append(said | ({} if value is None else {"value": float(value.value)}))
    record["extras"] = {"relationships": stated}
    if c.isSuppressed:
        record["suppressed"] = True
    else:
        draft.report.approximated(
            f"constraint {own}", "CAPTURE_KIND_RAW", kind="AssemblyConstraint", program=draft.program
        )
    draft.constraints.append(record)
