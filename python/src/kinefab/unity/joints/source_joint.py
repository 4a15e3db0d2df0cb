"""A joint as its source has it, which stands beside the component that is made of it: Unity's fields hold less of one.

Right-handed, metres and radians, in the frames of the source's own parts, as ``model.Joint`` has it.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, fields
from typing import Any, cast

import numpy as np

from ...model import FREEDOM_NAMES, LOCKED, Drive, Freedom, Joint, JointKind, Motion, Passive, SphericalDrive
from ...spatial import Array, Pose, matrix_from_quaternion, quaternion_from_matrix

AS_STATED = "asStated"
"""In ``extras`` of a component: the joint that it was made of."""
DECIMALS = 12
"""Of frames: a picometre, and what is left of sin(pi) is 0."""
MOST = 3.4e38
"""What a 32-bit float holds: no number of a scene file is larger."""
UNIT = 1e-6
"""By how much a rotation's quaternion may miss the length 1."""
FOR_MESSAGES = ("name", "where")
Entry = Mapping[str, Any]


def source_of(joint: Joint, number: int, on_a: bool) -> dict[str, Entry]:
    """Of the extras of its component; nothing where it has numbers that no file holds.

    number: its place among the scene's joints.  on_a: whether a is on the component's own side.
    """
    unlocked = {name: _entry(f) for name, f in zip(FREEDOM_NAMES, joint.freedoms) if f.motion is not Motion.LOCKED}
    found: dict[str, Any] = {
        "number": number,
        "kind": joint.kind.value,
        "a": "own" if on_a else "connected",
        "frameA": _frame(joint.frame_a),
        "frameB": _frame(joint.frame_b),
        "freedoms": unlocked,
    }
    if joint.lead:
        found["lead"] = joint.lead
    if joint.slerp is not None:
        found["slerp"] = _entry(joint.slerp)
    return {AS_STATED: found} if _fits(found) else {}


def number_of(extras: Entry) -> float:
    """The joint's place among the source's; behind all others where none is told."""
    told = extras.get(AS_STATED)
    number: Any = cast(Entry, told).get("number") if isinstance(told, Mapping) else None
    return number if type(number) is int else math.inf


def source_joint(extras: Entry, id: str, own: int | None, connected: int | None) -> Joint | None:
    """The joint that ``source_of`` told; None where nothing is told, or another program has left no sound joint.

    own, connected: the nodes that it is between.
    """
    entry: Any = extras.get(AS_STATED)
    try:
        told, sides = entry["freedoms"], {"own": (own, connected), "connected": (connected, own)}
        a, b = sides[entry["a"]]
        return Joint(
            id,
            JointKind(entry["kind"]),
            a,
            b,
            _pose(entry["frameA"]),
            _pose(entry["frameB"]),
            tuple(_freedom(told[name]) if name in told else LOCKED for name in FREEDOM_NAMES),
            lead=_number(entry.get("lead", 0.0)),
            slerp=_slerp(entry["slerp"]) if "slerp" in entry else None,
        )
    except (LookupError, TypeError, ValueError, AttributeError):
        return None


def _entry(noun: Any) -> dict[str, Any]:
    """The fields of it that say something."""
    found: dict[str, Any] = {}
    for own in fields(noun):
        value = getattr(noun, own.name)
        if own.name in FOR_MESSAGES or value is None or (own.default is not MISSING and value == own.default):
            continue
        if isinstance(value, np.ndarray):
            value = [float(x) for x in cast(Any, value).ravel()]
        found[own.name] = _entry(value) if isinstance(value, (Drive, Passive)) else value
    found |= {"motion": noun.motion.value} if isinstance(noun, Freedom) else {}
    return found


def _frame(pose: Pose) -> Entry:
    values = {"position": pose.translation.tolist(), "rotation": quaternion_from_matrix(pose.rotation).tolist()}
    return {key: [round(x, DECIMALS) for x in numbers] for key, numbers in values.items()}


def _fits(value: Any) -> bool:
    if isinstance(value, Mapping):
        return all(map(_fits, cast(Entry, value).values()))
    if isinstance(value, list):
        return all(map(_fits, cast("list[Any]", value)))
    return not isinstance(value, float) or abs(value) <= MOST


def _number(value: Any) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= MOST:
        raise ValueError(f"{value!r} is no number")
    return float(value)


def _numbers(values: Any, count: int) -> Array:
    found = np.array([_number(value) for value in values], dtype=np.float64)
    if len(found) != count:
        raise ValueError(f"{len(found)} numbers")
    return found


def _pose(entry: Entry) -> Pose:
    turn = _numbers(entry["rotation"], 4)
    if abs(math.hypot(*turn) - 1.0) > UNIT:
        raise ValueError("a rotation that is none")
    return Pose(matrix_from_quaternion(turn), _numbers(entry["position"], 3))


def _filled(kind: type[Any], entry: Entry, **given: Any) -> Any:
    """A noun of numbers, and of yes and no where its own default is one of them."""
    values: dict[str, Any] = dict(given)
    for own in fields(kind):
        if own.name not in entry or own.name in values:
            continue
        value = entry[own.name]
        if not isinstance(own.default, bool):
            value = type(own.default)(_number(value)) if isinstance(own.default, int) else _number(value)
        elif not isinstance(value, bool):
            raise TypeError(f"{value!r} is neither true nor false")
        values[own.name] = value
    return kind(**values)


def _freedom(entry: Entry) -> Freedom:
    drive, passive = (
        _filled(kind, entry[key]) if key in entry else None for key, kind in (("drive", Drive), ("passive", Passive))
    )
    return _filled(Freedom, entry, motion=Motion(entry["motion"]), drive=drive, passive=passive)


def _slerp(entry: Entry) -> SphericalDrive:
    return _filled(
        SphericalDrive,
        entry,
        target=_numbers(entry["target"], 9).reshape(3, 3),
        target_velocity=_numbers(entry["target_velocity"], 3),
    )
