"""What a joint of OndselSolver holds, as a joint or a constraint of the scene.

Each joint ties marker J to marker I; a marker's Z is its axis.  The solver's angles turn J's x from I's x about I's z
and its lengths run from I to J along I's z, whichever way J's z points.

Source: OndselSolver's own constraints (``*Joint::initializeGlobally``): products of axes that are zero, so that an axis
may point either way and a fixed part may stand half a turn from its markers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from ...model import (
    Constraint,
    ConstraintKind,
    Feature,
    FeatureKind,
    Freedom,
    Joint,
    JointKind,
    Motion,
    Sense,
    freedoms_of,
)
from ...spatial import Array, Pose

Range = tuple[float, float]
UNLIMITED: Range = (-math.inf, math.inf)

JOINTS = {
    "FixedJoint": JointKind.FIXED,
    "RevoluteJoint": JointKind.REVOLUTE,
    "CylindricalJoint": JointKind.CYLINDRICAL,
    "TranslationalJoint": JointKind.PRISMATIC,
    "SphericalJoint": JointKind.SPHERICAL,
}
"""Kinds that are joints by themselves."""

_LINE, _PLANE, _POINT = FeatureKind.LINE, FeatureKind.PLANE, FeatureKind.POINT
CONSTRAINTS = {
    "ParallelAxesJoint": (ConstraintKind.PARALLEL, _LINE, _LINE),
    "PerpendicularJoint": (ConstraintKind.PERPENDICULAR, _LINE, _LINE),
    "AngleJoint": (ConstraintKind.ANGLE, _LINE, _LINE),
    "PlanarJoint": (ConstraintKind.DISTANCE, _PLANE, _PLANE),
    "PointInPlaneJoint": (ConstraintKind.DISTANCE, _PLANE, _POINT),
    "LineInPlaneJoint": (ConstraintKind.DISTANCE, _PLANE, _LINE),
    "PointInLineJoint": (ConstraintKind.COINCIDENT, _LINE, _POINT),
    "RevCylJoint": (ConstraintKind.DISTANCE, _LINE, _LINE),
    "RevRevJoint": (ConstraintKind.DISTANCE, _LINE, _LINE),
    "CylSphJoint": (ConstraintKind.DISTANCE, _LINE, _POINT),
    "SphSphJoint": (ConstraintKind.DISTANCE, _POINT, _POINT),
    "UniversalJoint": (ConstraintKind.UNIVERSAL, _LINE, _LINE),
    "NoRotationJoint": (ConstraintKind.LOCK_ORIENTATION, FeatureKind.FRAME, FeatureKind.FRAME),
}
"""Kinds that are geometric constraints, between what of I and what of J."""
UNSIGNED = frozenset({"RevCylJoint", "RevRevJoint", "CylSphJoint", "SphSphJoint"})
"""Their distance has no side."""
CONSTANT_VELOCITY = "ConstantVelocityJoint"

COUPLINGS = frozenset({"GearJoint", "RackPinionJoint", "ScrewJoint"})
"""Kinds that couple the motions of two parts."""

HALF_TURNS = tuple(np.diag(d) for d in ([1.0, 1, 1], [1.0, -1, -1], [-1.0, 1, -1], [-1.0, -1, 1]))
"""About nothing, x, y and z."""
TURNS_OF = {JointKind.FIXED: (0, 1, 2, 3), JointKind.PRISMATIC: (0, 1, 2, 3), JointKind.SPHERICAL: (0,)}
"""By which half turns J may stand off I where the kind's axes are as good as aligned; of all others (0, 1)."""
CLOSED = 1e-6
"""Metres and radians within which a fixed joint's markers meet: what the solver leaves."""
TO_X_MAIN = np.array([[0.0, 1, 0], [0, 0, 1], [1, 0, 0]])
"""Columns: z, x, y: the scene's joint frames have their axis along X."""


@dataclass(frozen=True, slots=True, eq=False)
class Marker:
    """A frame on a node (None: the ground): in the node's frame, scene axes, metres."""

    node: int | None
    frame: Pose


@dataclass(frozen=True, slots=True, eq=False)
class Statement:
    """A joint as the solver is given it.

    kind: the solver's word (``RevoluteJoint``).  value, second: metres or radians: the distance, offset, angle, pitch
    radius, pitch (a turn) or radius I, and radius J.  length, angle: limits that are switched on.
    raw_kind: the source's word.
    """

    id: str
    kind: str
    i: Marker
    j: Marker
    value: float = 0.0
    second: float = 0.0
    length: Range = UNLIMITED
    angle: Range = UNLIMITED
    name: str = ""
    raw_kind: str = ""
    where: str = ""
    because: tuple[str, ...] = field(default=())


def world(marker: Marker, poses: Sequence[Pose]) -> Pose:
    """The marker's frame in the world."""
    return marker.frame if marker.node is None else poses[marker.node] @ marker.frame


