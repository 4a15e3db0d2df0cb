"""Other ways to read a joint or constraint of a program, for the self check: frame, face side, axis, unit, limit.

Each is the record as captured with one or two of these read differently, named in words for the report.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from ..spatial import Array
from .draft import Record

Poses = dict[str, tuple[Array, Array]]
"""Rotation and origin in the world of every component, by id."""
Change = tuple[str, Callable[[Record], bool]]
"""Words for the report, and what turns a copy into that reading; it returns whether anything changed."""

CENTIMETRES_PER_METRE = 100.0
SIDES, FRAMES = ("a", "b", "c"), ("frameA", "frameB")


def poses_of(components: list[Record]) -> Poses:
    """World poses of the components."""
    found: Poses = {}
    for component in components:
        pose = component["pose"]
        found[component["id"]] = (np.array([pose["x"], pose["y"], pose["z"]]).T, np.array(pose["o"]))
    return found


def readings(record: Record, owner: str, poses: Poses) -> Iterator[tuple[str, Record]]:
    """Every alternative of a record with its name, the plainest first.  owner: the assembly that states it, or 'world'."""
    framed, turned = _frame_changes(owner, poses), _turns()
    scaled = _scalings()
    singles: list[tuple[Change, ...]] = [(change,) for change in (*framed, *turned, *scaled)]
    doubles: list[tuple[Change, ...]] = [(f, t) for f in framed for t in (*turned, *scaled)]
    for changes in (*singles, *doubles):
        copied = copy.deepcopy(record)
        done = [change(copied) for _, change in changes]
        if all(done):
            yield ", ".join(words for words, _ in changes), copied


def _vectors(record: Record) -> list[tuple[Record, str, str]]:
    """(part that holds vectors, its component, name of its point) of a joint or constraint."""
    if "frameA" in record or "type" in record:
        return [(record[key], record[key[-1].lower()], "o") for key in FRAMES if key in record]
    return [
        (record[key], record[key]["component"], "p") for key in SIDES if key in record and "in" in record[key]
    ]


def _frame_changes(owner: str, poses: Poses) -> list[Change]:
    def inside(frame: str, only_points: bool) -> Callable[[Record], bool]:
        def change(copied: Record) -> bool:
            changed = False
            for part, component, point in _vectors(copied):
                if component == "ground" and frame == "part":
                    continue
                wanted = component if frame == "part" else frame
                current = component if part["in"] == "part" else part["in"]
                if wanted == current or point not in part:
                    continue
                changed = True
                if only_points:
                    world = lifted(part[point], wanted, poses)
                    part[point] = lowered(world, current, poses)
                else:
                    part["in"] = wanted
            return changed

        return change

    changes: list[Change] = []
    for frame, words in (("part", "the part's"), ("world", "the root's"), (owner, "the owning assembly's")):
        changes += [
            (f"numbers taken in {words} frame", inside(frame, False)),
            (f"points taken in {words} frame", inside(frame, True)),
        ]
    return changes


def _turns() -> list[Change]:
    sides = (("z", "d"), "direction"), (("x",), "zero direction")
    reversals: list[Change] = [
        (f"{words} of {('the first', 'the second')[i]} side reversed", _reversed_of(i, keys))
        for keys, words in sides
        for i in (0, 1)
    ]
    return [
        ("value with the other sign", _negated),
        ("limits counted from the value", _counted_from_value),
        *reversals,
        ("gap along the first axis", _displaced),
        ("zero direction placed by the displayed value", _placed_by_value),
    ]


def _reversed_of(index: int, keys: tuple[str, ...]) -> Callable[[Record], bool]:
    def change(copied: Record) -> bool:
        parts = _vectors(copied)
        if index >= len(parts):
            return False
        part = parts[index][0]
        present = [key for key in keys if key in part]
        for key in present:
            part[key] = [-v for v in part[key]]
        return bool(present)

    return change


def _negated(copied: Record) -> bool:
    if copied.get("value"):
        copied["value"] = -copied["value"]
        return True
    bounded = [copied] if "kind" in copied and ("min" in copied or "max" in copied) else []
    values = [*bounded, *(dof for dof in copied.get("dof", []) if dof.get("value"))]
    for dof in values:
        dof["value"] = -dof.get("value", 0.0)
        low, high = dof.pop("min", None), dof.pop("max", None)
        flags = dof.pop("minEnabled", None), dof.pop("maxEnabled", None)
        for key, end, flag in (("min", high, flags[1]), ("max", low, flags[0])):
            if end is not None:
                dof[key] = -end
                if dof is not copied:
                    dof[f"{key}Enabled"] = bool(flag)
    return bool(values)


def _counted_from_value(copied: Record) -> bool:
    found = [d for d in copied.get("dof", []) if d.get("value") and ("min" in d or "max" in d)]
    if "value" in copied and ("min" in copied or "max" in copied):
        found.append(copied)
    for dof in found:
        for key in ("min", "max"):
            if key in dof:
                dof[key] += dof["value"]
    return bool(found)


def _displaced(copied: Record) -> bool:
    gap = copied.get("extras", {}).get("gap")
    if gap:
        part = _vectors(copied)[0][0]
        z = np.array(part["z"]) / np.linalg.norm(part["z"])
        part["o"] = (np.array(part["o"]) + gap * z).tolist()
    return bool(gap)


def _placed_by_value(copied: Record) -> bool:
    turning = [dof for dof in copied.get("dof", []) if dof["name"] == "rz" and "value" in dof]
    return bool(turning) and copied.get("frameB", {}).pop("x", None) is not None


def _scalings() -> list[Change]:
    def scaled(factor: float) -> Callable[[Record], bool]:
        def change(copied: Record) -> bool:
            parts = [(part, point) for part, _, point in _vectors(copied) if point in part]
            for part, point in parts:
                part[point] = [v * factor for v in part[point]]
            return bool(parts)

        return change

    def value(factor: float) -> Callable[[Record], bool]:
        def change(copied: Record) -> bool:
            if copied.get("value"):
                copied["value"] *= factor
            return bool(copied.get("value"))

        return change

    changes: list[Change] = []
    for factor, words in ((CENTIMETRES_PER_METRE, "metres"), (1.0 / CENTIMETRES_PER_METRE, "centimetres")):
        changes += [(f"value taken in {words}", value(factor)), (f"points taken in {words}", scaled(factor))]
    # A wrong value is the likelier one.
    return sorted(changes, key=lambda change: change[0].startswith("points"))


def lifted(point: Any, frame: str, poses: Poses) -> Array:
    """A point of a frame in the world."""
    p = np.asarray(point, dtype=float)
    if frame not in poses:
        return p
    rotation, origin = poses[frame]
    return np.asarray(rotation @ p + origin)


def lowered(point: Array, frame: str, poses: Poses) -> list[float]:
    """A point of the world in a frame."""
    if frame not in poses:
        return point.tolist()
    rotation, origin = poses[frame]
    lowered: list[float] = np.linalg.solve(rotation, point - origin).tolist()
    return lowered
