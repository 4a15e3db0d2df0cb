"""Animation clips of the legacy Animation component, which needs no state machine."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from ....unity.scene import AnimationClip
from ..text.dialects import Dialect
from ..text.documents import HEAD, version
from ..text.yaml import HEADER, NULL, Fields, Plain, document, placed, vector

CLIP_ID = 7400000
WRAP = {"Once": 1, "Loop": 2, "PingPong": 4}
SAMPLE_RATE = 60
"""Hz, of Unity's own clips; the keys stand at the source's own times."""
THIRD = 1 / 3
ROTATION_ORDER = 4


def clip_asset(clip: AnimationClip, name: str, paths: Mapping[int, str], dialect: Dialect) -> bytes:
    """paths: of each GameObject that a track moves, from the object with the Animation, names with slashes between."""
    turning = [(t.gameObject, t.localRotation) for t in clip.tracks if t.localRotation]
    moving = [(t.gameObject, t.localPosition) for t in clip.tracks if t.localPosition]
    stop = float(clip.times[-1]) if clip.times else 0.0
    fields: Fields = {
        **HEAD,
        "m_Name": name,
        **version(dialect.clip),
        "m_Legacy": 1,
        "m_Compressed": 0,
        "m_UseHighQualityCurve": 1,
        "m_RotationCurves": [_curve(clip.times, _continuous(v), paths[o]) for o, v in turning],
        "m_CompressedRotationCurves": [],
        "m_EulerCurves": [],
        "m_PositionCurves": [_curve(clip.times, v, paths[o]) for o, v in moving],
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


def _curve(times: Sequence[float], values: Values, path: str) -> Fields:
    weight = _components([THIRD] * len(values[0]))
    keys: list[Fields] = []
    for i, (time, value) in enumerate(zip(times, values)):
        before = _slope(times, values, i - 1)
        after = _slope(times, values, i)
        keys.append(
            {
                "serializedVersion": 3,
                "time": float(time),
                "value": _components(value),
                "inSlope": _components(before or after or [0.0] * len(value)),
                "outSlope": _components(after or before or [0.0] * len(value)),
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


def _slope(times: Sequence[float], values: Values, i: int) -> list[float] | None:
    """Of the straight line from key i to the next, per second; None beyond the ends."""
    if not 0 <= i < len(values) - 1 or times[i + 1] <= times[i]:
        return None
    step = times[i + 1] - times[i]
    return [(b - a) / step for a, b in zip(values[i], values[i + 1])]
