"""The joints of the Assembly workbench, of FreeCAD 1.0, 1.1 and the versions before 1.0, as its solver is given them.

A joint's frame is the global placement of the object that its reference names, times ``Placement1`` or ``Placement2``:
these are relative to the object, hold ``Offset1`` and ``Offset2`` already, and are saved, detached or not.
Source: FreeCAD's ``AssemblyObject::makeMbdJoint`` and ``getDistanceType``.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from ...diagnostics import Report
from ...spatial import Pose, rotation_about
from ..asmt.joints import UNLIMITED, Marker, Range, Statement
from ..reading.record import shown
from .distances import distance_kind
from .document import UNIT, Target, Thing
from .elements import element_of
from .occurrences import ASSEMBLY, SUB_ASSEMBLY, Occurrence
from .parts import TURN, Parts, scene_pose
from .references import Lost, Reference, resolve
from .shapes import Shapes

KINDS = {
    "Fixed": "FixedJoint",
    "Revolute": "RevoluteJoint",
    "Cylindrical": "CylindricalJoint",
    "Slider": "TranslationalJoint",
    "Ball": "SphericalJoint",
    "Parallel": "ParallelAxesJoint",
    "Perpendicular": "PerpendicularJoint",
    "Angle": "AngleJoint",
    "RackPinion": "RackPinionJoint",
    "Screw": "ScrewJoint",
    "Gears": "GearJoint",
    "Belt": "GearJoint",
    "Planar": "PlanarJoint",
}
"""The solver's joint for each type but Distance, whose joint the elements choose."""
PARALLEL = 1e-7
"""Radians: an angle this small asks for parallel axes."""


class JointReader:
    """Collects the statements of a document's assemblies."""

    def __init__(self, parts: Parts, shapes: Shapes, report: Report):
        self._parts, self._shapes, self._report = parts, shapes, report
        self.statements: list[Statement] = []
        self.grounded: list[int] = []
        self._labels: dict[str, int] = {}
        self.identities: dict[str, str] = {}

    def read(self, assembly: Occurrence) -> None:
        """The joints and grounds of an assembly whose parts move apart."""
        joints = list(joints_of(assembly.target))
        for thing in joints:
            if thing.has("ObjectToGround"):
                self._ground(thing, assembly)
        for thing in joints:
            if not thing.has("ObjectToGround"):
                self._joint(thing, assembly, joints)

    def _ground(self, thing: Thing, assembly: Occurrence) -> None:
        target = thing.target("ObjectToGround")
        if target is None:
            return
        for below in assembly.walk():
            if (
                below.thing.name == target.name
                and below.thing.document is thing.document
                and id(below) in self._parts.of
            ):
                self.grounded.append(self._parts.of[id(below)])
                self._report.kept(f"ground {shown(thing.label)}", thing.where)
                return
        self._left(thing, "what it grounds is not in the assembly")

    def _joint(self, thing: Thing, assembly: Occurrence, joints: list[Thing]) -> None:
        word = thing.word("JointType")
        if not thing.flag("Activated", True) or thing.flag("Suppressed"):
            self._report.dropped(f"joint {shown(thing.label)}", "FEATURE_SUPPRESSED", thing.where)
            return
        if word not in KINDS and word != "Distance":
            self._left(thing, f"its type '{shown(word)}' is not known")
            return
        sides = [self._side(thing, number, assembly) for number in (1, 2)]
        first, second = sides
        if first is None or second is None:
            return
        kind, value, other = _stated(thing, word)
        if word == "Distance":
            elements = [element_of(side[0].owner, side[0].element, self._shapes) for side in (first, second)]
            found = distance_kind(
                elements[0], elements[1], [side[0].element for side in (first, second)], value
            )
            if found is None:
                self._left(thing, "what it is measured between is told by the shapes, which were not read")
                return
            kind, value, swapped = found
            if swapped:
                first, second = second, first
        if word in ("RackPinion", "Screw"):
            index = self._slides(first, second, assembly, joints)
            if index == 0:
                self._left(
                    thing,
                    "neither part has a Slider joint along its axis, without which FreeCAD does not use it",
                )
                return
            if index == 2:
                first, second = second, first
            if word == "RackPinion":
                first = (first[0], rack_frame(first, second))
        name = self._name(thing, assembly)
        self.statements.append(
            Statement(
                name, kind, self._marker(first), self._marker(second), value, other,
                length=limits(thing, "Length", UNIT) if word in ("Slider", "Cylindrical") else UNLIMITED,
                angle=limits(thing, "Angle", math.pi / 180.0) if word in ("Revolute", "Cylindrical") else UNLIMITED,
                name=thing.label, raw_kind=word, where=thing.where,
            )
        )  # fmt: skip

    def _name(self, thing: Thing, assembly: Occurrence) -> str:
        """The joint's label, which FreeCAD keeps unique in a document, and its number where another one has it too."""
        number = self._labels[thing.label] = self._labels.get(thing.label, 0) + 1
        node = self._parts.node(assembly)
        holder = "" if node is None else self._parts.identities[self._parts.nodes[node].id]
        found = thing.label if number == 1 else f"{thing.label}#{thing.name}:{number}"
        self.identities[found] = f"{holder}/{thing.name}"
        return found

    def _side(self, thing: Thing, number: int, assembly: Occurrence) -> tuple[Reference, Pose] | None:
        """What a side is fixed to, and its frame in the world, millimetres; None after a report."""
        target = reference(thing, number)
        if target is None:
            self._left(thing, f"its side {number} is not set")
            return None
        try:
            found = resolve(target, assembly, self._parts)
        except Lost as error:
            self._left(thing, f"its side {number} cannot be followed: {error}")
            return None
        return found, found.pose @ thing.placement(f"Placement{number}")

    def _marker(self, side: tuple[Reference, Pose]) -> Marker:
        found, frame = side
        world = scene_pose(frame)
        own = self._parts.nodes[found.node].pose.inverse()
        # A part's own axes are turned with the world's, a frame's are kept: its z stays its axis.
        return Marker(found.node, own @ Pose(TURN @ frame.rotation, world.translation))

    def _slides(
        self,
        first: tuple[Reference, Pose],
        second: tuple[Reference, Pose],
        assembly: Occurrence,
        joints: list[Thing],
    ) -> int:
        """Which side, 1 or 2, has a slider along its z; 0 for none."""
        found = 0
        for thing in joints:
            if (
                thing.word("JointType") != "Slider"
                or not thing.flag("Activated", True)
                or thing.flag("Suppressed")
            ):
                continue
            for number in (1, 2):
                target = reference(thing, number)
                try:
                    side = None if target is None else resolve(target, assembly, self._parts)
                except Lost:
                    side = None
                if side is None:
                    continue
                axis = (side.pose @ thing.placement(f"Placement{number}")).rotation[:, 2]
                for index, (own, frame) in enumerate((first, second), 1):
                    if own.node == side.node and abs(float(axis @ frame.rotation[:, 2])) > 1.0 - 1e-7:
                        found = found or index
        return found

    def _left(self, thing: Thing, reason: str) -> None:
        label = shown(thing.label)
        self._report.dropped(f"joint {label}", "FREECAD_JOINT_DROPPED", thing.where, reason=reason)


