"""A mechanism's motion as plain data, for a program that draws it: each block against its root.

A block of one joint is that joint; one with one freedom is a curve, told in poses fine enough to be interpolated; any
other keeps its equations, to be solved where it is shown.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...model import RX, JointKind, Scene
from ...spatial import Array, quaternions_from_matrices, without_flips
from ..equations.scene_equations import is_about_an_axis_of_b, joint_sides
from ..equations.system import System
from .coordinates import DrivenBlock
from .mechanism import Mechanism
from .walk import Poses, Walk
from .way import Way, walked

TURN_KNOTS = 181
"""Poses of a whole turn; a cubic between them is off by some 1e-7 of the size."""
MOST_CURVES = 60
"""Curves baked; the loops beyond are solved where they are shown."""
CANDIDATES = 4
"""Coordinates tried as a curve's own until one goes all the way round."""
ROUND = 1e-6
"""Difference of poses a turn apart up to which the mechanism has come round."""
INSIDE = 1e-6
"""Share of a range left out at a dead point, where a coordinate no longer tells the pose."""

NEAR = 1e-6
"""How exactly a dead point is looked for, radians or fractions of the length."""

Baked = dict[str, Any]


def baked(mechanism: Mechanism) -> list[Baked]:
    """Its blocks, roots first.

    Of each: ``root`` and ``bodies`` (numbers of the assembly's bodies, 0 the ground); ``coordinates``, names; ``held``,
    those that are its freedoms; ``mode``, with what that needs: ``joint``, ``curve`` or ``solve``.  Displacements are of
    the bodies against the root, from the closed pose; radians and metres, right-handed.
    """
    found: list[Baked] = []
    order = mechanism.generation_of
    curves = 0
    for block in sorted(mechanism.blocks, key=lambda block: order[block.part]):
        root, bodies = mechanism.bodies_of(block)
        held = sorted(block.independent())
        entry: Baked = {
            "root": root,
            "bodies": bodies,
            "coordinates": [mechanism.name_of(block, i) for i in range(len(block.joints))],
            "held": [mechanism.name_of(block, i) for i in held],
        }
        single = _is_single(block)
        curve = None
        if not single and block.mobility == 1 and held and curves < MOST_CURVES:
            curve, curves = _curve(block, held[0]), curves + 1
        if single:
            entry |= {"mode": "joint"} | _joint(block, mechanism.scene)
        elif curve is not None:
            driver = curve.pop("driver")
            entry |= {"mode": "curve", "held": [mechanism.name_of(block, driver)]} | curve
        else:
            entry |= {"mode": "solve"} | _equations(block)
        found.append(entry)
    return found


def _is_single(block: DrivenBlock) -> bool:
    """Whether the block is one joint with at most two rotations, and nothing else."""
    if len(block.measured.bodies) != 1 or len({driven.joint.id for driven, _ in block.joints}) != 1:
        return False
    driven = block.joints[0][0]
    turns = [i for i in driven.joint.unlocked if i >= RX]
    owners = np.unique(block.measured.system.owner)
    plain = driven.joint.kind is not JointKind.SCREW and driven.moving == driven.joint.unlocked
    return plain and len(turns) < 3 and len(owners) == 1


def _joint(block: DrivenBlock, scene: Scene) -> Baked:
    """frame: of a at the closed pose, WORLD, rows of 3 x 4; start: of b.  inverse: whether a is what moves."""
    joint, first = block.joint(0)
    sides = joint_sides(joint, scene)
    frame, start = (np.column_stack([s.z, s.x, s.y, s.p]).tolist() for s in sides)
    probe = block.measured.probe
    of_a = probe.body_b if is_about_an_axis_of_b(first, joint) else probe.body_a
    return {
        "frame": frame,
        "start": start,
        "inverse": bool(of_a[0] != 0),
        "freedoms": [freedom for _, freedom in block.joints],
    }


def _curve(block: DrivenBlock, first: int) -> Baked | None:
    """The block's poses over its most telling coordinate."""
    best: Baked | None = None
    order = [first, *(i for i in block.order() if i != first)]
    for i in order[:CANDIDATES]:
        if not block.measured.rotary[i] and best is not None:
            continue
        found = _over(block, i)
        if found is not None and (best is None or found["reach"] > best["reach"]):
            best = found
        if best is not None and best["whole"]:
            break
    return best


