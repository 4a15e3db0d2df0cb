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
from ...spatial import Array, quaternion_from_matrix, without_flips
from .api import Usd, UsdGeom
from .found import Found
from .keys import key_times, pose_at
from .placing import Placing
from .stage import OpenStage
from .transforms import knots_of, local_of

GROWN = 1e-5
"""Share of a scale that it may change by unnoticed: files carry float32."""
MAX_SIZES = 1000
"""So many samples of a scale are looked at."""
STILL = 1e-9
"""Metres and parts of a quaternion: what moves less does not."""


def read_clips(found: Found, nodes: Sequence[Node], opened: OpenStage, report: Report) -> list[AnimationClip]:
    """Clips of everything that moves.  nodes: as ``Parts.read`` makes them, groups before parts."""
    if not found.animated:
        return []
    for path in found.animated:
        _tell_scale(path, found.animated[path], opened, report)
    placing = Placing(found, opened.stage)
    keys = [f"/{node.id}" for node in nodes[: len(found.groups) + len(found.parts)]]
    above = ["" if node.parent is None else f"/{nodes[node.parent].id}" for node in nodes]
    moved = {i: paths for i, key in enumerate(keys) if (paths := placing.moved_by(key, above[i]))}
    times = key_times(
        list(found.animated.values()), [(keys[i], above[i]) for i in moved], placing, opened, report
    )
    if len(times) < 2:
        return []
    if opened.stage.GetInterpolationType() == Usd.InterpolationTypeHeld:
        report.approximated(
            "animation",
            "USD_FEATURE_APPROXIMATED",
            opened.name,
            detail="its held keys are passed through evenly",
        )
    spans = _spans(times, opened)
    tracks: list[list[Track]] = [[] for _ in spans]
    told: set[str] = set()
    for number, paths in moved.items():
        node = nodes[number]
        told |= paths
        detail = ""
        if node.mass is not None and not node.dynamics.kinematic:
            detail = "physics moves this body; it starts where the animation does"
        elif not placing.is_finite(keys[number], above[number], times):
            detail = "its samples are not finite; it stays as at the exported time"
        if detail:
            report.dropped(f"animation of {node.id}", "USD_FEATURE_DROPPED", node.where, detail=detail)
            continue
        for own, span in zip(tracks, spans):
            track = _track(number, keys[number], above[number], span.codes, placing, opened)
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


def _tell_scale(path: str, prim: Any, opened: OpenStage, report: Report) -> None:
    """That a prim grows or shrinks, or is mirrored or sheared over time, which no clip holds."""
    sized = [
        op for op in UsdGeom.Xformable(prim).GetOrderedXformOps()
        if op.GetOpType() in (UsdGeom.XformOp.TypeScale, UsdGeom.XformOp.TypeTransform)
    ]  # fmt: skip
    codes = sorted({time for op in sized for time in knots_of(op.GetAttr())})[:MAX_SIZES]
    linears = np.array([local_of(prim, Usd.TimeCode(time)).matrix[:3, :3] for time in codes])
    if len(linears) < 2 or not np.isfinite(linears).all():
        return
    squares = linears.transpose(0, 2, 1) @ linears
    if np.abs(squares - squares[0]).max() > GROWN * np.abs(squares[0]).max():
        report.dropped(
            f"animation of the scale of {path[1:]}", "USD_FEATURE_DROPPED", opened.place(path),
            detail="a clip moves and turns; it keeps its scale as at the exported time",
        )  # fmt: skip


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


def _track(
    number: int, key: str, above: str, times: Array, placing: Placing, opened: OpenStage
) -> Track | None:
    poses = [pose_at(key, above, time, placing, opened) for time in times.tolist()]
    translations = np.array([pose.translation for pose in poses])
    rotations = np.array([quaternion_from_matrix(pose.rotation) for pose in poses])
    rotations = without_flips(rotations[:, None])[:, 0]
    slides = bool(np.ptp(translations, axis=0).max() > STILL)
    turns = bool(np.ptp(rotations, axis=0).max() > STILL)
    if not (slides or turns):
        return None
    return Track(number, translations if slides else None, rotations if turns else None)
