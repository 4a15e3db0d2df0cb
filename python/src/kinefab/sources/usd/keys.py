"""Times of a clip's keys: those of the samples, and between them so many that what is drawn from key to key is the stage's way."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...spatial import Array, Pose, rotation_exp, rotation_log
from .api import Usd, UsdGeom
from .placing import Placing
from .stage import OpenStage
from .transforms import knots_of, stand

STEP = 30.0
"""Degrees that an angle may turn between two keys: a full turn of two samples is one of twelve keys."""
MAX_KEYS = 20_000
STRAIGHT = 3.0
"""Degrees: a turn of two samples closer than these is taken for straight."""
BENT = 1e-3
"""Radians, and share of the way of a node, that it may be off between two keys."""
BETWEEN = (0.25, 0.5, 0.75)
"""Where it is looked for."""
LOOKED = 500
"""So many samples tell how far a node goes."""
FINEST = 1.0 / 128.0
"""Of the time between two samples, the least between two keys."""


def key_times(
    prims: Sequence[Any],
    nodes: Sequence[tuple[str, str]],
    placing: Placing,
    opened: OpenStage,
    report: Report,
) -> Array:
    """Time codes, ascending.  prims: with samples.  nodes: keys of what moves and of what it is counted from."""
    knots, ops = _knots(prims, opened)
    nodes = [node for node in nodes if placing.is_finite(*node, np.array(knots))]
    reach = {node: _reach(node, knots, placing, opened) for node in nodes} if ops else {}
    held = opened.stage.GetInterpolationType() == Usd.InterpolationTypeHeld
    times: list[float] = knots[:1]
    for start, end in zip(knots, knots[1:]):
        most, bends = _turned(ops, start, end)
        count = min(max(1, math.ceil(most / STEP - 1e-9)), max(1, MAX_KEYS - len(times)))
        steps = [start, *(start + (end - start) * (i + 1) / count for i in range(count))]
        if bends and not held:
            steps = _refined(steps, reach, placing, opened, MAX_KEYS - len(times))
        times += steps[1:]
    if len(times) > MAX_KEYS:
        times = times[:MAX_KEYS]
        report.approximated(
            "animation", "USD_FEATURE_APPROXIMATED", opened.name,
            detail=f"its first {MAX_KEYS} keys were taken, up to time code {times[-1]:g}",
        )  # fmt: skip
    return np.array(times)


def _knots(prims: Sequence[Any], opened: OpenStage) -> tuple[list[float], list[tuple[Any, bool]]]:
    """Time codes of all samples within the stage's range, and the operations that turn or are curves, and which of both."""
    low, high = -math.inf, math.inf
    if opened.stage.HasAuthoredTimeCodeRange():
        low, high = opened.stage.GetStartTimeCode(), opened.stage.GetEndTimeCode()
    samples: set[float] = set()
    ops: list[tuple[Any, bool]] = []
    for prim in prims:
        for op in UsdGeom.Xformable(prim).GetOrderedXformOps():
            its = knots_of(op.GetAttr())
            samples.update(t for t in its if low <= t <= high)
            if its:
                samples.update(t for t in (low, high) if math.isfinite(t))
            turns = op.GetOpName().removeprefix("!invert!").split(":")[1]
            is_curve = not op.GetTimeSamples()
            if len(its) > 1 and (is_curve or turns.startswith(("rotate", "orient", "transform"))):
                ops.append((op, is_curve))
    return sorted(samples), ops


def _turned(ops: Sequence[tuple[Any, bool]], start: float, end: float) -> tuple[float, bool]:
    """Degrees that the angle which changes most does, and whether the way may be other than straight.  ops: see ``_knots``."""
    most, bends = 0.0, False
    for op, is_curve in ops:
        first, last = op.Get(start), op.Get(end)
        kind = op.GetOpType()
        if kind == UsdGeom.XformOp.TypeOrient:
            turned = 2.0 * math.degrees(math.acos(min(1.0, abs(_cosine(first, last)))))
        elif kind == UsdGeom.XformOp.TypeTransform:
            turned = 180.0 if first != last else 0.0
        else:
            change = np.array(last, dtype=np.float64) - np.array(first, dtype=np.float64)
            turned = float(np.abs(change).max()) if np.isfinite(change).all() else 0.0
            if "rotate" in op.GetOpName():
                most = max(most, min(turned, STEP * MAX_KEYS))
        bends |= turned > STRAIGHT or is_curve
    return most, bends


def _cosine(first: Any, last: Any) -> float:
    """Between two quaternions, 1 where one has no length."""
    a, b = (np.array([q.GetReal(), *q.GetImaginary()], dtype=np.float64) for q in (first, last))
    lengths = float(np.linalg.norm(a) * np.linalg.norm(b))
    return float(a @ b) / lengths if lengths > 0.0 and math.isfinite(lengths) else 1.0


def _refined(
    steps: Sequence[float],
    reach: dict[tuple[str, str], float],
    placing: Placing,
    opened: OpenStage,
    room: int,
) -> list[float]:
    """The times of one interval with those between at which a node is off the straight way.  room: for so many."""
    finest = (steps[-1] - steps[0]) * FINEST
    found, waiting = [steps[0]], list(reversed(steps[1:]))
    while waiting:
        start, end = found[-1], waiting[-1]
        more = len(found) + len(waiting) < room and end - start > finest
        if more and any(_is_off(node, start, end, way, placing, opened) for node, way in reach.items()):
            waiting.append(0.5 * (start + end))
        else:
            found.append(waiting.pop())
    return found


def _reach(node: tuple[str, str], knots: Sequence[float], placing: Placing, opened: OpenStage) -> float:
    """Length of the box that a node's way fills, metres."""
    times = {t for a, b in zip(knots[:LOOKED], knots[1:]) for t in (a, 0.7 * a + 0.3 * b, b)}
    points = np.array([pose_at(*node, t, placing, opened).translation for t in sorted(times)])
    return float(np.linalg.norm(np.ptp(points, axis=0))) if len(points) else 0.0


def _is_off(
    node: tuple[str, str], start: float, end: float, reach: float, placing: Placing, opened: OpenStage
) -> bool:
    a, b = (pose_at(*node, t, placing, opened) for t in (start, end))
    if not all(np.isfinite(p.rotation).all() and np.isfinite(p.translation).all() for p in (a, b)):
        return False
    turn = rotation_log(a.rotation.T @ b.rotation)
    for share in BETWEEN:
        here = pose_at(*node, start + share * (end - start), placing, opened)
        away = here.translation - (a.translation + share * (b.translation - a.translation))
        turned = rotation_log(here.rotation.T @ a.rotation @ rotation_exp(share * turn))
        if float(np.linalg.norm(turned)) > BENT or float(np.linalg.norm(away)) > BENT * max(reach, 1e-6):
            return True
    return False


def pose_at(key: str, above: str, time: float, placing: Placing, opened: OpenStage) -> Pose:
    """Of a node in its parent's frame, the world's for ""."""
    own = stand(placing.world(key, time), opened.frame).pose
    outer = Pose() if not above else stand(placing.world(above, time), opened.frame).pose
    return outer.inverse() @ own
