"""OndselSolver's ``.asmt``, which FreeCAD exports: parts, joints, limits and motions; no geometry."""

from __future__ import annotations

import hashlib
import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...diagnostics import Report, is_encodable
from ...model import RX, TX, Drive, Motion, Node, NodeKind, Scene, Source
from ...spatial import Array, Pose
from ..reading.file import read_bytes
from ..reading.placement import SKEWED
from ..reading.record import shown
from ..reading.request import Request
from ..reading.source_frame import DIRECTIONS, FORWARD, turn_to_scene
from .assembled import add_statements
from .joints import CONSTANT_VELOCITY, CONSTRAINTS, COUPLINGS, JOINTS, UNLIMITED, Marker, Statement, world
from .text import AsmtError, Item, linear, parse, row

TURN: Array = turn_to_scene(DIRECTIONS["Z"], DIRECTIONS[FORWARD["Z"]])
UNITS = {"OndselSolver": 1e-3}
"""Metres in the file's unit, by its first line: FreeCAD exports millimetres; the format itself names no unit."""
SI = 1.0
"""Of the files with another first line, from before FreeCAD."""
KINDS = (*JOINTS, *CONSTRAINTS, *COUPLINGS, CONSTANT_VELOCITY)
NUMBERS = {
    "AngleJoint": "theIzJz", "PlanarJoint": "offset", "PointInPlaneJoint": "offset", "LineInPlaneJoint": "offset",
    "RevCylJoint": "distanceIJ", "RevRevJoint": "distanceIJ", "CylSphJoint": "distanceIJ", "SphSphJoint": "distanceIJ",
    "RackPinionJoint": "pitchRadius", "ScrewJoint": "pitch", "GearJoint": "radiusI",
}  # fmt: skip
"""The field of each kind's number; all but the angle are lengths."""
CLOSE = 1e-5
"""Metres within which a distance holds at the pose of the file."""


def read(path: Path, report: Report, request: Request = Request()) -> Scene:
    """The scene of an ``.asmt``.  request: nothing of it is needed.  Raises KinefabError with every error found."""
    data = read_bytes(path, report)
    reader = _Reader(
        path.name, report, UNITS.get(data.partition(b"\n")[0].decode("ascii", "replace").strip(), SI)
    )
    try:
        text = data.decode("utf-8-sig")
        if "\0" in text or not is_encodable(text):
            raise AsmtError(1, "it holds characters that no text has")
        reader.read(parse(text))
    except UnicodeDecodeError as error:
        report.add("SOURCE_NOT_UTF8", path.name, offset=error.start)
    except AsmtError as error:
        report.add("ASMT_SYNTAX", f"{path.name}:{error.line}", detail=str(error))
    report.raise_for_errors()
    reader.scene.source = Source(path.name, "Z", reader.unit, hashlib.sha256(data).hexdigest())
    return reader.scene


