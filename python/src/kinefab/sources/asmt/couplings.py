"""Gears, racks and screws of OndselSolver as couplings between the coordinates of the joints that carry them.

The solver's equations tie two parts directly: a gear's angles are counted from the line between the two centres, a
screw's travel and turn from part to part.  A coupling ties joint coordinates, so each side is followed along the joints
to the body that carries both: about a wheel's axis through hinges on that axis, along a rack through slides that way.
Where a carrier turns too (a planet's), the coordinates on the way add up.

Source: ``GearConstraintIJ``, ``RackPinConstraintIJ``, ``ScrewConstraintIJ``: aG there is zero at the exported pose.
"""

from __future__ import annotations

import math
from collections import deque
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from ...model import RX, TX, Coupling, CouplingKind, Joint, JointKind, Term
from ...spatial import Array, Pose
from .joints import Statement, world

SAME_AXIS_LENGTH = 1e-5
"""Metres that two axes may be apart and count as one."""
ALONG = 1.0 - 1e-9
"""Cosine from which on two directions are one."""

TURNING = {JointKind.REVOLUTE: RX, JointKind.CYLINDRICAL: RX, JointKind.SCREW: RX}
SLIDING = {JointKind.PRISMATIC: TX, JointKind.CYLINDRICAL: TX}

Ends = dict[int, tuple[tuple[Joint, int, float], ...]]
"""For each body that can be reached, the coordinates (joint, freedom, sign) that add up to the motion against it."""


class UncarriedError(Exception):
    """No body carries both sides by joints that the coordinates could be counted in."""


@dataclass(frozen=True, slots=True, eq=False)
class Bodies:
    """Which nodes are one body.  of: body by node.  ground: the ground's body.  poses: of all nodes, WORLD."""

    of: Sequence[int]
    ground: int
    poses: Sequence[Pose]

    def body(self, node: int | None) -> int:
        return self.ground if node is None else self.of[node]


def coupling_of(statement: Statement, joints: Iterable[Joint], bodies: Bodies) -> Coupling:
    """The coupling of a gear, a rack or a screw.  Raises UncarriedError."""
    joints = list(joints)
    i, j = (world(marker, bodies.poses) for marker in (statement.i, statement.j))
    axis_i, axis_j = i.rotation[:, 2], j.rotation[:, 2]
    if statement.kind == "GearJoint":
        # angle_J + (r_I / r_J) angle_I = constant, each about its own z
        first = _reach(statement.i.node, joints, bodies, _turns_about(i.translation, axis_i))
        second = _reach(statement.j.node, joints, bodies, _turns_about(j.translation, axis_j))
        kind = CouplingKind.GEAR if statement.value * statement.second > 0.0 else CouplingKind.BELT
        weights = (statement.value / statement.second, 1.0)
    else:
        along = i.rotation[:, 0] if statement.kind == "RackPinionJoint" else axis_i
        first = _reach(statement.i.node, joints, bodies, _slides_along(along))
        second = _reach(statement.j.node, joints, bodies, _turns_about(j.translation, axis_i))
        kind = CouplingKind.RACK
        if statement.kind == "RackPinionJoint":
            # The x of J seen from I, + radius angle = constant: I goes the other way.
            weights = (
                -1.0,
                statement.value,
            )
        else:
            weights = (-math.tau, -statement.value)  # 2 pi z - pitch angle = constant, z of J seen from I
    return _coupling(statement, kind, first, second, weights, bodies)


def _coupling(
    statement: Statement,
    kind: CouplingKind,
    first: Ends,
    second: Ends,
    weights: tuple[float, float],
    bodies: Bodies,
) -> Coupling:
    """weights[0] * (motion of I) + weights[1] * (motion of J) = constant, solved for one coordinate."""
    own = {bodies.body(statement.i.node), bodies.body(statement.j.node)}
    carriers = [body for body in first if body in second and body not in own]
    if not carriers:
        raise UncarriedError
    carrier = min(carriers, key=lambda b: (len(first[b]) + len(second[b]), b != bodies.ground, b))
    sums: dict[tuple[str, int], float] = {}
    here: dict[tuple[str, int], float] = {}
    for ends, weight in ((first[carrier], weights[0]), (second[carrier], weights[1])):
        for joint, freedom, sign in ends:
            key = (joint.id, freedom)
            sums[key] = sums.get(key, 0.0) + weight * sign
            here[key] = _measured(joint, freedom, bodies.poses)
    sums = {key: factor for key, factor in sums.items() if factor != 0.0}
    if len(sums) < 2:
        raise UncarriedError
    last = (second[carrier][-1][0].id, second[carrier][-1][1])
    led = last if last in sums else next(reversed(sums))
    terms = tuple(Term(*key, -factor / sums[led]) for key, factor in sums.items() if key != led)
    offset = here[led] - sum(term.ratio * here[(term.joint, term.freedom)] for term in terms)
    return Coupling(statement.id, kind, led[0], led[1], terms, offset, statement.where)


def _reach(node: int | None, joints: list[Joint], bodies: Bodies, counts: _Counts) -> Ends:
    """The bodies that can be reached from a node's body by joints that count, the nearest first."""
    start = bodies.body(node)
    found: Ends = {start: ()}
    waiting = deque([start])
    while waiting:
        body = waiting.popleft()
        for joint in joints:
            a, b = bodies.body(joint.a), bodies.body(joint.b)
            if a == b or body not in (a, b):
                continue
            other = a if body == b else b
            if other in found or (counted := counts(joint, bodies.poses)) is None:
                continue
            freedom, sign = counted
            # The joint counts b against a; here the near side counts against the far one.
            found[other] = ((joint, freedom, sign if body == b else -sign), *found[body])
            waiting.append(other)
    return found


_Counts = Callable[[Joint, Sequence[Pose]], "tuple[int, float] | None"]


def _axis(joint: Joint, poses: Sequence[Pose]) -> Pose:
    return _in_world(joint.a, joint.frame_a, poses)


def _in_world(node: int | None, frame: Pose, poses: Sequence[Pose]) -> Pose:
    return frame if node is None else poses[node] @ frame


def _turns_about(point: Array, direction: Array) -> _Counts:
    def counts(joint: Joint, poses: Sequence[Pose]) -> tuple[int, float] | None:
        if joint.kind not in TURNING:
            return None
        frame = _axis(joint, poses)
        cosine = float(frame.rotation[:, 0] @ direction)
        apart = np.cross(point - frame.translation, direction)
        if abs(cosine) < ALONG or float(np.linalg.norm(apart)) > SAME_AXIS_LENGTH:
            return None
        return TURNING[joint.kind], math.copysign(1.0, cosine)

    return counts


def _slides_along(direction: Array) -> _Counts:
    def counts(joint: Joint, poses: Sequence[Pose]) -> tuple[int, float] | None:
        if joint.kind not in SLIDING:
            return None
        cosine = float(_axis(joint, poses).rotation[:, 0] @ direction)
        return None if abs(cosine) < ALONG else (SLIDING[joint.kind], math.copysign(1.0, cosine))

    return counts


def _measured(joint: Joint, freedom: int, poses: Sequence[Pose]) -> float:
    """The joint's coordinate at the exported pose, metres or radians."""
    between = _axis(joint, poses).inverse() @ _in_world(joint.b, joint.frame_b, poses)
    if freedom == TX:
        return float(between.translation[0])
    return math.atan2(between.rotation[2, 1], between.rotation[1, 1])
