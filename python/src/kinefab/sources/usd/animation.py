"""Time-sampled transforms as clips: poses of nodes in their parents, by seconds.

One clip of the whole line of time, or those that the root layer says stand on it one after another, as Kinefab writes them.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from ...diagnostics import Report
from ...model import AnimationClip, Node, Repeat, Track
from ...spatial import Array, Pose, quaternion_from_matrix
from .api import Usd, UsdGeom
from .stage import OpenStage
from .transforms import local_of, placed, stand
from .walk import Found

STEP = 30.0
"""Degrees that an angle may turn between two keys: a full turn of two samples is one of twelve keys."""
MAX_KEYS = 20_000
STILL = 1e-9
"""Metres and parts of a quaternion: what moves less does not."""


def read_clips(found: Found, nodes: Sequence[Node], opened: OpenStage, report: Report) -> list[AnimationClip]:
    """Clips of everything that moves.  nodes: as ``Parts.read`` makes them, groups before parts."""
    if not found.animated:
        return []
    times = _times(list(found.animated.values()), opened)
    if len(times) < 2:
        return []
    if opened.stage.GetInterpolationType() == Usd.InterpolationTypeHeld:
        report.approximated(
            "animation",
            "USD_FEATURE_APPROXIMATED",
            opened.name,
            detail="its held keys are passed through evenly",
        )
    if len(times) > MAX_KEYS:
        times = times[:MAX_KEYS]
        report.approximated(
            "animation", "USD_FEATURE_APPROXIMATED", opened.name,
            detail=f"its first {MAX_KEYS} keys were taken, up to time code {times[-1]:g}",
        )  # fmt: skip
    prims = [group.prim for group in found.groups] + [part.prim for part in found.parts]
    placing = _Placing(found.animated)
    spans = _spans(times, opened)
    tracks: list[list[Track]] = [[] for _ in spans]
    told: set[str] = set()
    for number, node in enumerate(nodes):
        above = prims[node.parent] if node.parent is not None else None
        between = placing.between(prims[number], above)
        if not between:
            continue
        told |= between
        if node.mass is not None and not node.dynamics.kinematic:
            report.dropped(
                f"animation of {node.id}", "USD_FEATURE_DROPPED", node.where,
                detail="physics moves this body; it starts where the animation does",
            )  # fmt: skip
            continue
        if not placing.is_finite(prims[number], above, times):
            report.dropped(
                f"animation of {node.id}", "USD_FEATURE_DROPPED", node.where,
                detail="its samples are not finite; it stays as at the exported time",
            )  # fmt: skip
            continue
        for own, span in zip(tracks, spans):
            track = _track(number, prims[number], above, span.codes, placing, opened)
            if track is not None:
                own.append(track)
    for path in sorted(found.animated.keys() - told):
        report.dropped(
            f"animation of {path[1:]}", "USD_FEATURE_DROPPED", opened.place(path),
            detail="it moves geometry within a body, which stays as at the exported time",
        )  # fmt: skip
    rate = opened.stage.GetTimeCodesPerSecond()
    return [
        AnimationClip(
            span.name,
            span.start + (span.codes - span.codes[0]) / rate,
            tuple(own),
            span.repeat,
            where=opened.name,
        )
        for own, span in zip(tracks, spans)
        if own
    ]


@dataclass(frozen=True, slots=True, eq=False)
class _Span:
    """A clip's part of the line of time.  codes: of its keys.  start: seconds at the first of them."""

    name: str
    codes: Array
    start: float = 0.0
    repeat: Repeat = Repeat.ONCE


def _spans(times: Array, opened: OpenStage) -> list[_Span]:
    """Those that the root layer tells, where each holds keys; else the whole.  times: codes of all keys."""
    whole = [_Span("Animation", times)]
    told = _mapping(_mapping(opened.stage.GetRootLayer().customLayerData).get("kinefab")).get("clips")
    found: list[_Span] = []
    for entry in map(_mapping, _mapping(told).values()):
        name, low, high, start = (entry.get(key) for key in ("name", "start", "end", "seconds"))
        repeats = [repeat for repeat in Repeat if repeat.value == entry.get("repeat")]
        numbers = all(isinstance(n, float) and math.isfinite(n) for n in (low, high, start))
        if not isinstance(name, str) or not numbers or not repeats:
            return whole
        codes = times[(times >= cast(float, low)) & (times <= cast(float, high))]
        if not len(codes):
            return whole
        found.append(_Span(name, codes, cast(float, start), repeats[0]))
    return found or whole