def _over(block: DrivenBlock, i: int) -> Baked | None:
    """Both ways from where a coordinate stands, to its limits, dead points, a turn, or the length many times."""
    measured = block.measured
    unit = 1.0 if measured.rotary[i] else measured.length
    far = math.tau if measured.rotary[i] else 4.0 * measured.length
    start = measured.read(measured.start, measured.turns)[0]
    if float(np.linalg.norm(block.rates[i])) < 1e-9:
        return None
    ends, dead = [float(start[i])] * 2, [False, False]
    for k, sign in enumerate((-1.0, 1.0)):
        way = _way(block, i, start[i] + sign * far, np.array([0.0, 1.0]))
        ends[k] = float(start[i] + sign * far * way.reached)
        dead[k] = way.reached < 1.0 and way.limit is None
    turns = measured.rotary[i] and ends[1] - ends[0] >= 2.0 * far - 1e-9
    count = int(np.clip(TURN_KNOTS * (ends[1] - ends[0]) / unit / math.tau, 25, 4 * TURN_KNOTS))
    if turns:
        whole = _way(block, i, start[i] + math.tau, np.array([0.0, 1.0]))
        if _came_round(whole.poses):
            ends, count = [float(start[i]), float(start[i]) + math.tau], TURN_KNOTS
        else:
            turns = False
    return {
        "driver": i,
        "whole": bool(turns),
        "reach": (ends[1] - ends[0]) / unit,
        **_sampled(block, i, ends, dead, count),
    }


def _way(block: DrivenBlock, i: int, target: float, shares: Array) -> Way:
    walk = Walk(block.measured, [i], NEAR)
    before = block.measured.read(block.measured.start, block.measured.turns)[0]
    return walked(block, walk, np.array([target]), shares, before)


def _came_round(poses: Poses) -> bool:
    turn = np.abs(poses.rotation[-1] - poses.rotation[0]).max()
    return len(poses.at) > 1 and bool(max(turn, np.abs(poses.shift[-1] - poses.shift[0]).max()) < ROUND)


def _sampled(block: DrivenBlock, i: int, ends: Sequence[float], dead: Sequence[bool], count: int) -> Baked:
    """rotations: (knots, n, 4).  shifts: (knots, n, 3).  values: (knots, k).

    even: whether the knots are spaced evenly in the driver; else as the cosine, close together at dead points.
    """
    start = float(block.measured.read(block.measured.start, block.measured.turns)[0][i])
    margin = INSIDE * (ends[1] - ends[0])
    low, high = ends[0] + margin * dead[0], ends[1] - margin * dead[1]
    u = np.linspace(0.0, 1.0, count)
    even = not any(dead)
    at = low + (high - low) * (u if even else 0.5 - 0.5 * np.cos(math.pi * u))
    pieces: list[Poses] = []
    values: list[Array] = []
    for sign in (-1.0, 1.0):
        side = at[at < start] if sign < 0.0 else at[at >= start]
        end = low if sign < 0.0 else high
        if not len(side):
            continue
        shares = np.abs((side - start) / (end - start)) if end != start else np.zeros(len(side))
        shares = np.clip(shares[::-1] if sign < 0.0 else shares, 0.0, 1.0)
        way = _way(block, i, end, shares)
        flip = slice(None, None, -1) if sign < 0.0 else slice(None)
        pieces.append(Poses(*(getattr(way.poses, f)[flip] for f in ("at", "rotation", "shift", "angle"))))
        values.append(way.values[flip])
    rotation = np.concatenate([p.rotation[:, 1:] for p in pieces])
    shift = np.concatenate([p.shift[:, 1:] for p in pieces])
    center = block.measured.system.center[1:]
    moves = center + shift - np.einsum("fbij,bj->fbi", rotation, center)
    return {
        "low": low,
        "high": high,
        "even": even,
        "values": np.concatenate(values),
        "rotations": without_flips(quaternions_from_matrices(rotation)),
        "shifts": moves,
    }


def _equations(block: DrivenBlock) -> Baked:
    """system: the block's atoms and rows, scaled.  probe: those of its coordinates.  turns: the angles at the start."""
    measured = block.measured
    own, probe = measured.system, measured.probe
    return {
        "system": _atoms(own, measured.start.angle),
        "probe": _atoms(probe, measured.turns),
        "center": own.center[1:],
        "length": own.length[1:],
    }


def _atoms(system: System, angle: Array) -> Baked:
    names = ("kind", "row", "body_a", "body_b", "p_a", "a", "k", "p_b", "b", "d")
    found: Baked = {name: getattr(system, name) for name in names}
    return found | {"scale": system.scale(), "rows": system.rows, "angle": angle}
