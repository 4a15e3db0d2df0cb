"""One block along a straight way between values of its held coordinates: its poses, and what ends the way."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...model import RX, Motion
from ...spatial import Array, BoolArray
from .coordinates import DrivenBlock
from .walk import Poses, Walk, coordinates_at

ON_LIMIT = 1e-9
"""Radians, or fractions of the length, that a coordinate may be past its limit."""


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """poses: at the shares asked for, as far as they were reached.  values: (poses, k), all coordinates there.

    reached: share of the way.  limit: the coordinate (its place) whose limit ended it, and ``bound``, the value there;
    None at a dead point.
    residual: largest of the block's rows, scaled.  knots: the poses that were walked through, as far as it was reached.
    """

    poses: Poses
    values: Array
    reached: float
    limit: int | None
    bound: float
    residual: float
    knots: Poses


def watched(block: DrivenBlock) -> BoolArray:
    """Which coordinates have a limit that is the coordinate's own: slides, and turns about one or two axes.

    The three angles of a ball are limited together, as a twist and a cone; those are not watched.
    """
    found: list[bool] = []
    for driven, freedom in block.joints:
        turns = [i for i in driven.moving if i >= RX]
        limited = driven.joint.freedoms[freedom].motion is Motion.LIMITED
        found.append(limited and (freedom < RX or len(turns) < 3))
    return np.array(found, dtype=bool)


def walked(block: DrivenBlock, walk: Walk, target: Array, shares: Array, before: Array) -> Way:
    """Walk towards ``target`` and tell the poses at ``shares`` of the way (ascending, 0 to 1).

    before: (k,), the block's coordinates where the walk stands now.
    """
    start = walk.values
    knots, arrived = walk.towards(target)
    reached, limit, bound = (1.0 if arrived else float(knots.at[-1])), None, 0.0
    asked = shares[shares <= reached]
    new = asked[~np.isin(asked, knots.at)]
    poses = knots.merged(walk.between(knots, new, start, target)) if len(new) else knots
    values = coordinates_at(block.measured, poses)
    first: Array = values[0]
    turns = ((before - first) / (2.0 * np.pi)).round() * 2.0 * np.pi
    values = values + np.where(block.measured.rotary, turns, 0.0)
    past = _past(block, values)
    if past is not None:
        sample, limit, bound = past
        reached = _met(block, walk, knots, poses, (start, target), (sample, limit, bound), values)
    kept = np.isin(poses.at, asked) & (poses.at <= reached)
    found = poses.taken(kept)
    walked_through = knots.taken(knots.at <= reached)
    return Way(found, values[kept], reached, limit, bound, walk.misfit(found), walked_through)


def _past(block: DrivenBlock, values: Array) -> tuple[int, int, float] | None:
    """The first sample past a limit, the coordinate and the limit; one outside from the start may come back in."""
    unit = np.where(block.measured.rotary, 1.0, block.measured.length)
    seen = watched(block)
    upper = np.where(seen, np.maximum(block.measured.upper, values[0]), np.inf) + ON_LIMIT * unit
    lower = np.where(seen, np.minimum(block.measured.lower, values[0]), -np.inf) - ON_LIMIT * unit
    over, under = values > upper, values < lower
    beyond = over | under
    if not beyond.any():
        return None
    sample = int(np.flatnonzero(beyond.any(axis=1))[0])
    i = int(np.flatnonzero(beyond[sample])[0])
    bounds = (block.measured.upper, values[0]) if over[sample, i] else (block.measured.lower, values[0])
    return sample, i, float((max if over[sample, i] else min)(b[i] for b in bounds))


def _met(
    block: DrivenBlock,
    walk: Walk,
    knots: Poses,
    poses: Poses,
    way: tuple[Array, Array],
    past: tuple[int, int, float],
    values: Array,
) -> float:
    """The share of the way where a coordinate meets its limit, between a sample and the one before."""
    from scipy.optimize import brentq  # late: it takes a tenth of a second

    sample, i, bound = past
    before = values[sample - 1]

    def beyond(at: float) -> float:
        state = walk.single(knots, at, *way)
        if state is None:
            return float(values[sample, i]) - bound
        value = float(block.measured.read(state, np.zeros(len(block.measured.probe.kind)))[0][i])
        if block.measured.rotary[i]:
            value += 2.0 * np.pi * round((float(before[i]) - value) / (2.0 * np.pi))
        return value - bound

    low, high = float(poses.at[sample - 1]), float(poses.at[sample])
    if beyond(low) * beyond(high) >= 0.0:
        return low
    root: Any = brentq(beyond, low, high, xtol=1e-13)
    return float(root)