def _mapping(value: object) -> Mapping[str, object]:
    return cast("Mapping[str, object]", value) if isinstance(value, Mapping) else {}


class _Placing:
    """World matrices of prims over time.  animated: prims with several samples, by path."""

    def __init__(self, animated: dict[str, Any]):
        self._animated = animated
        self._known: dict[tuple[str, float], Array] = {}

    def between(self, prim: Any, above: Any) -> set[str]:
        """Paths of what moves a prim against one above it (None: the world)."""
        found: set[str] = set()
        while prim and not prim.IsPseudoRoot() and (above is None or prim != above):
            path = str(prim.GetPath())
            if path in self._animated:
                found.add(path)
            prim = prim.GetParent()
        return found

    def is_finite(self, prim: Any, above: Any, times: Array) -> bool:
        """Of both prims at all times; ``above`` may be None."""
        return all(bool(np.isfinite(self.world(p, t)).all()) for t in times.tolist() for p in (prim, above))

    def world(self, prim: Any, time: float) -> Array:
        if not prim or prim.IsPseudoRoot():
            return np.eye(4)
        path = str(prim.GetPath())
        key = (path, time)
        if key not in self._known:
            moment = Usd.TimeCode(time) if path in self._animated else None
            self._known[key] = placed(self.world(prim.GetParent(), time), local_of(prim, moment))
        return self._known[key]


def _times(prims: Sequence[Any], opened: OpenStage) -> Array:
    """Time codes of all samples within the stage's range, and so many between, up to MAX_KEYS, that no angle turns far at once."""
    low, high = -math.inf, math.inf
    if opened.stage.HasAuthoredTimeCodeRange():
        low, high = opened.stage.GetStartTimeCode(), opened.stage.GetEndTimeCode()
    samples: set[float] = set()
    turns: list[Any] = []
    for prim in prims:
        for op in UsdGeom.Xformable(prim).GetOrderedXformOps():
            its = op.GetTimeSamples()
            samples.update(t for t in its if low <= t <= high)
            if its:
                samples.update(t for t in (low, high) if math.isfinite(t))
            if len(its) > 1 and "rotate" in op.GetOpName():
                turns.append(op)
    knots = sorted(samples)
    times: list[float] = knots[:1]
    for start, end in zip(knots, knots[1:]):
        most = 0.0
        for op in turns:
            change = np.array(op.Get(end), dtype=np.float64) - np.array(op.Get(start), dtype=np.float64)
            if np.isfinite(change).all():
                most = max(most, float(np.abs(change).max()))
        most = min(most, STEP * MAX_KEYS)
        count = min(max(1, math.ceil(most / STEP - 1e-9)), max(1, MAX_KEYS - len(times)))
        times += [start + (end - start) * (i + 1) / count for i in range(count)]
    return np.array(times)


def _track(
    number: int, prim: Any, above: Any, times: Array, placing: _Placing, opened: OpenStage
) -> Track | None:
    poses: list[Pose] = []
    for time in times.tolist():
        own = stand(placing.world(prim, time), opened.frame).pose
        outer = Pose() if above is None else stand(placing.world(above, time), opened.frame).pose
        poses.append(outer.inverse() @ own)
    translations = np.array([pose.translation for pose in poses])
    rotations = np.array([quaternion_from_matrix(pose.rotation) for pose in poses])
    for i in range(1, len(rotations)):
        if rotations[i] @ rotations[i - 1] < 0.0:
            rotations[i] = -rotations[i]
    slides = bool(np.ptp(translations, axis=0).max() > STILL)
    turns = bool(np.ptp(rotations, axis=0).max() > STILL)
    if not (slides or turns):
        return None
    return Track(number, translations if slides else None, rotations if turns else None)
