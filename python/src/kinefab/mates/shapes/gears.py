"""Toothed wheels: how many teeth a part has about an axis, and which wheels mesh, by their pitch circles."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ...model import FaceKind
from ...spatial import Array, Pose, cross, perpendicular
from .features import Shape

FEWEST, MOST = 6, 400
"""Teeth of a wheel."""
REGULAR = 0.02
"""Share by which the gaps between teeth may differ."""
MOST_CORNERS = 12
"""Corners that a tooth has at one radius."""
PARALLEL = 1e-4


@dataclass(frozen=True, slots=True, eq=False)
class Wheel:
    """point, axis: of the wheel.  low, high: radii between which its teeth are, metres.  span: of the teeth along the
    axis from ``point``."""

    point: Array
    axis: Array
    teeth: int
    low: float
    high: float
    span: tuple[float, float]

    def placed(self, pose: Pose) -> Wheel:
        return Wheel(
            pose.point(self.point), pose.direction(self.axis), self.teeth, self.low, self.high, self.span
        )


@dataclass(frozen=True, slots=True, eq=False)
class Mesh:
    """Two wheels (numbers of parts) whose teeth are in each other.  ratio: turns of the second about the first's axis
    direction for one of the first, seen from what carries both."""

    first: int
    second: int
    a: Wheel
    b: Wheel
    ratio: float


def wheel_of(shape: Shape) -> Wheel | None:
    """The teeth of a part about one of its axes, in the shape's frame."""
    if len(shape.flats) + len(shape.others) < FEWEST:
        return None
    points = np.concatenate(
        [r.corners for r in shape.rounds] + [f.corners.reshape(-1, 3) for f in shape.flats] + [shape.others]
    )
    for point, axis in _axes(shape):
        found = _teeth(points, point, axis, _plain_radii(shape, point, axis))
        if found is not None:
            return found
    return None


def _axes(shape: Shape) -> Iterator[tuple[Array, Array]]:
    """The different axes of a part's cylinders, those of the longest ones first; a few of them."""
    lines: list[tuple[Array, Array]] = []
    longest = sorted(
        (r for r in shape.rounds if r.kind is FaceKind.CYLINDER), key=lambda r: r.span[0] - r.span[1]
    )
    for r in longest[:64]:
        if len(lines) >= 4:
            return
        if all(
            float(np.linalg.norm(cross(r.point - p, d))) > 1e-4 * shape.size
            or float(np.linalg.norm(cross(r.direction, d))) > PARALLEL
            for p, d in lines
        ):
            lines.append((r.point, r.direction))
            yield lines[-1]


def _plain_radii(shape: Shape, point: Array, axis: Array) -> Array:
    """Radii of circles about an axis that are no teeth: ends of whole surfaces of revolution."""
    found = [np.zeros(0)]
    for r in shape.rounds:
        off = float(np.linalg.norm(cross(r.point - point, axis)))
        if (
            r.is_round
            and off < 1e-4 * shape.size
            and float(np.linalg.norm(cross(r.direction, axis))) < PARALLEL
        ):
            offset = r.corners - point
            found.append(np.linalg.norm(offset - np.outer(offset @ axis, axis), axis=1))
    return np.unique(np.concatenate(found).round(9))


def _teeth(points: Array, point: Array, axis: Array, plain: Array) -> Wheel | None:
    """Radii at which the corners come round regularly, as often at two of them at least; plain: radii left out."""
    x = perpendicular(axis)
    offset = points - point
    u, v, height = offset @ x, offset @ cross(axis, x), offset @ axis
    radii = np.hypot(u, v)
    angles = np.arctan2(v, u)
    order = np.argsort(radii)
    largest = float(radii[order[-1]])
    steps = np.flatnonzero(np.diff(radii[order]) > 1e-4 * largest)
    levels: dict[int, list[tuple[float, np.ndarray]]] = {}
    for members in np.split(order, steps + 1):
        middle = float(radii[members].mean())
        is_plain = len(plain) and float(np.abs(plain - middle).min()) < 1e-4 * largest
        if len(members) >= FEWEST and not is_plain:
            count = _regular(angles[members])
            if count:
                levels.setdefault(count, []).append((float(radii[members].mean()), members))
    best = max((c for c in levels if len(levels[c]) >= 2), key=lambda c: (len(levels[c]), c), default=0)
    if not best:
        return None
    inside = np.concatenate([members for _, members in levels[best]])
    found = [radius for radius, _ in levels[best]]
    return Wheel(
        point, axis, best, min(found), max(found), (float(height[inside].min()), float(height[inside].max()))
    )


def _regular(angles: Array) -> int:
    """How often a pattern of a few corners comes round; 0 where it does not come round regularly."""
    ordered = np.sort(angles)
    keep = np.append(True, np.diff(ordered) > 1e-4)
    ordered = ordered[keep]
    if len(ordered) > 1 and ordered[0] + 2.0 * math.pi - ordered[-1] < 1e-4:
        ordered = ordered[:-1]
    gaps = np.diff(np.append(ordered, ordered[0] + 2.0 * math.pi))
    for pattern in range(1, MOST_CORNERS + 1):
        count, rest = divmod(len(ordered), pattern)
        if rest or not FEWEST <= count <= MOST:
            continue
        rows = gaps.reshape(count, pattern)
        if float(np.ptp(rows, axis=0).max()) <= REGULAR * 2.0 * math.pi / count:
            return count
    return 0


def meshes(wheels: Sequence[Wheel | None], pairs: Sequence[tuple[int, int]]) -> list[Mesh]:
    """Which of the pairs of parts are wheels in mesh: teeth in each other on parallel axes, as deep as teeth are."""
    found: list[Mesh] = []
    for i, j in pairs:
        a, b = wheels[i], wheels[j]
        if a is not None and b is not None and (ratio := _ratio(a, b)):
            found.append(Mesh(i, j, a, b, ratio))
    return found


def _ratio(a: Wheel, b: Wheel) -> float:
    if float(np.linalg.norm(cross(a.axis, b.axis))) > PARALLEL:
        return 0.0
    offset = b.point - a.point
    along = float(offset @ a.axis)
    distance = float(np.linalg.norm(offset - along * a.axis))
    sign = 1.0 if float(a.axis @ b.axis) > 0.0 else -1.0
    low, high = sorted((along + sign * b.span[0], along + sign * b.span[1]))
    if min(a.span[1], high) <= max(a.span[0], low) or distance < 1e-9:
        return 0.0
    outside = distance / (a.teeth + b.teeth)
    if _within(a, outside) and _within(b, outside):
        return -a.teeth / b.teeth
    if a.teeth != b.teeth:
        inside = distance / abs(b.teeth - a.teeth)
        if _within(a, inside) and _within(b, inside):
            return a.teeth / b.teeth
    return 0.0


def _within(wheel: Wheel, radius_a_tooth: float) -> bool:
    """Whether the pitch circle runs through the teeth, and these are about as high as that pitch has them (2 to 2.5
    modules, a module being twice the pitch radius a tooth)."""
    pitch = wheel.teeth * radius_a_tooth
    height = (wheel.high - wheel.low) / (2.0 * radius_a_tooth)
    return wheel.low < pitch < wheel.high and 1.2 < height < 3.2
