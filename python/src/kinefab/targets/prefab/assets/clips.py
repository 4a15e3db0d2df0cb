"""Animation clips of the legacy Animation component, which needs no state machine."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np

from ....unity.scene import AnimationClip
from ...numbers import rising
from ..text.dialects import Dialect
from ..text.documents import HEAD, version
from ..text.yaml import HEADER, NULL, Fields, Plain, document, placed, vector

CLIP_ID = 7400000
WRAP = {"Once": 1, "Loop": 2, "PingPong": 4}
SAMPLE_RATE = 60
"""Hz, of Unity's own clips; the keys stand at the source's own times."""
THIRD = 1 / 3
ROTATION_ORDER = 4
STRAIGHT = 1e-3
"""Radians: an arc shorter than this is its chord in the digits of a file."""

Slopes = tuple[list[float], list[float]]
"""Of the four or three numbers, per second: leaving a key and arriving at the next."""
Way = Callable[[Sequence[float], Sequence[float], float], Slopes]


def clip_asset(clip: AnimationClip, name: str, paths: Mapping[int, str], dialect: Dialect) -> bytes:
    """paths: of each GameObject that a track moves, from the object with the Animation, names with slashes between."""
    turning = [(t.gameObject, t.localRotation) for t in clip.tracks if t.localRotation]
    moving = [(t.gameObject, t.localPosition) for t in clip.tracks if t.localPosition]
    times: list[float] = rising(np.array(clip.times, dtype=np.float64)).tolist()
    stop = times[-1] if times else 0.0
    fields: Fields = {
        **HEAD,
        "m_Name": name,
        **version(dialect.clip),
        "m_Legacy": 1,
        "m_Compressed": 0,
        "m_UseHighQualityCurve": 1,
        "m_RotationCurves": [_curve(times, _continuous(v), paths[o], _along_arc) for o, v in turning],
        "m_CompressedRotationCurves": [],
        "m_EulerCurves": [],
        "m_PositionCurves": [_curve(times, v, paths[o], _straight) for o, v in moving],
        "m_ScaleCurves": [],
        "m_FloatCurves": [],
        "m_PPtrCurves": [],
        "m_SampleRate": SAMPLE_RATE,
        "m_WrapMode": WRAP[clip.wrapMode],
        "m_Bounds": {"m_Center": vector((0, 0, 0)), "m_Extent": vector((0, 0, 0))},
        "m_ClipBindingConstant": {"genericBindings": [], "pptrCurveMapping": []},
        "m_AnimationClipSettings": _settings(stop, clip.wrapMode != "Once"),
        "m_EditorCurves": [],
        "m_EulerEditorCurves": [],
        "m_HasGenericRootTransform": 0,
        "m_HasMotionFloatCurves": 0,
        "m_Events": [],
    }
    return (HEADER + document(74, "AnimationClip", CLIP_ID, fields)).encode("ascii")


def _settings(stop: float, loop: bool) -> Fields:
    return {
        "serializedVersion": 2,
        "m_AdditiveReferencePoseClip": NULL,
        "m_AdditiveReferencePoseTime": 0,
        "m_StartTime": 0,
        "m_StopTime": stop,
        "m_OrientationOffsetY": 0,
        "m_Level": 0,
        "m_CycleOffset": 0,
        "m_HasAdditiveReferencePose": 0,
        "m_LoopTime": loop,
        "m_LoopBlend": 0,
        "m_LoopBlendOrientation": 0,
        "m_LoopBlendPositionY": 0,
        "m_LoopBlendPositionXZ": 0,
        "m_KeepOriginalOrientation": 0,
        "m_KeepOriginalPositionY": 1,
        "m_KeepOriginalPositionXZ": 0,
        "m_HeightFromFeet": 0,
        "m_Mirror": 0,
    }


Values = Sequence[tuple[float, ...]]


def _continuous(rotations: Values) -> Values:
    """The same turns by quaternions that do not jump to the other sign, between which Unity would interpolate wrongly."""
    found: list[tuple[float, ...]] = []
    for q in rotations:
        if found and sum(a * b for a, b in zip(found[-1], q)) < 0.0:
            q = tuple(-x for x in q)
        found.append(q)
    return found


def _curve(times: Sequence[float], values: Values, path: str, way: Way) -> Fields:
    weight = _components([THIRD] * len(values[0]))
    still = [0.0] * len(values[0])
    slopes = [way(a, b, end - start) for a, b, start, end in zip(values, values[1:], times, times[1:])] or [
        (still, still)
    ]
    keys: list[Fields] = []
    for i, (time, value) in enumerate(zip(times, values)):
        before = slopes[i - 1][1] if i else slopes[0][0]
        after = slopes[i][0] if i < len(slopes) else slopes[-1][1]
        keys.append(
            {
                "serializedVersion": 3,
                "time": float(time),
                "value": _components(value),
                "inSlope": _components(before),
                "outSlope": _components(after),
                "tangentMode": 0,
                "weightedMode": 0,
                "inWeight": weight,
                "outWeight": weight,
            }
        )
    curve: Fields = {
        "serializedVersion": 2,
        "m_Curve": keys,
        "m_PreInfinity": 2,
        "m_PostInfinity": 2,
        "m_RotationOrder": ROTATION_ORDER,
    }
    return {"curve": curve, "path": path}


def _components(values: Sequence[float]) -> Plain:
    return placed(values)


def _straight(a: Sequence[float], b: Sequence[float], seconds: float) -> Slopes:
    slope = [(y - x) / seconds for x, y in zip(a, b)]
    return slope, slope


def _along_arc(a: Sequence[float], b: Sequence[float], seconds: float) -> Slopes:
    """Of the great arc between unit quaternions.  Unity makes cubic curves of the four numbers: with the slopes of the chord a turn
    of 160 degrees would be 6 degrees off on its way."""
    cosine = min(1.0, sum(x * y for x, y in zip(a, b)))
    angle = math.acos(cosine)
    if angle < STRAIGHT:
        return _straight(a, b, seconds)
    rate = angle / math.sin(angle) / seconds
    return [rate * (y - cosine * x) for x, y in zip(a, b)], [rate * (cosine * y - x) for x, y in zip(a, b)]
