"""Joints and as-built joints of a Gallery assembly as a bundle's joints.

A geometry's origin is in the root's frame; its axes are in that of the occurrence which the entity belongs to, as
Fusion's API hands them out, though not in every file.  So both readings are tried, and the one in which the two
sides fit at the exported pose is taken.  Angle and offset place the second side's frame where the coordinates are zero.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np

from ...spatial import Array, rotation_about
from .tree import Record, Tree
from .values import BadValueError, Json, direction, needed, number, objects, text, vector

TYPES = {
    "RigidJointType": "rigid", "RevoluteJointType": "revolute", "SliderJointType": "slider",
    "CylindricalJointType": "cylindrical", "PinSlotJointType": "pin_slot", "PlanarJointType": "planar",
    "BallJointType": "ball",
}  # fmt: skip
AXES = {"XAxisJointDirection": 0, "YAxisJointDirection": 1, "ZAxisJointDirection": 2}
MAIN = {
    "revolute": "rotation_axis", "cylindrical": "rotation_axis", "pin_slot": "rotation_axis",
    "slider": "slide_direction", "planar": "normal_direction",
}  # fmt: skip
SECOND = {"pin_slot": "slide_direction", "planar": "primary_slide_direction"}
LIMITS = {
    "revolute": {"rz": "rotation"}, "slider": {"tz": "slide"}, "cylindrical": {"tz": "slide", "rz": "rotation"},
    "pin_slot": {"tx": "slide", "rz": "rotation"},
    "planar": {"tx": "primary_slide", "ty": "secondary_slide", "rz": "rotation"},
}  # fmt: skip
FITS = 1e-4
"""Radians up to which two sides fit."""
FLAT = 1e-6
"""Centimetres below which a bounding box has no thickness."""


def joint_record(tree: Tree, values: Json, as_built: bool) -> Record:
    """The record of one joint, without an id.  Raises BadValueError."""
    motion = needed(values.get("joint_motion"), "joint_motion")
    word = TYPES.get(str(motion.get("joint_type")))
    if word is None:
        raise BadValueError("no joint of that type is known")
    ends = [_component(tree, values, key) for key in ("occurrence_one", "occurrence_two")]
    record: Record = {"name": text(values.get("name"), "Joint"), "type": word, "a": ends[1], "b": ends[0]}
    if ends[0] == ends[1]:
        raise BadValueError("both sides are the same part")
    if values.get("is_suppressed") is True:
        record["suppressed"] = True
    if as_built:
        geometry = values.get("joint_geometry")
        if geometry is None and word != "rigid":
            raise BadValueError("it has no geometry")
        if geometry is not None:
            side = _Side(tree, objects(geometry), values, "one")
            local = side.flat_along(side.axes(True)) or not side.flat_along(side.axes(False))
            frames = (side.axes(local), side.origin), None
            _framed(record, motion, *frames)
    else:
        two, one = (
            _Side(tree, needed(values.get(f"geometry_or_origin_{n}"), f"geometry {n}"), values, n)
            for n in ("two", "one")
        )
        _framed(record, motion, *_fitting(one, two, values, word, motion))
    dofs = [_dof(name, objects(motion.get(f"{key}_limits"))) for name, key in LIMITS.get(word, {}).items()]
    if record["b"] == "ground":
        record["a"], record["b"] = record["b"], record["a"]
        if "frameB" in record:
            record["frameA"], record["frameB"] = record["frameB"], record["frameA"]
        dofs = [_turned(dof) for dof in dofs]
    if dofs:
        record["dof"] = dofs
    return record


def _component(tree: Tree, values: Json, key: str) -> str:
    """A joint without an occurrence on one side is on the root, which stands still."""
    name = values.get(key)
    if name is None:
        return "ground"
    placed = tree.placed.get(str(name))
    if placed is None:
        raise BadValueError(f"its {key} is not in the file")
    return placed.id


class _Side:
    """One geometry.  origin: in the root, centimetres."""

    def __init__(self, tree: Tree, geometry: Json, values: Json, word: str) -> None:
        self.origin = vector(geometry.get("origin"), "origin")
        z = direction(geometry.get("primary_axis_vector"), "primary axis")
        x = direction(geometry.get("secondary_axis_vector"), "secondary axis")
        x = x - z * float(x @ z)
        length = float(np.linalg.norm(x))
        if length < FITS:
            raise BadValueError("the axes of its geometry are parallel")
        x = x / length
        self._given = np.column_stack([x, np.cross(z, x), z])
        entity = objects(geometry.get("entity_one"))
        placed = tree.placed.get(str(entity.get("occurrence", values.get(f"occurrence_{word}"))))
        self._rotation = np.eye(3) if placed is None else placed.pose.rotation
        self._box = objects(entity.get("bounding_box"))

    def axes(self, local: bool) -> Array:
        """Columns x, y, z in the root.  local: the file states them in the occurrence's frame."""
        return self._rotation @ self._given if local else self._given

    def flat_along(self, axes: Array) -> bool:
        """Whether the entity is flat and z its normal."""
        try:
            low, high = (vector(self._box.get(key), key) for key in ("min_point", "max_point"))
        except BadValueError:
            return False
        thin = np.flatnonzero(high - low < FLAT)
        return len(thin) == 1 and abs(float(axes[thin[0], 2])) > 1.0 - FITS


