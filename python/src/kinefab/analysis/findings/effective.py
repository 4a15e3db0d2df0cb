"""The joint that connects any two parts, whether or not constraints join them directly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...model import RX, JointKind
from ...spatial import Array, cross
from ..assembly.assemble import Assembly
from ..equations.solve import Solver
from ..freedom.finite import Candidate
from ..freedom.first_order import BlockFreedom
from ..freedom.motion import stepped
from ..freedom.rank import spans
from ..freedom.twists import TwistSpace, twist_space
from ..pairs.candidates import Geometry, candidates

POSES = 3
"""Other poses at which a joint found from twists must have kept its axis, point and pitch."""
WALK = 0.1
KEPT = 1e-7


@dataclass(frozen=True, slots=True, eq=False)
class Effective:
    """The relative motion of two bodies.

    kind: of the joint, GENERAL where there is none.  dof: dimension of the relative velocities.
    instantaneous: the twists have an axis or point that does not stay (a pole): no joint.
    axes, origin: joint frame, WORLD at the closed pose.
    """

    kind: JointKind
    dof: int
    axes: Array
    origin: Array
    instantaneous: bool = False


def effective(assembly: Assembly, body_a: int, body_b: int) -> Effective:
    """The effective joint of body b against body a (numbers of the assembly)."""
    origin, length = assembly.relative.center[body_b], float(assembly.relative.length[body_b])
    columns = _relative_twists(assembly, body_a, body_b, origin, length)
    size = np.linalg.norm(columns, axis=0)
    columns = columns[:, size > 1e-9]
    basis = spans([columns / np.linalg.norm(columns, axis=0)], 1e-6)[0]
    axes = assembly.relative.axes
    space = twist_space(basis, origin, length, axes)
    point = space.center if space.center is not None else origin
    for candidate in candidates(
        space, Geometry(point[None], np.zeros((0, 3)), np.zeros((0, 3)), axes), length
    ):
        if candidate.dof == basis.shape[1]:
            stays = _stays(assembly, body_a, body_b, candidate, length)
            return Effective(
                candidate.kind if stays else JointKind.GENERAL,
                basis.shape[1],
                candidate.axes,
                candidate.origin,
                not stays,
            )
    return Effective(JointKind.GENERAL, basis.shape[1], axes, origin, _has_pole(space))


def _has_pole(space: TwistSpace) -> bool:
    return space.r == 1 and space.center is not None


def _path(assembly: Assembly, body: int) -> list[int]:
    """Bodies from one whose block is its own out to the island's root: each in a further block."""
    path: list[int] = []
    blocks = assembly.blocks
    while blocks.block[body] >= 0:
        path.append(body)
        body = int(blocks.root[blocks.block[body]])
    path.append(body)
    return path


def _relative_twists(assembly: Assembly, body_a: int, body_b: int, origin: Array, length: float) -> Array:
    """Scaled twists of b against a about ``origin``: one set of columns for each block between them."""
    relative, blocks = assembly.relative, assembly.blocks
    own: dict[int, BlockFreedom] = {}
    for freedom in assembly.freedoms:
        own[int(blocks.block[freedom.bodies[0]])] = freedom
    sides: dict[int, Array] = {}
    for body, sign in ((body_b, 1.0), (body_a, -1.0)):
        for step in _path(assembly, body):
            block = int(blocks.block[step])
            if block < 0:
                continue
            freedom = own[block]
            at = 6 * int(np.flatnonzero(freedom.bodies == step)[0])
            twist = freedom.basis[at : at + 6]
            arm = origin - relative.center[step]
            v = twist[:3] * relative.length[step] + cross(twist[3:].T, arm).T
            moved = sign * np.concatenate([v / length, twist[3:]])
            sides[block] = sides.get(block, 0.0) + moved
    columns = list(sides.values())
    if int(blocks.island[body_a]) != int(blocks.island[body_b]):
        columns.append(np.eye(6))
    return np.concatenate(columns, axis=1) if columns else np.zeros((6, 0))


def _stays(assembly: Assembly, body_a: int, body_b: int, candidate: Candidate, length: float) -> bool:
    """Whether walks along the whole mechanism keep the locked coordinates of the candidate."""
    draw = np.random.default_rng(17)
    solver: Solver = assembly.solver
    for _ in range(POSES):
        state = stepped(solver, assembly.freedoms, assembly.start, WALK, draw)
        rotation, translation = solver.system.displacement(state)
        turn_a, shift_a = _absolute(assembly, rotation, translation, body_a)
        turn_b, shift_b = _absolute(assembly, rotation, translation, body_b)
        turn = turn_a.T @ turn_b
        shift = turn_a.T @ (turn_b @ candidate.origin + shift_b - shift_a) - candidate.origin
        turn, shift = candidate.axes.T @ turn @ candidate.axes, candidate.axes.T @ shift
        if not _allowed(candidate, turn, shift / length):
            return False
    return True


def _absolute(assembly: Assembly, rotation: Array, translation: Array, body: int) -> tuple[Array, Array]:
    turn, shift = np.eye(3), np.zeros(3)
    for step in _path(assembly, body):
        if assembly.blocks.block[step] >= 0:
            turn, shift = rotation[step] @ turn, rotation[step] @ shift + translation[step]
    return turn, shift


def _allowed(candidate: Candidate, turn: Array, shift: Array) -> bool:
    if candidate.kind is JointKind.SCREW:
        return True
    turning = [i - RX for i in candidate.unlocked if i >= RX]
    off = [abs(shift[i]) for i in range(3) if i not in candidate.unlocked]
    if not turning:
        off.append(float(np.abs(turn - np.eye(3)).max()))
    elif len(turning) == 1:
        off.append(float(np.abs(turn[:, turning[0]] - np.eye(3)[:, turning[0]]).max()))
    return max(off, default=0.0) < KEPT
