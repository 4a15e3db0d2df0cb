"""The instances of a PointInstancer."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from ...diagnostics import Report
from ...spatial import Array
from .api import Tf, Usd, UsdGeom, Vt
from .stage import OpenStage, matrix
from .values import shown

MAX_INSTANCES = 1_000_000
UNEVEN = "its arrays have different lengths"
_VECTORS = (Vt.Vec3fArray, Vt.Vec3dArray, Vt.Vec3hArray)
_TYPES: dict[str, Any] = {
    "protoIndices": Vt.IntArray,
    "positions": _VECTORS,
    "orientations": (Vt.QuathArray, Vt.QuatfArray, Vt.QuatdArray),
    "scales": _VECTORS,
}
"""Of an instancer's arrays; pxr passes over some of another type, and stumbles over others."""
_MOVING = (*_TYPES, "invisibleIds")

_SPEEDS = ("velocities", "angularVelocities")
"""Of instances: PhysX starts bodies with them."""


def instances(prim: Any, opened: OpenStage, report: Report) -> Iterator[tuple[int, Any, Array]]:
    """For each shown instance its number, its prototype and what stands between the instancer and the prototype's own
    transform, shape (4, 4)."""
    instancer = UsdGeom.PointInstancer(prim)
    time = Usd.TimeCode.Default()
    if instancer.GetPositionsAttr().Get(time) is None:
        time = Usd.TimeCode.EarliestTime()
    if not _is_typed(prim, time, opened, report):
        return
    indices = instancer.GetProtoIndicesAttr().Get(time)
    targets = instancer.GetPrototypesRel().GetForwardedTargets()
    where = opened.place(prim)
    if not indices or not targets:
        return
    if len(indices) > MAX_INSTANCES:
        report.dropped(
            f"instancer {prim.GetPath()}", "USD_FEATURE_DROPPED", where, detail=f"{len(indices)} instances"
        )
        return
    _tell_lost(prim, time, opened, report)
    found, detail = _transforms(instancer, time, len(indices))
    if found is None:
        report.dropped(f"instancer {prim.GetPath()}", "USD_FEATURE_DROPPED", where, detail=detail)
        return
    mask = instancer.ComputeMaskAtTime(time) or [True] * len(indices)
    for number, (index, visible) in enumerate(zip(indices, mask)):
        if not visible:
            continue
        prototype = prim.GetStage().GetPrimAtPath(targets[index]) if 0 <= index < len(targets) else None
        placing = matrix(found[number])
        if not prototype or not np.isfinite(placing).all():
            report.dropped(
                f"instance {prim.GetPath()}[{number}]", "USD_FEATURE_DROPPED", where,
                detail=f"prototype {index} is missing or its place is not finite",
            )  # fmt: skip
            continue
        yield number, prototype, placing


def _is_typed(prim: Any, time: Any, opened: OpenStage, report: Report) -> bool:
    """Whether all arrays are of their types; the first that is not is told."""
    for name, kinds in _TYPES.items():
        value = prim.GetAttribute(name).Get(time)
        if value is not None and not isinstance(value, kinds):
            detail = f"{name} cannot be {shown(value)}"
            report.dropped(
                f"instancer {prim.GetPath()}", "USD_FEATURE_DROPPED", opened.place(prim, name), detail=detail
            )
            return False
    return True


def _tell_lost(prim: Any, time: Any, opened: OpenStage, report: Report) -> None:
    """What instances do over time, the speeds that they start with, and colours of their own."""
    moving = [name for name in _MOVING if prim.GetAttribute(name).GetNumTimeSamples() > 1]
    if moving:
        detail = f"its {', '.join(moving)} change over time; its instances stay as at the exported time"
        feature, where = f"animation of {str(prim.GetPath())[1:]}", opened.place(prim)
        report.dropped(feature, "USD_FEATURE_DROPPED", where, detail=detail)
    for name in _SPEEDS:
        speeds = prim.GetAttribute(name).Get(time)
        if isinstance(speeds, _VECTORS) and np.any(speeds):
            report.dropped(
                f"{name} of {prim.GetPath()}", "USD_FEATURE_DROPPED", opened.place(prim, name),
                detail="an instance starts at the speed that its prototype states",
            )  # fmt: skip
    for name in ("displayColor", "displayOpacity"):
        primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar(name)
        if primvar and primvar.HasAuthoredValue() and primvar.GetInterpolation() != UsdGeom.Tokens.constant:
            report.dropped(
                f"primvar {name} of {prim.GetPath()}", "USD_FEATURE_DROPPED", opened.place(prim, f"primvars:{name}"),
                detail="an instance looks as its prototype does",
            )  # fmt: skip


def _transforms(instancer: Any, time: Any, count: int) -> tuple[Any, str]:
    """A matrix for each of ``count`` instances, or None and what is wrong."""
    try:
        found = instancer.ComputeInstanceTransformsAtTime(
            time, time, UsdGeom.PointInstancer.ExcludeProtoXform, UsdGeom.PointInstancer.IgnoreMask
        )
    except Tf.ErrorException as error:
        return None, str(error) or UNEVEN
    return (found, "") if found is not None and len(found) == count else (None, UNEVEN)