Frame = tuple[Array, Array]
"""Axes as columns, and origin, in the root."""


def _fitting(one: _Side, two: _Side, values: Json, word: str, motion: Json) -> tuple[Frame, Frame]:
    """The frames of a (the second side, where the coordinates are zero) and of b, read as they fit best."""
    angle = _parameter(values, "angle")
    offset = _parameter(values, "offset")
    flipped = values.get("is_flipped") is True
    best: tuple[float, Frame, Frame] | None = None
    # Axes in the occurrences' frames first: so they are in the files that were looked at.
    for local_one, local_two in ((True, True), (False, False), (True, False), (False, True)):
        base, moving = two.axes(local_two), one.axes(local_one)
        zero = rotation_about(base[:, 2], angle) @ base
        if flipped:
            moving = moving * [1.0, -1.0, -1.0]
        misfit = _misfit(zero, moving, word, motion)
        if best is None or misfit < best[0] - FITS:
            best = misfit, (zero, two.origin), (moving, one.origin)
    assert best is not None
    (zero, at), moving = best[1], best[2]
    along = zero[:, 2] * offset
    gaps = [float(np.linalg.norm(moving[1] - at - along * sign)) for sign in (1.0, -1.0, 0.0)]
    sign = (1.0, -1.0, 0.0)[int(np.argmin(gaps))] if word in ("rigid", "revolute", "ball") else 1.0
    return (zero, at + along * sign), moving


def _parameter(values: Json, key: str) -> float:
    found = objects(values.get(key)).get("value")
    return 0.0 if found is None else number(found, key)


def _misfit(zero: Array, moving: Array, word: str, motion: Json) -> float:
    """Radians by which the directions that the joint holds differ."""
    if word == "ball":
        return 0.0
    if word in ("rigid", "slider"):
        return math.acos(min(max((float(np.trace(zero.T @ moving)) - 1.0) / 2.0, -1.0), 1.0))
    main = _axis(motion, MAIN[word])
    return math.acos(min(max(float(zero[:, main] @ moving[:, main]), -1.0), 1.0))


def _axis(motion: Json, key: str, default: str = "ZAxisJointDirection") -> int:
    word = str(motion.get(key, default))
    if word not in AXES:
        raise BadValueError("it moves along an entity of its own, whose direction the file does not state")
    return AXES[word]


def _framed(record: Record, motion: Json, a: Frame, b: Frame | None) -> None:
    word = record["type"]
    main = _axis(motion, MAIN[word]) if word in MAIN else 2
    second = (main + 1) % 3
    if word in SECOND:
        second = _axis(motion, SECOND[word], tuple(AXES)[second])
        if second == main:
            raise BadValueError("it slides along the axis that it turns about")
    for key, frame in (("frameA", a), ("frameB", b)):
        if frame is not None:
            axes, origin = frame
            z, x = axes[:, main].tolist(), axes[:, second].tolist()
            record[key] = {"in": "world", "o": origin.tolist(), "z": z, "x": x}


def _dof(name: str, limits: Json) -> Record:
    """A limit counts only with its flag."""
    found: Record = {"name": name}
    for end in ("minimum", "maximum"):
        if limits.get(f"is_{end}_value_enabled") is True:
            found[end[:3]] = number(limits.get(f"{end}_value"), f"{end}_value")
            found[f"{end[:3]}Enabled"] = True
    return found


def _turned(dof: Record) -> Record:
    """The coordinate counted from the other side."""
    found: dict[str, Any] = {"name": dof["name"]}
    for end, other in itertools.permutations(("min", "max")):
        if end in dof:
            found[other], found[f"{other}Enabled"] = -dof[end], True
    return found
