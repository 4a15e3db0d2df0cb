"""Axis-axis constraints of the paper's CSV: a direction is stated, the point that makes it a line is found.

In this order: a point that the row states; the DOF centre of the one part that moves while the other stands
still; a mesh cylinder that both parts have along the direction; the part's origin.  The step is reported for
every axis.
The DOF centre serves in that case alone: of a part that hangs on a moving one it is an instantaneous pole.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np

from ...diagnostics import Report
from ...model import MeshReference
from ...spatial import Array
from ..reading.record import entries_in
from ..reading.request import Vertices
from ..reading.source_frame import METRES
from .axis_point import common_axis_point

Numbers = tuple[float, float, float]

ALONG = 1.0 - 1e-6
"""Cosine from which on two directions are one, up to sense, to the digits that are printed."""


@dataclass(frozen=True, slots=True)
class Part:
    """A row: its bodies' names in the mesh, its freedoms to ground, DOF centre and origin, source units.

    fixed: it has no freedom and stands on the ground.  line: of the file.
    """

    id: str
    bodies: tuple[str, ...]
    fixed: bool
    translations: list[list[float]]
    rotations: list[list[float]]
    center: list[float] | None
    origin: list[float] | None
    line: int


@dataclass(frozen=True, slots=True)
class Axis:
    """An axis that ``part`` shares with ``partner``.  line: of the file."""

    part: str
    partner: str
    direction: Numbers
    point: Numbers | None
    line: int


def axis_records(
    axes: list[Axis],
    parts: dict[str, Part],
    values: dict[str, object],
    lines: dict[str, int],
    path: Path,
    report: Report,
    vertices: Vertices | None,
) -> None:
    """Append a concentric constraint and a revolute joint for every axis to the raw bundle ``values``."""
    seen: list[tuple[frozenset[str], Array]] = []
    constraints, joints = entries_in(values, "constraints"), entries_in(values, "joints")
    for axis in axes:
        place, feature = f"{path.name}:{axis.line}", f"axis of {axis.part} and {axis.partner}"
        length = float(np.linalg.norm(axis.direction))
        if not length > 0.0:
            report.add("AXIS_ZERO", place, field="axes")
            continue
        direction = np.array(axis.direction) / length
        pair = frozenset((axis.part, axis.partner))
        if any(pair == other and abs(direction @ d) > ALONG for other, d in seen):
            report.add("AXIS_STATED_TWICE", place, feature=feature)
            continue
        seen.append((pair, direction))
        point, step = _point(axis, direction, parts, values, path, vertices)
        if step is None:
            report.approximated(feature, "AXIS_POINT_GUESSED", place, part=axis.part)
        else:
            report.add("AXIS_POINT_FOUND", place, feature=feature, step=step)
        number = len(joints) + 1
        line = {"in": "world", "p": list(point), "d": list(direction)}
        lines[f"/constraints/{len(constraints)}"] = lines[f"/joints/{len(joints)}"] = axis.line
        constraints.append(
            {
                "id": f"Axis:{number}",
                "kind": "concentric",
                "a": {"component": axis.partner, "geometry": "line", **line},
                "b": {"component": axis.part, "geometry": "line", **line},
            }
        )
        joints.append(
            {
                "id": f"Joint:{number}",
                "type": "revolute",
                "a": axis.partner,
                "b": axis.part,
                "frameA": {"in": "world", "o": list(point), "z": list(direction)},
                "because": [f"Axis:{number}"],
            }
        )


def slide_records(
    axes: list[Axis],
    parts: dict[str, Part],
    values: dict[str, object],
    lines: dict[str, int],
    name: str,
    report: Report,
) -> None:
    """Append a slider joint to ground for every part that only slides and hangs on the mechanism by one axis.

    What holds such a part on its line is no axis-axis constraint, so the paper's file has its free direction
    alone.  With a second axis it would be a coupler, whose free direction holds for the moment only.
    """
    joints = entries_in(values, "joints")
    for part in parts.values():
        partners = {
            axis.partner if axis.part == part.id else axis.part
            for axis in axes
            if part.id in (axis.part, axis.partner)
        }
        slides = len(part.translations) == 1 and not part.rotations and part.origin is not None
        if not slides or len(partners) != 1 or parts[partners.pop()].fixed:
            continue
        report.add("SLIDE_FROM_DOF", f"{name}:{part.line}", part=part.id)
        lines[f"/joints/{len(joints)}"] = part.line
        along = {"in": "world", "o": part.origin, "z": part.translations[0]}
        joints.append(
            {"id": f"Slide:{part.id}", "type": "slider", "a": "ground", "b": part.id, "frameA": along}
        )


def _point(
    axis: Axis,
    direction: Array,
    parts: dict[str, Part],
    values: dict[str, object],
    path: Path,
    vertices: Vertices | None,
) -> tuple[Array, str | None]:
    """A point on the axis in the source's world, and where it came from; None for the mere origin of the
    part."""
    if axis.point is not None:
        return np.array(axis.point), "the point column"
    part, partner = parts[axis.part], parts[axis.partner]
    for one, still in ((part, partner), (partner, part)):
        moving = _carrier(one, parts)
        if still.fixed and moving.center is not None and _turns_only_about(moving, direction):
            return np.array(moving.center), f"the DOF centre of {moving.id}"
    if vertices is not None:
        first, second = (_vertices(entry, parts, values, path, vertices) for entry in (partner, part))
        found = common_axis_point(first, second, direction)
        if found is not None:
            return found, "a cylinder common to both meshes"
    return np.array(part.origin or (0.0, 0.0, 0.0)), None


def _carrier(part: Part, parts: dict[str, Part]) -> Part:
    """The part, or the assembly above it whose freedoms it shares: a rigid sub-assembly moves as one."""
    above = part.id.rpartition("/")[0]
    if part.fixed or part.translations or part.rotations or not above or above not in parts:
        return part
    return _carrier(parts[above], parts)


def _turns_only_about(part: Part, direction: Array) -> bool:
    if part.translations or len(part.rotations) != 1:
        return False
    axis = np.array(part.rotations[0])
    return bool(abs(axis @ direction) > ALONG * np.linalg.norm(axis))


def _vertices(
    part: Part, parts: dict[str, Part], values: dict[str, object], path: Path, vertices: Vertices
) -> Array:
    """Vertices of a part, or of all parts of an assembly, in the source's world and unit."""
    meta = cast(Any, values["meta"])  # as the reader has put it together
    mesh = meta["mesh"]
    scale = METRES.get(mesh["units"], 1.0) / METRES.get(meta["units"]["length"], 1.0)
    to_source = np.diag([scale, scale, scale, 1.0])
    keys = [
        key
        for name, entry in parts.items()
        if name == part.id or name.startswith(f"{part.id}/")
        for key in entry.bodies
    ]
    file = path.parent / mesh["files"][0]
    clouds = [vertices(MeshReference(file, to_source, key)) for key in keys]
    return np.vstack([np.zeros((0, 3)), *clouds])
