"""The joints between a body and its parent, one after the other, as steps: joints of Unity's kind that move exactly so.

MuJoCo puts any number of hinges and slides into one body, each in the frame that the ones before it have moved.  Those
that one joint of six freedoms can be are one step; between two steps stands a light body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...model import RX, RZ, TX, JointKind, kind_of
from ...spatial import Array, Pose, frame_from_axes, rotation_about

SQUARE = 1e-9
"""Cosine up to which two axes are at right angles, sine up to which they are one; metres up to which points are."""


@dataclass(frozen=True, slots=True, eq=False)
class Axis:
    """One hinge, slide or ball.  point, direction: in the body's frame, MuJoCo's axes, metres, unit.
    zero: coordinate in the reference pose.  at: at the exported one; of a ball a rotation matrix.
    plain: nothing limits or drives it, and nothing acts on it."""

    index: int
    kind: str
    point: Array
    direction: Array
    zero: float
    at: float
    symmetric: bool
    limited: bool
    turn: Array | None = None

    def moved(self) -> Pose:
        """What it does to the body's frame at the exported pose."""
        if self.kind == "slide":
            return Pose(translation=(self.at - self.zero) * self.direction)
        rotation = self.turn if self.turn is not None else rotation_about(self.direction, self.at - self.zero)
        return Pose(rotation, self.point - rotation @ self.point)


@dataclass(frozen=True, slots=True, eq=False)
class Step:
    """One joint.  freedoms: TX..RZ of each axis (three for a ball).  frame_a, frame_b: of the joint in the frames before
    and after it, both the body's own where nothing has moved."""

    axes: tuple[Axis, ...]
    kind: JointKind
    freedoms: tuple[int, ...]
    frame_a: Pose
    frame_b: Pose


def steps_of(axes: Sequence[Axis]) -> list[Step]:
    """The fewest steps from the parent outwards, taken greedily."""
    steps: list[Step] = []
    rest = list(axes)
    while rest:
        for count in range(min(4, len(rest)), 0, -1):
            step = _step(tuple(rest[:count]))
            if step is not None:
                steps.append(step)
                del rest[:count]
                break
    return steps


def _step(axes: tuple[Axis, ...]) -> Step | None:
    kinds = [axis.kind for axis in axes]
    if kinds == ["ball"]:
        at = Pose(translation=axes[0].point)
        return Step(axes, JointKind.SPHERICAL, (RX,), at, at)
    if kinds == ["slide"] * 3 + ["ball"]:
        return _floating(axes)
    if "ball" in kinds:
        return None
    hinges = [axis for axis in axes if axis.kind == "hinge"]
    slides = [axis for axis in axes if axis.kind == "slide"]
    if len(hinges) == 2 and not slides:
        return _universal(hinges[0], hinges[1])
    if len(hinges) > 1 or sum(axis.limited for axis in slides) > 1:
        return None
    if hinges and slides and axes[-1] is not hinges[0] and not _cylindrical(hinges[0], slides):
        return None
    return _sliding(axes, hinges, slides)


def _floating(axes: tuple[Axis, ...]) -> Step | None:
    """Three slides without ranges at right angles, and a ball after them: nothing is held."""
    *slides, ball = axes
    if any(axis.limited for axis in axes) or not all(
        _across(one, other) for i, one in enumerate(slides) for other in slides[:i]
    ):
        return None
    basis = np.column_stack([axis.direction for axis in slides])
    if np.linalg.det(basis) < 0.0:
        basis = basis[:, [1, 0, 2]]
    freedoms = tuple(TX + int(np.argmax(basis.T @ axis.direction)) for axis in slides)
    start = sum((axis.zero * axis.direction for axis in slides), np.zeros(3))
    return Step(
        axes, JointKind.FREE, (*freedoms, RX), Pose(basis, ball.point - start), Pose(basis, ball.point)
    )


def _cylindrical(hinge: Axis, slides: list[Axis]) -> bool:
    return len(slides) == 1 and _along(hinge, slides[0])


def _along(one: Axis, other: Axis) -> bool:
    return float(np.linalg.norm(np.cross(one.direction, other.direction))) <= SQUARE


def _across(one: Axis, other: Axis) -> bool:
    return abs(float(one.direction @ other.direction)) <= SQUARE


def _sliding(axes: tuple[Axis, ...], hinges: list[Axis], slides: list[Axis]) -> Step | None:
    """Slides at right angles, and a hinge after them; X is the hinge, or a slide."""
    for i, one in enumerate(slides):
        if any(not _across(one, other) for other in slides[:i]):
            return None
    if len(slides) > 3:
        return None
    # The frame in which every axis is counted the way that MuJoCo counts it.
    for main in hinges or slides:
        for second in [s for s in slides if s is not main and not _along(main, s)] or [None]:
            basis = frame_from_axes(main.direction, None if second is None else second.direction)
            seen = [basis.T @ axis.direction for axis in axes]
            if all(float(v.max()) > 1.0 - SQUARE for v in seen):
                return _slid(axes, main, slides, basis, seen)
    return None


def _slid(axes: tuple[Axis, ...], main: Axis, slides: list[Axis], basis: Array, seen: list[Array]) -> Step:
    freedoms = [(RX if axis.kind == "hinge" else TX) + int(np.argmax(v)) for axis, v in zip(axes, seen)]
    hinges = [axis for axis in axes if axis.kind == "hinge"]
    kind = kind_of(tuple(sorted(freedoms)))
    origin = main.point
    start = sum((axis.zero * axis.direction for axis in slides), np.zeros(3))
    turned = rotation_about(np.array([1.0, 0.0, 0.0]), hinges[0].zero if hinges else 0.0)
    return Step(axes, kind, tuple(freedoms), Pose(basis, origin - start), Pose(basis @ turned, origin))


def _universal(first: Axis, second: Axis) -> Step | None:
    """Z turns in the parent, X in the body.  Unity limits Z to either side alike, so other limits need two joints."""
    if not _across(first, second) or (first.limited and not first.symmetric):
        return None
    between = second.point - first.point
    common = np.cross(first.direction, second.direction)
    if abs(float(between @ common)) > SQUARE:
        return None
    origin = first.point + float(between @ first.direction) * first.direction
    basis = np.column_stack([second.direction, np.cross(first.direction, second.direction), first.direction])
    x, z = np.eye(3)[0], np.eye(3)[2]
    return Step(
        (first, second),
        JointKind.UNIVERSAL,
        (RZ, RX),
        Pose(basis @ rotation_about(z, -first.zero), origin),
        Pose(basis @ rotation_about(x, second.zero), origin),
    )
