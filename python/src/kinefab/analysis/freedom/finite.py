"""The test that decides: does a joint's whole finite motion keep the constraints it stands for?

Twists are first order.  A rod, a tangency and a point on a plane have the same ones; which joint it is,
only finite motions tell.  Equations are analytic, so a few random motions settle it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum
from typing import cast

import numpy as np
from scipy.sparse import csr_matrix

from ...model import RX, RY, RZ, TX, UNLOCKED, Freedom, JointKind, freedoms_of, unlocked_of
from ...spatial import Array, IntArray
from ..equations.atoms import USED, Atom, evaluate
from ..equations.system import System, exponential
from .stacks import alike

SAMPLES = 24
REACH = 0.4
"""Translations sampled, as a fraction of the characteristic length, to either side."""
TURN_REACH = 0.7
"""Rotations sampled, radians, to either side."""
EXACT = 1e-9
"""Misfit, as a fraction of the characteristic length (or radians), up to which a motion fits."""


@dataclass(frozen=True, slots=True, eq=False)
class Candidate:
    """A joint that may stand for a pair's constraints.

    axes: joint frame in the WORLD, columns X, Y, Z.  origin: WORLD, metres.
    first_is_a: the pair's first body is the joint's ``a``.  lead: metres a turn of a SCREW.
    """

    kind: JointKind
    axes: Array
    origin: Array
    first_is_a: bool = True
    lead: float = 0.0
    freedoms: tuple[Freedom, ...] = field(default=())

    @property
    def six(self) -> tuple[Freedom, ...]:
        """All six freedoms, TX..RZ."""
        return self.freedoms or freedoms_of(self.kind)

    @property
    def unlocked(self) -> tuple[int, ...]:
        return unlocked_of(self.freedoms) if self.freedoms else UNLOCKED.get(self.kind, ())

    @property
    def dof(self) -> int:
        return len(self.unlocked) - (self.kind is JointKind.SCREW)


def motions(candidates: list[Candidate], lengths: Array, samples: int, seed: int = 7) -> tuple[Array, Array]:
    """Random motions of b against a that each joint allows, in the joint frame.

    Returns rotations (candidates, samples, 3, 3) and translations (candidates, samples, 3): the pose of b's
    frame in a's, with the semantics of a D6 joint: translations along a's axes; with only Y (Z) locked, X
    stays fixed in b and Z (Y) in a; with only X locked, the swing is homokinetic.
    """
    draw = np.random.default_rng(seed).uniform(-1.0, 1.0, (samples, 6))
    q = np.repeat(draw[None], len(candidates), axis=0)
    q[..., :3] *= (REACH * lengths)[:, None, None]
    q[..., 3:] *= TURN_REACH
    rotation = np.empty((len(candidates), samples, 3, 3))
    for (unlocked, screw), own in alike((c.unlocked, c.kind is JointKind.SCREW) for c in candidates):
        q[own] *= [i in unlocked for i in range(6)]
        if screw:
            members: list[int] = own.tolist()
            lead = np.array([candidates[i].lead for i in members])
            q[own, :, TX] = lead[:, None] / math.tau * q[own, :, RX]
        turning = tuple(i for i in unlocked if i >= RX)
        if turning == (RX, RZ):
            rotation[own] = _about(2, q[own, :, RZ]) @ _about(0, q[own, :, RX])
        elif turning == (RX, RY):
            rotation[own] = _about(1, q[own, :, RY]) @ _about(0, q[own, :, RX])
        else:
            rotation[own] = exponential(q[own, :, 3:])
    return rotation, q[..., :3]


def _about(axis: int, angle: Array) -> Array:
    w = np.zeros(angle.shape + (3,))
    w[..., axis] = angle
    return exponential(w)


def world_motions(
    candidates: list[Candidate], lengths: Array, samples: int, seed: int = 7
) -> tuple[Array, Array]:
    """Displacements of each pair's second body (first at rest) about the candidate's origin, in the WORLD."""
    rotation, shift = motions(candidates, lengths, samples, seed)
    axes = np.array([c.axes for c in candidates])[:, None]
    back = np.swapaxes(axes, 2, 3)
    rotation = axes @ rotation @ back
    shift = (shift[:, :, None] @ back)[:, :, 0]
    swapped = np.flatnonzero([not c.first_is_a for c in candidates])
    if len(swapped):
        rotation[swapped] = np.swapaxes(rotation[swapped], 2, 3)
        shift[swapped] = -np.einsum("nsij,nsj->nsi", rotation[swapped], shift[swapped])
    return rotation, shift


class Moves(IntEnum):
    """Which side of an atom is on the body that is displaced."""

    A = 0
    B = 1
    NEITHER = 2


def chain_misfit(
    system: System, second: int, near: Candidate, far: Candidate, length: float, samples: int = SAMPLES
) -> float:
    """As ``misfits``, of one pair whose second body hangs on the first by two joints, ``near`` first."""
    lengths = np.array([length])
    turn, shift = world_motions([near], lengths, samples)
    far_turn, far_shift = world_motions([far], lengths, samples, seed=8)
    arm = far.origin - near.origin
    shift = (turn @ (arm + far_shift)[..., None])[..., 0] + shift - arm
    one = np.zeros(len(system.kind), dtype=np.int64)
    moved = turn @ far_turn, shift, far.origin[None]
    return float(_violations(system, np.array([second]), one, *moved, lengths)[0])


def misfits(
    system: System,
    second: IntArray,
    atom_pair: IntArray,
    candidates: list[Candidate],
    lengths: Array,
    samples: int = SAMPLES,
) -> Array:
    """Largest violation of each pair's rows over its candidate's motions, shape (pairs,).

    system: its atoms all join ``second[p]`` of the pair p = ``atom_pair[atom]`` with the pair's other body, or lie within one
    of the two, and its rows hold atoms of one pair each.  lengths: metres, by which each pair's lengths are measured.
    """
    rotation, shift = world_motions(candidates, lengths, samples)
    origin = np.array([c.origin for c in candidates])
    return _violations(system, second, atom_pair, rotation, shift, origin, lengths)


def _violations(
    system: System,
    second: IntArray,
    atom_pair: IntArray,
    rotation: Array,
    shift: Array,
    origin: Array,
    lengths: Array,
) -> Array:
    """Largest violation of each pair's rows, its second body displaced about ``origin``, shape (pairs,).

    rotation: shape (pairs, samples, 3, 3).  shift: shape (pairs, samples, 3).
    """
    samples = rotation.shape[1]
    value = np.zeros((len(system.kind), samples))
    moves = np.where(system.body_b == second[atom_pair], Moves.B, Moves.A)
    moves[system.body_a == system.body_b] = Moves.NEITHER
    for kind in Atom:
        for side in Moves:
            atoms = np.flatnonzero((system.kind == kind) & (moves == side))
            if not len(atoms):
                continue
            p, used = atom_pair[atoms], USED[kind].split()
            turning = rotation.take(p, axis=0)

            def turn(v: Array, turning: Array = turning) -> Array:
                return np.einsum("nsij,nj->nsi", turning, v)

            def stay(v: Array) -> Array:
                return np.broadcast_to(v[:, None], (len(v), samples, 3))

            def move(points: Array, p: IntArray = p, turn: Callable[[Array], Array] = turn) -> Array:
                return turn(points - origin[p]) + origin[p][:, None] + shift[p]

            on_a, at_a = (turn, move) if side is Moves.A else (stay, stay)
            on_b, at_b = (turn, move) if side is Moves.B else (stay, stay)
            d = np.broadcast_to(system.d[atoms][:, None], (len(atoms), samples))
            ways = {"p_a": at_a, "a": on_a, "k": on_a, "p_b": at_b, "b": on_b}
            p_a, a, k, p_b, b = (
                (way if name in used else stay)(getattr(system, name)[atoms]) for name, way in ways.items()
            )
            value[atoms] = evaluate(kind, p_a, a, k, p_b, b, d)[0]
    angles = system.kind == Atom.ANG
    value[angles] = np.remainder(value[angles] + np.pi, math.tau) - np.pi
    scale = system.weight / np.where(system.is_length[system.row], lengths[atom_pair], 1.0)
    gather = csr_matrix((scale, (system.row, np.arange(len(scale)))), shape=(system.rows, len(scale)))
    gathered = cast(Array, gather @ value)  # sparse times dense is dense
    by_row = np.abs(gathered).max(axis=1)
    worst = np.zeros(len(second))
    row_pair = np.zeros(system.rows, dtype=np.int64)
    row_pair[system.row] = atom_pair
    np.maximum.at(worst, row_pair, by_row)
    return worst