def joint_of(statement: Statement, poses: Sequence[Pose]) -> Joint:
    """The scene's joint of a statement whose kind is in ``JOINTS``.  poses: of all nodes, WORLD."""
    kind = JOINTS[statement.kind]
    i, j = statement.i, statement.j
    turned = HALF_TURNS[_half_turn(kind, world(i, poses), world(j, poses))]
    if j.node is None:  # a scene's joint hangs on a node: I seen from J, both turned round, reads the same
        i, j = j, i
        back = HALF_TURNS[0] if kind in (JointKind.FIXED, JointKind.SPHERICAL) else HALF_TURNS[1]
        frame_a = Pose(i.frame.rotation @ turned @ back, i.frame.translation)
        frame_b = Pose(j.frame.rotation @ back, j.frame.translation)
    else:
        frame_a, frame_b = i.frame, Pose(j.frame.rotation @ turned, j.frame.translation)
    assert j.node is not None
    given: dict[str, Freedom] = {}
    if kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL):
        given["rx"] = limited(statement.angle)
    if kind in (JointKind.PRISMATIC, JointKind.CYLINDRICAL):
        given["tx"] = limited(statement.length)
    return Joint(
        statement.id,
        kind,
        i.node,
        j.node,
        x_main(frame_a),
        x_main(frame_b),
        freedoms_of(kind, **given),
        name=statement.name,
        because=statement.because,
        where=statement.where,
    )


def is_open(statement: Statement, poses: Sequence[Pose]) -> bool:
    """Whether the two markers of a fixed joint do not meet in the file, so that its parts are still to be moved."""
    i, j = world(statement.i, poses), world(statement.j, poses)
    turned = j.rotation @ HALF_TURNS[_half_turn(JointKind.FIXED, i, j)]
    apart = float(np.linalg.norm(i.translation - j.translation))
    return apart > CLOSED or float(np.abs(i.rotation - turned).max()) > CLOSED


def frames_together(statement: Statement, poses: Sequence[Pose]) -> Constraint:
    """A fixed joint as a constraint that moves its parts together, where a joint would take them as they stand."""
    turned = HALF_TURNS[_half_turn(JointKind.FIXED, world(statement.i, poses), world(statement.j, poses))]
    j = Marker(statement.j.node, Pose(statement.j.frame.rotation @ turned, statement.j.frame.translation))
    return Constraint(
        statement.id,
        ConstraintKind.COINCIDENT,
        (feature(statement.i, FeatureKind.FRAME), feature(j, FeatureKind.FRAME)),
        name=statement.name,
        raw_kind=statement.raw_kind or statement.kind,
        where=statement.where,
    )


def constraints_of(statement: Statement) -> list[Constraint]:
    """The scene's constraints of a statement whose kind is in ``CONSTRAINTS``: a link between two hinges is a distance of their
    axes, and J's point in the plane across I's."""
    found = [_constraint(statement)]
    if statement.kind == "RevRevJoint":
        level = replace(statement, id=f"{statement.id} level", kind="PointInPlaneJoint", value=0.0)
        found.append(_constraint(replace(level, raw_kind=statement.raw_kind or statement.kind)))
    return found


def _constraint(statement: Statement) -> Constraint:
    kind, of_i, of_j = CONSTRAINTS[statement.kind]
    value = abs(statement.value) if statement.kind in UNSIGNED else statement.value
    reading: dict[str, str] = {}
    if kind is ConstraintKind.DISTANCE and of_i is _PLANE:
        reading["offset"] = "along_normal"
    elif statement.kind in UNSIGNED and value == 0.0:  # no distance has no gradient; it is one in the other
        kind = ConstraintKind.COINCIDENT
    elif statement.kind in ("RevCylJoint", "RevRevJoint"):
        reading["line_line_distance"] = "parallel"
    return Constraint(
        statement.id,
        kind,
        (feature(statement.i, of_i), feature(statement.j, of_j)),
        value,
        sense=Sense.EITHER,
        name=statement.name,
        raw_kind=statement.raw_kind or statement.kind,
        reading=reading,
        where=statement.where,
    )


def feature(marker: Marker, kind: FeatureKind) -> Feature:
    """The marker's point, its z axis, or the plane across it."""
    axes, point = marker.frame.rotation, marker.frame.translation
    if kind is _POINT:
        return Feature(marker.node, kind, point)
    return Feature(marker.node, kind, point, axes[:, 2], axes[:, 0])


def limited(given: Range) -> Freedom:
    """A freedom with a range, metres or radians; free where the range is none."""
    lower, upper = given
    return Freedom(Motion.FREE if given == UNLIMITED else Motion.LIMITED, lower, upper)


def x_main(frame: Pose) -> Pose:
    """A frame with its axis along Z as one with it along X."""
    return Pose(frame.rotation @ TO_X_MAIN, frame.translation)


def _half_turn(kind: JointKind, i: Pose, j: Pose) -> int:
    """Which of ``HALF_TURNS`` of J comes closest to I, among those that the joint holds as well as none."""
    between = i.rotation.T @ j.rotation
    if kind in (JointKind.REVOLUTE, JointKind.CYLINDRICAL):
        return 0 if between[2, 2] >= 0.0 else 1
    return max(TURNS_OF[kind], key=lambda k: (round(float(np.trace(between @ HALF_TURNS[k])), 9), -k))


def opposed(statement: Statement, poses: Sequence[Pose]) -> bool:
    """Whether the two z axes point against each other."""
    axes: list[Array] = [world(marker, poses).rotation[:, 2] for marker in (statement.i, statement.j)]
    return bool(axes[0] @ axes[1] < 0.0)