def _stated(thing: Thing, word: str) -> tuple[str, float, float]:
    """The solver's joint ("" for Distance, whose elements choose it) and its two numbers, radians or metres.  word: its type."""
    kind, value, other = KINDS.get(word, ""), thing.number("Distance"), thing.number("Distance2")
    if word == "Angle":
        degrees = thing.number("Angle") if thing.has("Angle") else value
        turn = math.fmod(abs(math.radians(degrees)), math.tau)
        if turn < PARALLEL or math.tau - turn < PARALLEL:
            return "ParallelAxesJoint", 0.0, other
        return kind, turn, other
    return kind, value * UNIT, -other * UNIT if word == "Belt" else other * UNIT


def joints_of(target: Thing | None) -> Iterator[Thing]:
    """Joints and grounds of an assembly, in its joint group's order."""
    if target is None or target.type not in (ASSEMBLY, SUB_ASSEMBLY):
        return
    document = target.document
    for entry in target.targets("Group"):
        group = document.things.get(entry.name)
        if group is None or group.type != "Assembly::JointGroup":
            continue
        for name in group.targets("Group"):
            thing = document.things.get(name.name)
            if thing is not None and (thing.has("JointType") or thing.has("ObjectToGround")):
                yield thing


def reference(thing: Thing, number: int) -> Target | None:
    """What a side names; before 1.0 the object, its part and its element were apart."""
    found = thing.target(f"Reference{number}")
    if found is not None or thing.has(f"Reference{number}"):
        return found
    part, named = thing.target(f"Part{number}"), thing.target(f"Object{number}")
    if named is None:
        return None
    element = thing.text(f"Element{number}") or (named.subs[0] if named.subs else "")
    path = [part.name] if part is not None and part.name != named.name else []
    return Target(
        part.name if path and part else named.name, "", (".".join([*path[1:], named.name, element]),)
    )


def limits(thing: Thing, what: str, unit: float) -> Range:
    """The range of a joint's length or angle: ends without their flags are only numbers; the wrong way round they are
    swapped, as FreeCAD does."""
    ends = [
        thing.number(f"{what}{end}") * unit if thing.flag(f"Enable{what}{end}") else math.inf * sign
        for end, sign in (("Min", -1.0), ("Max", 1.0))
    ]
    return min(ends), max(ends)


def rack_frame(rack: tuple[Reference, Pose], pinion: tuple[Reference, Pose]) -> Pose:
    """The rack's frame as the solver has it: the pinion's axis for z, and for x the slide's direction.

    FreeCAD 1.0 and 1.1 turn the pinion's frame within the rack by the angle to the slide, about an axis that is stated
    in the rack and applied in the frame itself; which way along the slide x then points is what decides the sign.
    """
    own, frame = rack
    inside = own.pose.inverse().rotation @ pinion[1].rotation
    slide = own.pose.inverse().rotation @ frame.rotation[:, 2]
    z, x = inside[:, 2], inside[:, 0]
    angle = math.acos(max(-1.0, min(1.0, float(x @ slide))))
    if float(z @ np.cross(x, slide)) < 0.0:
        angle = -angle
    turned = inside @ rotation_about(z / np.linalg.norm(z), angle)
    along = float(turned[:, 0] @ slide)
    if abs(along) < 1.0 - 1e-7:  # neither along nor against it: taken as what was meant
        along = 1.0
    x_axis = slide * math.copysign(1.0, along)
    z_axis = z - x_axis * float(z @ x_axis)
    z_axis = z_axis / max(float(np.linalg.norm(z_axis)), 1e-12)
    axes = np.column_stack([x_axis, np.cross(z_axis, x_axis), z_axis])
    return Pose(own.pose.rotation @ axes, frame.translation)