class _Reader:
    def __init__(self, name: str, report: Report, unit: float):
        self.name, self.report, self.unit = name, report, unit
        self.scene = Scene()
        self.markers: dict[str, Marker] = {}
        self.ids: dict[str, int] = {}

    def read(self, assembly: Item) -> None:
        title = assembly.value("Name") or "Assembly"
        self.scene.nodes.append(
            Node(title, title, NodeKind.ASSEMBLY, flexible=True, where=self.place(assembly))
        )
        self._markers(assembly, f"/{title}", None, _pose(assembly))
        parts = assembly.find("Parts")
        for part in parts.all("Part") if parts is not None else ():
            self._part(part, title)
        sets = assembly.find("ConstraintSets")
        if sets is None:
            raise AsmtError(assembly.line, "the assembly has no 'ConstraintSets'")
        ranges = self._limits(sets)
        statements: list[Statement] = []
        pairs: dict[str, tuple[str, str]] = {}
        joints = sets.find("Joints")
        for item in joints.below if joints is not None else ():
            if (found := self._statement(item, ranges)) is not None:
                statements.append(found)
                pairs[found.id] = (item.value("MarkerI"), item.value("MarkerJ"))
        add_statements(
            self.scene,
            statements,
            lambda statement, reason: self._left(f"joint {statement.id}", statement.where, reason),
        )
        self._motions(sets, pairs)
        gravity = assembly.find("ConstantGravity")
        pull = row(gravity.below[0]) if gravity is not None and gravity.below else []
        if len(pull) == 3 and any(pull):
            x, y, z = (TURN @ np.array(pull) * self.unit).tolist()
            self.scene.physics = replace(self.scene.physics, gravity=(x, y, z))
        self.report.add("ASMT_ASSUMED", self.name, unit="millimetre" if self.unit == 1e-3 else "metre")

    def place(self, item: Item) -> str:
        return f"{self.name}:{item.line}"

    def _left(self, feature: str, where: str, reason: str) -> None:
        self.report.dropped(feature, "ASMT_LEFT_OUT", where, reason=reason)

    def _part(self, part: Item, title: str) -> None:
        name = part.value("Name")
        if not name:
            raise AsmtError(part.line, "the part has no name")
        node = len(self.scene.nodes)
        pose = _pose(part)
        key = self._unique(f"{title}/{name}")
        label = name.rpartition("#")[2] or name
        self.scene.nodes.append(
            Node(
                key,
                label,
                NodeKind.PART,
                0,
                _turned(pose, self.unit),
                definition=name,
                where=self.place(part),
            )
        )
        self._markers(part, f"/{title}/{name}", node, Pose())

    def _unique(self, name: str) -> str:
        number = self.ids[name] = self.ids.get(name, 0) + 1
        if number == 1:
            return name
        self.scene.counted.add(f"{name}:{number}")
        return f"{name}:{number}"

    def _markers(self, holder: Item, path: str, node: int | None, base: Pose) -> None:
        """Markers by their path, in the node's frame; a marker's own axes are those that joints mean."""
        points = holder.find("RefPoints")
        for point in points.all("RefPoint") if points is not None else ():
            outer = base @ _pose(point)
            listed = point.find("Markers")
            for marker in listed.all("Marker") if listed is not None else ():
                frame = outer @ _pose(marker)
                scene_frame = Pose(TURN @ frame.rotation, TURN @ frame.translation * self.unit)
                self.markers[f"{path}/{marker.value('Name')}"] = Marker(node, scene_frame)

    def _limits(self, sets: Item) -> dict[tuple[str, str, str], list[float]]:
        """Range by the two markers (or the joint) and the kind of the limit."""
        found: dict[tuple[str, str, str], list[float]] = {}
        limits = sets.find("Limits")
        for item in limits.all("RotationLimit", "TranslationLimit") if limits is not None else ():
            end, value = item.value("Type"), linear(item.value("Limit"))
            if value is None or value[1] != 0.0 or end not in ("=>", "=<"):
                self._left(f"limit {shown(item.value('Name'))}", self.place(item), "its limit is no number")
                continue
            joint = item.value("MotionJoint").rpartition("/")[2]
            first, second = (joint, "") if joint else (item.value("MarkerI"), item.value("MarkerJ"))
            ends = found.setdefault((item.text, first, second), [-math.inf, math.inf])
            index = 0 if end == "=>" else 1
            ends[index] = value[0] * (1.0 if item.text == "RotationLimit" else self.unit)
        return found

    def _statement(self, item: Item, ranges: dict[tuple[str, str, str], list[float]]) -> Statement | None:
        name = item.value("Name")
        if not name:
            name = f"{item.text}:{item.line}"
            self.scene.counted.add(name)
        feature, where = f"joint {shown(name)}", self.place(item)
        unknown = f"its type '{shown(item.text)}' is not known, or not told apart from another"
        if not _named(item.text):
            self._left(feature, where, unknown)
            return None
        sides = [self.markers.get(item.value(word)) for word in ("MarkerI", "MarkerJ")]
        if sides[0] is None or sides[1] is None:
            self._left(feature, where, "one of its markers is not in the file")
            return None
        kind = self._kind(item, sides[0], sides[1])
        if not kind:
            self._left(feature, where, unknown)
            return None
        word = NUMBERS.get(kind, "")
        # Older files leave it out.
        value = item.number(word, 0.0 if word == "offset" else None) if word else 0.0
        second = item.number("radiusJ") * self.unit if kind == "GearJoint" else 0.0
        own = [(item.value("MarkerI"), item.value("MarkerJ")), (name, "")]
        ranged: dict[str, tuple[float, float]] = {}
        for word, what in (("RotationLimit", "angle"), ("TranslationLimit", "length")):
            ends = next((ranges[word, i, j] for i, j in own if (word, i, j) in ranges), None)
            ranged[what] = UNLIMITED if ends is None else (min(ends), max(ends))
        return Statement(
            self._unique(name), kind, sides[0], sides[1],
            value if kind == "AngleJoint" else value * self.unit, second,
            length=ranged["length"], angle=ranged["angle"],
            name=name.rpartition("#")[2] or name, raw_kind=kind, where=where,
        )  # fmt: skip

    def _kind(self, item: Item, i: Marker, j: Marker) -> str:
        """The joint's word; "" where more than one may be meant."""
        alike = _named(item.text)
        if len(alike) < 2:
            return alike[0] if alike else ""
        # CylSph and SphSph are left with the same letters: the pose tells whose distance it is.
        poses = [node.pose for node in self.scene.nodes]
        between = world(i, poses).inverse() @ world(j, poses)
        distance = abs(item.number("distanceIJ")) * self.unit
        apart = {
            "SphSphJoint": float(np.linalg.norm(between.translation)),
            "CylSphJoint": float(np.linalg.norm(between.translation[:2])),
        }
        holds = [kind for kind in alike if abs(apart.get(kind, math.inf) - distance) < CLOSE]
        return holds[0] if len(holds) == 1 else ""

    def _motions(self, sets: Item, pairs: dict[str, tuple[str, str]]) -> None:
        motions = sets.find("Motions")
        for item in motions.below if motions is not None else ():
            name, where = shown(item.value("Name") or item.text), self.place(item)
            turning = (
                item.text in ("RotationalMotion", "tionalMotionE") and item.find("RotationZ") is not None
            )
            value = linear(item.value("RotationZ" if turning else "TranslationZ"))
            wanted = (item.value("MarkerI"), item.value("MarkerJ"))
            freedom = RX if turning else TX
            named = item.value("MotionJoint").rpartition("/")[2]
            index = next(
                (
                    number
                    for number, joint in enumerate(self.scene.joints)
                    if (pairs.get(joint.id) == wanted or joint.id == named) and freedom in joint.unlocked
                ),
                None,
            )
            if index is None or value is None or value[1] == 0.0:
                self._left(f"motion {name}", where, "it is no steady motion of a joint")
                continue
            joint = self.scene.joints[index]
            freedoms = list(joint.freedoms)
            old = freedoms[freedom]
            rate = value[1] if turning else value[1] * self.unit
            motion = Motion.FREE if old.motion is Motion.LOCKED else old.motion
            freedoms[freedom] = replace(old, motion=motion, drive=Drive(target_velocity=rate, motor=True))
            self.scene.joints[index] = replace(joint, freedoms=tuple(freedoms))
            self.report.kept(f"motion {name}", where)


def _named(word: str) -> list[str]:
    """The kinds that a word may stand for; FreeCAD 1.0 writes it without its first four letters and with an E behind."""
    if word in KINDS:
        return [word]
    return [kind for kind in KINDS if kind[4:] + "E" == word]  # of a gear "JointE"


def _pose(item: Item) -> Pose:
    """Position and rotation of an item, in the file's axes and unit.  Raises AsmtError."""
    (position,) = item.rows("Position3D", 1)
    rotation = np.array(item.rows("RotationMatrix", 3))
    off = float(np.abs(rotation.T @ rotation - np.eye(3)).max())
    if not off < SKEWED or np.linalg.det(rotation) < 0.0:
        raise AsmtError(item.line, f"the axes of '{shown(item.value('Name') or item.text)}' are no rotation")
    left, _, right = np.linalg.svd(rotation)
    return Pose(left @ right, np.array(position))


def _turned(pose: Pose, unit: float) -> Pose:
    """A node's pose in the scene's axes and metres."""
    return Pose(TURN @ pose.rotation @ TURN.T, TURN @ pose.translation * unit)
