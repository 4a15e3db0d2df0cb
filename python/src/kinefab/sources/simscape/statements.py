"""Constraints, joints and rigid groups of a Simscape Multibody assembly as a bundle's constraints and joints."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...model import IN_BRACKETS, FreeIds
from ...spatial import Array
from ..reading.record import MIN_DIRECTION, shown
from ..robots.xml_elements import Element
from .tree import Record, Tree

KINDS = {
    "coincident": "coincident", "mate": "coincident", "align": "coincident", "flush": "coincident",
    "concentric": "concentric", "insert": "insert", "parallel": "parallel", "perpendicular": "perpendicular",
    "angle": "angle", "angleoffset": "angle", "distance": "distance", "offset": "distance", "distanceoffset": "distance",
    "tangent": "tangent", "fixed": "lock", "fix": "lock", "lock": "lock", "rigid": "lock", "weld": "lock",
}  # fmt: skip
"""Kinds of a bundle by the lower-case words for constraints in Inventor, SolidWorks and Creo."""
JOINTS = {
    "weld": "rigid", "rigid": "rigid", "fixed": "rigid", "revolute": "revolute", "prismatic": "slider",
    "cylindrical": "cylindrical", "spherical": "ball", "planar": "planar", "pinslot": "pin_slot", "universal": "universal",
}  # fmt: skip
FREE = frozenset(("sixdof", "bushing"))
"""Joints that hold nothing."""
LINES = frozenset(("line", "circle", "cylinder", "cone", "axis", "edge"))
"""Geometry that has an axis."""
PARALLEL = 1e-9
"""Sine up to which two directions are one."""
ROUND = frozenset(("cylinder", "cone", "sphere", "torus", "circle"))
GEOMETRY = {"axis": "line", "edge": "line", "arc": "circle", "vertex": "point", "face": "plane"}
"""Other words for a bundle's geometry."""


