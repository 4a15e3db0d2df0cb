"""What a written joint component lets its object do, read back as words with ranges from the pose in the file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..spatial import Array, frame_from_axes, matrix_from_quaternion

SLIDES = {"xMotion": "slide X", "yMotion": "slide Y", "zMotion": "slide Z"}
TURNS = {"angularXMotion": "turn X", "angularYMotion": "turn Y", "angularZMotion": "turn Z"}

BODIES = ("Rigidbody", "ArticulationBody")

Placement = tuple[Array, Array, Array]
"""World rotation, shape (3, 3), position, metres, and scale along the object's own axes, shape (3,)."""

WORLD: Placement = (np.eye(3), np.zeros(3), np.ones(3))


def world_placements(objects: Sequence[Mapping[str, Any]]) -> list[Placement]:
    """Of every GameObject, in the file's left-handed world; parents stand before their children."""
    found: list[Placement] = []
    for entry in objects:
        parent: int | None = entry.get("parent")
        rotation, position, scale = WORLD if parent is None else found[parent]
        transform = entry.get("transform", {})
        turn = matrix_from_quaternion(np.array(transform.get("localRotation", (0, 0, 0, 1)), dtype=float))
        offset = np.array(transform.get("localPosition", (0, 0, 0)), dtype=float)
        own_scale = np.array(transform.get("localScale", (1, 1, 1)), dtype=float)
        found.append((rotation @ turn, rotation @ (scale * offset) + position, scale * own_scale))
    return found


def world_points(points: Sequence[float] | Array, placement: Placement) -> Array:
    """Points of an object's own frame, shape (..., 3), metres, in the file's world."""
    rotation, position, scale = placement
    return (np.asarray(points, dtype=float) * scale) @ rotation.T + position


def counted(objects: Sequence[object], joints: Sequence[object]) -> tuple[str, str]:
    """``2 objects``, ``1 joint``."""
    return (
        f"{len(objects)} object{'' if len(objects) == 1 else 's'}",
        f"{len(joints)} joint{'' if len(joints) == 1 else 's'}",
    )


def joint_name(component: Mapping[str, Any]) -> str:
    """What the user calls a joint, empty where the file does not say."""
    name = component.get("name") or component.get("extras", {}).get("name", "")  # so had format 1.0
    return name if isinstance(name, str) else ""


def freedoms_of_component(
    component: Mapping[str, Any], own: int, placements: Sequence[Placement]
) -> list[str]:
    """What a joint component on object ``own`` leaves: ``turn X -10 .. 80 deg``, ``slide X 0 .. 0.4 m``.

    Ranges are the own object's, from the pose in the file.  Several limited slides share one radius; each
    is given its own range, reached while the others are at their middle.
    """
    if component["type"] == "FixedJoint":
        return []
    if component["type"] == "ArticulationBody":
        return _link_freedoms(component)
    if component["type"] == "HingeJoint":
        limits = component.get("limits", {})
        ends = (limits.get("min", 0), limits.get("max", 0)) if component.get("useLimits", False) else None
        return [_words("turn X", ends, "deg")]
    connected: int | None = component.get("connectedBody")
    start = _gap_along_axes(component, placements[own], WORLD if connected is None else placements[connected])
    radius = _limit(component, "linearLimit")
    found: list[str] = []
    for axis, (field, words) in enumerate(SLIDES.items()):
        motion = component.get(field, "Free")
        if motion != "Locked":
            ends = (-radius - start[axis], radius - start[axis]) if motion == "Limited" else None
            found.append(_words(words, ends, "m"))
    for field, words in TURNS.items():
        motion = component.get(field, "Free")
        if motion != "Locked":
            found.append(_words(words, angle_range(component, field) if motion == "Limited" else None, "deg"))
    return found


def _link_freedoms(link: Mapping[str, Any]) -> list[str]:
    """Of a link against the one above it.  A joint of one axis that is locked moves freely, as in Unity."""
    kind = link.get("jointType", "Fixed")
    if kind == "Prismatic":
        return [_words("slide X", _ends(link, "linearLock", "xDrive"), "m")]
    if kind == "Revolute":
        return [_words("turn X", _ends(link, "twistLock", "xDrive"), "deg")]
    if kind != "Spherical":
        return []
    axes = zip(TURNS.values(), ("twistLock", "swingYLock", "swingZLock"), ("xDrive", "yDrive", "zDrive"))
    return [
        _words(words, _ends(link, lock, drive), "deg")
        for words, lock, drive in axes
        if link.get(lock, "Locked") != "Locked"
    ]


def _ends(link: Mapping[str, Any], lock: str, drive: str) -> tuple[float, float] | None:
    if link.get(lock) != "Limited":
        return None
    return link.get(drive, {}).get("lowerLimit", 0), link.get(drive, {}).get("upperLimit", 0)


def link_above(objects: Sequence[Mapping[str, Any]], index: int) -> int | None:
    """The object whose link the own one is held to, None for a root."""
    above: int | None = objects[index].get("parent")
    while above is not None and not any(
        c["type"] == "ArticulationBody" for c in objects[above].get("components", ())
    ):
        above = objects[above].get("parent")
    return above


def _limit(component: Mapping[str, Any], name: str) -> float:
    return component.get(name, {}).get("limit", 0)


def angle_range(component: Mapping[str, Any], field: str) -> tuple[float, float]:
    """Range of a Limited angle of a ConfigurableJoint, degrees, of the object itself.

    field: ``angularXMotion``, ``angularYMotion`` or ``angularZMotion``.
    """
    if field != "angularXMotion":
        limit = _limit(component, "angularYLimit" if field == "angularYMotion" else "angularZLimit")
        return -limit, limit
    low, high = _limit(component, "lowAngularXLimit"), _limit(component, "highAngularXLimit")
    # X limits hold for the connected body; told here is what the object itself does.
    return (low, high) if component.get("swapBodies", False) else (-high, -low)


def _gap_along_axes(component: Mapping[str, Any], own: Placement, connected: Placement) -> Array:
    """From the connected anchor to the own one, along the joint's X, Y and Z, metres, shape (3,)."""
    if component.get("autoConfigureConnectedAnchor", True):
        return np.zeros(3)
    ends = (("anchor", own), ("connectedAnchor", connected))
    here, there = (world_points(component.get(name, (0, 0, 0)), at) for name, at in ends)
    frame = np.eye(3) if component.get("configuredInWorldSpace", False) else own[0]
    axes = frame_from_axes(
        np.array(component.get("axis", (1, 0, 0)), dtype=float),
        np.array(component.get("secondaryAxis", (0, 1, 0)), dtype=float),
    )
    return (frame @ axes).T @ (here - there)


def _words(words: str, ends: tuple[float, float] | None, unit: str) -> str:
    if ends is None:
        return words
    # Nine decimals: a nanometre says zero where rounding says 1e-17.
    lower, upper = (round(float(end), 9) + 0.0 for end in ends)
    return f"{words} {lower:g} .. {upper:g} {unit}"