class Statements:
    """joints, constraints: records of a bundle.  lines: of each, by pointer."""

    def __init__(self, tree: Tree, report: Report) -> None:
        self.tree, self.report = tree, report
        self.joints: list[Record] = []
        self.constraints: list[Record] = []
        self.lines: dict[str, int] = {}
        self._free_ids = FreeIds(form=IN_BRACKETS)

    def read(self) -> None:
        for owner, assembly in self.tree.owners:
            for group, build in (("Constraints", self._constraint), ("Joints", self._joint)):
                above = assembly.child(group)
                for element in above.children if above is not None else ():
                    self._one(owner, element, build)
        for (_, group), members in self.tree.groups.items():
            for member in members[1:]:
                own = self._id((), f"{shown(group)}: {member.rpartition('/')[2]}")
                self.joints.append({"id": own, "type": "rigid", "a": members[0], "b": member})

    def _one(
        self, owner: tuple[str, ...], element: Element, build: Callable[[tuple[str, ...], Element, str], None]
    ) -> None:
        """Left out, with a word, where it leads to no part; one that the program suppresses is not written at all."""
        name = self._id(owner, element.attributes.get("name", "").strip() or element.tag)
        try:
            build(owner, element, name)
        except KeyError:
            self._left(element, name, "it names an instance that is not in the file")

    def _left(self, element: Element, name: str, reason: str) -> None:
        feature = f"{shown(element.tag)} {shown(name)}"
        self.report.dropped(feature, "SIMSCAPE_LEFT_OUT", element.where, reason=reason)

    def _id(self, owner: tuple[str, ...], name: str) -> str:
        name = f"{self.tree.ids[owner]}/{name}" if owner else name
        return self._free_ids.take(name)

    # Joints ...........................................................................................................

    def _joint(self, owner: tuple[str, ...], element: Element, name: str) -> None:
        """The base carries the follower, which is b; z is the axis, x the slot's direction."""
        word = element.tag.lower().removesuffix("joint")
        base, follower = element.child("BaseFrame"), element.child("FollowerFrame")
        if word in FREE:
            return
        if word not in JOINTS:
            self._left(element, name, "no joint of that type is known")
            return
        if base is None or follower is None:
            self._left(element, name, "it has no two frames")
            return
        (a, frame_a), (b, frame_b) = self._frame(owner, base, word), self._frame(owner, follower, word)
        if b == "ground":
            (a, frame_a), (b, frame_b) = (b, frame_b), (a, frame_a)
        if a == b:
            self._left(element, name, "both sides are the same part")
            return
        record = {"id": name, "type": JOINTS[word], "a": a, "b": b, "frameA": frame_a, "frameB": frame_b}
        self.lines[f"/joints/{len(self.joints)}"] = element.line
        self.joints.append(record)

    def _frame(self, owner: tuple[str, ...], element: Element, word: str) -> tuple[str, Record]:
        component, inside = self.tree.inside(owner, element)
        pose = self.tree.transform(element)
        z, x = pose.rotation[:, 2].tolist(), pose.rotation[:, 0].tolist()
        if word == "universal" and element.tag == "FollowerFrame":
            # Simscape turns about the base's x, then about the follower's y; a bundle names the arm in b as b's z.
            z, x = pose.rotation[:, 1].tolist(), pose.rotation[:, 0].tolist()
        elif word == "universal":
            z, x = pose.rotation[:, 0].tolist(), pose.rotation[:, 1].tolist()
        return component, {"in": inside, "o": pose.translation.tolist(), "z": z, "x": x}

    # Constraints ......................................................................................................

    def _constraint(self, owner: tuple[str, ...], element: Element, name: str) -> None:
        sides = [self._side(owner, found) for found in element.all("ConstraintGeometry")][:2]
        kind = KINDS.get(element.tag.lower(), element.tag)
        if len(sides) < 2:
            self._left(element, name, "it has no two sides")
            return
        a, b = sides
        if a["component"] == b["component"]:
            self._left(element, name, "both sides are the same part")
            return
        record: Record = {"id": name, "name": name, "kind": kind, "rawKind": element.tag, "a": a, "b": b}
        if kind == "tangent" and any(side["geometry"] in ROUND and "r" not in side for side in sides):
            self._left(element, name, "the file does not state the radius that it touches at")
            return
        for side in sides:
            if side["geometry"] == "cone" and kind != "tangent":
                side["geometry"] = "line"  # what it holds is the cone's axis
        if kind in ("angle", "distance"):
            value = self._measured(kind, a, b)
            record["value"] = value
            shown_as = f"{math.degrees(value):.6g} degrees" if kind == "angle" else f"{value:.6g}"
            self.report.add(
                "SIMSCAPE_MEASURED", element.where, feature=f"{element.tag} {shown(name)}", value=shown_as
            )
        self.lines[f"/constraints/{len(self.constraints)}"] = element.line
        self.constraints.append(record)

    def _side(self, owner: tuple[str, ...], element: Element) -> Record:
        component, inside = self.tree.inside(owner, element)
        word = element.attributes.get("geomType", "").strip().lower()
        position, axis = element.child("Position"), element.child("Axis")
        side: Record = {
            "component": component,
            "geometry": GEOMETRY.get(word, word) or "body",
            "in": inside,
            "p": list((0.0,) * 3 if position is None else position.values(3, (0.0,) * 3)),
        }
        if axis is not None and axis.text.strip():
            side["d"] = list(axis.values(3, (0.0,) * 3))
        radius = element.child("Radius")
        if radius is not None and radius.text.strip():
            side["r"] = radius.value()
        return side

    def _measured(self, kind: str, a: Record, b: Record) -> float:
        """The angle or distance of two sides at the exported pose: the file states no value.  Radians, or the file's unit."""
        (p, d), (q, e) = self._placed(a), self._placed(b)
        if kind == "angle":
            if d is None or e is None:
                return 0.0
            return math.atan2(float(np.linalg.norm(np.cross(d, e))), float(d @ e))
        across = q - p
        normal = d if a["geometry"] == "plane" else e if b["geometry"] == "plane" else None
        if normal is not None:
            return abs(float(across @ normal))
        lines = [v for v, side in ((d, a), (e, b)) if v is not None and side["geometry"] in LINES]
        if len(lines) == 2:
            both = np.cross(lines[0], lines[1])
            if (size := float(np.linalg.norm(both))) > PARALLEL:
                return abs(float(across @ both)) / size
        for line in lines[:1]:
            across = across - line * float(across @ line)
        return float(np.linalg.norm(across))

    def _placed(self, side: dict[str, Any]) -> tuple[Array, Array | None]:
        """Point and unit direction of a side in the world, in the file's unit."""
        p, d = np.array(side["p"]), side.get("d")
        length = 0.0 if d is None else float(np.linalg.norm(d))
        unit = np.array(d) / length if length > MIN_DIRECTION else None
        pose = self.tree.poses[side["in"]]
        return pose.point(p), None if unit is None else pose.rotation @ unit
